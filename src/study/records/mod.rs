//! What a run leaves behind: the rows of its CSV files, and the summary.
//!
//! One flat struct a file, full precision, unknown is `None` (an empty cell, never 0 or NaN). Everything that reads
//! a finished run (tables, plots) reads these and nothing else. Only [`TimingRecord`] and [`PassTiming`], both
//! rows of `timings.csv`, and the rows of files named `times-*` hold times, so every other file is byte-identical for any
//! number of threads.

mod assumptions;
mod calibration;
mod run_times;
mod speed;
mod split_cost;
mod stability;
mod strategies;
mod trace;
mod traversal;
mod work;

use serde::{Deserialize, Serialize};

pub use assumptions::{
    BiasRecord, ExactRecord, GroupRecord, MetricRecord, OrderRecord, VisitRecord,
};
pub use calibration::{
    ChoiceRecord, ConstantRecord, ModelRecord, OrderOfTimesRecord, PredictionRecord, ShareRecord,
    TimeVerdicts,
};
pub use run_times::{Machine, MachineTimes, RunTimes};
pub use speed::{
    CoverageRecord, EnoughRecord, ErrorRecord, ExponentRecord, PlaneRecord, PrecisionRecord,
    REFUSE_BELOW, WARN_BELOW,
};
pub use split_cost::{CurveNodeRecord, CurveRecord, MedianRecord, OctreeRecord};
pub use stability::{CaseRecord, MetamorphicRecord, RandomRecord, TieRecord};
pub use strategies::{OutlineRecord, PassTiming, RUN, RayRecord, SliceRecord};

pub use trace::{HitRecord, TraceRecord};
pub use traversal::{LinkRecord, TraversalRecord};
pub use work::{StepRecord, StrategyChoiceRecord, TreeOrderRecord, WorkRecord};

/// Version of the layout of `data/`.
pub const SCHEMA: u32 = 2;

/// One cell of a study: one scene, one tree, one set of lines. A row of `cells.csv`.
///
/// Rates are per line. `*_se` is the standard error of the counted rate, from the per-line scores of the first
/// `pilot_lines` lines and the number of all `lines`. Fits and tests are empty where the tree has nothing to fit: no node
/// but the root, or (free line) no two nodes of different area. A standard error is empty where the pilot cannot tell it:
/// where the variance hangs on events too rare for the pilot's lines.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CellRecord {
    /// Identity of the cell, computed from all its parameters (seed included).
    pub cell: String,
    /// Scene as named on the command line, e.g. `spd:balls:4`.
    pub scene: String,
    /// Objects in the scene.
    pub objects: u64,
    /// Strategy that placed the planes, e.g. `sah`.
    pub strategy: String,
    /// Stop rule, e.g. `objects:2:16`.
    pub stop: String,
    /// Whether straddling triangles and polygons were clipped to the parts of a node.
    pub clipped: bool,
    /// Seed of the run; the lines' own follows from it and the scene's boxes.
    pub seed: u64,
    /// Lines counted; each hits the scene's box.
    pub lines: u64,
    /// First lines, traversed one by one, whose scores give the standard errors.
    pub pilot_lines: u64,
    /// Cost of one inner node visit.
    pub c_k: f64,
    /// Cost of one leaf visit.
    pub c_b: f64,
    /// Cost of one object test.
    pub c_t: f64,
    /// Depth of the deepest leaf (root = 0).
    pub depth: u64,
    /// Inner nodes of the tree.
    pub inner_nodes: u64,
    /// Leaves of the tree, empty ones included.
    pub leaves: u64,
    /// Leaves without an object.
    pub empty_leaves: u64,
    /// References: entries of objects in leaves.
    pub references: u64,
    /// Bytes a traversal reads of it: nodes and references.
    pub bytes: u64,
    /// Nodes whose box has no area (p = 0): told, and left out of every fit.
    pub zero_area_nodes: u64,
    /// Nodes with an area that no line hit.
    pub unhit_nodes: u64,
    /// Inner node visits of all lines together.
    pub inner_visits: u64,
    /// Leaf visits of all lines together.
    pub leaf_visits: u64,
    /// Object tests of all lines together.
    pub object_tests: u64,
    /// Inner nodes a line visits: the area ratio's prediction.
    pub n_k_predicted: f64,
    /// Inner nodes a line visits: counted.
    pub n_k_counted: f64,
    /// Standard error of `n_k_counted`.
    pub n_k_se: Option<f64>,
    /// Leaves a line visits: predicted.
    pub n_b_predicted: f64,
    /// Leaves a line visits: counted.
    pub n_b_counted: f64,
    /// Standard error of `n_b_counted`.
    pub n_b_se: Option<f64>,
    /// Object tests a line makes: predicted.
    pub n_t_predicted: f64,
    /// Object tests a line makes: counted.
    pub n_t_counted: f64,
    /// Standard error of `n_t_counted`.
    pub n_t_se: Option<f64>,
    /// Tree cost C from the predicted counts.
    pub c_predicted: f64,
    /// Tree cost C from the counted ones.
    pub c_counted: f64,
    /// Standard error of `c_counted`.
    pub c_se: Option<f64>,
    /// Slope through the origin, weights 1/(p(1-p)) from the predicted p.
    pub slope: Option<f64>,
    /// Standard error of `slope`, from per-line scores.
    pub slope_se: Option<f64>,
    /// Slope through the origin, ordinary least squares.
    pub slope_ols: Option<f64>,
    /// Standard error of `slope_ols`, from per-line scores.
    pub slope_ols_se: Option<f64>,
    /// Free line y = a + b p (weighted): intercept a.
    pub free_intercept: Option<f64>,
    /// Standard error of `free_intercept`.
    pub free_intercept_se: Option<f64>,
    /// Free line y = a + b p (weighted): slope b.
    pub free_slope: Option<f64>,
    /// Standard error of `free_slope`.
    pub free_slope_se: Option<f64>,
    /// p-value of a = 0 and b = 1 together (Hotelling, F(2, n - 2)).
    pub free_p: Option<f64>,
    /// 1 - R^2 of the ordinary line through the origin (R^2 uncentred).
    pub unexplained: Option<f64>,
    /// What 1 - R^2 is expected to be for a correct program: sum p(1-p) / (N sum p^2).
    pub unexplained_expected: Option<f64>,
    /// Largest |z| over the nodes that at least 10 lines are expected to hit and at least 10 to miss.
    pub max_abs_z: Option<f64>,
    /// Smallest exact two-sided binomial tail over the nodes.
    pub smallest_tail: Option<f64>,
    /// p-value of slope = 1 (weighted).
    pub slope_p: Option<f64>,
    /// Nodes times `smallest_tail`, at most 1.
    pub tail_p: Option<f64>,
    /// p-value of Hotelling's test over the contrasts.
    pub hotelling_p: Option<f64>,
    /// Independent contrasts in that test.
    pub contrasts: u64,
}

