//! What a run of kind `split-cost` leaves behind.

use serde::{Deserialize, Serialize};

/// One axis of one node that is drawn. A row of `curve-nodes.csv`. Positions are b, 0 to 1 across the node; costs are f(b)
/// over SA(node), the tests that a line through the node is expected to make.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CurveNodeRecord {
    /// Scene.
    pub scene: String,
    /// Rank of the node among the inner nodes by surface area: 1 is the root.
    pub rank: u64,
    /// Its number in the tree.
    pub node: u64,
    /// Its depth (root = 0).
    pub depth: u64,
    /// `x`, `y` or `z`.
    pub axis: String,
    /// Objects in the node.
    pub objects: u64,
    /// Object median b_om; the spatial one is at 1/2.
    pub object_median: f64,
    /// Where f is least of all planes strictly inside the node.
    pub minimum: f64,
    /// Least f.
    pub minimum_f: f64,
}

/// One position on it. A row of `curves.csv`. Of long curves every so many points are kept, and all samples.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CurveRecord {
    /// Scene.
    pub scene: String,
    /// Rank of the node, see [`CurveNodeRecord`].
    pub rank: u64,
    /// `x`, `y` or `z`.
    pub axis: String,
    /// Position b.
    pub b: f64,
    /// Objects on the left, straddlers included.
    pub left: u64,
    /// Objects on the right, straddlers included.
    pub right: u64,
    /// f(b) over SA(node), straddlers counted on both sides.
    pub f: f64,
    /// The same with each object counted once, where its centre lies.
    pub f_centres: f64,
    /// Whether strategy 7 looks here.
    pub sample: bool,
}

/// The inner nodes of one tree on one axis, or on all together, by size. A row of `medians.csv`. A node counts once for
/// each axis on which a plane parts it; it has at least two objects.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MedianRecord {
    /// Scene.
    pub scene: String,
    /// Stop rule of the tree.
    pub stop: String,
    /// `x`, `y`, `z` or `all`.
    pub axis: String,
    /// Fewest objects of a node of this row.
    pub objects_lo: u64,
    /// Most objects; empty without a bound.
    pub objects_hi: Option<u64>,
    /// Nodes.
    pub nodes: u64,
    /// Nodes whose least f, of all planes strictly inside, lies between the medians, both included.
    pub between: u64,
    /// The same where each object counts once, by its centre.
    pub between_centres: u64,
    /// Mean over the nodes of (least f between the medians) / (least f) - 1: what strategy 4 gives away.
    pub between_excess_mean: Option<f64>,
    /// The same of strategy 7's samples.
    pub samples_excess_mean: Option<f64>,
    /// Nodes where nothing straddles either median and the object median has as many objects on either side.
    pub even: u64,
    /// Largest |f(b_om)/f(b_rm) - 1| over them: 0 but for rounding.
    pub even_apart: Option<f64>,
    /// Nodes where something straddles a median.
    pub straddled: u64,
    /// Quantile of f(b_om)/f(b_rm) - 1 over them: 5 %.
    pub apart_q05: Option<f64>,
    /// 25 %.
    pub apart_q25: Option<f64>,
    /// 50 %.
    pub apart_q50: Option<f64>,
    /// 75 %.
    pub apart_q75: Option<f64>,
    /// 95 %.
    pub apart_q95: Option<f64>,
}

/// Strategy 1 stopped at every third level beside the octree of the same cells. A row of `octree.csv`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OctreeRecord {
    /// Scene.
    pub scene: String,
    /// Stop rule of the kd-tree.
    pub stop: String,
    /// Objects.
    pub objects: u64,
    /// Leaves, the same of both.
    pub leaves: u64,
    /// Inner nodes of the kd-tree.
    pub kd_inner_nodes: u64,
    /// Inner nodes of the octree.
    pub octree_inner_nodes: u64,
    /// Isotropic lines counted through both.
    pub lines: u64,
    /// Leaves a line visits, the same ones in both: counted.
    pub n_b_counted: f64,
    /// Inner kd-nodes a line visits: predicted from areas.
    pub kd_n_k_predicted: f64,
    /// Counted.
    pub kd_n_k_counted: f64,
    /// Standard error of that.
    pub kd_n_k_se: f64,
    /// Inner octree nodes a line visits: predicted from areas.
    pub octree_n_k_predicted: f64,
    /// Counted.
    pub octree_n_k_counted: f64,
    /// Standard error of that.
    pub octree_n_k_se: f64,
}
