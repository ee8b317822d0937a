//! Counting: the traversal, the streams and brute force agree on every node, bit for bit.
#![allow(clippy::unwrap_used, missing_docs)]

mod common;

use common::{STOPS, gridded_boxes, hard_lines, random_boxes, tree};
use sahlab::geom::{Line, Span};
use sahlab::kd::stream::{Lanes, Streams, count_lines};
use sahlab::kd::traverse::traverse_line;
use sahlab::kd::{Counts, NodeKind, Stack, Strategy, Tree, predict};
use sahlab::rays::SurfaceLines;

/// Slab tests of every node's box, one by one: what a count is by definition.
fn brute_force(tree: &Tree, lines: &[Line]) -> Counts {
    let mut counts = Counts::new(tree);
    counts.lines = lines.len() as u64;
    for line in lines {
        for (i, node) in tree.nodes.iter().enumerate() {
            if tree.boxes[i].clip(line, Span::FULL).is_none() {
                continue;
            }
            counts.hits[i] += 1;
            match node.kind() {
                NodeKind::Inner { .. } => counts.work.inner += 1,
                NodeKind::Leaf { count, .. } => {
                    counts.work.leaves += 1;
                    counts.work.tests += u64::from(count);
                }
            }
        }
    }
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

fn streamed(tree: &Tree, lines: &[Line]) -> Counts {
    let with = |lanes: Lanes| {
        let mut counts = Counts::new(tree);
        Streams::with(lanes).count(tree, lines, &mut counts);
        counts
    };
    let portable = with(Lanes::PORTABLE);
    for lanes in Lanes::available() {
        assert_eq!(with(lanes), portable, "{}", lanes.name());
    }
    portable
}

#[test]
fn streams_equal_plain_equal_brute_force_on_every_node() {
    for (bounds, name) in [
        (gridded_boxes(300, 1), "gridded"),
        (random_boxes(300, 2), "random"),
    ] {
        let lines = hard_lines(&bounds, 400);
        assert!(lines.iter().filter(|l| l.is_axis_parallel()).count() > 100);
        for strategy in Strategy::ALL {
            for stop in STOPS {
                let tree = tree(&bounds, strategy, stop);
                let by_boxes = brute_force(&tree, &lines);
                assert_eq!(
                    plain(&tree, &lines),
                    by_boxes,
                    "plain, {name} {strategy} {stop}"
                );
                assert_eq!(
                    streamed(&tree, &lines),
                    by_boxes,
                    "streams, {name} {strategy} {stop}"
                );
            }
        }
    }
}

#[test]
fn flat_worlds_and_flat_cells_count_too() {
    // All objects in the plane z = 0: the root is flat, SA = 2A, and a line crosses it in one point.
    let mut bounds = random_boxes(200, 3);
    for b in &mut bounds {
        b.lo.z = 0.0;
        b.hi.z = 0.0;
    }
    let tree = tree(&bounds, Strategy::Sah, "objects:1");
    let p = predict(&tree);
    assert!((p.n_b - 1.0).abs() < 1e-12, "the leaves tile the plane");
    let lines = SurfaceLines {
        world: tree.world,
        seed: 1,
    };
    let lines: Vec<Line> = lines.range(0..20_000).collect();
    let counts = streamed(&tree, &lines);
    counts.check(&tree).unwrap();
    assert_eq!(counts, plain(&tree, &lines));
    assert_eq!(counts, brute_force(&tree, &lines));
    assert_eq!(counts.work.leaves, counts.lines);
}

#[test]
fn identities_hold_and_a_dropped_line_breaks_them() {
    let bounds = random_boxes(500, 4);
    let tree = tree(&bounds, Strategy::Sah, "cost-gain");
    let lines = SurfaceLines {
        world: tree.world,
        seed: 2,
    };
    let lines: Vec<Line> = lines.range(0..2000).collect();
    let counts = plain(&tree, &lines);
    counts.check(&tree).unwrap();

    // A line that was never traversed; a visit lost on the way down, at any node; a visit too many.
    let mut dropped = plain(&tree, &lines[1..]);
    dropped.lines += 1;
    assert!(dropped.check(&tree).unwrap_err().contains("hit the root"));
    for i in (0..tree.nodes.len()).filter(|&i| counts.hits[i] > 0) {
        let mut lost = counts.clone();
        lost.hits[i] -= 1;
        assert!(lost.check(&tree).is_err(), "lost visit of node {i}");
        let mut gained = counts.clone();
        gained.hits[i] += 1;
        assert!(gained.check(&tree).is_err(), "visit too many of node {i}");
    }
}

#[test]
fn counts_do_not_depend_on_threads() {
    let bounds = random_boxes(400, 5);
    let tree = tree(&bounds, Strategy::SahCyclic, "objects:2:16");
    let lines = SurfaceLines {
        world: tree.world,
        seed: 3,
    };
    let n = 3 * (1 << 17) + 1234;
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| count_lines(&tree, n, |range| lines.range(range), |_| ()))
    };
    let one = with(1);
    one.check(&tree).unwrap();
    assert_eq!(one.lines, n);
    for threads in [2, 3, 7] {
        assert_eq!(with(threads), one, "{threads} threads");
    }
}

