//! One node, cut once: no strategy's plane is cheaper than the reference's, by counts taken here from the boxes.
//!
//! Strategy 3 looks at object bounds only. Between two of them the split cost is linear, and before the first and behind the
//! last it falls towards them; so planes at no bound, as the medians are, never beat the best bound. One exception: objects
//! that lie flat in a face of the node pull the best plane towards that face, which is no candidate itself.
#![allow(clippy::unwrap_used, missing_docs)]

mod common;

use common::{gridded_boxes, random_boxes, rules, world};
use sahlab::geom::Aabb;
use sahlab::kd::{NodeKind, Strategy, build};
use sahlab::rays::Uniforms;
use sahlab::scene::Scene;

/// The root plane's one-level cost, every object looked at; `None` if the root is not cut.
fn naive_cost(bounds: &[Aabb], node: Aabb, strategy: Strategy) -> Option<f64> {
    let rules = rules(strategy, "objects:1:1");
    let tree = build(bounds, node, &rules);
    let NodeKind::Inner { axis, split, .. } = tree.nodes[0].kind() else {
        return None;
    };
    let (mut below, mut above, mut in_plane) = (0.0, 0.0, 0.0);
    for b in bounds {
        if b.lo[axis] == split && b.hi[axis] == split {
            in_plane += 1.0;
        }
        below += f64::from(b.lo[axis] < split);
        above += f64::from(b.hi[axis] > split);
    }
    let (left, right) = node.split(axis, split);
    let p = |part: Aabb| part.surface_area() / node.surface_area();
    let cost = |l, r| rules.cost.split(p(left), l, p(right), r);
    Some(cost(below + in_plane, above).min(cost(below, above + in_plane)))
}

/// Whether an object lies flat in a face of the node.
fn lies_in_a_face(b: &Aabb, node: &Aabb) -> bool {
    let on_a_face = b.lo.cmpeq(node.lo) | b.lo.cmpeq(node.hi);
    (b.lo.cmpeq(b.hi) & on_a_face).any()
}

/// Compare all strategies at one node; whether it could be cut.
fn compare(bounds: &[Aabb], node: Aabb, name: &str) -> bool {
    let best = naive_cost(bounds, node, Strategy::Sah);
    for strategy in Strategy::ALL {
        // Where the reference has no plane, nobody has.
        if let Some(cost) = naive_cost(bounds, node, strategy) {
            let best = best.unwrap_or(f64::INFINITY);
            assert!(
                best <= cost * (1.0 + 1e-12),
                "{name}, {strategy}: {cost} below {best} in {node:?}"
            );
        }
    }
    best.is_some()
}

#[test]
fn no_strategy_beats_sah_on_boxes() {
    for seed in 0..40 {
        let bounds = if seed % 2 == 0 {
            gridded_boxes(60, seed)
        } else {
            random_boxes(60, seed)
        };
        assert!(compare(&bounds, world(&bounds), "boxes"));
    }
}

#[test]
fn no_strategy_beats_sah_at_the_nodes_of_scenes() {
    let mut uniforms = Uniforms::starting_at(41, 0);
    for name in [
        "simple:soup:1000",
        "simple:mixture:1000",
        "simple:overlapping:60",
        "simple:flat:300",
        "spd:tetra:4",
        "spd:balls:2",
    ] {
        let scene = Scene::load(name).unwrap();
        let mut cut = 0;
        for strategy in [
            Strategy::Sah,
            Strategy::ObjectMedian,
            Strategy::SpatialMedian,
        ] {
            let tree = build(&scene.bounds, scene.world, &rules(strategy, "objects:4:12"));
            for _ in 0..100 {
                let [u, ..] = uniforms.next4();
                let node = tree.boxes[(u * tree.boxes.len() as f64) as usize];
                // The objects' parts in it; those that only touch it are left out unless they are flat.
                let part = |b: &Aabb| Aabb::new(b.lo.max(node.lo), b.hi.min(node.hi));
                let flat = |b: &Aabb| b.lo.cmpeq(b.hi).any();
                let inside = |b: &Aabb| b.lo.cmplt(node.hi).all() && b.hi.cmpgt(node.lo).all();
                let held = scene
                    .bounds
                    .iter()
                    .filter(|b| inside(b) || flat(b))
                    .map(part);
                let held: Vec<Aabb> = held.filter(Aabb::is_valid).collect();
                if held.len() > 1 && !held.iter().any(|b| lies_in_a_face(b, &node)) {
                    cut += u32::from(compare(&held, node, name));
                }
            }
        }
        assert!(cut > 30, "{name}: only {cut} nodes to compare at");
    }
}

#[test]
fn objects_in_a_face_are_the_exception() {
    // Nine objects on the floor of a unit cube and one that fills it: no bound lies inside, so strategy 3 has no plane. The
    // middle on z keeps the nine below: 15 + 20 * 2/3 * (10 + 1).
    let cube = Aabb::new([0.0; 3].into(), [1.0; 3].into());
    let floor = Aabb::new([0.0; 3].into(), [1.0, 1.0, 0.0].into());
    let mut bounds = vec![floor; 9];
    bounds.push(cube);
    assert_eq!(naive_cost(&bounds, cube, Strategy::Sah), None);
    let middle = naive_cost(&bounds, cube, Strategy::SpatialMedian).unwrap();
    assert!((middle - (15.0 + 440.0 / 3.0)).abs() < 1e-9, "{middle}");
    assert!(middle < rules(Strategy::Sah, "objects:1").cost.leaf(10.0));
}
