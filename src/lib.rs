//! How well does the surface area heuristic (SAH) predict what ray tracing through a kd-tree really costs?
//!
//! MacDonald & Booth (1990) showed that a line, uniform in origin and direction, that hits a box R also hits a convex
//! box K inside it with probability SA(K)/SA(R). From that follow the expected numbers of inner nodes (n_K), leaves
//! (n_B) and object tests (n_t) a line meets in a kd-tree, and the tree's cost C = c_K n_K + c_B n_B + c_t n_t. This
//! library builds the trees, draws the lines, counts, and compares, with an error beside every number.
//!
//! From a scene to a tree, what areas predict of it, and what lines count:
//!
//! ```
//! use sahlab::cost::CostModel;
//! use sahlab::kd::{Rules, StopRule, Strategy, build, predict, stream::count_lines};
//! use sahlab::rays::SurfaceLines;
//! use sahlab::scene::Scene;
//!
//! let scene = Scene::load("simple:soup:500")?;
//! let (strategy, stop) = (Strategy::Sah, StopRule::CostGain { depth: None });
//! let rules = Rules { strategy, stop, cost: CostModel::WALD_HAVRAN, clipped: false };
//! let tree = build(&scene.bounds, scene.world, &rules);
//!
//! let expected = predict(&tree);
//! let predicted = rules.cost.cost(expected.n_k, expected.n_b, expected.n_t);
//!
//! let lines = SurfaceLines { world: scene.world, seed: 1 };
//! let counts = count_lines(&tree, 65_536, |range| lines.range(range), |_| {});
//! let counted = counts.work.cost(rules.cost) / counts.lines as f64;
//!
//! assert!((counted / predicted - 1.0).abs() < 0.01, "{counted} counted, {predicted} predicted");
//! # Ok::<(), sahlab::scene::SceneError>(())
//! ```
//!
//! The layers, each using only those before it: [`geom`], [`cost`], [`stats`] and [`files`]; [`exact`]; [`scene`]; [`rays`]; [`kd`];
//! [`tracer`]; [`study`]; [`report`], which knows only the study's records; [`archive`].

pub mod archive;
pub mod cost;
pub mod exact;
pub mod files;
pub mod geom;
pub mod kd;
pub mod rays;
pub mod report;
pub mod scene;
pub mod stats;
pub mod study;
pub mod tracer;

/// Twelve hex digits that stand for this program's sources and locked dependencies.
pub const REVISION: &str = env!("SAHLAB_REVISION");
