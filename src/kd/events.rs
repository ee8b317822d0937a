//! The event lists of nested nodes: what a strategy whose candidates are object bounds carries through the tree.
//!
//! Wald & Havran (2006): lists are sorted once, and a split keeps their order. Clipped (section 4.3), only objects that the
//! plane cuts get new events; these are sorted, and merged into the lists of the two sides, so building stays O(N log N).

use std::cmp::Ordering;

use crate::geom::{Aabb, Axis};

use super::arena::{give_up, make_room, merge, spread};
use super::clip::Cut;
use super::split::{LEFT, RIGHT, Split};

/// What happens to an object at a position. At equal positions ends come before planars before starts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum EventKind {
    End,
    Planar,
    Start,
}

/// A bound of an object on one axis, in 12 bytes: a build's memory is mostly events.
#[derive(Clone, Copy, Debug)]
#[repr(C, packed(4))]
pub(super) struct Event {
    position: f64,
    /// The kind in the two bits on top, the object below.
    tag: u32,
}

/// Bits of an event that name its object.
const OBJECT_BITS: u32 = 30;

/// Objects that events can tell apart, and a leaf can hold.
pub(super) const MOST_OBJECTS: usize = (1 << OBJECT_BITS) - 1;

impl Event {
    fn new(position: f64, kind: EventKind, object: u32) -> Self {
        let tag = (kind as u32) << OBJECT_BITS | object;
        Self { position, tag }
    }

    /// The start of an object that no one asks for.
    pub fn start_at(position: f64) -> Self {
        Self::new(position, EventKind::Start, 0)
    }

    #[inline(always)]
    pub fn position(self) -> f64 {
        self.position
    }

    #[inline(always)]
    pub fn object(self) -> u32 {
        self.tag & MOST_OBJECTS as u32
    }

    #[inline(always)]
    pub fn kind(self) -> EventKind {
        match self.tag >> OBJECT_BITS {
            0 => EventKind::End,
            1 => EventKind::Planar,
            _ => EventKind::Start,
        }
    }

    /// Whether the object is not flat and starts here.
    #[inline(always)]
    pub fn starts(self) -> bool {
        self.tag >> OBJECT_BITS == EventKind::Start as u32
    }

    /// Whether the object is flat.
    #[inline(always)]
    pub fn is_planar(self) -> bool {
        self.tag >> OBJECT_BITS == EventKind::Planar as u32
    }

    /// The same event where its object has another number.
    pub fn renamed(self, object: u32) -> Self {
        Self::new(self.position, self.kind(), object)
    }

    /// By position, then kind, then object: one number to compare. The bits of a number, but the sign of negative ones
    /// turned, are in its order (as in `f64::total_cmp`).
    #[inline(always)]
    fn key(self) -> i128 {
        let bits = self.position.to_bits() as i64;
        let ordered = bits ^ ((bits >> 63) as u64 >> 1) as i64;
        i128::from(ordered) << 32 | i128::from(self.tag)
    }
}

impl Ord for Event {
    #[inline(always)]
    fn cmp(&self, other: &Self) -> Ordering {
        self.key().cmp(&other.key())
    }
}

impl PartialOrd for Event {
    #[inline(always)]
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Eq for Event {}

impl PartialEq for Event {
    #[inline(always)]
    fn eq(&self, other: &Self) -> bool {
        self.key() == other.key()
    }
}

/// Append the events of an object with box `b` on one axis.
pub(super) fn push_events(events: &mut Vec<Event>, object: u32, b: &Aabb, axis: Axis) {
    // Adding +0 turns -0 into +0, so that equal positions are equal in a list's order too.
    let (lo, hi) = (b.lo[axis] + 0.0, b.hi[axis] + 0.0);
    if lo == hi {
        events.push(Event::new(lo, EventKind::Planar, object));
    } else {
        events.push(Event::new(lo, EventKind::Start, object));
        events.push(Event::new(hi, EventKind::End, object));
    }
}

/// All events of one axis, not sorted yet.
pub(super) fn unsorted_events(bounds: &[Aabb], axis: Axis) -> Vec<Event> {
    let mut events = Vec::with_capacity(2 * bounds.len());
    for (object, b) in bounds.iter().enumerate() {
        push_events(&mut events, object as u32, b, axis);
    }
    events
}

/// The sorted events of nested nodes on one axis: an arena, the current node's on top.
pub(super) struct EventList {
    axis: Axis,
    arena: Vec<Event>,
    /// Scratch: events of the parts of cut objects, by side (left, right).
    fresh: [Vec<Event>; 2],
}

impl EventList {
    /// Of a root with these events, sorted.
    pub fn new(axis: Axis, arena: Vec<Event>) -> Self {
        let fresh = Default::default();
        Self { axis, arena, fresh }
    }

