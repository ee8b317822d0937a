//! What a run of kind `speed-vs-error` leaves behind besides `timings.csv`.

pub use crate::kd::narrow::{REFUSE_BELOW, WARN_BELOW};

use serde::{Deserialize, Serialize};

/// How far the counts of so many lines are off, by one sampler: over independent replicates. A row of `errors.csv`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ErrorRecord {
    /// Identity of the tree's cell.
    pub cell: String,
    /// Scene of the tree.
    pub scene: String,
    /// Strategy of the tree.
    pub strategy: String,
    /// How the lines were drawn.
    pub sampler: String,
    /// What the lines ask, as a set of rays is named: `lines` (nothing stops them) or `lines:nearest`.
    pub rays: String,
    /// What is estimated: `nodes` (the hit probability of every node but the root's), `n_K`, `n_B`, `n_t` or `C`.
    pub quantity: String,
    /// Lines of a replicate.
    pub lines: u64,
    /// Independent replicates.
    pub replicates: u64,
    /// The true value; empty for `nodes`, which have one each. From areas; of `lines:nearest` from a long reference.
    pub truth: Option<f64>,
    /// Standard error of the reference over `truth`; empty where the truth is exact.
    pub truth_error: Option<f64>,
    /// Mean of the replicates over `truth`, minus 1; empty for `nodes`.
    pub bias: Option<f64>,
    /// Root mean square error over `truth`. Of `nodes`: square root of the mean over nodes of MSE/(p(1 - p)), which is
    /// 1/sqrt(lines) for independent lines.
    pub rmse: f64,
    /// Lower end of its 95 % interval.
    pub rmse_lo: f64,
    /// Upper end of its 95 % interval.
    pub rmse_hi: f64,
    /// Mean square error of as many random lines over this one: how many times fewer lines do. Random lines' error is that of
    /// all their replicates together.
    pub gain: Option<f64>,
    /// Lower end of its 95 % interval.
    pub gain_lo: Option<f64>,
    /// Upper end of its 95 % interval.
    pub gain_hi: Option<f64>,
}

/// The fit RMSE = a N^(-exponent) to the rows of one quantity. A row of `exponents.csv`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ExponentRecord {
    /// Scene.
    pub scene: String,
    /// How the lines were drawn.
    pub sampler: String,
    /// What they ask.
    pub rays: String,
    /// What is estimated.
    pub quantity: String,
    /// Fewest lines of the fit.
    pub from_lines: u64,
    /// Most lines of the fit.
    pub to_lines: u64,
    /// The factor a.
    pub factor: f64,
    /// The exponent.
    pub exponent: f64,
    /// Lower end of its 95 % interval.
    pub exponent_lo: f64,
    /// Upper end of its 95 % interval.
    pub exponent_hi: f64,
}

/// Lines that a wanted relative error of the tree cost C takes. A row of `enough.csv`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct EnoughRecord {
    /// Scene.
    pub scene: String,
    /// How the lines are drawn.
    pub sampler: String,
    /// What they ask.
    pub rays: String,
    /// Root mean square error of C wanted, over C.
    pub wanted: f64,
    /// Lines it takes by the fit, rounded up to a number that the sampler can draw.
    pub lines: u64,
    /// Whether the fit is used beyond the lines it was made from.
    pub extrapolated: bool,
}

