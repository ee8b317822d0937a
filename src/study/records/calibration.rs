//! Rows of what was fitted to seconds: all in files named `times-*`, which differ from machine to machine.

use serde::{Deserialize, Serialize};

use super::Verdict;

/// How well a model of the time of a ray predicts scenes that it was not fitted to. A row of `times-models.csv`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ModelRecord {
    /// The model: its terms, or whose ratio of constants it takes.
    pub model: String,
    /// Constants that are fitted.
    pub constants: u64,
    /// What was left out at a time: `scene`, or `group` (all sizes of a scene).
    pub left_out: String,
    /// Rows predicted: trees times sets of rays.
    pub rows: u64,
    /// Median of |predicted/measured - 1|.
    pub error_median: f64,
    /// Mean of it.
    pub error_mean: f64,
    /// Its 90 % quantile.
    pub error_p90: f64,
    /// Its largest value.
    pub error_max: f64,
    /// Mean over scenes and sets of rays of Kendall's tau-b between predicted and measured time of the trees; this and what follows is empty
    /// where no scene has two trees to compare.
    pub tau: Option<f64>,
    /// Share of pairs of trees of a scene that are put into the right order.
    pub pairs_right: Option<f64>,
    /// Mean over scenes and sets of T(tree of least predicted time)/T(fastest tree) - 1.
    pub regret_mean: Option<f64>,
    /// Its largest value.
    pub regret_max: Option<f64>,
}

impl ModelRecord {
    /// The model that areas can be put into: a constant for n_K and one for n_t.
    pub const TWO: &'static str = "n_K, n_t";
    /// That of the tree cost C: one for each of n_K, n_B and n_t.
    pub const THREE: &'static str = "n_K, n_B, n_t";
    /// The model whose terms are chosen by what they predict.
    pub const CHOSEN: &'static str = "chosen terms";
    /// One scene is left out at a time.
    pub const SCENE: &'static str = "scene";
    /// All sizes of a scene are left out at a time.
    pub const GROUP: &'static str = "group";
}

/// A fitted constant. A row of `times-constants.csv`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ConstantRecord {
    /// The model.
    pub model: String,
    /// What it is the time of.
    pub term: String,
    /// Nanoseconds.
    pub ns: f64,
    /// Lower end of the 95 % interval, from a bootstrap over groups of scenes; empty where draws cannot tell.
    pub lo: Option<f64>,
    /// Upper end.
    pub hi: Option<f64>,
    /// Variance inflation: by how much the other terms widen the interval; empty where they determine this one.
    pub inflation: Option<f64>,
    /// Share of the time that it explains, mean over rows.
    pub share: f64,
}

impl ConstantRecord {
    /// The term of c_K.
    pub const INNER: &'static str = "inner node (c_K)";
    /// The term of c_B.
    pub const LEAF: &'static str = "leaf (c_B)";
    /// The term of c_t.
    pub const TEST: &'static str = "object test (c_t)";
    /// The term of a branch that the processor's predictor gets wrong.
    pub const SURPRISE: &'static str = "mispredicted branch";
}

/// A step of the choice of terms. A row of `times-choice.csv`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ChoiceRecord {
    /// Number of the step; of each all candidates are told.
    pub step: u64,
    /// The candidate.
    pub candidate: String,
    /// Mean error of scenes left out, before.
    pub error_before: f64,
    /// And with the candidate.
    pub error_after: f64,
    /// Mean over scenes of the gain.
    pub gain: f64,
    /// Its standard error.
    pub gain_se: f64,
    /// Whether it was taken: the largest of the gains of its step that are above one standard error.
    pub taken: bool,
}

/// The time of a set of rays in a tree, measured and predicted by models fitted without the tree's scene. A row of
/// `times-predictions.csv`. Nanoseconds a ray.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PredictionRecord {
    /// Identity of the tree's cell.
    pub cell: String,
    /// Scene of the tree.
    pub scene: String,
    /// Its group: all sizes of a scene.
    pub group: String,
    /// Strategy of the tree.
    pub strategy: String,
    /// Stop rule of the tree.
    pub stop: String,
    /// The set of rays.
    pub rays: String,
    /// Measured.
    pub measured_ns: f64,
    /// Whether the two halves of the rounds are more than 3 % apart.
    pub disturbed: bool,
    /// From n_K and n_t predicted from areas.
    pub areas_ns: f64,
    /// From n_K and n_t counted.
    pub two_ns: f64,
    /// From the terms that were chosen.
    pub chosen_ns: f64,
}

/// How well a cost puts the trees of a scene into the order of their times. A row of `times-order.csv`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OrderOfTimesRecord {
    /// The set of rays, or `all`.
    pub rays: String,
    /// Where the counts are from and what a step costs.
    pub cost: String,
    /// Scenes (of `all`: scenes times sets).
    pub scenes: u64,
    /// Mean of Kendall's tau-b over them.
    pub tau: f64,
    /// Share of pairs of trees put into the right order.
    pub pairs_right: f64,
    /// Mean regret of the tree of least cost.
    pub regret_mean: f64,
    /// Worst regret.
    pub regret_max: f64,
    /// The scene of it.
    pub regret_scene: String,
}

/// Where the time of a set of rays goes, by the chosen terms. A row of `times-shares.csv`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ShareRecord {
    /// The set of rays.
    pub rays: String,
    /// The term.
    pub term: String,
    /// Its share of the predicted time of a ray, mean over scenes and trees.
    pub share: f64,
}

/// `times-verdicts.json`: expectations of seconds and what came of them.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct TimeVerdicts {
    /// As those of the summary.
    pub verdicts: Vec<Verdict>,
}
