//! What a builder makes of a part of the scene: a subtree in arenas of its own, and how such parts make a tree.

use crate::geom::Aabb;
use crate::kd::arena::make_room;
use crate::kd::split::Split;
use crate::kd::{Node, NodeKind, Tree};

/// A subtree, its root first.
#[derive(Default)]
pub(super) struct Growth {
    pub nodes: Vec<Node>,
    pub references: Vec<u32>,
    /// Depth of the deepest leaf, in the whole tree.
    pub depth: usize,
}

impl Growth {
    /// A node that is not grown yet.
    pub fn bud() -> Self {
        Self {
            nodes: vec![Node::leaf(0, 0)],
            ..Self::default()
        }
    }

    /// Make `node` a leaf of these objects.
    pub fn make_leaf(
        &mut self,
        node: usize,
        objects: impl ExactSizeIterator<Item = u32>,
        depth: usize,
    ) {
        let (first, count) = (self.references.len(), objects.len());
        make_room(&mut self.references, count);
        self.references.extend(objects);
        self.nodes[node] = Node::leaf(number(first, "references"), count as u32);
        number(self.references.len(), "references");
        self.depth = self.depth.max(depth);
    }

    /// Cut `node`. Returns the left child's number, which the right one's follows.
    pub fn make_inner(&mut self, node: usize, split: &Split) -> usize {
        let left = self.nodes.len();
        // The right child's number fits too.
        let right = number(left + 1, "nodes");
        self.nodes[node] = Node::inner(split.axis, split.position, right - 1);
        make_room(&mut self.nodes, 2);
        self.nodes.extend([Node::leaf(0, 0); 2]);
        left
    }

    /// The subtree whose root is cut so and whose children are these: numbered as if they had been grown in its arenas.
    pub fn cut(split: &Split, children: [Self; 2]) -> Self {
        let mut whole = Self::bud();
        let sums = children
            .each_ref()
            .map(|c| [c.nodes.len(), c.references.len()]);
        whole.nodes.reserve_exact(sums[0][0] + sums[1][0]);
        whole.references.reserve_exact(sums[0][1] + sums[1][1]);
        let left = whole.make_inner(0, split);
        for (side, child) in children.into_iter().enumerate() {
            // The child's root goes to its place beside its sibling, all else on top.
            let nodes = whole.nodes.len() - 1;
            let references = whole.references.len();
            let mut moved = child.nodes.iter().map(|node| match node.kind() {
                NodeKind::Inner { axis, split, left } => {
                    let right = number(nodes + left as usize + 1, "nodes");
                    Node::inner(axis, split, right - 1)
                }
                NodeKind::Leaf { first, count } => {
                    Node::leaf(number(references + first as usize, "references"), count)
                }
            });
            whole.nodes[left + side] = moved.next().expect("a subtree has a root");
            whole.nodes.extend(moved);
            whole.references.extend(child.references);
            whole.depth = whole.depth.max(child.depth);
        }
        whole
    }

    /// The tree in this world, with the box of every node as the planes cut it.
    pub fn into_tree(mut self, world: Aabb) -> Tree {
        self.nodes.shrink_to_fit();
        self.references.shrink_to_fit();
        let mut boxes = Vec::with_capacity(self.nodes.len());
        boxes.push(world);
        add_boxes(&mut boxes, &self.nodes, 0, &world);
        Tree {
            nodes: self.nodes,
            boxes,
            references: self.references,
            depth: self.depth,
            world,
        }
    }
}

/// Add the boxes of all below a node with these bounds, in the order in which the nodes were made.
fn add_boxes(boxes: &mut Vec<Aabb>, nodes: &[Node], node: usize, bounds: &Aabb) {
    if let NodeKind::Inner { axis, split, left } = nodes[node].kind() {
        let left = left as usize;
        debug_assert_eq!(boxes.len(), left);
        let (below, above) = bounds.split(axis, split);
        boxes.extend([below, above]);
        add_boxes(boxes, nodes, left, &below);
        add_boxes(boxes, nodes, left + 1, &above);
    }
}

/// A number of nodes or references, which a tree holds in 32 bits.
fn number(n: usize, of_what: &str) -> u32 {
    u32::try_from(n).unwrap_or_else(|_| panic!("more than 2^32 {of_what}"))
}