/// One kernel through one tree: what it gets wrong, by the exact oracle. A row of `precision.csv`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PrecisionRecord {
    /// Identity of the tree's cell.
    pub cell: String,
    /// Scene of the tree.
    pub scene: String,
    /// Strategy of the tree.
    pub strategy: String,
    /// How far the scene was moved along x, y and z, over the longest side of its box.
    pub offset: f64,
    /// `f64`, `f32` or `f32-padded`.
    pub kernel: String,
    /// `random`: isotropic lines; `aimed`: through edges and corners of the tree's boxes and of triangles.
    pub family: String,
    /// `clean`, `warned` or `refused`.
    pub verdict: String,
    /// The longest side of the box over the spacing of f32 numbers at its farthest coordinate; empty for f64.
    pub resolution: Option<f64>,
    /// Lines.
    pub lines: u64,
    /// Nodes whose closed boxes the lines meet, exactly. Where the tree is refused, visits and tests are of the first 64 lines.
    pub visits: u64,
    /// Nodes visited that the line does not meet, by more than 8 ulp of the kernel's numbers.
    pub wrong_visits: u64,
    /// Nodes missed that the line meets, by more than 8 ulp.
    pub missed_visits: u64,
    /// Nodes visited or missed wrongly by less: the ends of the line's exact interval lie within 8 ulp.
    pub tied_visits: u64,
    /// Those of them that were missed.
    pub tied_missed_visits: u64,
    /// Wrong and missed visits, ties included, per 10^9 visits.
    pub visits_per_1e9: Option<f64>,
    /// Lower end of its 95 % interval, by the errors of each line.
    pub visits_per_1e9_lo: Option<f64>,
    /// Upper end of its 95 % interval.
    pub visits_per_1e9_hi: Option<f64>,
    /// Triangles of the leaves that a line meets or was taken to, each once a line; hit if its test says so in a leaf visited.
    pub tests: u64,
    /// Triangles taken for hit that the line misses, by more than 8 ulp.
    pub wrong_hits: u64,
    /// Triangles hit by more than 8 ulp that were missed.
    pub missed_hits: u64,
    /// Triangles hit or missed wrongly by less.
    pub tied_hits: u64,
    /// Wrong and missed hits, ties included, per 10^9 tests.
    pub hits_per_1e9: Option<f64>,
    /// Lower end of its 95 % interval.
    pub hits_per_1e9_lo: Option<f64>,
    /// Upper end of its 95 % interval.
    pub hits_per_1e9_hi: Option<f64>,
    /// Slope of hits against area minus 1 (random lines), by the areas of the boxes used.
    pub slope_error: Option<f64>,
    /// Its standard error.
    pub slope_se: Option<f64>,
    /// Largest |z| of a node, (y - p)/sqrt(p(1 - p)/N), of those that at least 25 lines are expected to hit and to miss.
    pub max_z: Option<f64>,
    /// Nodes whose box has no area.
    pub flat_nodes: u64,
}

/// One plane search over one scene. A row of `planes.csv`; its seconds are the row `build` of the cell in `timings.csv`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlaneRecord {
    /// Identity of the tree's cell.
    pub cell: String,
    /// Scene.
    pub scene: String,
    /// Objects in the scene.
    pub objects: u64,
    /// The strategy that searches.
    pub strategy: String,
    /// Whether objects were clipped to the nodes.
    pub clipped: bool,
    /// Tree cost C, predicted.
    pub c: f64,
    /// C over that of the exact search (strategy `sah`) with the same clipping, minus 1.
    pub above: f64,
    /// C over that of the exact search without clipping, minus 1.
    pub above_unclipped: f64,
    /// Depth of the deepest leaf.
    pub depth: u64,
    /// Inner nodes.
    pub inner_nodes: u64,
    /// Leaves.
    pub leaves: u64,
    /// References.
    pub references: u64,
}

/// Whether intervals cover and tests have their level, over many runs of one small scene. A row of `coverage.csv`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CoverageRecord {
    /// What is checked: `slope`, `n_K`, `n_B`, `n_t`, `C`: an interval; `p-slope`, `p-tail`, `p-contrasts`: a test rejects; `error`: the
    /// stopping rule keeps its word.
    pub check: String,
    /// Scene.
    pub scene: String,
    /// How the lines were drawn.
    pub sampler: String,
    /// Lines of a run; of `error` the mean.
    pub lines: u64,
    /// Level of the interval or test; of `error` the wanted relative error.
    pub nominal: f64,
    /// Independent runs.
    pub runs: u64,
    /// Runs whose interval covers, whose test rejects, whose true error is within the wanted one.
    pub counted: u64,
    /// Fewest that are expected.
    pub least: u64,
    /// Most that are expected.
    pub most: u64,
}
