//! What the surface area metric predicts (MacDonald & Booth 1990): counts from the nodes' boxes alone.

use super::{NodeKind, Tree};

/// Expected visits and tests of a line, uniform in origin and direction, that hits the root and never stops.
#[derive(Clone, Debug, PartialEq)]
pub struct Prediction {
    /// p = SA(K)/SA(R) of every node: the share of lines that hit it.
    pub p: Vec<f64>,
    /// Inner nodes visited: the sum of p over them.
    pub n_k: f64,
    /// Leaves visited, empty ones too: the sum of p over them.
    pub n_b: f64,
    /// Objects tested: the sum of p times the number of objects over the leaves.
    pub n_t: f64,
}

/// Predict the counts of a tree.
pub fn predict(tree: &Tree) -> Prediction {
    let root = tree.boxes[0].surface_area();
    let p = tree.boxes.iter().map(|b| b.surface_area() / root);
    Prediction::of_shares(tree, p.collect())
}

impl Prediction {
    /// The counts that follow if these shares of the lines hit the nodes.
    pub fn of_shares(tree: &Tree, p: Vec<f64>) -> Self {
        let (mut n_k, mut n_b, mut n_t) = (0.0, 0.0, 0.0);
        for (node, &p) in tree.nodes.iter().zip(&p) {
            match node.kind() {
                NodeKind::Inner { .. } => n_k += p,
                NodeKind::Leaf { count, .. } => {
                    n_b += p;
                    n_t += p * f64::from(count);
                }
            }
        }
        Self { p, n_k, n_b, n_t }
    }
}
