//! Faults on purpose: a gate that never fires is no test. And the other way round: it fires as rarely as it says.
#![allow(clippy::unwrap_used, missing_docs)]

mod common;

use common::rules;
use glam::DVec3;
use sahlab::geom::{Objects, Triangle};
use sahlab::kd::{Node, NodeKind, Rules, Strategy, Tree, build, predict};
use sahlab::rays::Uniforms;
use sahlab::scene::Scene;
use sahlab::stats::holm;
use sahlab::study::LineRule;
use sahlab::study::hits::cell::{CellPlan, compare, measure};
use sahlab::study::records::CellRecord;

/// Level of the gate.
const GATE: f64 = 0.001;

fn plan(scene: &Scene, rules: Rules, seed: u64, lines: u64) -> CellPlan<'_> {
    CellPlan {
        id: "test".into(),
        scene,
        rules,
        seed,
        line_seed: seed,
        lines: LineRule::exactly(lines).unwrap(),
        nodes: false,
    }
}

/// The gate's p-value of one cell: Holm over slope, smallest tail, contrasts.
fn gate(r: &CellRecord) -> f64 {
    let p = [r.slope_p, r.tail_p, r.hotelling_p].map(Option::unwrap);
    holm(&p).into_iter().fold(1.0, f64::min)
}

/// The tree with the plane of `node` moved by a tenth of the node's extent, towards its larger part.
fn with_moved_plane(tree: &Tree, node: usize) -> Option<Tree> {
    let NodeKind::Inner { axis, split, left } = tree.nodes[node].kind() else {
        return None;
    };
    let (lo, hi) = (tree.boxes[node].lo[axis], tree.boxes[node].hi[axis]);
    let tenth = 0.1 * (hi - lo);
    let moved = if hi - split > split - lo {
        split + tenth
    } else {
        split - tenth
    };
    let mut tree = tree.clone();
    tree.nodes[node] = Node::inner(axis, moved, left);
    Some(tree)
}

/// Some planes hardly change a node's area (those across a flat node's thin side): they take more lines, never more than
/// the study may choose.
#[test]
fn a_moved_plane_is_caught_wherever_it_matters() {
    const LINES: [u64; 4] = [1 << 16, 1 << 18, 1 << 20, 1 << 22];
    let mut caught_with = [0; LINES.len()];
    for name in ["spd:tetra:4", "simple:uniform:500", "simple:flat:500"] {
        let scene = Scene::load(name).unwrap();
        for strategy in [Strategy::Sah, Strategy::ObjectMedian] {
            let rules = rules(strategy, "objects:2:16");
            let tree = build(&scene.bounds, scene.world, &rules);
            let prediction = predict(&tree);
            let gate_with = |tree: &Tree, lines: u64| {
                let plan = plan(&scene, rules, 1, lines);
                gate(&compare(&plan, tree, &prediction, &()).unwrap().0.record)
            };
            for lines in LINES {
                let p = gate_with(&tree, lines);
                assert!(
                    p >= GATE,
                    "{name} {strategy}, {lines} lines: sound tree rejected, {p}"
                );
            }
            // Trees of the object median have many such nodes: every third will do.
            let step = if strategy == Strategy::Sah { 1 } else { 3 };
            let nodes = (0..tree.nodes.len()).filter(|&i| prediction.p[i] >= 0.05);
            for node in nodes.step_by(step) {
                let Some(broken) = with_moved_plane(&tree, node) else {
                    continue;
                };
                let caught = LINES.iter().position(|&n| gate_with(&broken, n) < GATE);
                let p = prediction.p[node];
                let caught = caught
                    .unwrap_or_else(|| panic!("{name} {strategy}: plane of node {node}, p = {p}"));
                caught_with[caught] += 1;
            }
        }
    }
    println!("planes caught with {LINES:?} lines: {caught_with:?}");
    assert!(caught_with.iter().sum::<u32>() > 50);
}

/// A fault that a regression cannot see: all nodes right but one small one. Its own binomial tail sees it.
#[test]
fn one_wrong_node_is_caught_by_its_tail() {
    let scene = Scene::load("simple:uniform:500").unwrap();
    let rules = rules(Strategy::Sah, "objects:2:16");
    let tree = build(&scene.bounds, scene.world, &rules);
    let mut prediction = predict(&tree);
    let small = (0..tree.nodes.len())
        .find(|&i| prediction.p[i] < 0.01)
        .unwrap();
    prediction.p[small] *= 1.1;
    let bad = compare(&plan(&scene, rules, 1, 1 << 20), &tree, &prediction, &())
        .unwrap()
        .0
        .record;
    assert!(bad.slope_p.unwrap() > 0.01, "the slope does not see it");
    assert!(bad.tail_p.unwrap() < GATE);
}

