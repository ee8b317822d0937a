//! Line streams: counting many lines at once, in f64, closed and unpadded; equal to the plain traversal on every node.
//!
//! Lines of one direction octant agree on which child is near. A list of them, each with its span [t0, t1], is pushed
//! down the tree: at a node the list's length is added to the hits, and each line is appended to the near list where
//! t >= t0 and to the far list where t <= t1. A visit costs a few sequential bytes instead of a cache miss per node.

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod avx512;
mod lanes;
mod lists;
mod order;
#[cfg(test)]
mod tests;
mod trace;

use glam::DVec3;
use rayon::prelude::*;

use crate::geom::{Line, Span};

use super::traverse::{Stack, traverse_line};
use super::{Counts, NodeKind, Tree};

pub use lanes::{Lane, Lanes};
use lists::{Cut, Lists, room};
use order::Order;
pub use trace::RayStreams;

/// Lines in one block. Blocks go to threads as they are free; counts are integers, so the result is the same.
pub const BLOCK: u64 = 1 << 17;

/// Count the lines `0..lines`, given as `make(start..end)`, over all threads of the current rayon pool.
///
/// `done` is told how many lines have been counted since it was last called.
pub fn count_lines<I>(
    tree: &Tree,
    lines: u64,
    make: impl Fn(std::ops::Range<u64>) -> I + Sync,
    done: impl Fn(u64) + Sync,
) -> Counts
where
    I: Iterator<Item = Line>,
{
    let count_blocks = |mut state: (Counts, Streams, Vec<Line>), block: u64| {
        let (counts, streams, buffer) = &mut state;
        let start = block * BLOCK;
        let end = lines.min(start + BLOCK);
        buffer.clear();
        buffer.extend(make(start..end));
        streams.count(tree, buffer, counts);
        done(end - start);
        state
    };
    (0..lines.div_ceil(BLOCK))
        .into_par_iter()
        .fold(
            || (Counts::new(tree), Streams::default(), Vec::new()),
            count_blocks,
        )
        .map(|state| state.0)
        .reduce(|| Counts::new(tree), |a, b| a.merge(&b))
}

/// The arenas of one thread, kept from block to block.
pub struct Streams {
    /// The octant's lines, in order.
    octant: Vec<Line>,
    /// Their origins and reciprocal directions, by axis.
    lines: [Vec<[f64; 2]>; 3],
    /// Lists on their way down.
    lists: Lists<DVec3>,
    stack: Stack,
}

impl Default for Streams {
    fn default() -> Self {
        Self::with(Lanes::widest())
    }
}

impl Streams {
    /// With these instructions; counts of finite lines are the same with all of them.
    pub fn with(lanes: Lanes) -> Self {
        Self {
            octant: Vec::new(),
            lines: Default::default(),
            lists: Lists::new(lanes),
            stack: Stack::default(),
        }
    }

    /// Add the counts of `lines`, which are finite.
    ///
    /// # Panics
    /// If there are 2^31 or more.
    pub fn count(&mut self, tree: &Tree, lines: &[Line], counts: &mut Counts) {
        counts.lines += lines.len() as u64;
        let mut order = Order::new(&tree.world);
        for (number, line) in lines.iter().enumerate() {
            // A line parallel to a coordinate plane has no near child there: those few go down one by one.
            if line.is_axis_parallel() {
                traverse_line(tree, line, Span::FULL, &mut self.stack, &mut *counts);
            } else if let Some(span) = tree.world.clip(line, Span::FULL) {
                order.add(number, line, span);
            }
        }
        for (octant, numbers) in order.octants() {
            // In a loop of its own, so that many of these lines are on their way from memory at a time.
            self.octant.clear();
            self.octant.extend(numbers.map(|number| lines[number]));
            self.lines.iter_mut().for_each(Vec::clear);
            self.lists.clear();
            for line in &self.octant {
                let span = tree.world.clip(line, Span::FULL);
                let Span { t0, t1 } = span.expect("those that miss the world are not in the order");
                self.lists.push(t0, t1, self.lines[0].len() as u32);
                for (k, lines) in self.lines.iter_mut().enumerate() {
                    lines.push([line.origin[k], line.inverse[k]]);
                }
            }
            let n = self.lines[0].len();
            self.descend(tree, 0, octant, 0, n, counts);
        }
    }

    /// Count the list `start..start + n` at `node` and below it; the list's place is free afterwards.
    fn descend(
        &mut self,
        tree: &Tree,
        node: usize,
        octant: usize,
        start: usize,
        n: usize,
        counts: &mut Counts,
    ) {
        if n == 0 {
            return;
        }
        counts.hits[node] += n as u64;
        match tree.nodes[node].kind() {
            NodeKind::Leaf { count, .. } => {
                counts.work.leaves += n as u64;
                counts.work.tests += n as u64 * u64::from(count);
            }
            NodeKind::Inner { axis, split, left } => {
                counts.work.inner += n as u64;
                let cut = Cut {
                    position: split,
                    padding: 0.0,
                    lines: &self.lines[axis],
                };
                let (near_n, far_n) = self.lists.divide(&cut, start, n);
                let right_first = (octant >> axis) & 1;
                let near = left as usize + right_first;
                let far = left as usize + 1 - right_first;
                // The near list lies behind the far one: it goes first, then its place is free.
                self.descend(tree, near, octant, start + room(n), near_n, counts);
                self.descend(tree, far, octant, start, far_n, counts);
            }
        }
    }
}
