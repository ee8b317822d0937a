//! Links and face trees against all leaves that touch each face.

use glam::DVec3;

use super::*;
use crate::cost::CostModel;
use crate::geom::Aabb;
use crate::kd::{Rules, Strategy, Tree, build};

/// Cubes on the points of a crooked lattice, so that no two planes of different cubes coincide.
fn trees() -> Vec<Tree> {
    let boxes = (0..60).map(|i| {
        let part = |k: u32| f64::from(i * k % 61) / 61.0 + f64::from(i) * 1e-5;
        let lo = DVec3::new(part(1), part(17), part(38));
        Aabb::new(lo, lo + DVec3::splat(0.13 + 1e-3 * part(7)))
    });
    let boxes: Vec<Aabb> = boxes.collect();
    let world = boxes.iter().fold(Aabb::EMPTY, |w, b| w.union(*b));
    let tree = |&strategy: &Strategy| {
        let rules = Rules {
            strategy,
            stop: "objects:2:14".parse().unwrap(),
            cost: CostModel::WALD_HAVRAN,
            clipped: false,
        };
        build(&boxes, world, &rules)
    };
    Strategy::ALL.iter().map(tree).collect()
}

/// Leaf numbers at or below a node.
fn below(tree: &Tree, links: &Links<DVec3>, node: u32) -> Vec<u32> {
    match tree.node(node) {
        NodeKind::Leaf { .. } => vec![links.numbers[node as usize]],
        NodeKind::Inner { left, .. } => {
            let parts = [left, left + 1].map(|child| below(tree, links, child));
            parts.concat()
        }
    }
}

/// Leaf numbers in a face tree, with the axes of its planes.
fn in_face_tree(faces: &FaceTrees<DVec3>, link: u32, axes: &mut Vec<u32>) -> Vec<u32> {
    if link & LEAF != 0 {
        return vec![link & !LEAF];
    }
    let plane = &faces.nodes[link as usize];
    axes.push(plane.axis);
    plane
        .children
        .map(|child| in_face_tree(faces, child, axes))
        .concat()
}

/// The leaves that touch a face in more than an edge.
fn touching(links: &Links<DVec3>, leaf: usize, axis: Axis, side: usize) -> Vec<u32> {
    let own = &links.leaves[leaf].planes;
    let touches = |other: &Faces<f64>| {
        other[axis][1 - side] == own[axis][side]
            && (0..3).filter(|&k| k != axis).all(|k| {
                let (lo, hi) = (own[k][0].max(other[k][0]), own[k][1].min(other[k][1]));
                lo < hi
            })
    };
    let all = (0..).zip(&links.leaves);
    all.filter(|(_, other)| touches(&other.planes))
        .map(|(number, _)| number)
        .collect()
}

#[test]
fn links_lead_to_all_that_touches_a_face_and_to_no_larger_node() {
    for tree in trees() {
        let links = Links::of(&tree);
        let faces = FaceTrees::of(&tree, &links);
        assert_eq!(links.leaves.len(), tree.leaves());
        let facts = links.facts();
        let sum = facts.to_leaves + facts.to_inner + facts.outside;
        assert_eq!(sum, 6 * tree.leaves());
        let mut planes = 0;
        for (number, leaf) in links.leaves.iter().enumerate() {
            for axis in 0..3 {
                let b = &tree.boxes[links.nodes[number] as usize];
                assert_eq!(leaf.planes[axis], [b.lo[axis], b.hi[axis]]);
                for side in 0..2 {
                    let expected = touching(&links, number, axis, side);
                    let link = leaf.links[axis][side];
                    let face = faces.links.leaves[number].links[axis][side];
                    match target(link) {
                        Target::Outside => assert!(expected.is_empty() && face == OUTSIDE),
                        Target::Leaf(other) => assert!(expected == [other] && face == link),
                        Target::Inner(node) => {
                            let NodeKind::Inner { left, .. } = tree.node(node) else {
                                panic!("{node} is a leaf");
                            };
                            let holds = |node: u32| {
                                let below = below(&tree, &links, node);
                                expected.iter().all(|leaf| below.contains(leaf))
                            };
                            assert!(expected.len() > 1 && holds(node));
                            assert!(!holds(left) && !holds(left + 1));
                            let mut axes = Vec::new();
                            assert_eq!(in_face_tree(&faces, face, &mut axes), expected);
                            assert!(!axes.contains(&(axis as u32)));
                            planes += axes.len();
                        }
                    }
                }
            }
        }
        let (stored, unshared) = faces.planes();
        assert_eq!(unshared, planes);
        assert!(0 < stored && stored < unshared);
    }
}

#[test]
fn bytes_are_those_of_all_parts() {
    assert_eq!([size_of::<Leaf<f64>>(), size_of::<Leaf<f32>>()], [80, 56]);
    for tree in trees() {
        let links = Links::of(&tree);
        assert_eq!(links.bytes(), 80 * tree.leaves() + 4 * tree.nodes.len());
        let faces = FaceTrees::of(&tree, &links);
        assert_eq!(faces.bytes(), links.bytes() + 24 * faces.planes().0);
    }
}
