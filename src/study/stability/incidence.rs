//! A tree as a kernel has it, and one line through it: the nodes it visits, and those it should.

use glam::Vec3;

use crate::exact::{Incidence, line_box};
use crate::geom::{Aabb, Line, Span};
use crate::kd::narrow::{Refusal, narrow_line};
use crate::kd::{
    Counting, Mode, NarrowTree, NodeKind, Planes, Probe, Stack, Tracing, Tree, traverse,
};
use crate::study::kernel::Kernel;

use super::judge::{TIE, last_place};

/// A tree in the numbers of a kernel.
pub enum KernelTree<'a> {
    /// Of `f64`.
    Wide(&'a Tree),
    /// Of `f32`, with the tree it was made from; whether planes are widened.
    Narrow(&'a Tree, NarrowTree, bool),
}

impl<'a> KernelTree<'a> {
    /// The tree for a kernel, or why there is none.
    pub fn of(kernel: Kernel, tree: &'a Tree) -> Result<Self, Refusal> {
        let narrow = || NarrowTree::of(tree).map(|(narrow, _)| narrow);
        Ok(match kernel {
            Kernel::F64 => Self::Wide(tree),
            Kernel::F32 => Self::Narrow(tree, narrow()?, false),
            Kernel::F32Padded => Self::Narrow(tree, narrow()?, true),
        })
    }

    /// The tree in `f64`: nodes and references have the same numbers.
    pub fn wide(&self) -> &Tree {
        match self {
            Self::Wide(tree) | Self::Narrow(tree, ..) => tree,
        }
    }

    /// The boxes of the nodes, in exact numbers.
    pub fn boxes(&self) -> &[Aabb] {
        match self {
            Self::Wide(tree) => &tree.boxes,
            Self::Narrow(_, narrow, _) => &narrow.boxes,
        }
    }

    /// Mark the nodes that the kernel visits. Gives the line that it follows, in exact numbers.
    pub fn visit(&self, line: &Line, seen: &mut Seen) -> Result<Line, Refusal> {
        seen.begin(self.boxes().len());
        match self {
            Self::Wide(tree) => {
                follow::<Counting, _>(*tree, line, seen);
                Ok(*line)
            }
            Self::Narrow(_, narrow, padded) => {
                let line = narrow_line(line)?;
                if *padded {
                    follow::<Tracing, _>(narrow, &line, seen);
                } else {
                    follow::<Counting, _>(narrow, &line, seen);
                }
                let [origin, direction] = [line.origin, line.direction].map(Vec3::as_dvec3);
                Ok(Line::new(origin, direction))
            }
        }
    }

    /// Hold the nodes that were visited against those whose boxes the exact line meets. Both children of every node met are looked
    /// at, so that misses are seen too. `each` gets a node, whether it was visited, and what is right.
    pub fn judge(&self, line: &Line, seen: &Seen, mut each: impl FnMut(u32, bool, Incidence)) {
        let (nodes, boxes) = (&self.wide().nodes, self.boxes());
        let mut waiting = vec![0];
        while let Some(node) = waiting.pop() {
            let exact = line_box(line.origin, line.direction, &boxes[node as usize]);
            let visited = seen.has(node);
            each(node, visited, exact);
            if let NodeKind::Inner { left, .. } = nodes[node as usize].kind()
                && (visited || exact.hit)
            {
                waiting.extend([left, left + 1]);
            }
        }
    }
}

fn follow<M: Mode, T: Planes<Real: Default>>(tree: &T, line: &Line<T::Vector>, seen: &mut Seen) {
    let mut stack = Stack::default();
    let nowhere = <T::Real as crate::geom::Real>::INFINITY;
    traverse::<M, T, _>(tree, line, Span::FULL, &mut stack, seen, |_, _| nowhere);
}

/// The nodes that the last line visited.
#[derive(Default)]
pub struct Seen {
    /// The line that visited each node last.
    stamps: Vec<u32>,
    line: u32,
}

impl Seen {
    fn begin(&mut self, nodes: usize) {
        if self.stamps.len() != nodes || self.line == u32::MAX {
            self.stamps = vec![0; nodes];
            self.line = 0;
        }
        self.line += 1;
    }

    /// Whether it visited this one.
    pub fn has(&self, node: u32) -> bool {
        self.stamps[node as usize] == self.line
    }
}

impl Probe for Seen {
    fn inner(&mut self, node: u32) {
        self.stamps[node as usize] = self.line;
    }

    fn leaf(&mut self, node: u32, _: u32) {
        self.stamps[node as usize] = self.line;
    }
}

/// Verdicts of a kernel, counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Pairs judged.
    pub cases: u64,
    /// Of them, exact hits.
    pub hits: u64,
    /// Misses taken for hits, and no tie.
    pub wrong: u64,
    /// Hits taken for misses, and no tie.
    pub missed: u64,
    /// Pairs nearer to a tie than [`TIE`].
    pub ties: u64,
    /// Of them, misses taken for hits.
    pub tied_wrong: u64,
    /// Of them, hits taken for misses.
    pub tied_missed: u64,
}

impl Tally {
    /// Count a verdict; `ulps` are units of the last place of `f64`. Whether it is a wrongly judged tie.
    pub fn add(&mut self, kernel: Kernel, said: bool, exact: bool, ulps: f64) -> bool {
        let tie = ulps < TIE * last_place(kernel);
        self.cases += 1;
        self.hits += u64::from(exact);
        self.ties += u64::from(tie);
        let place = match (tie, said, exact) {
            (false, true, false) => &mut self.wrong,
            (false, false, true) => &mut self.missed,
            (true, true, false) => &mut self.tied_wrong,
            (true, false, true) => &mut self.tied_missed,
            _ => return false,
        };
        *place += 1;
        tie
    }
}

impl std::ops::AddAssign for Tally {
    fn add_assign(&mut self, other: Self) {
        self.cases += other.cases;
        self.hits += other.hits;
        self.wrong += other.wrong;
        self.missed += other.missed;
        self.ties += other.ties;
        self.tied_wrong += other.tied_wrong;
        self.tied_missed += other.tied_missed;
    }
}