/// One node. A row of `nodes.csv`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NodeRecord {
    /// Identity of the cell.
    pub cell: String,
    /// Scene of the cell.
    pub scene: String,
    /// Strategy of the cell.
    pub strategy: String,
    /// Node number in its tree (root = 0).
    pub node: u64,
    /// Depth (root = 0).
    pub depth: u64,
    /// `inner` or `leaf`.
    pub kind: String,
    /// Surface area SA(K), in the scene's units squared.
    pub area: f64,
    /// Predicted hit probability SA(K)/SA(R).
    pub p: f64,
    /// Lines that hit the node.
    pub hits: u64,
    /// Lines in all.
    pub lines: u64,
    /// (hits/lines - p) / sqrt(p(1-p)/lines); empty where p is 0 or 1.
    pub z: Option<f64>,
    /// Exact two-sided binomial tail of `hits`; empty where p is 0 or 1.
    pub tail: Option<f64>,
}

/// The nodes of one cell whose p lies in one bin (eighths of a decade). A row of `bins.csv`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BinRecord {
    /// Identity of the cell.
    pub cell: String,
    /// Scene of the cell.
    pub scene: String,
    /// Strategy of the cell.
    pub strategy: String,
    /// Lower end of the bin in p.
    pub p_lo: f64,
    /// Upper end of the bin in p.
    pub p_hi: f64,
    /// Nodes in the bin.
    pub nodes: u64,
    /// Sum of p over them: hits a line is predicted to make here.
    pub p_sum: f64,
    /// Hits counted on them.
    pub hits: u64,
    /// Lines in all.
    pub lines: u64,
    /// Mean of z over them.
    pub z_mean: f64,
    /// Root mean square of z over them (about 1 for a correct program).
    pub z_rms: f64,
    /// Largest |z| over them.
    pub z_max_abs: f64,
}

/// Seconds of one cell. A row of `timings.csv`, the only file that is not reproducible.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TimingRecord {
    /// Identity of the cell.
    pub cell: String,
    /// Scene of the cell.
    pub scene: String,
    /// Strategy of the cell.
    pub strategy: String,
    /// Building the tree, one thread, wall seconds.
    pub build_s: f64,
    /// Making and counting all lines, wall seconds.
    pub count_s: f64,
    /// Threads that counted.
    pub threads: u64,
    /// (line, node) visits counted in `count_s`.
    pub visits: u64,
}

