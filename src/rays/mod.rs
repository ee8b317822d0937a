//! Lines and where their randomness comes from: the exact law of the metric, and its look-alikes.

mod address;
pub mod checks;
mod laws;
mod surface;

pub use address::{Purpose, Uniforms, generator};
pub use laws::LineLaw;
pub use surface::{SurfaceLines, surface_line};
