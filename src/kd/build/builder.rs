//! The builder of a subtree: its lists, and how they become the lists of its children's subtrees.
//!
//! A builder grows its subtree depth first, in stacks that its nodes share, without an allocation of a node's own. At the
//! root, and below it while nodes are large and there are threads to share them among, it cuts one node and leaves the left
//! child to another builder, in whose lists objects have new numbers, from 0 on in their old order.

use std::borrow::Cow;

use rayon::slice::ParallelSliceMut;

use crate::geom::Aabb;
use crate::kd::Rules;
use crate::kd::arena::{give_up, spread};
use crate::kd::clip::Clipping;
use crate::kd::events::{EventList, unsorted_events};
use crate::kd::planes::Fractions;
use crate::kd::split::{LEFT, RIGHT, Split};
use crate::kd::strategy::Positions;
use crate::kd::sweep::sorted_events;

use super::axes::each_axis;
use super::choose::{Candidate, Search};
use super::growth::Growth;

/// What all builders of a tree have in common.
pub(super) struct Frame<'a> {
    pub rules: &'a Rules,
    pub depth_bound: usize,
    pub root_area: f64,
    /// Where the strategy's named planes are, between its ends.
    pub fractions: Fractions,
    /// Whether candidates are found in sorted events.
    pub sweeps: bool,
    /// Objects from which on a node is shared among threads.
    pub grain: usize,
}

impl<'a> Frame<'a> {
    pub fn new(rules: &'a Rules, objects: usize, world: &Aabb, sweeps: bool, grain: usize) -> Self {
        Self {
            rules,
            depth_bound: rules.stop.depth_bound(objects),
            root_area: world.surface_area(),
            fractions: rules.strategy.parts().1.fractions(),
            sweeps,
            grain,
        }
    }

    /// Whether nodes look at their objects' boxes, not only at events.
    fn reads_boxes(&self) -> bool {
        let (_, positions) = self.rules.strategy.parts();
        !self.sweeps || self.rules.clipped || positions != Positions::AllBounds
    }
}

/// Where a node's lists begin in its builder's arenas; they end where the arenas do.
#[derive(Clone, Copy, Default)]
pub(super) struct Region {
    pub objects: usize,
    pub events: [usize; 3],
}

/// What the way from the root to a node leaves to the stop rule.
#[derive(Clone, Copy)]
pub(super) struct Path {
    pub depth: usize,
    /// Planes of little gain still allowed, see [`StopRule::patience`](crate::kd::StopRule).
    pub patience: usize,
}

pub(super) struct Builder<'a> {
    frame: &'a Frame<'a>,
    /// The scene's number of each object.
    names: Vec<u32>,
    /// Every object's box, where they are read; clipped, that of its part in the node at hand.
    bounds: Cow<'a, [Aabb]>,
    /// Arena of object lists: a stack, the current node's on top.
    objects: Vec<u32>,
    /// Sorted events, likewise, where the strategy sweeps.
    events: Option<[EventList; 3]>,
    /// Scratch of the search for planes, by axis.
    searches: [Search; 3],
    /// Sides of the current split an object goes to: bit 0 left, bit 1 right.
    sides: Vec<u8>,
    /// Set where the rules clip.
    clipping: Option<Clipping<'a>>,
    growth: Growth,
}

impl<'a> Builder<'a> {
    /// A builder of the whole tree.
    pub fn new(frame: &'a Frame<'a>, bounds: &'a [Aabb], clipping: Option<Clipping<'a>>) -> Self {
        let shared = bounds.len() >= frame.grain;
        let sorted = |axis| {
            let events = if shared {
                let mut events = unsorted_events(bounds, axis);
                events.par_sort_unstable();
                events
            } else {
                sorted_events(bounds, axis)
            };
            EventList::new(axis, events)
        };
        let events = frame.sweeps.then(|| each_axis(shared, [0, 1, 2], sorted));
        let names = (0..bounds.len() as u32).collect();
        Self::of(frame, names, Cow::Borrowed(bounds), events, clipping)
    }

    /// A builder of a subtree of all objects with these names, boxes and events.
    fn of(
        frame: &'a Frame<'a>,
        names: Vec<u32>,
        bounds: Cow<'a, [Aabb]>,
        events: Option<[EventList; 3]>,
        clipping: Option<Clipping<'a>>,
    ) -> Self {
        Self {
            frame,
            objects: (0..names.len() as u32).collect(),
            sides: vec![0; names.len()],
            names,
            bounds,
            events,
            searches: [0, 1, 2].map(|axis| Search::new(axis, &frame.fractions)),
            clipping,
            growth: Growth::bud(),
        }
    }

    /// Build the subtree below a node with these bounds.
    pub fn build(mut self, bounds: Aabb, path: Path) -> Growth {
        let whole = Region::default();
        if !self.is_shared(whole) {
            self.grow(0, &bounds, path, whole);
            return self.growth;
        }
        let Some((split, patience)) = self.choose(&bounds, path, whole) else {
            self.make_leaf(0, path.depth, whole);
            return self.growth;
        };
        let below = path.below(patience);
        let (left_box, right_box) = bounds.split(split.axis, split.position);
        let top = self.distribute(&split, whole);
        let left = self.detached(top);
        self.turn_right(0, top);
        let (left, right) = rayon::join(
            || left.build(left_box, below),
            || self.build(right_box, below),
        );
        Growth::cut(&split, [left, right])
    }

