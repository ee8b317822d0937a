//! The kd-tree: strategies that place planes, stop rules, building, traversal with probes, and the area prediction;
//! an octree to compare with.
//!
//! Nothing here knows files, clocks or random numbers. Predicted counts come from the boxes alone ([`predict()`]), or from the
//! boxes and the objects' areas ([`expect`]), counted ones from the planes alone ([`traverse()`], [`stream`]).

mod arena;
pub mod ask;
pub mod audit;
pub mod build;
mod clip;
pub mod count;
pub mod curve;
mod events;
pub mod expect;
pub mod hits;
pub mod links;
mod medians;
pub mod narrow;
pub mod octree;
mod planes;
pub mod predict;
pub mod probe;
pub mod restart;
pub mod slice;
mod split;
pub mod stop;
pub mod strategy;
pub mod stream;
mod sweep;
mod tally;
pub mod traverse;
pub mod tree;

pub use ask::Ask;
pub use build::{Rules, build, build_objects};
pub use count::Counts;
pub use hits::{Hit, nearest, occluded};
pub use links::{FaceTrees, Links};
pub use narrow::NarrowTree;
pub use predict::{Prediction, predict};
pub use probe::{NoProbe, Probe, Turn, Work};
pub use restart::Restart;
pub use stop::StopRule;
pub use strategy::Strategy;
pub use traverse::{Counting, Mode, Planes, Stack, Tracing, Walk, traverse};
pub use tree::{Node, NodeKind, Tree};
