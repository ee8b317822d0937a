//! Candidate planes on one axis and the object counts on their sides, from one pass over sorted events.
//!
//! Wald & Havran (2006): every object has a start and an end event on each axis (one planar event if it is flat
//! there); they are sorted once, and their order survives every split. A node's list holds the events inside or on its
//! box; objects whose start or end lies outside are known from the object count.

use std::cmp::Ordering;

use crate::geom::{Aabb, Axis};

use super::split::{Coster, Split};

/// What happens to an object at a position. At equal positions ends come before planars before starts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum EventKind {
    End,
    Planar,
    Start,
}

/// A bound of an object on one axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Event {
    pub position: f64,
    pub object: u32,
    pub kind: EventKind,
}

impl Event {
    /// The total order of a list: by position, then kind, then object.
    pub fn order(&self, other: &Self) -> Ordering {
        self.position
            .total_cmp(&other.position)
            .then(self.kind.cmp(&other.kind))
            .then(self.object.cmp(&other.object))
    }
}

/// Append the events of an object with box `b` on one axis.
pub(super) fn push_events(events: &mut Vec<Event>, object: u32, b: &Aabb, axis: Axis) {
    // Adding +0 turns -0 into +0, so that equal positions are equal to `total_cmp` too.
    let (lo, hi) = (b.lo[axis] + 0.0, b.hi[axis] + 0.0);
    let event = |position, kind| Event {
        position,
        object,
        kind,
    };
    if lo == hi {
        events.push(event(lo, EventKind::Planar));
    } else {
        events.extend([event(lo, EventKind::Start), event(hi, EventKind::End)]);
    }
}

/// All events of one axis, in total order.
pub(super) fn sorted_events(bounds: &[Aabb], axis: Axis) -> Vec<Event> {
    let mut events = Vec::with_capacity(2 * bounds.len());
    for (object, b) in bounds.iter().enumerate() {
        push_events(&mut events, object as u32, b, axis);
    }
    events.sort_unstable_by(Event::order);
    events
}

/// One axis of one node: what a sweep reads.
pub(super) struct Sweep<'a> {
    /// Events of the axis inside or on the node's box.
    pub events: &'a [Event],
    /// Objects in the node.
    pub n: usize,
}

impl Sweep<'_> {
    /// The cheapest candidate; of equals the lowest. Candidates are the object bounds inside `window` and the positions
    /// `extra` (ascending), all strictly inside the node.
    pub fn cheapest(
        &self,
        coster: &Coster,
        window: Option<(f64, f64)>,
        extra: &[f64],
    ) -> Option<Split> {
        let mut best = None;
        self.each(window, extra, |s, left, planar, right| {
            coster.offer(&mut best, s, left, planar, right);
        });
        best
    }

    /// Offer each object bound inside `window` and each position of `extra` (ascending), with the number of objects that
    /// go left, lie in the plane, and go right.
    #[inline]
    pub fn each(
        &self,
        window: Option<(f64, f64)>,
        extra: &[f64],
        mut offer: impl FnMut(f64, usize, usize, usize),
    ) {
        let window = window.unwrap_or((f64::INFINITY, f64::NEG_INFINITY));
        let in_window = |s: f64| window.0 <= s && s <= window.1;
        // Left of the first event: objects that start below the node are on the left, all are on the right.
        let begun = self
            .events
            .iter()
            .filter(|e| e.kind != EventKind::End)
            .count();
        let mut left = self.n - begun;
        let mut right = self.n;
        let mut extra = extra.iter().copied().peekable();
        let mut rest = self.events;
        while let Some(first) = rest.first() {
            let s = first.position;
            while let Some(x) = extra.next_if(|&x| x < s) {
                offer(x, left, 0, right);
            }
            // All events at s: first what ends here, then what lies here, then what starts here.
            let run = |events: &[Event], kind| {
                events
                    .iter()
                    .take_while(|e| e.position == s && e.kind == kind)
                    .count()
            };
            let ends = run(rest, EventKind::End);
            let planars = run(&rest[ends..], EventKind::Planar);
            let starts = run(&rest[ends + planars..], EventKind::Start);
            rest = &rest[ends + planars + starts..];
            right -= ends + planars;
            let asked = extra.next_if(|&x| x == s).is_some();
            if asked || in_window(s) {
                offer(s, left, planars, right);
            }
            left += planars + starts;
        }
        for x in extra {
            offer(x, left, 0, right);
        }
    }
}