    pub fn axis(&self) -> Axis {
        self.axis
    }

    /// The current node's, which begin at `start`.
    pub fn from(&self, start: usize) -> &[Event] {
        &self.arena[start..]
    }

    /// Give up what lies above this end.
    pub fn give_up(&mut self, end: usize) {
        give_up(&mut self.arena, end);
    }

    /// The list of the current node alone, its objects renamed.
    pub fn detached(&self, start: usize, name: impl Fn(u32) -> u32) -> Self {
        let events = self.from(start).iter();
        let arena = events.map(|e| e.renamed(name(e.object()))).collect();
        Self::new(self.axis, arena)
    }

    /// Tell from the events on the split's own axis to which sides the node's objects go: they are taken to go to both.
    pub fn classify(&self, start: usize, split: &Split, sides: &mut [u8]) {
        let s = split.position;
        let events = self.from(start);
        let below = events.partition_point(|e| e.position < s);
        let here = events[below..].iter().take_while(|e| e.position == s);
        let above = below + here.count();
        // What ends below is not on the right, what begins above not on the left. No branches: kinds are not to be guessed.
        for e in &events[..below] {
            sides[e.object() as usize] &= !(u8::from(!e.starts()) * RIGHT);
        }
        for e in &events[below..above] {
            sides[e.object() as usize] = match e.kind() {
                EventKind::End => LEFT,
                EventKind::Planar => split.planar_side(),
                EventKind::Start => RIGHT,
            };
        }
        for e in &events[above..] {
            sides[e.object() as usize] &= !(u8::from(e.kind() != EventKind::End) * LEFT);
        }
    }

    /// Sort the node's list, which begins at `start`, into the children's, where objects go to these sides, `lefts` of them
    /// left, or are cut (and go to neither). The right child's takes the node's place; returns where the left child's
    /// begins, on top of it.
    pub fn distribute(
        &mut self,
        split: &Split,
        sides: &[u8],
        lefts: usize,
        cut: &[Cut],
        start: usize,
    ) -> usize {
        let Self { axis, arena, fresh } = self;
        // The events of a whole that is cut end here: its parts have their own.
        fresh.iter_mut().for_each(Vec::clear);
        for &Cut { object, parts } in cut {
            for (part, fresh) in parts.iter().zip(&mut *fresh) {
                if let Some(part) = part {
                    push_events(fresh, object, part, *axis);
                }
            }
        }
        fresh.iter_mut().for_each(|fresh| fresh.sort_unstable());
        let [left, right] = fresh;

        let (s, lefts, gap) = (split.position, 2 * lefts, right.len());
        let (end, top) = if *axis == split.axis {
            // An event beyond the plane leaves the child's box: its object now reaches the face.
            spread(arena, start, lefts, gap, |e| {
                let inside = u8::from(e.position <= s) * LEFT + u8::from(e.position >= s) * RIGHT;
                sides[e.object() as usize] & inside
            })
        } else {
            spread(arena, start, lefts, gap, |e| sides[e.object() as usize])
        };
        merge(&mut arena[start..top], end - start, right);
        let old = arena.len() - top;
        make_room(arena, left.len());
        arena.extend_from_slice(left);
        merge(&mut arena[top..], old, left);
        top
    }
}
