//! What a kernel visits and hits, held against the exact oracle on the kernel's own inputs.

use std::ops::AddAssign;

use rayon::prelude::*;

use crate::exact::{Meeting, line_box, line_triangle};
use crate::geom::{Line, Ray, Real, Span};
use crate::kd::{Mode, NodeKind, Planes, Probe, Stack, traverse};

use super::numbers::{Exact, Subject};

/// Distance from a tie, in units of the kernel's numbers, below which an error is counted apart.
const TIE: f64 = 8.0;

/// Pieces that go to the threads; each has its own floating sums, put together in the order of the pieces.
const PIECES: usize = 64;

/// Verdicts of a kind, and those that were wrong.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Errors {
    /// Nodes that lines meet, or tests of triangles.
    pub judged: u64,
    /// Taken for met though missed.
    pub wrong: u64,
    /// Taken for missed though met.
    pub missed: u64,
    /// Either, within 8 ulp of a tie.
    pub tied: u64,
}

impl Errors {
    fn add(&mut self, met: bool, ulps: f64) {
        if ulps < TIE {
            self.tied += 1;
        } else if met {
            self.missed += 1;
        } else {
            self.wrong += 1;
        }
    }

    /// Errors of all kinds.
    pub fn all(&self) -> u64 {
        self.wrong + self.missed + self.tied
    }
}

impl AddAssign for Errors {
    fn add_assign(&mut self, other: Self) {
        self.judged += other.judged;
        self.wrong += other.wrong;
        self.missed += other.missed;
        self.tied += other.tied;
    }
}

/// What came of a set of lines.
#[derive(Clone, Debug, Default)]
pub struct Judged {
    /// Nodes.
    pub visits: Errors,
    /// Triangles.
    pub tests: Errors,
    /// Lines that the kernel took to each node.
    pub hits: Vec<u64>,
    /// Sums of the lines' scores and of their squares: the slope is the mean score.
    pub scores: [f64; 2],
}

/// Nodes visited, and the references of their leaves.
#[derive(Default)]
struct Visited(Vec<u32>);

impl Probe for Visited {
    #[inline(always)]
    fn inner(&mut self, node: u32) {
        self.0.push(node);
    }

    #[inline(always)]
    fn leaf(&mut self, node: u32, _: u32) {
        self.0.push(node);
    }
}

/// Take a kernel through some lines and judge the first `judged` of them. `score` is what a visit of each node adds to a line's
/// score.
pub fn judge<M: Mode, T: Planes<Vector: Exact> + Sync>(
    subject: &Subject<'_, T>,
    lines: &[Line<T::Vector>],
    judged: usize,
    score: &[f64],
) -> Judged
where
    T::Vector: Sync,
{
    let size = lines.len().div_ceil(PIECES).max(1);
    let piece = |(i, lines): (usize, &[Line<T::Vector>])| {
        let mut found = Judged {
            hits: vec![0; subject.boxes.len()],
            ..Judged::default()
        };
        let mut buffers = Buffers::default();
        for (k, line) in lines.iter().enumerate() {
            found.count::<M, T>(subject, line, score, &mut buffers);
            if i * size + k < judged {
                found.judge(subject, line, &mut buffers);
            }
        }
        found
    };
    let pieces = lines.par_chunks(size).enumerate();
    let pieces: Vec<Judged> = pieces.map(piece).collect();
    let mut all = Judged {
        hits: vec![0; subject.boxes.len()],
        ..Judged::default()
    };
    for piece in pieces {
        all.visits += piece.visits;
        all.tests += piece.tests;
        all.hits
            .iter_mut()
            .zip(piece.hits)
            .for_each(|(a, b)| *a += b);
        all.scores
            .iter_mut()
            .zip(piece.scores)
            .for_each(|(a, b)| *a += b);
    }
    all
}

/// Kept from line to line, to spare allocations.
struct Buffers<R> {
    stack: Stack<R>,
    visited: Visited,
    /// Nodes that the line meets, with their distances from a tie.
    met: Vec<(u32, f64)>,
    open: Vec<u32>,
}

impl<R: Real> Default for Buffers<R> {
    fn default() -> Self {
        Self {
            stack: Stack::default(),
            visited: Visited::default(),
            met: Vec::new(),
            open: Vec::new(),
        }
    }
}

impl Judged {
    /// Take the kernel through one more line.
    fn count<M: Mode, T: Planes<Vector: Exact>>(
        &mut self,
        subject: &Subject<'_, T>,
        line: &Line<T::Vector>,
        score: &[f64],
        buffers: &mut Buffers<T::Real>,
    ) {
        let Buffers { stack, visited, .. } = buffers;
        visited.0.clear();
        traverse::<M, T, _>(subject.tree, line, Span::FULL, stack, visited, |_, _| {
            T::Real::INFINITY
        });
        visited.0.sort_unstable();
        let mut sum = 0.0;
        for &node in &visited.0 {
            self.hits[node as usize] += 1;
            sum += score[node as usize];
        }
        self.scores[0] += sum;
        self.scores[1] += sum * sum;
    }

    /// Judge what [`count`](Self::count) has just visited, and every triangle of the leaves among it.
    fn judge<T: Planes<Vector: Exact>>(
        &mut self,
        subject: &Subject<'_, T>,
        line: &Line<T::Vector>,
        buffers: &mut Buffers<T::Real>,
    ) {
        let [origin, direction] = [line.origin, line.direction].map(Exact::exact);
        let ray = Ray::new(*line, Span::FULL);
        let Buffers {
            visited: Visited(visited),
            met,
            open,
            ..
        } = buffers;
        // A line that meets a node's box meets its parent's.
        met.clear();
        open.clear();
        open.push(0);
        while let Some(node) = open.pop() {
            let exact = line_box(origin, direction, &subject.boxes[node as usize]);
            if exact.hit {
                met.push((node, exact.ulps));
                if let NodeKind::Inner { left, .. } = subject.tree.node(node) {
                    open.extend([left, left + 1]);
                }
            }
        }
        met.sort_unstable_by_key(|m| m.0);
        self.visits.judged += met.len() as u64;
        for &(node, ulps) in met.iter() {
            if visited.binary_search(&node).is_err() {
                self.visits.add(true, ulps * T::Vector::UNIT);
            }
        }
        for &node in visited.iter() {
            if met.binary_search_by_key(&node, |m| m.0).is_err() {
                let exact = line_box(origin, direction, &subject.boxes[node as usize]);
                self.visits.add(false, exact.ulps * T::Vector::UNIT);
            }
            if let NodeKind::Leaf { first, count } = subject.tree.node(node) {
                for &object in subject.tree.objects(first, count) {
                    let triangle = &subject.triangles[object as usize];
                    let exact = line_triangle(origin, direction, &triangle.0.map(Exact::exact));
                    let hit = matches!(exact.meeting, Meeting::Hit(_));
                    self.tests.judged += 1;
                    if triangle.intersect(&ray).is_some() != hit {
                        self.tests.add(hit, exact.ulps * T::Vector::UNIT);
                    }
                }
            }
        }
    }
}
