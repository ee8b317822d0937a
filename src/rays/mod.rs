//! Lines and where their randomness comes from: the exact law of the metric, its look-alikes, and rays from elsewhere.

mod address;
pub mod checks;
pub mod file;
mod laws;
pub mod source;
mod surface;
mod surface_points;

pub use address::{Purpose, Uniforms, generator};
pub use laws::LineLaw;
pub use source::{Source, SourceRays};
pub use surface::{SurfaceLines, surface_line};
pub use surface_points::SurfacePoints;
