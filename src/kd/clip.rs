//! Clipped ("perfect") splits: an object cut by a plane goes to each side with the bounds of its part there.

use crate::geom::{Aabb, Axis, Clipper, Objects, clip_slack};

use super::split::{LEFT, RIGHT};

/// An object cut by a plane.
pub(super) struct Cut {
    pub object: u32,
    /// Bounds of what lies on the left and on the right; at least one is there.
    pub parts: [Option<Aabb>; 2],
}

/// What a builder that clips has besides the boxes.
pub(super) struct Clipping<'a> {
    objects: &'a Objects,
    slack: f64,
    clipper: Clipper,
    /// Objects cut by the current plane.
    pub cut: Vec<Cut>,
    /// Right parts of all planes above, for when their left sides are done.
    waiting: Vec<(u32, Aabb)>,
}

impl<'a> Clipping<'a> {
    pub fn new(objects: &'a Objects, world: &Aabb) -> Self {
        Self {
            objects,
            slack: clip_slack(world),
            clipper: Clipper::default(),
            cut: Vec::new(),
            waiting: Vec::new(),
        }
    }

    /// What a builder of a subtree needs.
    pub fn for_subtree(&self) -> Self {
        Self {
            objects: self.objects,
            slack: self.slack,
            clipper: Clipper::default(),
            cut: Vec::new(),
            waiting: Vec::new(),
        }
    }

    /// Cut the objects (known to the scene by these names) that go to both sides of the plane `x[axis] = s`: tell the sides
    /// where each has a part, give it its left part's bounds and keep the right part's for later.
    pub fn cut(
        &mut self,
        objects: &[u32],
        names: &[u32],
        sides: &mut [u8],
        bounds: &mut [Aabb],
        (axis, s): (Axis, f64),
    ) {
        self.cut.clear();
        for &object in objects {
            let i = object as usize;
            if sides[i] != LEFT | RIGHT {
                continue;
            }
            let (left, right) = bounds[i].split(axis, s);
            let parts = [left, right].map(|region| {
                let clipper = &mut self.clipper;
                self.objects
                    .clipped_bounds(names[i], &region, self.slack, clipper)
            });
            assert!(parts.iter().any(Option::is_some), "object {object} lost");
            sides[i] = u8::from(parts[0].is_some()) * LEFT + u8::from(parts[1].is_some()) * RIGHT;
            if let Some(left) = parts[0] {
                bounds[i] = left;
            }
            self.waiting.extend(parts[1].map(|right| (object, right)));
            self.cut.push(Cut { object, parts });
        }
    }

    /// How many right parts wait.
    pub fn waiting(&self) -> usize {
        self.waiting.len()
    }

    /// The left side is done: give the objects whose right parts wait since there were `first` of them these bounds.
    pub fn turn_right(&mut self, first: usize, bounds: &mut [Aabb]) {
        for (object, part) in self.waiting.drain(first..) {
            bounds[object as usize] = part;
        }
    }
}
