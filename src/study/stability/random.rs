//! Random pairs: lines against the boxes of a tree's nodes and against triangles, by the kernels and by the exact oracle.
//!
//! A line is held against every node whose parent it visits or should visit, and against every triangle of the leaves it visits
//! or should visit, each once.
//! Lines are the metric's own, or aimed at edges and corners. They come in waves of a fixed number, so that the pairs do not depend on the number of
//! threads.

use std::collections::BTreeMap;

use rayon::prelude::*;

use crate::geom::Line;
use crate::kd::narrow::Refusal;
use crate::kd::{NodeKind, Tree};
use crate::scene::Scene;
use crate::study::kernel::Kernel;
use crate::study::records::{RandomRecord, TieRecord};

use super::aim::Aim;
use super::incidence::{KernelTree, Seen, Tally};
use super::judge::{last_place, line_and_triangle};

/// Lines of a wave, and of a piece of it.
const WAVE: u64 = 256;
const PIECE: u64 = 32;

/// Ties told of each row.
const TOLD: usize = 25;

/// What lines are held against.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Against {
    /// The boxes of nodes, by the traversal.
    Box,
    /// Triangles, by the object test.
    Triangle,
}

impl Against {
    /// The name in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Box => "box",
            Self::Triangle => "triangle",
        }
    }
}

/// A tree of a scene, and what to judge of it.
pub struct Bench<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// Its tree.
    pub tree: &'a Tree,
    /// The tree's strategy.
    pub strategy: String,
    /// Seed of the scene's lines.
    pub seed: u64,
}

/// A wrongly judged tie.
struct Tie {
    target: u32,
    ulps: f64,
    exact: bool,
    line: Line,
}

type Judged = Result<(Tally, Vec<Tie>), Refusal>;

impl Bench<'_> {
    /// At least so many pairs of one family by one kernel.
    ///
    /// # Errors
    /// If the kernel has no such tree or line.
    pub fn judge(
        &self,
        kernel: Kernel,
        against: Against,
        aimed: bool,
        pairs: u64,
    ) -> Result<(RandomRecord, Vec<TieRecord>), Refusal> {
        let in_kernel = KernelTree::of(kernel, self.tree)?;
        let aim = Aim {
            scene: self.scene,
            tree: self.tree,
            seed: self.seed,
            against,
        };
        let piece = |first: u64| -> Judged {
            let mut seen = Seen::default();
            let (mut tally, mut ties) = (Tally::default(), Vec::new());
            for i in first..first + PIECE {
                let line = if aimed { aim.aimed(i) } else { aim.drawn(i) };
                match against {
                    Against::Box => {
                        boxes(kernel, &in_kernel, &line, &mut seen, &mut tally, &mut ties)?
                    }
                    Against::Triangle => {
                        let near = self.near(&in_kernel, &line, &mut seen)?;
                        self.triangles(kernel, &line, &near, &mut tally, &mut ties)?
                    }
                }
            }
            Ok((tally, ties))
        };
        let (mut tally, mut ties) = (Tally::default(), Vec::new());
        let mut first = 0;
        while tally.cases < pairs {
            let before = tally.cases;
            let begin = |k: u64| first + PIECE * k;
            let pieces = (0..WAVE / PIECE).into_par_iter().map(begin);
            let judged: Vec<Judged> = pieces.map(piece).collect();
            for result in judged {
                let (more, found) = result?;
                tally += more;
                ties.extend(found);
                ties.truncate(TOLD);
            }
            if tally.cases == before {
                break;
            }
            first += WAVE;
        }
        Ok(self.rows(kernel, against, aimed, tally, ties))
    }

    /// The triangles of the leaves that the kernel visits or whose boxes the line meets, and whether a visited leaf holds them.
    fn near(
        &self,
        tree: &KernelTree<'_>,
        line: &Line,
        seen: &mut Seen,
    ) -> Result<BTreeMap<u32, bool>, Refusal> {
        let line = tree.visit(line, seen)?;
        let triangles = self.scene.objects.triangles.len() as u32;
        let mut near = BTreeMap::new();
        tree.judge(&line, seen, |node, visited, exact| {
            if let NodeKind::Leaf { first, count } = self.tree.nodes[node as usize].kind()
                && (visited || exact.hit)
            {
                for &object in self.tree.objects(first, count) {
                    if object < triangles {
                        *near.entry(object).or_insert(false) |= visited;
                    }
                }
            }
        });
        Ok(near)
    }

    /// The triangles near a line: one is hit if a visited leaf holds it and its test says so.
    fn triangles(
        &self,
        kernel: Kernel,
        line: &Line,
        near: &BTreeMap<u32, bool>,
        tally: &mut Tally,
        ties: &mut Vec<Tie>,
    ) -> Result<(), Refusal> {
        for (&object, &visited) in near {
            let triangle = &self.scene.objects.triangles[object as usize];
            let judged = line_and_triangle(kernel, line, triangle)?;
            let ulps = judged.ulps * last_place(kernel);
            if tally.add(kernel, judged.said && visited, judged.exact, ulps) {
                ties.push(Tie {
                    target: object,
                    ulps: judged.ulps,
                    exact: judged.exact,
                    line: *line,
                });
            }
        }
        Ok(())
    }

    fn rows(
        &self,
        kernel: Kernel,
        against: Against,
        aimed: bool,
        tally: Tally,
        ties: Vec<Tie>,
    ) -> (RandomRecord, Vec<TieRecord>) {
        let family = if aimed { "aimed" } else { "random" };
        let row = RandomRecord {
            scene: self.scene.name.clone(),
            strategy: self.strategy.clone(),
            kernel: kernel.name().into(),
            against: against.name().into(),
            family: family.into(),
            cases: tally.cases,
            hits: tally.hits,
            wrong: tally.wrong,
            missed: tally.missed,
            ties: tally.ties,
            tied_wrong: tally.tied_wrong + tally.tied_missed,
            tied_missed: tally.tied_missed,
        };
        let tie = |tie: Tie| {
            let (o, d) = (tie.line.origin, tie.line.direction);
            TieRecord {
                scene: row.scene.clone(),
                strategy: row.strategy.clone(),
                kernel: row.kernel.clone(),
                against: row.against.clone(),
                family: row.family.clone(),
                target: tie.target.into(),
                ulps: tie.ulps,
                exact: tie.exact,
                ox: o.x,
                oy: o.y,
                oz: o.z,
                dx: d.x,
                dy: d.y,
                dz: d.z,
            }
        };
        let ties = ties.into_iter().map(tie).collect();
        (row, ties)
    }
}

/// The nodes that the line visits or should.
fn boxes(
    kernel: Kernel,
    tree: &KernelTree<'_>,
    line: &Line,
    seen: &mut Seen,
    tally: &mut Tally,
    ties: &mut Vec<Tie>,
) -> Result<(), Refusal> {
    let line = tree.visit(line, seen)?;
    tree.judge(&line, seen, |node, visited, exact| {
        if tally.add(kernel, visited, exact.hit, exact.ulps) {
            ties.push(Tie {
                target: node,
                ulps: exact.ulps / last_place(kernel),
                exact: exact.hit,
                line,
            });
        }
    });
    Ok(())
}

#[cfg(test)]
mod tests;
