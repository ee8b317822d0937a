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
    /// Nodes that lines meet, or triangles of the leaves that they meet or were taken to, each once a line.
    pub judged: u64,
    /// Taken for met though missed.
    pub wrong: u64,
    /// Taken for missed though met.
    pub missed: u64,
    /// Wrong within 8 ulp of a tie.
    pub tied_wrong: u64,
    /// Missed within 8 ulp of a tie.
    pub tied_missed: u64,
    /// Sum over the lines of the squares of their errors of all kinds. One line that grazes a box errs in all nodes below: lines
    /// err independently, nodes do not.
    pub squares: u64,
}

impl Errors {
    fn add(&mut self, met: bool, ulps: f64) {
        let count = match (ulps < TIE, met) {
            (true, true) => &mut self.tied_missed,
            (true, false) => &mut self.tied_wrong,
            (false, true) => &mut self.missed,
            (false, false) => &mut self.wrong,
        };
        *count += 1;
    }

    /// These errors as those of one line.
    fn of_a_line(self) -> Self {
        Self {
            squares: self.all().pow(2),
            ..self
        }
    }

    /// Errors within 8 ulp of a tie.
    pub fn tied(&self) -> u64 {
        self.tied_wrong + self.tied_missed
    }

    /// Errors of all kinds.
    pub fn all(&self) -> u64 {
        self.wrong + self.missed + self.tied()
    }
}

impl AddAssign for Errors {
    fn add_assign(&mut self, other: Self) {
        self.judged += other.judged;
        self.wrong += other.wrong;
        self.missed += other.missed;
        self.tied_wrong += other.tied_wrong;
        self.tied_missed += other.tied_missed;
        self.squares += other.squares;
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
    /// Triangles of the leaves that the line meets or was taken to.
    held: Vec<Held>,
}

/// A triangle in a leaf.
struct Held {
    object: u32,
    /// Whether the kernel took the line to the leaf.
    visited: bool,
    /// Distance of the leaf from a tie.
    ulps: f64,
}

impl<R: Real> Default for Buffers<R> {
    fn default() -> Self {
        Self {
            stack: Stack::default(),
            visited: Visited::default(),
            met: Vec::new(),
            open: Vec::new(),
            held: Vec::new(),
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

    /// Judge what [`count`](Self::count) has just visited, and every triangle of the leaves among it and of those that it should
    /// have visited.
    fn judge<T: Planes<Vector: Exact>>(
        &mut self,
        subject: &Subject<'_, T>,
        line: &Line<T::Vector>,
        buffers: &mut Buffers<T::Real>,
    ) {
        let [origin, direction] = [line.origin, line.direction].map(Exact::exact);
        let Buffers {
            visited: Visited(visited),
            met,
            open,
            held,
            ..
        } = buffers;
        // A line that meets a node's box meets its parent's.
        met.clear();
        held.clear();
        open.clear();
        open.push(0);
        let mut hold = |node: u32, visited: bool, ulps: f64| {
            if let NodeKind::Leaf { first, count } = subject.tree.node(node) {
                let objects = subject.tree.objects(first, count).iter();
                held.extend(objects.map(|&object| Held {
                    object,
                    visited,
                    ulps,
                }));
            }
        };
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
        let mut visits = Errors {
            judged: met.len() as u64,
            ..Errors::default()
        };
        for &(node, ulps) in met.iter() {
            let found = visited.binary_search(&node).is_ok();
            if !found {
                visits.add(true, ulps * T::Vector::UNIT);
            }
            hold(node, found, ulps);
        }
        for &node in visited.iter() {
            if met.binary_search_by_key(&node, |m| m.0).is_err() {
                let exact = line_box(origin, direction, &subject.boxes[node as usize]);
                visits.add(false, exact.ulps * T::Vector::UNIT);
                hold(node, true, exact.ulps);
            }
        }
        self.visits += visits.of_a_line();
        self.tests += tests(subject, line, held).of_a_line();
    }
}

/// Judge each of these triangles once: the kernel hits it if it stands in a leaf that was visited and its test says so.
fn tests<T: Planes<Vector: Exact>>(
    subject: &Subject<'_, T>,
    line: &Line<T::Vector>,
    held: &mut [Held],
) -> Errors {
    let [origin, direction] = [line.origin, line.direction].map(Exact::exact);
    let ray = Ray::new(*line, Span::FULL);
    held.sort_unstable_by_key(|h| h.object);
    let mut tests = Errors::default();
    for leaves in held.chunk_by(|a, b| a.object == b.object) {
        let triangle = &subject.triangles[leaves[0].object as usize];
        let exact = line_triangle(origin, direction, &triangle.0.map(Exact::exact));
        let met = matches!(exact.meeting, Meeting::Hit(_));
        let hit = triangle.intersect(&ray).is_some();
        let visited = leaves.iter().any(|leaf| leaf.visited);
        tests.judged += 1;
        if (visited && hit) != met {
            // What its test would have hit was lost with its leaves; the one farthest from a tie was the surest to be met.
            let lost = if hit && met {
                leaves.iter().map(|leaf| leaf.ulps).fold(0.0, f64::max)
            } else {
                f64::INFINITY
            };
            tests.add(met, exact.ulps.min(lost) * T::Vector::UNIT);
        }
    }
    tests
}
