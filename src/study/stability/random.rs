//! Random pairs: lines against the boxes of a tree's nodes and against triangles, by the kernels and by the exact oracle.
//!
//! A line is held against every node whose parent it visits or should visit, and against every triangle of the leaves it visits
//! or should visit, each once.
//! Lines are the metric's own, or aimed at edges and corners. They come in waves of a fixed number, so that the pairs do not depend on the number of
//! threads.

use rayon::prelude::*;

use crate::geom::Line;
use crate::kd::narrow::Refusal;
use crate::kd::{Counting, Mode, NarrowTree, Planes, Tracing, Tree};
use crate::rays::SurfaceLines;
use crate::scene::Scene;
use crate::study::incidence::{
    Against, Aim, Exact, Judged, Narrow, Pair, Subject, Tally, Visits, exact_line, nodes, triangles,
};
use crate::study::kernel::Kernel;
use crate::study::records::{RandomRecord, TieRecord};

/// Lines of a wave, and of a piece of it.
const WAVE: u64 = 256;
const PIECE: u64 = 32;

/// Ties told of each row.
const TOLD: usize = 25;

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

/// What is held against what.
#[derive(Clone, Copy)]
struct Family {
    against: Against,
    aimed: bool,
}

/// A wrongly judged tie, and its line in exact numbers.
struct Tie {
    pair: Pair,
    line: Line,
}

impl Bench<'_> {
    /// At least so many pairs of one family by one kernel.
    ///
    /// # Errors
    /// If the kernel has no such tree.
    pub fn judge(
        &self,
        kernel: Kernel,
        against: Against,
        aimed: bool,
        pairs: u64,
    ) -> Result<(RandomRecord, Vec<TieRecord>), Refusal> {
        let family = Family { against, aimed };
        let corners = &self.scene.objects.triangles;
        let narrow = || NarrowTree::of(self.tree).map(|(tree, _)| Narrow::new(tree, corners));
        let (tally, ties) = match kernel {
            Kernel::F64 => {
                self.pairs::<Counting, _>(&Subject::new(self.tree, corners), family, pairs)
            }
            Kernel::F32 => self.pairs::<Counting, _>(&narrow()?.subject(), family, pairs),
            Kernel::F32Padded => self.pairs::<Tracing, _>(&narrow()?.subject(), family, pairs),
        };
        Ok(self.rows(kernel, family, tally, ties))
    }

    /// Waves of lines until there are so many pairs, and the first wrongly judged ties.
    fn pairs<M: Mode, T: Planes<Vector: Exact> + Sync>(
        &self,
        subject: &Subject<'_, T>,
        family: Family,
        wanted: u64,
    ) -> (Tally, Vec<Tie>)
    where
        T::Vector: Sync,
    {
        let lines = SurfaceLines {
            world: self.scene.world,
            seed: self.seed,
        };
        let aim = Aim { subject, lines };
        let (mut tally, mut ties) = (Tally::default(), Vec::new());
        let mut first = 0;
        while tally.cases < wanted {
            let before = tally.cases;
            let begin = |k: u64| first + PIECE * k;
            let pieces = (0..WAVE / PIECE).into_par_iter().map(begin);
            let judged: Vec<_> = pieces
                .map(|first| piece::<M, T>(&aim, family, first))
                .collect();
            for (more, found) in judged {
                tally += more;
                ties.extend(found);
                ties.truncate(TOLD);
            }
            if tally.cases == before {
                break;
            }
            first += WAVE;
        }
        (tally, ties)
    }

    fn rows(
        &self,
        kernel: Kernel,
        Family { against, aimed }: Family,
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
            tied_wrong: tally.tied_errors(),
            tied_missed: tally.tied_missed,
        };
        let tie = |Tie { pair, line }: Tie| {
            let (o, d) = (line.origin, line.direction);
            TieRecord {
                scene: row.scene.clone(),
                strategy: row.strategy.clone(),
                kernel: row.kernel.clone(),
                against: row.against.clone(),
                family: row.family.clone(),
                target: pair.target.into(),
                ulps: pair.judged.ulps,
                exact: pair.judged.exact,
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

/// A piece of a wave: its verdicts, and its wrongly judged ties.
fn piece<M: Mode, T: Planes<Vector: Exact>>(
    aim: &Aim<'_, T>,
    Family { against, aimed }: Family,
    first: u64,
) -> (Tally, Vec<Tie>) {
    let mut visits = Visits::default();
    let (mut tally, mut ties) = (Tally::default(), Vec::new());
    let indices = first..first + PIECE;
    let lines: Vec<_> = if aimed {
        aim.aimed(indices, |_| against).collect()
    } else {
        aim.drawn(indices).collect()
    };
    for line in lines {
        let visited = visits.follow::<M, T>(aim.subject.tree, &line);
        let mut pairs = nodes(aim.subject, &line, visited);
        if against == Against::Triangle {
            pairs = triangles(aim.subject, &line, &pairs);
        }
        tally += Tally::of_a_line(&pairs);
        let wrong_tie = |judged: Judged| judged.errs() && judged.is_tie();
        let wrong_ties = pairs.into_iter().filter(|pair| wrong_tie(pair.judged));
        let line = exact_line(&line);
        ties.extend(wrong_ties.map(|pair| Tie { pair, line }));
    }
    (tally, ties)
}

#[cfg(test)]
mod tests;
