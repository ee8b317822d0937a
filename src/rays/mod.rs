//! Lines and where their randomness comes from: the exact law of the metric, its look-alikes, and rays from elsewhere.

mod address;
pub mod checks;
mod conditional;
pub mod file;
mod laws;
mod sampler;
mod sobol;
pub mod source;
mod stratified;
mod surface;
mod surface_points;
mod turn;

pub use address::{Purpose, Uniforms, generator};
pub use conditional::Conditional;
pub use laws::LineLaw;
pub use sampler::{PointSet, Sampler};
pub use source::{Source, SourceRays};
pub use surface::{SurfaceLines, surface_line};
pub use surface_points::SurfacePoints;
