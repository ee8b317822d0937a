//! Counting the hits of every node: line streams against the plain loop, and all cores against one.
//!
//! `cargo bench --bench count` takes less than a minute.

mod common;

use std::thread::available_parallelism;

use common::{Jobs, Table, rules};
use rayon::ThreadPoolBuilder;
use sahlab::geom::{Line, Span};
use sahlab::kd::stream::{BLOCK, Lanes, Streams, count_lines};
use sahlab::kd::traverse::traverse_line;
use sahlab::kd::{Counts, NoProbe, Stack, Strategy, Tree, build};
use sahlab::rays::SurfaceLines;
use sahlab::scene::Scene;

const ROUNDS: usize = 9;

/// Blocks counted on several cores.
const BLOCKS: u64 = 4;

fn main() {
    let mut table = Table::new("count", &["M visits/s", "over the plain loop"]);
    let scene = Scene::load("simple:soup:100000").expect("a procedural scene");
    for stop in ["cost-gain", "objects:2:16"] {
        rows(&scene, stop, &mut table);
    }
    table.finish();
}

/// Every way to count, on the tree of one stop rule.
fn rows(scene: &Scene, stop: &str, table: &mut Table) {
    let rules = rules(Strategy::Sah, stop, false);
    let tree = build(&scene.bounds, scene.world, &rules);
    let sampler = SurfaceLines {
        world: scene.world,
        seed: 1,
    };
    let lines: Vec<Line> = sampler.range(0..BLOCK).collect();
    let cores = available_parallelism().map_or(1, usize::from);
    let pools = [1, cores].map(|threads| {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("a pool of threads")
    });
    let counts = plain(&tree, &lines);
    let streamed = |streams: &mut Streams| {
        let mut counts = Counts::new(&tree);
        streams.count(&tree, &lines, &mut counts);
        counts
    };

    let mut jobs = Jobs::default();
    jobs.add(|| plain(&tree, &lines));
    jobs.add(|| {
        let mut stack = Stack::default();
        for line in &lines {
            traverse_line(&tree, line, Span::FULL, &mut stack, NoProbe);
        }
    });
    let mut names = vec![
        ("plain loop, hits of every node".to_owned(), 1),
        ("plain loop, nothing counted".to_owned(), 1),
    ];
    for lanes in Lanes::available() {
        let mut streams = Streams::with(lanes);
        assert_eq!(streamed(&mut streams), counts, "{} differ", lanes.name());
        jobs.add(move || streamed(&mut streams));
        names.push((
            format!("line streams, {}, hits of every node", lanes.name()),
            1,
        ));
    }
    for pool in &pools {
        let blocks = || count_lines(&tree, BLOCKS * BLOCK, |range| sampler.range(range), |_| {});
        jobs.add(move || pool.install(blocks));
    }
    let seconds = jobs.least(ROUNDS, table);

    let per_line = counts.visits() as f64 / BLOCK as f64;
    let nodes = tree.nodes.len();
    let heading = format!(
        "**soup of 100,000 triangles, `{stop}`: {nodes} nodes, {per_line:.0} visits a line**"
    );
    table.row(&[heading, String::new(), String::new()]);
    for cores in [1, cores] {
        names.push((
            format!("lines made and counted by streams, cores: {cores}"),
            BLOCKS,
        ));
    }
    for ((what, blocks), passed) in names.into_iter().zip(&seconds) {
        // Blocks of so many lines are alike to a percent.
        let blocks_per_s = blocks as f64 / passed;
        let rate = 1e-6 * blocks_per_s * counts.visits() as f64;
        let ratio = blocks_per_s * seconds[0];
        table.row(&[what, format!("{rate:.1}"), format!("{ratio:.2}")]);
    }
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
