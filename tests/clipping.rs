//! Clipped trees: sound, cheaper, counted as their boxes say, and not to be had by leaving objects out.
#![allow(clippy::unwrap_used, missing_docs)]

mod common;

use common::{STOPS, rules};
use glam::DVec3;
use sahlab::geom::{Aabb, Clipper, Line, Objects, Span, Triangle, clip_slack};
use sahlab::kd::audit::{audit, audit_clipped};
use sahlab::kd::stream::{Streams, count_lines};
use sahlab::kd::{Counts, Node, NodeKind, Rules, Strategy, Tree, build_objects, predict};
use sahlab::rays::SurfaceLines;
use sahlab::scene::Scene;

const SCENES: [&str; 5] = [
    "simple:soup:400",
    "spd:tetra:4",
    "simple:mixture:400",
    "simple:flat:200",
    "simple:overlapping:40",
];

fn tree(scene: &Scene, strategy: Strategy, stop: &str, clipped: bool) -> Tree {
    let rules = Rules {
        clipped,
        ..rules(strategy, stop)
    };
    build_objects(&scene.objects, &scene.bounds, scene.world, &rules)
}

#[test]
fn every_clipped_tree_passes_the_audit() {
    for name in SCENES {
        let scene = Scene::load(name).unwrap();
        for strategy in Strategy::ALL {
            for stop in STOPS {
                let tree = tree(&scene, strategy, stop, true);
                audit_clipped(&tree, &scene.objects, &scene.bounds)
                    .unwrap_or_else(|f| panic!("{name} {strategy} {stop}: {f:?}"));
            }
        }
    }
}

/// Cutting a polygon with reflex corners leaves seams without area along the cuts: an object need not be where only they are.
#[test]
fn seams_of_reflex_polygons_are_no_parts() {
    let scene = Scene::load("spd:gears:4").unwrap();
    let tree = tree(&scene, Strategy::Sah, "objects:2:16", true);
    audit_clipped(&tree, &scene.objects, &scene.bounds).unwrap();
}

/// Not one reference is superfluous or missing beyond the slack: a leaf holds what clipping to it finds.
#[test]
fn leaves_hold_what_has_a_part_in_them() {
    let scene = Scene::load("simple:soup:400").unwrap();
    let tree = tree(&scene, Strategy::Sah, "objects:2", true);
    let slack = clip_slack(&scene.world);
    let (mut held, mut by_box, mut clipper) = (0, 0, Clipper::default());
    for (node, b) in tree.nodes.iter().zip(&tree.boxes) {
        let NodeKind::Leaf { first, count } = node.kind() else {
            continue;
        };
        for object in 0..scene.objects.len() as u32 {
            let own = &scene.bounds[object as usize];
            let meets = own.lo.cmplt(b.hi).all() && own.hi.cmpgt(b.lo).all();
            let mut part = |slack| {
                scene
                    .objects
                    .clipped_bounds(object, b, slack, &mut clipper)
                    .is_some()
            };
            let found = tree.objects(first, count).contains(&object);
            by_box += usize::from(meets);
            held += usize::from(found);
            assert!(
                !meets || !part(0.5 * slack) || found,
                "object {object} lost"
            );
            assert!(!found || part(8.0 * slack), "object {object} is not here");
        }
    }
    // Triangles fill half of their boxes' faces at most: many leaves see a box, and no triangle.
    assert!(4 * held < 3 * by_box, "{held} of {by_box}");
}

#[test]
fn clipping_saves_references_and_cost() {
    for (name, share) in [("simple:soup:2000", 0.95), ("simple:mixture:2000", 0.95)] {
        let scene = Scene::load(name).unwrap();
        for strategy in Strategy::ALL {
            let [plain, clipped] =
                [false, true].map(|clipped| tree(&scene, strategy, "objects:2:16", clipped));
            assert!(
                clipped.references.len() < plain.references.len(),
                "{name} {strategy}: {} not fewer than {}",
                clipped.references.len(),
                plain.references.len()
            );
        }
        let [plain, clipped] = [false, true].map(|clipped| {
            let p = predict(&tree(&scene, Strategy::Sah, "cost-gain", clipped));
            rules(Strategy::Sah, "cost-gain")
                .cost
                .cost(p.n_k, p.n_b, p.n_t)
        });
        assert!(clipped < share * plain, "{name}: {clipped} against {plain}");
    }
}

