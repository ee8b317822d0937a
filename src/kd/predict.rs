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
///
/// ```
/// use glam::DVec3;
/// use sahlab::cost::CostModel;
/// use sahlab::geom::Aabb;
/// use sahlab::kd::{Rules, StopRule, Strategy, build, predict};
///
/// // A cube of three boxes, cut once in the middle: one box to the left, two to the right.
/// let slab = |lo: f64, hi: f64| Aabb::new(DVec3::new(lo, 0.0, 0.0), DVec3::new(hi, 1.0, 1.0));
/// let (strategy, stop) = (Strategy::SpatialMedian, StopRule::Depth(1));
/// let rules = Rules { strategy, stop, cost: CostModel::WALD_HAVRAN, clipped: false };
/// let tree = build(&[slab(0.0, 0.4), slab(0.6, 0.8), slab(0.8, 1.0)], slab(0.0, 1.0), &rules);
/// let expected = predict(&tree);
/// // Each half has 4/6 of the cube's surface: a line visits one inner node, 8/6 leaves, and tests 3 times 4/6 objects.
/// assert!((expected.n_k - 1.0).abs() < 1e-15);
/// assert!((expected.n_b - 8.0 / 6.0).abs() < 1e-15);
/// assert!((expected.n_t - 2.0).abs() < 1e-15);
/// ```
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
