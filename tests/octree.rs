//! Strategy 1 under the stop rule `octree` is an octree: the same leaves, visited by the same lines.
#![allow(clippy::unwrap_used, missing_docs)]

mod common;

use std::collections::BTreeMap;

use common::{Leaves, hard_lines, random_boxes, rules};
use glam::DVec3;
use sahlab::geom::{Aabb, Line, Span};
use sahlab::kd::audit::audit;
use sahlab::kd::octree::Octree;
use sahlab::kd::traverse::traverse_line;
use sahlab::kd::{NodeKind, Stack, Strategy, Tree, Work, build, predict};
use sahlab::rays::SurfaceLines;
use sahlab::scene::Scene;

type Key = [u64; 6];

fn key(b: &Aabb) -> Key {
    let numbers: Vec<u64> = [b.lo.to_array(), b.hi.to_array()]
        .as_flattened()
        .iter()
        .map(|x| x.to_bits())
        .collect();
    numbers.try_into().unwrap()
}

fn sorted(objects: &[u32]) -> Vec<u32> {
    let mut objects = objects.to_vec();
    objects.sort_unstable();
    objects
}

fn kd_leaves(tree: &Tree) -> BTreeMap<Key, Vec<u32>> {
    let nodes = tree.nodes.iter().zip(&tree.boxes);
    let leaf = |(node, b): (&sahlab::kd::Node, &Aabb)| match node.kind() {
        NodeKind::Leaf { first, count } => Some((
            key(b),
            sorted(match count {
                0 => &[],
                _ => tree.objects(first, count),
            }),
        )),
        NodeKind::Inner { .. } => None,
    };
    nodes.filter_map(leaf).collect()
}

#[test]
fn leaves_and_visits_are_an_octrees() {
    for (name, limit, levels) in [
        ("simple:soup:400", 2, 4),
        ("simple:soup:400", 15, 5),
        ("simple:mixture:400", 4, 4),
        ("simple:overlapping:40", 1, 3),
        ("simple:soup:400", 1, 0),
    ] {
        let scene = Scene::load(name).unwrap();
        let rule = format!("octree:{limit}:{}", 3 * levels);
        let tree = build(
            &scene.bounds,
            scene.world,
            &rules(Strategy::SpatialMedian, &rule),
        );
        audit(&tree, &scene.bounds).unwrap();
        let octree = Octree::build(&scene.bounds, scene.world, limit, levels);
        let cells: BTreeMap<Key, Vec<u32>> = octree
            .leaves()
            .map(|(_, b, o)| (key(&b), sorted(o)))
            .collect();
        assert_eq!(kd_leaves(&tree), cells, "{name} {rule}");
        assert_eq!(
            octree.inner_nodes() * 7,
            tree.inner_nodes(),
            "{name} {rule}"
        );

        let boxes: BTreeMap<u32, Key> = octree.leaves().map(|(i, b, _)| (i, key(&b))).collect();
        let mut stack = Stack::default();
        for line in hard_lines(&scene.bounds, 400) {
            if scene.world.clip(&line, Span::FULL).is_none() {
                continue;
            }
            let (mut kd, mut oct) = (
                (Leaves::default(), Work::default()),
                (Leaves::default(), Work::default()),
            );
            traverse_line(&tree, &line, Span::FULL, &mut stack, &mut kd);
            octree.visit(&line, &mut oct);
            let mut visited: Vec<Key> =
                kd.0.0
                    .iter()
                    .map(|&i| key(&tree.boxes[i as usize]))
                    .collect();
            let mut wanted: Vec<Key> = oct.0.0.iter().map(|i| boxes[i]).collect();
            visited.sort_unstable();
            wanted.sort_unstable();
            assert_eq!(visited, wanted, "{name} {rule} {line:?}");
            assert_eq!((kd.1.leaves, kd.1.tests), (oct.1.leaves, oct.1.tests));
            // Of an octree node's seven planes a line meets three at least.
            assert!((3 * oct.1.inner..=7 * oct.1.inner).contains(&kd.1.inner));
        }
    }
}

#[test]
fn in_a_cube_an_octree_node_stands_for_four() {
    // Areas of the parts of a cube, whole: 1, two halves: 4/3, four quarters: 5/3.
    let cube = Aabb::new(DVec3::ZERO, DVec3::ONE);
    let inside = |b: &Aabb| cube.contains(b);
    let bounds: Vec<Aabb> = random_boxes(300, 8).into_iter().filter(inside).collect();
    let tree = build(
        &bounds,
        cube,
        &rules(Strategy::SpatialMedian, "octree:2:12"),
    );
    let octree = Octree::build(&bounds, cube, 2, 4);
    let predicted = (predict(&tree).n_k, octree.predicted_inner());
    assert!(
        (predicted.0 / predicted.1 - 4.0).abs() < 1e-12,
        "{predicted:?}"
    );
    let lines = SurfaceLines {
        world: cube,
        seed: 6,
    };
    let lines: Vec<Line> = lines.range(0..20_000).collect();
    let (mut kd, mut oct) = (Work::default(), Work::default());
    let mut stack = Stack::default();
    for line in &lines {
        traverse_line(&tree, line, Span::FULL, &mut stack, &mut kd);
        octree.visit(line, &mut oct);
    }
    assert_eq!(kd.leaves, oct.leaves);
    assert!((oct.inner as f64 / lines.len() as f64 / predicted.1 - 1.0).abs() < 0.02);
    assert!((kd.inner as f64 / oct.inner as f64 - 4.0).abs() < 0.02);
}