/// The five checks of a law of lines through one box, as p-values. A row of `samplers.csv`. A p-value is empty where the
/// check does not apply (chords of a very flat or long box).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SamplerRecord {
    /// The law: `study` for the run's own lines, else as `validate list samplers` names it.
    pub law: String,
    /// Whether the law is the metric's; a wrong one is a negative control.
    pub exact: bool,
    /// Scene whose box the lines hit, or the box.
    pub scene: String,
    /// Lines checked.
    pub lines: u64,
    /// Hits of boxes: SA(K)/SA(R).
    pub boxes_p: Option<f64>,
    /// Mean chord: 4V/SA.
    pub mean_chord_p: Option<f64>,
    /// Mean fourth power of the chord: 12 V^2/(pi SA).
    pub fourth_chord_p: Option<f64>,
    /// Moments of the directions.
    pub directions_p: Option<f64>,
    /// Hits of triangles: 2A/SA(R).
    pub triangles_p: Option<f64>,
}

impl SamplerRecord {
    /// The five p-values, in the order of the columns.
    pub fn p_values(&self) -> [Option<f64>; 5] {
        [
            self.boxes_p,
            self.mean_chord_p,
            self.fourth_chord_p,
            self.directions_p,
            self.triangles_p,
        ]
    }
}

/// `summary.json`: the answer of a run, without times.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// Version of this layout.
    pub schema: u32,
    /// Name of the experiment (its file's stem).
    pub experiment: String,
    /// Kind of the experiment, e.g. `hits-vs-area`.
    pub kind: String,
    /// The question the experiment asks.
    pub question: String,
    /// Seed of the run.
    pub seed: u64,
    /// The command that repeats the run.
    pub command: String,
    /// The stop rule of every tree, if they have one in common.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stop: Option<String>,
    /// Level of `lo` to `hi` of every estimate.
    pub interval_level: f64,
    /// Level of `lo_all` to `hi_all`, all estimates of the run together.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub family_level: Option<f64>,
    /// True when fewer lines and smaller scenes were used: no figure of it is to be published.
    pub quick: bool,
    /// Slopes this near to 1 are what the run aims to show.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub slope_within: Option<f64>,
    /// The scene whose nodes the main figure shows.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub figure_scene: Option<String>,
    /// The strategy whose nodes the main figure shows.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub figure_strategy: Option<String>,
    /// What was expected and whether it held.
    pub verdicts: Vec<Verdict>,
    /// Every estimate with its interval.
    pub estimates: Vec<Estimate>,
}

/// One expectation, written before the run, and what came of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Verdict {
    /// Short name, e.g. `slope-within`.
    pub name: String,
    /// Whether it held.
    pub held: bool,
    /// One sentence with the figures.
    pub message: String,
}

/// One estimate with its interval. Interval and standard error are empty where the pilot cannot tell them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// What is estimated: `slope`, `n_K`, `n_B`, `n_t`, `C`, ...
    pub name: String,
    /// Scene.
    pub scene: String,
    /// Strategy.
    pub strategy: String,
    /// Stop rule.
    pub stop: String,
    /// Counted value.
    pub value: f64,
    /// Lower end of the 99 % interval.
    pub lo: Option<f64>,
    /// Upper end of the 99 % interval.
    pub hi: Option<f64>,
    /// Standard error.
    pub se: Option<f64>,
    /// Lines behind it.
    pub n: u64,
    /// What theory says it should be.
    pub predicted: f64,
    /// Lower end of the interval that holds for all estimates of the run together.
    pub lo_all: Option<f64>,
    /// Upper end of the interval that holds for all estimates of the run together.
    pub hi_all: Option<f64>,
}

/// The name of a scene or stop rule as part of a file name: its words with dashes between them.
pub fn file_stem(name: &str) -> String {
    let words = name.split(|c: char| !c.is_alphanumeric());
    let words: Vec<_> = words.filter(|word| !word.is_empty()).collect();
    words.join("-")
}

#[cfg(test)]
mod tests {
    use super::file_stem;

    #[test]
    fn scenes_of_different_folders_have_files_of_their_own() {
        assert_eq!(file_stem("spd:balls:4"), "spd-balls-4");
        assert_eq!(file_stem("sub/one.off"), "sub-one-off");
        assert_eq!(file_stem("./a__b/..//c (1).obj"), "a-b-c-1-obj");
        assert_ne!(file_stem("x/one.obj"), file_stem("y/one.obj"));
        assert_ne!(file_stem("one.ply"), file_stem("one.obj"));
    }
}
