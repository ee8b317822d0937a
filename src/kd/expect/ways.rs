//! Which children a line meets that hits an inner node, and recursions from the leaves up.

use crate::kd::{NodeKind, Tree};

/// Of the isotropic lines that hit an inner node, the shares that go each way: from areas alone, as the children's boxes
/// are convex (Santalo 1976). They add up to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Ways {
    /// Lines that hit the left child only: 1 - SA(right)/SA(node).
    pub left: f64,
    /// The right child only: 1 - SA(left)/SA(node).
    pub right: f64,
    /// Both, through their common face: twice its area over SA(node).
    pub both: f64,
}

impl Ways {
    pub fn of(tree: &Tree, node: usize, left: usize) -> Self {
        let area = tree.boxes[node].surface_area();
        let [p_left, p_right] = [0, 1].map(|side| tree.boxes[left + side].surface_area() / area);
        Self {
            left: 1.0 - p_right,
            right: 1.0 - p_left,
            both: p_left + p_right - 1.0,
        }
    }
}

/// An inner node as a recursion meets it.
#[derive(Clone, Copy)]
pub(super) struct Inner {
    /// Its number.
    pub node: usize,
    /// Its left child, the right one following.
    pub left: usize,
    /// The ways of the lines that hit it.
    pub ways: Ways,
}

/// The root's value of a recursion: that of a leaf from its number and references (first and count), that of an inner node
/// from its children's.
pub(super) fn from_leaves<T: Default>(
    tree: &Tree,
    mut leaf: impl FnMut(usize, u32, u32) -> T,
    mut inner: impl FnMut(Inner, T, T) -> T,
) -> T {
    // Children come after their parent in the arena.
    let mut values: Vec<T> = tree.nodes.iter().map(|_| T::default()).collect();
    for (node, kind) in tree.nodes.iter().map(|n| n.kind()).enumerate().rev() {
        values[node] = match kind {
            NodeKind::Leaf { first, count } => leaf(node, first, count),
            NodeKind::Inner { left, .. } => {
                let left = left as usize;
                let ways = Ways::of(tree, node, left);
                let [l, r] = [left, left + 1].map(|child| std::mem::take(&mut values[child]));
                inner(Inner { node, left, ways }, l, r)
            }
        };
    }
    std::mem::take(&mut values[0])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::Aabb;
    use glam::DVec3;

    /// A cube cut in two halves: each has 2/3 of its area, so a third of the lines cross the plane.
    #[test]
    fn a_third_of_the_lines_cross_the_middle_of_a_cube() {
        let world = Aabb::new(DVec3::ZERO, DVec3::ONE);
        let (left, right) = world.split(1, 0.5);
        let tree = Tree {
            nodes: vec![
                crate::kd::Node::inner(1, 0.5, 1),
                crate::kd::Node::leaf(0, 2),
                crate::kd::Node::leaf(2, 5),
            ],
            boxes: vec![world, left, right],
            references: vec![0; 7],
            depth: 1,
            world,
        };
        let counts = |_, first: u32, count: u32| f64::from(10 * first + count);
        let root = from_leaves(&tree, counts, |inner, l, r| {
            let ways = inner.ways;
            for way in [ways.left, ways.right, ways.both] {
                assert!((way - 1.0 / 3.0).abs() < 1e-15, "{ways:?}");
            }
            assert_eq!((inner.node, inner.left), (0, 1));
            l - r
        });
        assert_eq!(root, 2.0 - 25.0);
    }
}