/// Over many seeds of a correct program, each p-value is below 5 % and 1 % as often as it should be, and the slope's
/// interval covers. Bands: 99.9 % binomial; the smallest tail is conservative by design, so only its upper band counts.
#[test]
fn levels_are_what_they_say() {
    const SEEDS: u64 = 400;
    let scene = Scene::load("simple:uniform:100").unwrap();
    let rules = rules(Strategy::Sah, "objects:2:16");
    let mut below = [[0; 2]; 4];
    let mut covered = 0;
    for seed in 0..SEEDS {
        let r = measure(&plan(&scene, rules, 1000 + seed, 1 << 14), &())
            .unwrap()
            .0
            .record;
        let p = [r.slope_p, r.hotelling_p, r.free_p, r.tail_p].map(Option::unwrap);
        for (count, p) in below.iter_mut().zip(p) {
            count[0] += u32::from(p < 0.05);
            count[1] += u32::from(p < 0.01);
        }
        covered += u32::from((r.slope.unwrap() - 1.0).abs() <= 1.96 * r.slope_se.unwrap());
    }
    println!(
        "slope, contrasts, free line, smallest tail: {below:?} of {SEEDS} below 5 % and 1 %; {covered} covered"
    );
    // 99.9 % bands of Binomial(400, 0.05) and (400, 0.01).
    for (name, count) in ["slope", "contrasts", "free line"].iter().zip(below) {
        assert!((7..=36).contains(&count[0]), "{name}: {count:?}");
        assert!(count[1] <= 12, "{name}: {count:?}");
    }
    assert!(below[3][0] <= 36 && below[3][1] <= 12);
    assert!((364..=393).contains(&covered), "{covered}");
}

/// Scenes whose counts hang on rare events: a tiny dense cluster on a large floor, a flat terrain of grid cells, a needle
/// beside a triangle. A pilot that has not met the event must not take it for impossible.
#[test]
fn rare_events_raise_no_false_alarm() {
    let triangle = |a: DVec3, size: f64, turn: usize| {
        let mut b = DVec3::ZERO;
        (b[turn % 3], b[(turn + 1) % 3]) = (size, 0.3 * size);
        let mut c = DVec3::ZERO;
        (c[(turn + 1) % 3], c[(turn + 2) % 3]) = (size, 0.7 * size);
        Triangle([a, a + b, a + c])
    };
    let stadium = |ratio: f64| {
        let mut uniforms = Uniforms::starting_at(1, 0);
        let mut triangles = vec![
            Triangle([DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0)]),
            Triangle([DVec3::ZERO, DVec3::new(1.0, 1.0, 0.0), DVec3::Y]),
        ];
        for i in 0..1000 {
            let [x, y, z, _] = uniforms.next4();
            let at = DVec3::new(0.3, 0.6, 0.0) + DVec3::new(x, y, z) / ratio;
            triangles.push(triangle(at, 0.1 / ratio, i));
        }
        triangles
    };
    let mut terrain = Vec::new();
    for i in 0..12 {
        for j in 0..12 {
            let corner = |a: usize, b: usize| {
                DVec3::new(a as f64, b as f64, 0.001 * ((a * 7 + b * 3) % 5) as f64)
            };
            terrain.push(Triangle([corner(i, j), corner(i + 1, j), corner(i, j + 1)]));
            terrain.push(Triangle([
                corner(i + 1, j),
                corner(i + 1, j + 1),
                corner(i, j + 1),
            ]));
        }
    }
    let needle = vec![
        Triangle([DVec3::ZERO, 1e6 * DVec3::X, DVec3::new(0.0, 1.0, 0.1)]),
        Triangle([
            DVec3::new(0.0, 0.2, 0.3),
            DVec3::new(1.0, 0.2, 0.3),
            DVec3::new(0.0, 0.9, 1.0),
        ]),
    ];
    let grid: Vec<Triangle> = terrain
        .iter()
        .map(|t| Triangle(t.0.map(|p| DVec3::new(p.x, p.y, 0.0))))
        .collect();
    // Thinner than a pilot can tell from flat: sums of scores then differ by rounding alone.
    let sheet: Vec<Triangle> = terrain
        .iter()
        .map(|t| Triangle(t.0.map(|p| DVec3::new(p.x, p.y, 1e-5 * p.z))))
        .collect();
    let mut unjudged = 0;
    for (name, triangles) in [
        ("stadium 30", stadium(30.0)),
        ("stadium 100", stadium(100.0)),
        ("stadium 1000", stadium(1000.0)),
        ("terrain", terrain),
        ("planar grid", grid),
        ("sheet", sheet),
        ("needle", needle),
    ] {
        let objects = Objects {
            triangles,
            ..Objects::default()
        };
        let scene = Scene::new(name, objects, Vec::new()).unwrap();
        for strategy in [
            Strategy::Sah,
            Strategy::ObjectMedian,
            Strategy::MedianMidpoint,
            Strategy::SpatialMedianLongest,
        ] {
            for seed in 0..15 {
                let r = measure(
                    &plan(&scene, rules(strategy, "cost-gain"), seed, 1 << 17),
                    &(),
                )
                .unwrap()
                .0
                .record;
                let p: Vec<f64> = [r.slope_p, r.tail_p, r.hotelling_p]
                    .into_iter()
                    .flatten()
                    .collect();
                let least = holm(&p).into_iter().fold(1.0, f64::min);
                // 420 gates: one below 1e-5 has a chance of 0.4 %.
                assert!(least >= 1e-5, "{name} {strategy} seed {seed}: {p:?}");
                for (what, predicted, counted, se) in [
                    ("n_K", r.n_k_predicted, r.n_k_counted, r.n_k_se),
                    ("n_B", r.n_b_predicted, r.n_b_counted, r.n_b_se),
                    ("n_t", r.n_t_predicted, r.n_t_counted, r.n_t_se),
                ] {
                    let Some(se) = se else {
                        unjudged += 1;
                        continue;
                    };
                    // 1,260 intervals of 5 sigma: a miss has a chance of 0.07 %.
                    let off = (counted - predicted).abs();
                    assert!(
                        off <= 5.0 * se + 1e-9,
                        "{name} {strategy} seed {seed}: {what} {counted} for {predicted} ± {se}"
                    );
                }
            }
        }
    }
    println!("{unjudged} of 1260 counts hang on events too rare to judge");
    assert!(unjudged < 630);
}
