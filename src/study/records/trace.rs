//! What `validate trace` leaves behind.

use serde::{Deserialize, Serialize};

/// One ray. A row of `hits.csv`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HitRecord {
    /// Number of the ray in its file (first = 0).
    pub ray: u64,
    /// Number of the object hit, in the scene's order; empty of a miss.
    pub object: Option<u32>,
    /// Parameter of the hit, in units of the direction; empty of a miss.
    pub t: Option<f64>,
    /// Inner nodes visited.
    #[serde(rename = "n_K")]
    pub n_k: u64,
    /// Leaves visited.
    #[serde(rename = "n_B")]
    pub n_b: u64,
    /// Object tests made.
    pub n_t: u64,
}

/// What was traced, and what all rays did together: `trace.json`, without times.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TraceRecord {
    /// Scene as named on the command line.
    pub scene: String,
    /// Objects in the scene.
    pub objects: u64,
    /// The file of rays as named on the command line.
    pub file: String,
    /// Digest of the rays.
    pub content: String,
    /// What they ask: `all`, `nearest` or `any`.
    pub ask: String,
    /// Strategy of the tree.
    pub strategy: String,
    /// Stop rule of the tree.
    pub stop: String,
    /// Whether straddling triangles and polygons were clipped to the parts of a node.
    pub clipped: bool,
    /// Cost of one inner node visit.
    pub c_k: f64,
    /// Cost of one leaf visit.
    pub c_b: f64,
    /// Cost of one object test.
    pub c_t: f64,
    /// Stands for the sources and locked dependencies of the program.
    pub revision: String,
    /// Rays traced.
    pub rays: u64,
    /// Rays that meet the scene's box.
    pub entered: u64,
    /// Rays that hit an object.
    pub hits: u64,
    /// Inner node visits of all of them together.
    pub inner_visits: u64,
    /// Leaf visits of all of them together.
    pub leaf_visits: u64,
    /// Object tests of all of them together.
    pub object_tests: u64,
    /// Inner nodes a ray visits: predicted from areas, of isotropic lines that never stop.
    pub n_k_predicted: f64,
    /// Inner nodes a ray visits: counted.
    pub n_k_counted: f64,
    /// Leaves a ray visits: predicted.
    pub n_b_predicted: f64,
    /// Leaves a ray visits: counted.
    pub n_b_counted: f64,
    /// Object tests a ray makes: predicted.
    pub n_t_predicted: f64,
    /// Object tests a ray makes: counted.
    pub n_t_counted: f64,
    /// Tree cost C from the predicted counts.
    pub c_predicted: f64,
    /// Tree cost C from the counted ones.
    pub c_counted: f64,
}
