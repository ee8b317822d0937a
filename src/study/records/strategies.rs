//! What a run of kind `strategies` or `termination` leaves behind besides `cells.csv`.

use serde::{Deserialize, Serialize};

/// What the traced rays of one kind did in one tree. A row of `rays.csv`. Counts are complete: every ray of the kind.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RayRecord {
    /// Identity of the cell.
    pub cell: String,
    /// Scene of the cell.
    pub scene: String,
    /// Strategy of the cell.
    pub strategy: String,
    /// Stop rule of the cell.
    pub stop: String,
    /// `primary`, `shadow` or `secondary`.
    pub kind: String,
    /// Rays cast.
    pub rays: u64,
    /// Rays that hit something; of the shadow rays, are blocked.
    pub hits: u64,
    /// Inner nodes visited by all of them together.
    pub inner_visits: u64,
    /// Leaves visited, empty ones too.
    pub leaf_visits: u64,
    /// Objects tested.
    pub object_tests: u64,
}

/// Rays that follow each other in what kinds `cost-vs-work` and `traversal` time: so many of them share caches as in the whole set, and
/// are one draw of the sample.
pub const RUN: usize = 512;

/// Seconds of one thing done with one tree, on one thread. A row of `timings.csv` of a run of kind `strategies`,
/// `cost-vs-work`, `speed-vs-error` or `traversal`.
///
/// Every round goes over all trees of the scene in a fresh order. Of each chunk of rays the least time of all rounds
/// counts; a pass that would take too long is timed on a random sample of chunks and scaled.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PassTiming {
    /// Identity of the cell.
    pub cell: String,
    /// Scene of the cell.
    pub scene: String,
    /// Strategy of the cell.
    pub strategy: String,
    /// Stop rule of the cell.
    pub stop: String,
    /// `build`, or the kind of the rays traced: `primary`, `shadow`, `secondary`. Of a sampler `SAMPLER RAYS LINES`, such as
    /// `sobol lines:nearest 4096`: drawing, traversing and counting a set of so many lines.
    pub what: String,
    /// Rays in all; 1 for `build`.
    pub units: u64,
    /// Rays timed; 1 for `build`.
    pub timed_units: u64,
    /// Times that each chunk, or the build, was timed.
    pub rounds: u64,
    /// Seconds above which a pass was timed on a random sample.
    pub pass_s: f64,
    /// Seconds for all units.
    pub seconds: f64,
    /// Standard error of `seconds` from the choice of the sample; 0 where all units were timed. Of kind `traversal` from the scatter of
    /// runs of rays about their mean, of ways without a stack about their ratio to the stack's seconds: as if from endlessly many rays.
    pub sampling_se_s: f64,
    /// The same from the even rounds alone.
    pub half_a_s: f64,
    /// The same from the odd rounds alone.
    pub half_b_s: f64,
    /// Whether the halves are more than 3 % apart: the machine was disturbed.
    pub disturbed: bool,
    /// Load average of the machine when the scene was timed, where it is known.
    pub load_average: Option<f64>,
    /// Stands for the program that was timed: its sources and locked dependencies.
    pub revision: String,
}

/// A leaf that a plane across an axis cuts. A row of `slices.csv`. u and v are the two other axes in ascending order.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SliceRecord {
    /// Scene of the tree.
    pub scene: String,
    /// Strategy of the tree.
    pub strategy: String,
    /// Stop rule of the tree.
    pub stop: String,
    /// The axis that the plane stands across: `x`, `y` or `z`.
    pub axis: String,
    /// Where it stands.
    pub at: f64,
    /// Lower end of the leaf on u.
    pub u_lo: f64,
    /// Lower end on v.
    pub v_lo: f64,
    /// Upper end on u.
    pub u_hi: f64,
    /// Upper end on v.
    pub v_hi: f64,
    /// Depth of the leaf (root = 0).
    pub depth: u64,
    /// Objects in the leaf.
    pub objects: u64,
}

/// A piece of an object's outline in that plane. A row of `outlines.csv`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OutlineRecord {
    /// Scene.
    pub scene: String,
    /// Number of the object.
    pub object: u64,
    /// One end on u.
    pub u0: f64,
    /// One end on v.
    pub v0: f64,
    /// The other end on u.
    pub u1: f64,
    /// The other end on v.
    pub v1: f64,
}
