//! Clipped ("perfect") splits: an object cut by a plane goes to each side with the bounds of its part there.
//!
//! Wald & Havran (2006), section 4.3: only objects that a plane cuts get new events; these are sorted, and merged into
//! the lists of the two sides, so building stays O(N log N).

use crate::geom::{Aabb, Axis, Clipper, Objects, clip_slack};

use super::build::{LEFT, RIGHT};
use super::sweep::{Event, push_events};

/// What a builder that clips has besides the boxes.
pub(super) struct Clipping<'a> {
    objects: &'a Objects,
    slack: f64,
    clipper: Clipper,
    /// Objects cut by the current plane.
    pub cut: Vec<u32>,
    /// Events of their parts, sorted, by side (left, right) and axis.
    events: [[Vec<Event>; 3]; 2],
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
            events: Default::default(),
            waiting: Vec::new(),
        }
    }

    /// Cut the objects that go to both sides of the plane `x[axis] = s`: tell the sides where each has a part, give it its
    /// left part's bounds and keep the right part's for later.
    pub fn cut(
        &mut self,
        objects: &[u32],
        sides: &mut [u8],
        bounds: &mut [Aabb],
        (axis, s): (Axis, f64),
    ) {
        self.cut.clear();
        self.events.iter_mut().flatten().for_each(Vec::clear);
        for &object in objects {
            let i = object as usize;
            if sides[i] != LEFT | RIGHT {
                continue;
            }
            let (left, right) = bounds[i].split(axis, s);
            let parts = [left, right].map(|region| {
                let clipper = &mut self.clipper;
                self.objects
                    .clipped_bounds(object, &region, self.slack, clipper)
            });
            debug_assert!(parts.iter().any(Option::is_some), "object {object} lost");
            sides[i] = u8::from(parts[0].is_some()) * LEFT + u8::from(parts[1].is_some()) * RIGHT;
            for (part, events) in parts.iter().zip(&mut self.events) {
                if let Some(part) = part {
                    for (axis, events) in events.iter_mut().enumerate() {
                        push_events(events, object, part, axis);
                    }
                }
            }
            if let Some(left) = parts[0] {
                bounds[i] = left;
            }
            self.waiting.extend(parts[1].map(|right| (object, right)));
            self.cut.push(object);
        }
        for events in self.events.iter_mut().flatten() {
            events.sort_unstable_by(Event::order);
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

    /// Merge the new events of one side (0 left, 1 right) and axis into the sorted `arena[start..end]`; what lies behind
    /// is overwritten. Returns the new end.
    pub fn merge(
        &self,
        side: usize,
        axis: Axis,
        arena: &mut Vec<Event>,
        start: usize,
        end: usize,
    ) -> usize {
        let new = &self.events[side][axis];
        let Some(&any) = new.first() else {
            return end;
        };
        let merged = end + new.len();
        if merged > arena.len() {
            arena.resize(merged, any);
        }
        // From the back: what is written over has been read.
        let (mut old, mut new) = (end, &new[..]);
        let mut at = merged;
        while let Some((last, rest)) = new.split_last() {
            at -= 1;
            if old > start && arena[old - 1].order(last).is_gt() {
                old -= 1;
                arena[at] = arena[old];
            } else {
                arena[at] = *last;
                new = rest;
            }
        }
        merged
    }
}
