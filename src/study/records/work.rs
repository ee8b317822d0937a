//! Rows of what trees do to sets of rays.

use serde::{Deserialize, Serialize};

/// What one set of rays did in one tree, beside what surface areas predict of isotropic lines. A row of `work.csv`.
///
/// Rates are per ray. A standard error is empty where the set is complete, so that there is none: all rays of a picture, all
/// rays of a file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WorkRecord {
    /// Identity of the tree's cell.
    pub cell: String,
    /// Scene of the tree.
    pub scene: String,
    /// Objects in the scene.
    pub objects: u64,
    /// Strategy of the tree.
    pub strategy: String,
    /// Stop rule of the tree.
    pub stop: String,
    /// The set of rays: `lines`, `volume-ray:nearest`, `primary`, ...
    pub rays: String,
    /// What they ask: `all`, `nearest` or `any`.
    pub ask: String,
    /// Rays of the set.
    pub cast: u64,
    /// Whether these are all there are.
    pub complete: bool,
    /// Rays that hit an object.
    pub hits: u64,
    /// Inner node visits of all of them together.
    pub inner_visits: u64,
    /// Leaf visits of all of them together.
    pub leaf_visits: u64,
    /// Object tests of all of them together.
    pub object_tests: u64,
    /// Inner nodes a ray visits: predicted from areas.
    pub n_k_predicted: f64,
    /// Inner nodes a ray visits: counted.
    pub n_k_counted: f64,
    /// Standard error of `n_k_counted`.
    pub n_k_se: Option<f64>,
    /// Leaves a ray visits: predicted.
    pub n_b_predicted: f64,
    /// Leaves a ray visits: counted.
    pub n_b_counted: f64,
    /// Standard error of `n_b_counted`.
    pub n_b_se: Option<f64>,
    /// Object tests a ray makes: predicted.
    pub n_t_predicted: f64,
    /// Object tests a ray makes: counted.
    pub n_t_counted: f64,
    /// Standard error of `n_t_counted`.
    pub n_t_se: Option<f64>,
    /// Tree cost C from the predicted counts.
    pub c_predicted: f64,
    /// Tree cost C from the counted ones.
    pub c_counted: f64,
    /// Standard error of `c_counted`.
    pub c_se: Option<f64>,
}
