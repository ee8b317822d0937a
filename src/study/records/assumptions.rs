//! What a run of kind `assumptions` leaves behind besides `work.csv`.

use serde::{Deserialize, Serialize};

/// One set of rays in one tree: how far the metric errs. A row of `bias.csv`.
///
/// The metric tells what rays that hit the root's box do, so every ratio here is per ray that does (`entered`). Ratios are
/// counted over predicted: 1 where the metric is right, empty where nothing is predicted or no ray enters.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BiasRecord {
    /// Identity of the tree's cell.
    pub cell: String,
    /// Scene of the tree.
    pub scene: String,
    /// Strategy of the tree.
    pub strategy: String,
    /// The set of rays.
    pub rays: String,
    /// Whether the lines of its rays are uniform in origin and direction, as the metric assumes.
    pub uniform: bool,
    /// Share of all rays cast that begin inside the root's box, where the metric has them come from outside.
    pub inside: f64,
    /// Share of all rays cast that an object stops, where the metric has none stop.
    pub stopped: f64,
    /// Rays that hit the root's box.
    pub entered: u64,
    /// Nodes visited.
    pub visits: Option<f64>,
    /// Inner nodes visited.
    pub n_k: Option<f64>,
    /// Leaves visited.
    pub n_b: Option<f64>,
    /// Objects tested.
    pub n_t: Option<f64>,
    /// Tree cost.
    pub c: Option<f64>,
    /// Nodes below the root that enough rays are predicted to hit to be judged one by one.
    pub judged: u64,
    /// Standard deviation over them of ln(counted / predicted), weighted by p, sampling noise taken out.
    pub spread: Option<f64>,
    /// Spearman's correlation over them of p and hits.
    pub rank_correlation: Option<f64>,
}

/// The nodes of one tree grouped by one of their properties, and what one set of rays does in a group. A row of
/// `nodes-by.csv`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GroupRecord {
    /// Scene of the tree.
    pub scene: String,
    /// Strategy of the tree.
    pub strategy: String,
    /// The set of rays.
    pub rays: String,
    /// The property: `depth`; `area`, log10 of p; `distance` of the node's centre from the root's, 1 being a corner.
    pub by: String,
    /// Where the group begins.
    pub lo: f64,
    /// Where it ends; of depths, the same as `lo`.
    pub hi: f64,
    /// Nodes.
    pub nodes: u64,
    /// Sum of p over them: visits predicted of a ray.
    pub p_sum: f64,
    /// Visits of all rays together.
    pub hits: u64,
    /// Rays that hit the root's box.
    pub entered: u64,
    /// Visits counted over visits predicted.
    pub ratio: Option<f64>,
    /// As in `bias.csv`, over the nodes of the group.
    pub spread: Option<f64>,
}

/// What one set of rays does to one node, of the tree in the figure. A row of `visits.csv`; of large trees not all nodes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct VisitRecord {
    /// The set of rays.
    pub rays: String,
    /// Number of the node in its tree.
    pub node: u64,
    /// Its depth (root = 0).
    pub depth: u64,
    /// Its predicted hit probability SA(K)/SA(R).
    pub p: f64,
    /// Distance of its centre from the root's, 1 being a corner of the root.
    pub distance: f64,
    /// Rays that hit it.
    pub hits: u64,
    /// Rays that hit the root's box.
    pub entered: u64,
}

/// The strategies of one scene ranked by a metric and by one set of rays. A row of `order.csv`.
///
/// Two trees are told apart where the 99 % interval of the difference of their costs, from the same rays, leaves 0 out.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OrderRecord {
    /// Scene.
    pub scene: String,
    /// The set of rays.
    pub rays: String,
    /// What ranks them: `area` for the surface area metric, or the name of a metric that gives up an assumption.
    pub metric: String,
    /// Trees compared, one a strategy.
    pub trees: u64,
    /// Kendall's tau-b of C predicted and counted; empty where one of the two is the same for all trees.
    pub tau: Option<f64>,
    /// Pairs of trees told apart that the metric ranks rightly.
    pub right: u64,
    /// Pairs told apart that it ranks wrongly.
    pub wrong: u64,
    /// Pairs that the rays do not tell apart, or the metric not.
    pub tied: u64,
    /// Strategy of the least C predicted.
    pub predicted_best: String,
    /// Strategy of the least C counted.
    pub counted_best: String,
    /// C counted of the tree predicted to be cheapest over the least C counted, minus 1: what trusting the metric costs.
    pub regret: Option<f64>,
}

/// What one metric expects of a ray in one tree, and what a ray of one set cost. A row of `metrics.csv`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MetricRecord {
    /// Scene of the tree.
    pub scene: String,
    /// Strategy of the tree.
    pub strategy: String,
    /// The set of rays.
    pub rays: String,
    /// The metric: `area` for the surface area metric, or the name of one that gives up an assumption.
    pub metric: String,
    /// Whether of all metrics it is the one whose rays begin and end most like these.
    pub suited: bool,
    /// Inner nodes visited: expected.
    pub n_k: f64,
    /// Leaves visited: expected.
    pub n_b: f64,
    /// Objects tested: expected.
    pub n_t: f64,
    /// Tree cost: expected.
    pub c: f64,
    /// Tree cost counted, per ray that hits the root's box.
    pub c_counted: f64,
    /// Counted over expected; empty where nothing is expected.
    pub ratio: Option<f64>,
}

/// Nodes of one tree held against what theory says of rays that begin inside. A row of `exact.csv`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ExactRecord {
    /// Scene of the tree.
    pub scene: String,
    /// Strategy of the tree.
    pub strategy: String,
    /// The set of rays: `volume-ray` or `volume-segment`.
    pub rays: String,
    /// Where the expectation comes from: `lines` (weighted isotropic lines) or `slab` (closed form).
    pub by: String,
    /// Nodes compared.
    pub nodes: u64,
    /// Of the node that fits worst: its number,
    pub node: u64,
    /// its predicted hit probability SA(K)/SA(R),
    pub p: f64,
    /// the share of the rays that theory says hit it,
    pub expected: f64,
    /// standard error of that, 0 of a closed form,
    pub expected_se: f64,
    /// the share that did,
    pub counted: f64,
    /// and the p-value of the difference.
    pub p_value: f64,
}
