//! The event lists of nested nodes: what a strategy whose candidates are object bounds carries through the tree.
//!
//! Wald & Havran (2006): lists are sorted once, and a split keeps their order. Clipped (section 4.3), only objects that the
//! plane cuts get new events; these are sorted, and merged into the lists of the two sides, so building stays O(N log N).

use crate::geom::{Aabb, Axis};

use super::arena::spread;
use super::clip::Cut;
use super::split::{LEFT, RIGHT, Split};
use super::sweep::{Event, push_events, sorted_events};

/// Arenas of sorted events by axis, the current node's on top.
pub(super) struct EventLists {
    arenas: [Vec<Event>; 3],
    /// Scratch: events of the parts of cut objects, by side (left, right) and axis.
    fresh: [[Vec<Event>; 3]; 2],
}

impl EventLists {
    /// The root's lists.
    pub fn new(bounds: &[Aabb]) -> Self {
        Self {
            arenas: [0, 1, 2].map(|axis| sorted_events(bounds, axis)),
            fresh: Default::default(),
        }
    }

    /// The current node's list, which begins at `start`.
    pub fn on(&self, axis: Axis, start: usize) -> &[Event] {
        &self.arenas[axis][start..]
    }

    /// Give up what lies on top of these ends.
    pub fn truncate(&mut self, ends: [usize; 3]) {
        for (arena, end) in self.arenas.iter_mut().zip(ends) {
            arena.truncate(end);
        }
    }

    /// Sort the node's lists, which begin at `starts`, into the children's, where objects go to these sides or are cut.
    /// Returns where the left child's begin, on top, and where the right child's, which take the node's own place, end.
    pub fn distribute(
        &mut self,
        split: &Split,
        sides: &mut [u8],
        cut: &[Cut],
        starts: [usize; 3],
    ) -> ([usize; 3], [usize; 3]) {
        self.fresh.iter_mut().flatten().for_each(Vec::clear);
        for &Cut { object, parts } in cut {
            // The whole's events here end: the parts have their own.
            sides[object as usize] = 0;
            for (part, fresh) in parts.iter().zip(&mut self.fresh) {
                if let Some(part) = part {
                    for (axis, fresh) in fresh.iter_mut().enumerate() {
                        push_events(fresh, object, part, axis);
                    }
                }
            }
        }
        for fresh in self.fresh.iter_mut().flatten() {
            fresh.sort_unstable_by(Event::order);
        }
        let (mut tops, mut ends) = ([0; 3], [0; 3]);
        for (k, arena) in self.arenas.iter_mut().enumerate() {
            let (start, s) = (starts[k], split.position);
            let (top, end) = if k == split.axis {
                // An event beyond the plane leaves the child's box: its object now reaches the face.
                spread(arena, start, |e| {
                    let inside =
                        u8::from(e.position <= s) * LEFT + u8::from(e.position >= s) * RIGHT;
                    sides[e.object as usize] & inside
                })
            } else {
                spread(arena, start, |e| sides[e.object as usize])
            };
            // At most as many as the objects had here, so the right list still ends below the left one.
            let end = merge(&self.fresh[1][k], arena, start, end);
            debug_assert!(end <= top);
            let whole = arena.len();
            merge(&self.fresh[0][k], arena, top, whole);
            (tops[k], ends[k]) = (top, end);
        }
        (tops, ends)
    }
}

/// Merge sorted events into the sorted `arena[start..end]`; what lies behind is overwritten. Returns the new end.
fn merge(mut new: &[Event], arena: &mut Vec<Event>, start: usize, end: usize) -> usize {
    let Some(&any) = new.first() else {
        return end;
    };
    let merged = end + new.len();
    if merged > arena.len() {
        arena.resize(merged, any);
    }
    // From the back: what is written over has been read.
    let (mut old, mut at) = (end, merged);
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
