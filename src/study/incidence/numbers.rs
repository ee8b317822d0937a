//! The numbers of a kernel, each of which is an exact `f64`.

use glam::{DVec3, Vec3};

use crate::geom::{Line, Vector};

/// Points whose parts are exact as `f64`.
pub trait Exact: Vector {
    /// One unit of 2^-52, in which the oracle tells distances from a tie, over that of these numbers.
    const UNIT: f64;
    /// The same point.
    fn exact(self) -> DVec3;
    /// The nearest point.
    fn rounded(p: DVec3) -> Self;
}

impl Exact for DVec3 {
    const UNIT: f64 = 1.0;

    fn exact(self) -> DVec3 {
        self
    }

    fn rounded(p: DVec3) -> Self {
        p
    }
}

impl Exact for Vec3 {
    const UNIT: f64 = f64::EPSILON / f32::EPSILON as f64;

    fn exact(self) -> DVec3 {
        self.as_dvec3()
    }

    fn rounded(p: DVec3) -> Self {
        p.as_vec3()
    }
}

/// The same line in `f64`.
pub fn exact_line<V: Exact>(line: &Line<V>) -> Line {
    Line::new(line.origin.exact(), line.direction.exact())
}