#[test]
fn counts_are_slab_tests() {
    let scene = Scene::load("simple:mixture:300").unwrap();
    let lines = SurfaceLines {
        world: scene.world,
        seed: 9,
    };
    let lines: Vec<Line> = lines.range(0..400).collect();
    for strategy in Strategy::ALL {
        let tree = tree(&scene, strategy, "cost-gain", true);
        let mut counts = Counts::new(&tree);
        Streams::default().count(&tree, &lines, &mut counts);
        counts.check(&tree).unwrap();
        for (b, &hits) in tree.boxes.iter().zip(&counts.hits) {
            let slabs = lines.iter().filter(|l| b.clip(l, Span::FULL).is_some());
            assert_eq!(slabs.count() as u64, hits, "{strategy}");
        }
    }
}

/// What is predicted of a clipped tree is what lines do in it.
#[test]
fn predictions_hold() {
    let scene = Scene::load("simple:soup:2000").unwrap();
    let tree = tree(&scene, Strategy::Sah, "cost-gain", true);
    let lines = SurfaceLines {
        world: scene.world,
        seed: 1,
    };
    let n = 1 << 18;
    let counts = count_lines(&tree, n, |range| lines.range(range), |_| ());
    let p = predict(&tree);
    for (counted, predicted) in [
        (counts.work.inner, p.n_k),
        (counts.work.leaves, p.n_b),
        (counts.work.tests, p.n_t),
    ] {
        assert!((counted as f64 / n as f64 / predicted - 1.0).abs() < 0.01);
    }
}

#[test]
fn boxes_alone_are_not_changed_by_clipping() {
    // Spheres are their boxes: the same trees, node for node.
    let scene = Scene::load("spd:balls:2").unwrap();
    assert!(scene.objects.spheres.len() + 1 >= scene.objects.len());
    let spheres = Objects {
        spheres: scene.objects.spheres.clone(),
        ..Objects::default()
    };
    let bounds = spheres.bounds();
    for strategy in Strategy::ALL {
        for stop in STOPS {
            let [plain, clipped] = [false, true].map(|clipped| {
                let rules = Rules {
                    clipped,
                    ..rules(strategy, stop)
                };
                build_objects(&spheres, &bounds, common::world(&bounds), &rules)
            });
            assert_eq!(plain, clipped, "{strategy} {stop}");
        }
    }
}

#[test]
fn the_diagonal_frees_the_corner() {
    // A triangle below the diagonal of the unit square, and a flat square in the far corner that only its box reaches.
    let corner = |x: f64, y: f64| DVec3::new(x, y, 0.0);
    let objects = Objects {
        triangles: vec![
            Triangle([corner(0.0, 0.0), corner(1.0, 0.0), corner(0.0, 1.0)]),
            Triangle([corner(0.75, 1.0), corner(1.0, 0.75), corner(1.0, 1.0)]),
        ],
        ..Objects::default()
    };
    let bounds = objects.bounds();
    let world = Aabb::new(corner(0.0, 0.0), DVec3::ONE);
    let leaves = |clipped: bool| -> Vec<Vec<u32>> {
        let rules = Rules {
            clipped,
            ..rules(Strategy::SpatialMedian, "objects:1:6")
        };
        let tree = build_objects(&objects, &bounds, world, &rules);
        let kinds = tree.nodes.iter().map(Node::kind);
        kinds
            .filter_map(|k| match k {
                NodeKind::Leaf { first, count } => Some(tree.objects(first, count).to_vec()),
                NodeKind::Inner { .. } => None,
            })
            .collect()
    };
    assert!(leaves(false).contains(&vec![0, 1]), "the boxes overlap");
    assert!(!leaves(true).contains(&vec![0, 1]), "the triangles do not");
}

#[test]
fn the_audit_finds_each_lost_or_added_reference() {
    let scene = Scene::load("simple:soup:100").unwrap();
    let good = tree(&scene, Strategy::Sah, "objects:2", true);
    let check = |tree: &Tree| audit_clipped(tree, &scene.objects, &scene.bounds);
    check(&good).unwrap();
    // By their boxes, objects are missing.
    assert!(audit(&good, &scene.bounds).is_err());
    let (mut lost, mut exchanged) = (0, 0);
    for i in 0..good.nodes.len() {
        let NodeKind::Leaf { first, count } = good.nodes[i].kind() else {
            continue;
        };
        if count == 0 {
            continue;
        }
        let mut broken = good.clone();
        broken.nodes[i] = Node::leaf(first, count - 1);
        check(&broken).unwrap_err();
        lost += 1;
        // An object whose own box is elsewhere.
        let far = (0..100).find(|&o| {
            let (own, b) = (&scene.bounds[o as usize], &good.boxes[i]);
            !(own.lo.cmple(b.hi).all() && own.hi.cmpge(b.lo).all())
        });
        broken = good.clone();
        broken.references[first as usize] = far.unwrap();
        assert!(check(&broken).unwrap_err().join(" ").contains("1 too many"));
        exchanged += 1;
    }
    assert!(lost > 50 && exchanged > 50);
}