    /// Make node `node` and all below it from the lists on top of the arenas.
    fn grow(&mut self, node: usize, bounds: &Aabb, path: Path, region: Region) {
        let Some((split, patience)) = self.choose(bounds, path, region) else {
            self.make_leaf(node, path.depth, region);
            return;
        };
        let below = path.below(patience);
        let (left_box, right_box) = bounds.split(split.axis, split.position);
        // Both children side by side, then their subtrees, the left one first.
        let left = self.growth.make_inner(node, &split);
        let waiting = self.clipping.as_ref().map_or(0, Clipping::waiting);
        let top = self.distribute(&split, region);
        self.grow(left, &left_box, below, top);
        self.turn_right(waiting, top);
        self.grow(left + 1, &right_box, below, region);
    }

    fn make_leaf(&mut self, node: usize, depth: usize, region: Region) {
        let objects = self.objects[region.objects..].iter();
        let named = objects.map(|&object| self.names[object as usize]);
        self.growth.make_leaf(node, named, depth);
    }

    fn choose(&mut self, bounds: &Aabb, path: Path, region: Region) -> Option<(Split, usize)> {
        let events = self.events.as_ref();
        let candidate = Candidate {
            frame: self.frame,
            bounds,
            objects: &self.objects[region.objects..],
            boxes: &self.bounds,
            events: events.map(|lists| lists.each_ref().map(|l| l.from(region.events[l.axis()]))),
        };
        candidate.choose(path, &mut self.searches)
    }

    /// Whether a node is for several threads.
    fn is_shared(&self, region: Region) -> bool {
        self.objects.len() - region.objects >= self.frame.grain
    }

    /// Sort the node's lists into the children's: the right child's take its place, the left child's follow on top. Returns
    /// where these begin.
    fn distribute(&mut self, split: &Split, region: Region) -> Region {
        let shared = self.is_shared(region);
        let objects = &self.objects[region.objects..];
        let sides = &mut self.sides;
        if let Some(events) = &self.events {
            for &object in objects {
                sides[object as usize] = LEFT | RIGHT;
            }
            let start = region.events[split.axis];
            events[split.axis].classify(start, split, sides);
        } else {
            for &object in objects {
                sides[object as usize] = split.sides(&self.bounds[object as usize]);
            }
        }
        if let Some(clipping) = &mut self.clipping {
            let plane = (split.axis, split.position);
            let bounds = self.bounds.to_mut();
            clipping.cut(objects, &self.names, sides, bounds, plane);
        }
        let goes_left = |&&object: &&u32| sides[object as usize] & LEFT != 0;
        let lefts = objects.iter().filter(goes_left).count();
        let (_, top) = spread(&mut self.objects, region.objects, lefts, 0, |&object| {
            sides[object as usize]
        });
        let mut top = Region {
            objects: top,
            ..Region::default()
        };
        if let Some(events) = &mut self.events {
            let cut = self.clipping.as_ref().map_or(&[][..], |c| &c.cut);
            for cut in cut {
                sides[cut.object as usize] = 0;
            }
            top.events = each_axis(shared, events.each_mut(), |list| {
                list.distribute(split, sides, lefts, cut, region.events[list.axis()])
            });
        }
        top
    }

    /// The left child's subtree is done or another builder's: give up its lists, which begin at `top`, and the parts of
    /// objects there, for the right parts that wait since there were `waiting` of them.
    fn turn_right(&mut self, waiting: usize, top: Region) {
        if let Some(clipping) = &mut self.clipping {
            clipping.turn_right(waiting, self.bounds.to_mut());
        }
        give_up(&mut self.objects, top.objects);
        for (list, end) in self.events.iter_mut().flatten().zip(top.events) {
            list.give_up(end);
        }
    }

    /// A builder for the node on top alone.
    fn detached(&self, region: Region) -> Self {
        let objects = &self.objects[region.objects..];
        let mut numbers = vec![0; self.sides.len()];
        for (number, &object) in (0..).zip(objects) {
            numbers[object as usize] = number;
        }
        let all = objects.iter().map(|&object| object as usize);
        let bounds = if self.frame.reads_boxes() {
            all.clone().map(|object| self.bounds[object]).collect()
        } else {
            Vec::new()
        };
        let detached = |list: &EventList| {
            let start = region.events[list.axis()];
            list.detached(start, |object| numbers[object as usize])
        };
        let events = self.events.as_ref();
        Self::of(
            self.frame,
            all.map(|object| self.names[object]).collect(),
            Cow::Owned(bounds),
            events.map(|lists| each_axis(true, lists.each_ref(), detached)),
            self.clipping.as_ref().map(Clipping::for_subtree),
        )
    }
}

impl Path {
    fn below(self, patience: usize) -> Self {
        Self {
            depth: self.depth + 1,
            patience,
        }
    }
}
