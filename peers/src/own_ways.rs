//! Works that no peer has: counting the hits of every node, and making the lines for it.

use sahlab::cost::CostModel;
use sahlab::geom::{Line, Span};
use sahlab::kd::stream::{BLOCK, Streams};
use sahlab::kd::traverse::traverse_line;
use sahlab::kd::{Counts, Rules, Stack, StopRule, Strategy, Tree, build};
use sahlab::rays::SurfaceLines;
use sahlab::scene::Scene;

use crate::ours;
use crate::trial::{Contest, Job, Work, seconds};

/// Counting by line streams against the plain loop; and making a block of lines against counting it.
pub fn own_ways(name: &str, scene: &Scene, rounds: usize) -> [Contest; 2] {
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
    let make = || sampler.range(0..BLOCK).collect::<Vec<Line>>();
    let lines = make();
    let mut streams = Streams::default();
    let counted = streamed(&mut streams, &tree, &lines);
    assert_eq!(
        counted,
        plain(&tree, &lines),
        "streams and plain loop disagree"
    );

    let jobs: Vec<Job> = vec![
        (
            ours::STREAMS.into(),
            Box::new(|| seconds(|| streamed(&mut streams, &tree, &lines))),
        ),
        (
            "sahlab-plain-f64".into(),
            Box::new(|| seconds(|| plain(&tree, &lines))),
        ),
    ];
    let count = Contest::run(Work::Count, name, counted.visits() as f64, rounds, jobs);
    let jobs: Vec<Job> = vec![
        (ours::LINES.into(), Box::new(|| seconds(make))),
        (
            "sahlab-count-f64".into(),
            Box::new(|| seconds(|| streamed(&mut streams, &tree, &lines))),
        ),
    ];
    [
        count,
        Contest::run(Work::Lines, name, BLOCK as f64, rounds, jobs),
    ]
}

fn streamed(streams: &mut Streams, tree: &Tree, lines: &[Line]) -> Counts {
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
