//! The tree: one arena of 16-byte nodes, children side by side.

use crate::geom::{Aabb, Axis};

/// An inner node's plane and children, or a leaf's references, in 16 bytes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Node {
    /// Plane position (inner nodes).
    split: f64,
    /// Low two bits: axis, or 3 for a leaf; above them a leaf's number of references.
    tag: u32,
    /// Left child, the right one following it; or the first reference.
    first: u32,
}

const LEAF: u32 = 3;

/// What a node is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NodeKind<T = f64> {
    /// Cut by the plane `x[axis] = split`; the children are `left` and `left + 1`.
    Inner {
        /// Axis the plane is normal to.
        axis: Axis,
        /// Position of the plane.
        split: T,
        /// Number of the child below the plane; the one above follows it.
        left: u32,
    },
    /// References `first .. first + count`.
    Leaf {
        /// First reference.
        first: u32,
        /// Number of references, 0 for an empty leaf.
        count: u32,
    },
}

impl Node {
    /// An inner node.
    pub fn inner(axis: Axis, split: f64, left: u32) -> Self {
        Self {
            split,
            tag: axis as u32,
            first: left,
        }
    }

    /// A leaf.
    pub fn leaf(first: u32, count: u32) -> Self {
        assert!(
            count < 1 << 30,
            "{count} references in one leaf, at most 2^30 - 1 fit"
        );
        Self {
            split: 0.0,
            tag: LEAF | count << 2,
            first,
        }
    }

    /// Whether it is a leaf.
    #[inline(always)]
    pub fn is_leaf(&self) -> bool {
        self.tag & 3 == LEAF
    }

    /// What it is, with its data.
    #[inline(always)]
    pub fn kind(&self) -> NodeKind {
        match self.tag & 3 {
            LEAF => NodeKind::Leaf {
                first: self.first,
                count: self.tag >> 2,
            },
            axis => NodeKind::Inner {
                axis: axis as Axis,
                split: self.split,
                left: self.first,
            },
        }
    }
}

/// A kd-tree over a scene's objects. Node 0 is the root.
///
/// ```
/// use sahlab::cost::CostModel;
/// use sahlab::kd::{NodeKind, Rules, StopRule, Strategy, build};
/// use sahlab::scene::Scene;
///
/// let scene = Scene::load("simple:uniform:100")?;
/// let (strategy, stop) = (Strategy::ObjectMedian, StopRule::Depth(5));
/// let rules = Rules { strategy, stop, cost: CostModel::WALD_HAVRAN, clipped: false };
/// let tree = build(&scene.bounds, scene.world, &rules);
/// assert_eq!((tree.leaves(), tree.inner_nodes(), tree.depth), (32, 31, 5));
///
/// // The leaves tile the world, and every object is in one of them at least.
/// let leaves = || tree.nodes.iter().zip(&tree.boxes).filter(|(node, _)| node.is_leaf());
/// let volume: f64 = leaves().map(|(_, cell)| cell.volume()).sum();
/// assert!((volume / scene.world.volume() - 1.0).abs() < 1e-12);
/// let mut found = vec![false; scene.objects.len()];
/// for (node, _) in leaves() {
///     if let NodeKind::Leaf { first, count } = node.kind() {
///         tree.objects(first, count).iter().for_each(|&object| found[object as usize] = true);
///     }
/// }
/// assert!(found.iter().all(|&found| found));
/// # Ok::<(), sahlab::scene::SceneError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Tree {
    /// The nodes; all that a traversal reads besides [`references`](Self::references) and the root's box.
    pub nodes: Vec<Node>,
    /// The box of every node as the builder cut it: all that a prediction reads.
    pub boxes: Vec<Aabb>,
    /// Objects of the leaves, one entry an object and leaf.
    pub references: Vec<u32>,
    /// Depth of the deepest leaf (root = 0).
    pub depth: usize,
    /// The box that lines must hit: the root's.
    pub world: Aabb,
}

impl Tree {
    /// Objects in a leaf given by its reference range.
    #[inline(always)]
    pub fn objects(&self, first: u32, count: u32) -> &[u32] {
        &self.references[first as usize..][..count as usize]
    }

    /// Number of inner nodes.
    pub fn inner_nodes(&self) -> usize {
        self.nodes.iter().filter(|n| !n.is_leaf()).count()
    }

    /// Number of leaves, empty ones included.
    pub fn leaves(&self) -> usize {
        self.nodes.len() - self.inner_nodes()
    }

    /// Number of leaves without an object.
    pub fn empty_leaves(&self) -> usize {
        let empty = |n: &&Node| matches!(n.kind(), NodeKind::Leaf { count: 0, .. });
        self.nodes.iter().filter(empty).count()
    }

    /// Bytes that a traversal reads: nodes and references, without the boxes, which only predictions read.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.nodes[..]) + size_of_val(&self.references[..])
    }

    /// Depth of every node (root = 0).
    pub fn depths(&self) -> Vec<u32> {
        let mut depths = vec![0; self.nodes.len()];
        // Children come after their parent in the arena.
        for (i, node) in self.nodes.iter().enumerate() {
            if let NodeKind::Inner { left, .. } = node.kind() {
                let below = depths[i] + 1;
                depths[left as usize..][..2].fill(below);
            }
        }
        depths
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_node_is_sixteen_bytes_and_keeps_its_data() {
        assert_eq!(size_of::<Node>(), 16);
        for axis in 0..3 {
            let (split, left) = (-0.25, 7);
            let kind = NodeKind::Inner { axis, split, left };
            assert_eq!(Node::inner(axis, split, left).kind(), kind);
        }
        let (first, count) = (5, (1 << 30) - 1);
        assert_eq!(
            Node::leaf(first, count).kind(),
            NodeKind::Leaf { first, count }
        );
    }
}
