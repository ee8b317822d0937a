//! Turns that no branch predictor foresees.

use crate::kd::{NodeKind, Tree};

use super::ways::Ways;

/// n_s: the expected number of inner nodes where a line does not go the way that most lines go there (left child only, right
/// child only, or both): the sum of p_K (1 - the largest of the three shares).
pub fn branches(tree: &Tree) -> f64 {
    let root = tree.boxes[0].surface_area();
    let unforeseen = |(node, kind): (usize, NodeKind)| match kind {
        NodeKind::Inner { left, .. } => {
            let p = tree.boxes[node].surface_area() / root;
            p * (1.0 - Ways::of(tree, node, left as usize).most())
        }
        NodeKind::Leaf { .. } => 0.0,
    };
    let kinds = tree.nodes.iter().map(|node| node.kind());
    kinds.enumerate().map(unforeseen).sum()
}
