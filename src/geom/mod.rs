//! Boxes, lines and rays, and the object kinds with their exact bounds and nearest intersections. All in f64; boxes, lines,
//! rays and triangles have f32 instances too, from the same source ([`Real`]).

mod aabb;
mod area;
mod cast;
mod clip;
mod cone;
mod line;
mod objects;
mod polygon;
mod real;
mod section;
mod sphere;
mod triangle;

pub use aabb::Aabb;
pub use cast::Cast;
pub use clip::{Clipper, clip_slack};
pub use cone::Cone;
pub use line::{Frame, Line, Ray, Span, slack};
pub use objects::{Object, Objects, Targets};
pub use polygon::Polygon;
pub use real::{Real, Vector};
pub use section::Piece;
pub use sphere::Sphere;
pub use triangle::Triangle;

/// One of the three coordinate axes: 0 = x, 1 = y, 2 = z.
pub type Axis = usize;
