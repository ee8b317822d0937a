//! Rows of what trees do to sets of rays.

use serde::{Deserialize, Serialize};

/// What one set of rays did in one tree, beside what surface areas predict of isotropic lines. A row of `work.csv`.
///
/// Rates are per ray that hits the scene's box, as the predictions are. A standard error is empty where the set is complete, so that there is none: all rays of a picture, all
/// rays of a file.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
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
    /// Rays that hit the scene's box.
    pub entered: u64,
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

/// What the timed rays of a set did in a tree, step by step: sums over these rays. A row of `steps.csv`.
///
/// Integers that depend on tree, rays and their order alone. "Near" tests are those of objects whose own box the ray crosses:
/// the others end early.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StepRecord {
    /// Identity of the tree's cell.
    pub cell: String,
    /// Scene of the tree.
    pub scene: String,
    /// Strategy of the tree.
    pub strategy: String,
    /// Stop rule of the tree.
    pub stop: String,
    /// The set of rays.
    pub rays: String,
    /// Rays of it that were timed, and counted here.
    pub cast: u64,
    /// Inner nodes visited.
    pub inner_visits: u64,
    /// Leaves visited.
    pub leaf_visits: u64,
    /// Leaves without an object visited.
    pub empty_leaf_visits: u64,
    /// Tests of triangles.
    pub triangle_tests: u64,
    /// Tests of spheres.
    pub sphere_tests: u64,
    /// Tests of cones and cylinders.
    pub cone_tests: u64,
    /// Tests of polygons.
    pub polygon_tests: u64,
    /// Near tests of triangles.
    pub near_triangles: u64,
    /// Near tests of spheres.
    pub near_spheres: u64,
    /// Near tests of cones and cylinders.
    pub near_cones: u64,
    /// Near tests of polygons.
    pub near_polygons: u64,
    /// Corners of the polygons of near tests.
    pub near_corners: u64,
    /// Branches that the predictor gshare gets wrong.
    pub surprises: u64,
    /// Cache lines not found in a cache of 32 KiB.
    pub first_misses: u64,
    /// Of these, lines not found in one of 1 MiB either.
    pub second_misses: u64,
}

/// Which strategy to take for a set of rays in a scene, by the areas and by the counts. A row of `choices.csv`, made from the
/// rows of `work.csv` with the same scene, stop rule and rays.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StrategyChoiceRecord {
    /// Scene of the trees.
    pub scene: String,
    /// Stop rule of the trees.
    pub stop: String,
    /// The set of rays.
    pub rays: String,
    /// What they ask.
    pub ask: String,
    /// Rays of the set.
    pub cast: u64,
    /// Strategies compared.
    pub strategies: u64,
    /// Kendall's tau-b over the strategies between C predicted and C counted; empty where all cost the same.
    pub kendall_tau: Option<f64>,
    /// The strategy whose tree has the least C predicted.
    pub predicted: String,
    /// C predicted of that tree.
    pub predicted_c_predicted: f64,
    /// C counted of that tree.
    pub predicted_c_counted: f64,
    /// The strategy whose tree has the least C counted.
    pub least: String,
    /// C predicted of that tree.
    pub least_c_predicted: f64,
    /// C counted of that tree.
    pub least_c_counted: f64,
}

/// The order of a scene's trees under a set of rays: by the cost C that areas predict, and by the one counted. A row of
/// `tree-order.csv`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TreeOrderRecord {
    /// Scene of the trees.
    pub scene: String,
    /// The set of rays.
    pub rays: String,
    /// Stop rule of the trees, or `all`: trees of all stop rules together.
    pub stop: String,
    /// Trees: of a stop rule, one for each strategy.
    pub trees: u64,
    /// Kendall's tau-b between C predicted and counted; empty where all trees have the same of either.
    pub tau: Option<f64>,
    /// Pairs of trees.
    pub pairs: u64,
    /// Pairs that the prediction puts into the order of the count.
    pub pairs_right: u64,
    /// Cell of the tree of least C predicted, the first of several.
    pub taken: String,
    /// C counted of that tree over the least C counted, minus 1: 0 where it is the cheapest; empty where nothing is counted.
    pub regret: Option<f64>,
}
