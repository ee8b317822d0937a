//! Triangles, with the watertight test of Woop, Benthin & Wald (2013).

use glam::DVec3;

use super::{Aabb, Ray, Real, Vector};

/// A triangle by its corners. One without area is kept and tested, but never hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangle<V = DVec3>(pub [V; 3]);

impl Triangle {
    /// Area.
    pub fn area(&self) -> f64 {
        0.5 * self.normal().length()
    }

    /// Normal, to the side from which the corners go round counter-clockwise; not of unit length.
    pub fn normal(&self) -> DVec3 {
        let [a, b, c] = self.0;
        (b - a).cross(c - a)
    }
}

impl<V: Vector> Triangle<V> {
    /// The smallest box around it.
    pub fn bounds(&self) -> Aabb<V> {
        let [a, b, c] = self.0;
        Aabb {
            lo: a.min(b).min(c),
            hi: a.max(b).max(c),
        }
    }

    /// Parameter of the hit in the ray's range, or `None`.
    ///
    /// Neighbours that share an edge see edge functions that are exact negatives of each other (no fused multiply-add),
    /// so no ray slips between them. t is kept inside the ray's span of the triangle's own box, which a triangle nearly
    /// parallel to the ray could otherwise leave. A ray that misses that box misses the triangle, whatever the edge
    /// functions say of coordinates so unlike that these are noise: no tree could find such a hit.
    #[inline]
    pub fn intersect(&self, ray: &Ray<V>) -> Option<V::Real> {
        let [a, b, c] = self.0.each_ref().map(|p| ray.sheared(p));
        let [u, v, w] = [(c, b), (a, c), (b, a)].map(|(p, q)| p[0] * q[1] - p[1] * q[0]);
        let zero = V::Real::ZERO;
        // No short cuts: one branch, which most objects in a leaf take, instead of six.
        if ((u < zero) | (v < zero) | (w < zero)) & ((u > zero) | (v > zero) | (w > zero)) {
            return None;
        }
        let determinant = u + v + w;
        if determinant == zero {
            return None;
        }
        // Weights first: products of three lengths would leave the range of numbers long before products of two.
        let [u, v, w] = [u, v, w].map(|weight| weight / determinant);
        let t = u * a[2] + v * b[2] + w * c[2];
        let own = ray.within(&self.bounds())?;
        let t = t.clamp(own.t0, own.t1);
        ray.covers(t).then_some(t)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::{Line, Span};

    fn ray(o: DVec3, d: DVec3) -> Ray {
        Ray::new(Line::new(o, d), Span::FULL)
    }

    #[test]
    fn hit_behind_and_in_front() {
        let t = Triangle([DVec3::ZERO, DVec3::X, DVec3::Y]);
        let down = ray(DVec3::new(0.25, 0.25, 3.0), -DVec3::Z);
        assert_eq!(t.intersect(&down), Some(3.0));
        let up = ray(DVec3::new(0.25, 0.25, 3.0), DVec3::Z);
        assert_eq!(t.intersect(&up), Some(-3.0));
        let stopped = Ray::new(up.line, Span::from(0.0));
        assert_eq!(t.intersect(&stopped), None);
        assert_eq!(t.intersect(&ray(DVec3::new(0.6, 0.6, 1.0), DVec3::Z)), None);
    }

    #[test]
    fn degenerate_triangles_are_never_hit() {
        let d = DVec3::new(0.3, -0.2, 0.9);
        for t in [
            [DVec3::ZERO; 3],
            [DVec3::ZERO, DVec3::X, DVec3::X],
            [DVec3::ZERO, DVec3::X, 2.0 * DVec3::X],
        ] {
            assert_eq!(Triangle(t).intersect(&ray(-d, d)), None);
        }
    }

    /// A hit on a slanted triangle scales with it, to the ends of what scenes may have.
    #[test]
    fn hits_scale_by_powers_of_two() {
        let corners = [
            DVec3::ZERO,
            DVec3::new(1.0, 0.0, 1.0),
            DVec3::new(0.0, 1.0, 1.0),
        ];
        for (origin, t) in [
            (DVec3::new(0.2, 0.1, 5.0), 4.7),
            (DVec3::new(0.1, 0.3, 0.6), 0.2),
            (DVec3::new(0.4, 0.3, 2.0), 1.3),
        ] {
            for exponent in [-450, -365, -100, 0, 100, 345, 450] {
                let s = libm::ldexp(1.0, exponent);
                let triangle = Triangle(corners.map(|p| s * p));
                let hit = triangle.intersect(&ray(s * origin, -DVec3::Z));
                let hit = hit.expect("a hit") / s;
                assert!((hit / t - 1.0).abs() < 1e-14, "{hit} at 2^{exponent}");
            }
        }
    }

    /// A ray from inside an irregular octahedron to a point of an edge or a vertex must not leak.
    #[test]
    fn closed_octahedron_does_not_leak() {
        let v = [
            DVec3::new(1.1, 0.02, -0.03),
            DVec3::new(-0.9, 0.05, 0.01),
            DVec3::new(0.03, 1.3, 0.07),
            DVec3::new(-0.02, -0.8, 0.04),
            DVec3::new(0.06, -0.01, 0.95),
            DVec3::new(-0.04, 0.03, -1.2),
        ];
        let mut faces = Vec::new();
        for x in [0, 1] {
            for y in [2, 3] {
                for z in [4, 5] {
                    faces.push(Triangle([v[x], v[y], v[z]]));
                }
            }
        }
        let origin = DVec3::new(0.05, -0.03, 0.02);
        let mut rays = 0;
        for (i, a) in v.iter().enumerate() {
            // Vertices 2k and 2k + 1 are opposite: every other pair is an edge.
            for b in &v[(i / 2 + 1) * 2..] {
                for step in 0..=1000 {
                    let target = a.lerp(*b, f64::from(step) / 1000.0);
                    let r = Ray::new(Line::new(origin, target - origin), Span::from(0.0));
                    assert!(
                        faces.iter().any(|f| f.intersect(&r).is_some()),
                        "leak towards {target}"
                    );
                    rays += 1;
                }
            }
        }
        assert!(rays > 10_000);
    }
}
