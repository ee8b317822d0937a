//! A small Whitted tracer: turns a scene with a look into its rays by kind, and into its picture.

pub mod camera;
pub mod count;
pub mod optics;
pub mod picture;
pub mod ray_set;
mod surface;
pub mod whitted;

pub use camera::{Camera, PIXELS};
pub use count::{RayCounts, Tally, count};
pub use picture::Picture;
pub use ray_set::{KindRays, RayKind, RaySet};
pub use whitted::{MAX_DEPTH, Traced, trace};
