//! Faults on purpose: a gate that never fires is no test. And the other way round: it fires as rarely as it says.
#![allow(clippy::unwrap_used, missing_docs)]

mod common;

use common::rules;
use sahlab::kd::{Node, NodeKind, Rules, Strategy, Tree, build, predict};
use sahlab::scene::Scene;
use sahlab::stats::holm;
use sahlab::study::LineRule;
use sahlab::study::cell::{CellPlan, compare, measure};
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
                gate(&compare(&plan, tree, &prediction, &()).unwrap().record)
            };
            for lines in LINES {
                let p = gate_with(&tree, lines);
                assert!(
                    p >= GATE,
                    "{name} {strategy}, {lines} lines: sound tree rejected, {p}"
                );
            }
            for node in (0..tree.nodes.len()).filter(|&i| prediction.p[i] >= 0.05) {
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
