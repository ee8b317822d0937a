//! Works that no peer has: counting the hits of every node, and making the lines for it.

use sahlab::cost::CostModel;
use sahlab::geom::{Line, Span};
use sahlab::kd::stream::{BLOCK, Streams};
use sahlab::kd::traverse::traverse_line;
use sahlab::kd::{Counts, Rules, Stack, StopRule, Strategy, Tree, build};
use sahlab::rays::SurfaceLines;
use sahlab::scene::Scene;

use crate::ours;
use crate::trial::{Job, Plan, Work, seconds};

/// A tree, and a block of lines to count in it.
pub struct OwnWays {
    tree: Tree,
    sampler: SurfaceLines,
    lines: Vec<Line>,
    visits: u64,
}

impl OwnWays {
    /// By the surface area heuristic, not clipped.
    ///
    /// # Panics
    /// If the ways to count disagree.
    pub fn new(scene: &Scene) -> Self {
        let rules = Rules {
            strategy: Strategy::Sah,
            stop: StopRule::CostGain { depth: None },
            cost: CostModel::WALD_HAVRAN,
            clipped: false,
        };
        let tree = build(&scene.bounds, scene.world, &rules);
        let sampler = SurfaceLines {
            world: scene.world,
            seed: 1,
        };
        let lines: Vec<Line> = sampler.range(0..BLOCK).collect();
        let counted = streamed(&tree, &lines, &mut Streams::default());
        assert_eq!(
            counted,
            plain(&tree, &lines),
            "streams and plain loop disagree"
        );
        Self {
            tree,
            sampler,
            lines,
            visits: counted.visits(),
        }
    }

    /// Counting by line streams against the plain loop; making a block of lines against counting it.
    pub fn plans(&self, scene: &str) -> [Plan<'_>; 2] {
        let Self { tree, lines, .. } = self;
        let streams = || {
            let mut streams = Streams::default();
            Box::new(move || seconds(|| streamed(tree, lines, &mut streams)))
        };
        let count: Vec<Job> = vec![
            (ours::STREAMS.into(), streams()),
            (
                "sahlab-plain-f64".into(),
                Box::new(|| seconds(|| plain(tree, lines))),
            ),
        ];
        // Into a buffer that is kept, as counting does.
        let mut buffer = lines.clone();
        let mut make = move || {
            buffer.clear();
            buffer.extend(self.sampler.range(0..BLOCK));
            buffer.last().copied()
        };
        let making: Vec<Job> = vec![
            (ours::LINES.into(), Box::new(move || seconds(&mut make))),
            ("sahlab-count-f64".into(), streams()),
        ];
        let visits = self.visits as f64;
        [
            (Work::Count, visits, count),
            (Work::Lines, BLOCK as f64, making),
        ]
        .map(|(work, amount, jobs)| Plan {
            work,
            scene: scene.into(),
            amount,
            jobs,
        })
    }
}

fn streamed(tree: &Tree, lines: &[Line], streams: &mut Streams) -> Counts {
    let mut counts = Counts::new(tree);
    streams.count(tree, lines, &mut counts);
    counts
}

fn plain(tree: &Tree, lines: &[Line]) -> Counts {
    let mut counts = Counts::new(tree);
    counts.lines = lines.len() as u64;
    let mut stack = Stack::default();
    for line in lines {
        traverse_line(tree, line, Span::FULL, &mut stack, &mut counts);
    }
    counts
}
