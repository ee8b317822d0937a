//! A small Whitted tracer: turns a scene with a look into its rays by kind, and into its picture.

pub mod camera;

pub use camera::{Camera, PIXELS};