/// The prediction reads boxes, the count reads planes: break either and the other stands.
#[test]
fn prediction_and_count_share_nothing_but_the_tree() {
    let bounds = random_boxes(300, 6);
    let tree = tree(&bounds, Strategy::Sah, "cost-gain");
    let lines: Vec<Line> = SurfaceLines {
        world: tree.world,
        seed: 4,
    }
    .range(0..1000)
    .collect();
    let (predicted, counted) = (predict(&tree), plain(&tree, &lines));

    let mut wrong_boxes = tree.clone();
    wrong_boxes.boxes[3].hi.x += 0.5;
    assert_ne!(predict(&wrong_boxes), predicted);
    assert_eq!(plain(&wrong_boxes, &lines), counted);

    let mut wrong_planes = tree.clone();
    let NodeKind::Inner { axis, split, left } = tree.nodes[0].kind() else {
        panic!("the root is cut");
    };
    wrong_planes.nodes[0] = sahlab::kd::Node::inner(axis, 0.9 * split, left);
    assert_eq!(predict(&wrong_planes), predicted);
    assert_ne!(plain(&wrong_planes, &lines), counted);
}

#[test]
fn a_complete_grid_has_the_known_costs() {
    // Strategy 1 at depth 3k on a cube is a grid of 2^k: n_B = 2^k, n_K = 4(2^k - 1), whatever is in it.
    let cube = sahlab::geom::Aabb::new(glam::DVec3::ZERO, glam::DVec3::ONE);
    for k in 0..5 {
        for bounds in [vec![cube], random_boxes(50, 7)] {
            let bounds: Vec<_> = bounds
                .iter()
                .map(|b| sahlab::geom::Aabb::new(b.lo, b.hi.min(cube.hi)))
                .collect();
            let bounds: Vec<_> = bounds.into_iter().filter(|b| b.is_valid()).collect();
            let tree = sahlab::kd::build(
                &bounds,
                cube,
                &common::rules(Strategy::SpatialMedian, &format!("depth:{}", 3 * k)),
            );
            let p = predict(&tree);
            assert!((p.n_b - f64::from(1 << k)).abs() < 1e-9);
            assert!((p.n_k - 4.0 * f64::from((1 << k) - 1)).abs() < 1e-9);
        }
    }
}

/// Counts to the last line, on any machine: scenes, trees and lines use nothing that differs between processors.
#[test]
fn golden_counts() {
    const GOLDEN: [(&str, Strategy, [u64; 4]); 6] = [
        (
            "spd:balls:3",
            Strategy::Sah,
            [3_089, 175_163, 80_499, 81_991],
        ),
        (
            "spd:balls:3",
            Strategy::ObjectMedian,
            [19_903, 3_547_515, 961_189, 1_930_232],
        ),
        (
            "spd:tetra:5",
            Strategy::SahBetweenMedians,
            [1_311, 1_192_908, 351_610, 269_260],
        ),
        (
            "simple:soup:500",
            Strategy::SpatialMedian,
            [10_539, 3_346_473, 956_418, 1_674_903],
        ),
        (
            "simple:mixture:500",
            Strategy::SahSamples(10),
            [3_801, 2_194_627, 656_575, 1_188_709],
        ),
        (
            "simple:flat:500",
            Strategy::SahLongest,
            [1_069, 790_142, 183_237, 290_751],
        ),
    ];
    for (name, strategy, golden) in GOLDEN {
        let scene = sahlab::scene::Scene::load(name).unwrap();
        let tree = sahlab::kd::build(
            &scene.bounds,
            scene.world,
            &common::rules(strategy, "objects:2:16"),
        );
        let lines = SurfaceLines {
            world: scene.world,
            seed: 1990,
        };
        let counts = count_lines(&tree, 1 << 16, |range| lines.range(range), |_| ());
        let found = [
            tree.nodes.len() as u64,
            counts.work.inner,
            counts.work.leaves,
            counts.work.tests,
        ];
        assert_eq!(found, golden, "{name} {strategy}");
    }
}
