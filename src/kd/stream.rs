//! Line streams: counting many lines at once, in f64, closed and unpadded; equal to the plain traversal on every node.
//!
//! Lines of one direction octant agree on which child is near. A list of them, each with its span [t0, t1], is pushed
//! down the tree: at a node the list's length is added to the hits, and each line is appended to the near list where
//! t >= t0 and to the far list where t <= t1. A visit costs a few sequential bytes instead of a cache miss per node.

use rayon::prelude::*;

use crate::geom::{Line, Span};

use super::traverse::{Stack, traverse_line};
use super::{Counts, NodeKind, Tree};

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

/// A line on its way down: its number in the set, and its span in the node.
#[derive(Clone, Copy, Default)]
struct Entry {
    t0: f64,
    t1: f64,
    line: u32,
}

/// The arenas of one thread, kept from block to block.
#[derive(Default)]
pub struct Streams {
    /// Origin and reciprocal direction of the octant's lines, by axis.
    lines: [Vec<[f64; 2]>; 3],
    /// Lists on their way down, the current node's on top.
    entries: Vec<Entry>,
    stack: Stack,
}

impl Streams {
    /// Add the counts of `lines`.
    pub fn count(&mut self, tree: &Tree, lines: &[Line], counts: &mut Counts) {
        counts.lines += lines.len() as u64;
        // A line parallel to a coordinate plane has no near child there: those few go down one by one.
        for line in lines.iter().filter(|l| l.is_axis_parallel()) {
            traverse_line(tree, line, Span::FULL, &mut self.stack, &mut *counts);
        }
        for octant in 0..8 {
            self.lines.iter_mut().for_each(Vec::clear);
            self.entries.clear();
            for line in lines
                .iter()
                .filter(|l| !l.is_axis_parallel() && l.octant() == octant)
            {
                let Some(Span { t0, t1 }) = tree.world.clip(line, Span::FULL) else {
                    continue;
                };
                let number = self.lines[0].len() as u32;
                for k in 0..3 {
                    self.lines[k].push([line.origin[k], line.inverse[k]]);
                }
                self.entries.push(Entry {
                    t0,
                    t1,
                    line: number,
                });
            }
            self.descend(tree, 0, octant, 0, self.entries.len(), counts);
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
                let (near_n, far_n) = self.divide(axis, split, start, n);
                let right_first = (octant >> axis) & 1;
                let near = left as usize + right_first;
                let far = left as usize + 1 - right_first;
                // The near list lies behind the far one: it goes first, then its place is free.
                self.descend(tree, near, octant, start + n, near_n, counts);
                self.descend(tree, far, octant, start, far_n, counts);
            }
        }
    }

    /// Divide a list at a plane: the far list takes its place, the near list comes behind it. Both appends write always
    /// and advance if the line goes there, so there is no branch to mispredict.
    #[inline]
    fn divide(&mut self, axis: usize, split: f64, start: usize, n: usize) -> (usize, usize) {
        let end = start + 2 * n;
        if self.entries.len() < end {
            self.entries.resize(end, Entry::default());
        }
        let (list, near) = self.entries[start..end].split_at_mut(n);
        let lines = &self.lines[axis][..];
        let (mut near_n, mut far_n) = (0, 0);
        for i in 0..n {
            let Entry { t0, t1, line } = list[i];
            let [origin, inverse] = lines[line as usize];
            let t = (split - origin) * inverse;
            near[near_n] = Entry {
                t0,
                t1: t1.min(t),
                line,
            };
            near_n += usize::from(t >= t0);
            list[far_n] = Entry {
                t0: t0.max(t),
                t1,
                line,
            };
            far_n += usize::from(t <= t1);
        }
        (near_n, far_n)
    }
}
