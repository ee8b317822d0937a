//! Candidate planes on one axis and the object counts on their sides, from one pass over sorted events.
//!
//! Wald & Havran (2006): every object has a start and an end event on each axis (one planar event if it is flat
//! there); they are sorted once, and their order survives every split. A node's list holds the events inside or on its
//! box; objects whose start or end lies outside are known from the object count.

use crate::geom::{Aabb, Axis};

use super::events::{Event, EventKind, unsorted_events};
use super::split::{Coster, Split};

/// All events of one axis, in total order.
pub(super) fn sorted_events(bounds: &[Aabb], axis: Axis) -> Vec<Event> {
    let mut events = unsorted_events(bounds, axis);
    events.sort_unstable();
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
        let (lo, hi) = coster.faces();
        let all = window.is_some_and(|(from, to)| from <= lo && hi <= to);
        if all && extra.is_empty() && coster.is_monotone() {
            let (starts, planars) = self.events.iter().fold((0, 0), |(starts, planars), e| {
                (
                    starts + usize::from(e.starts()),
                    planars + usize::from(e.is_planar()),
                )
            });
            if planars == 0 {
                return self.cheapest_bound(coster, starts);
            }
        }
        let mut best = None;
        self.each(window, extra, |s, left, planar, right| {
            coster.offer(&mut best, s, left, planar, right);
        });
        best
    }

    /// The cheapest object bound strictly inside the node, of equals the lowest, where no object is flat and `starts` of the
    /// events are starts: each event is looked at as if no other stood where it does.
    ///
    /// Of the events at one position, the last end, or the first start if there is none, sees the counts of the plane there.
    /// All others see too many objects on a side, and none costs less. So the least cost is that of the plane where it is
    /// found, whose counts are then told from its neighbours.
    fn cheapest_bound(&self, coster: &Coster, starts: usize) -> Option<Split> {
        let (lo, hi) = coster.faces();
        let on_lo = self.events.iter().take_while(|e| e.position() <= lo);
        let from = on_lo.count();
        let on_hi = self.events[from..].iter().rev();
        let to = self.events.len() - on_hi.take_while(|e| e.position() >= hi).count();
        let inside = &self.events[from..to];
        let below = starting(&self.events[..from]);

        // Before the first event, objects that start below the node are on the left, all are on the right.
        let mut least = Least {
            left: (self.n - starts + below) as i32,
            right: (self.n - (from - below)) as i32,
            cost: f64::INFINITY,
            at: 0,
            counts: [0; 2],
        };
        least.counts = [least.left, least.right];
        let (blocks, rest) = inside.as_chunks();
        for (i, block) in blocks.iter().enumerate() {
            least.look_at(coster, block, i * BLOCK);
        }
        if let Some(last) = rest.last() {
            // More starts where the last event is: they see no fewer objects on a side than it does.
            let mut block = [Event::start_at(last.position()); BLOCK];
            block[..rest.len()].copy_from_slice(rest);
            least.look_at(coster, &block, blocks.len() * BLOCK);
        }

        let event = inside.get(least.at)?;
        let there = |e: &&Event| e.position() == event.position();
        let earlier = inside[..least.at].iter().rev().take_while(there);
        let later = inside[least.at + 1..].iter().take_while(there);
        let [left, right] = least.counts.map(|count| count as usize);
        let left = left - earlier.filter(|e| e.starts()).count();
        let right = right - later.filter(|e| !e.starts()).count();
        coster.split(event.position(), left, 0, right)
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
        let mut left = self.n - starting(self.events);
        let mut right = self.n;
        let mut extra = extra.iter().copied().peekable();
        let mut rest = self.events;
        while let Some(first) = rest.first() {
            let s = first.position();
            while let Some(x) = extra.next_if(|&x| x < s) {
                offer(x, left, 0, right);
            }
            // All events at s: first what ends here, then what lies here, then what starts here.
            let run = |events: &[Event], kind| {
                events
                    .iter()
                    .take_while(|e| e.position() == s && e.kind() == kind)
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

/// Events whose costs are computed together: without a branch, so that a compiler can use vectors.
const BLOCK: usize = 8;

/// A sweep on its way, and the least cost it has seen.
struct Least {
    /// Objects on the left of the next event's position, and on its right or ending there.
    left: i32,
    right: i32,
    cost: f64,
    /// Where, by number of the event.
    at: usize,
    /// Objects on the left and right there.
    counts: [i32; 2],
}

impl Least {
    /// Pass these events, of which the first has number `first`.
    #[inline(always)]
    fn look_at(&mut self, coster: &Coster, events: &[Event; BLOCK], first: usize) {
        let (mut left, mut right, mut costs) = ([0; BLOCK], [0; BLOCK], [0.0; BLOCK]);
        for i in 0..BLOCK {
            let starts = i32::from(events[i].starts());
            self.right -= 1 - starts;
            (left[i], right[i]) = (self.left, self.right);
            self.left += starts;
        }
        for i in 0..BLOCK {
            let counts = [left[i], right[i]].map(f64::from);
            costs[i] = coster.cost(events[i].position(), counts[0], counts[1]);
        }
        if costs
            .iter()
            .fold(false, |any, &cost| any | (cost < self.cost))
        {
            for i in 0..BLOCK {
                if costs[i] < self.cost {
                    self.cost = costs[i];
                    self.at = first + i;
                    self.counts = [left[i], right[i]];
                }
            }
        }
    }
}

/// How many of these events begin an object (and, if planar, end it).
#[inline]
fn starting(events: &[Event]) -> usize {
    events.iter().filter(|e| e.kind() != EventKind::End).count()
}

#[cfg(test)]
mod tests;
