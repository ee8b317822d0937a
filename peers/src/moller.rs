//! The test of Möller & Trumbore (1997), both sides, in single precision: for crates that leave triangles to their users.

use glam::Vec3;

use crate::Ray;

/// A triangle by a corner and two edges.
#[derive(Clone, Copy)]
pub struct Triangle {
    corner: Vec3,
    edges: [Vec3; 2],
}

impl Triangle {
    pub fn new([a, b, c]: [Vec3; 3]) -> Self {
        Self {
            corner: a,
            edges: [b - a, c - a],
        }
    }

    /// t of the hit, or infinity.
    #[inline]
    pub fn intersect(&self, ray: &Ray) -> f32 {
        let (origin, direction) = (Vec3::from(ray.origin), Vec3::from(ray.direction));
        let [e, f] = self.edges;
        let p = direction.cross(f);
        let inverse = 1.0 / e.dot(p);
        let s = origin - self.corner;
        let u = s.dot(p) * inverse;
        let q = s.cross(e);
        let v = direction.dot(q) * inverse;
        let t = f.dot(q) * inverse;
        // Where the determinant is 0 these are infinite or no numbers, and a comparison fails.
        if u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t >= 0.0 {
            t
        } else {
            f32::INFINITY
        }
    }
}
