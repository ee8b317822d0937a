//! Spheres.

use glam::DVec3;

use super::{Aabb, Ray};

/// A sphere, hit on both sides of its surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// Centre.
    pub centre: DVec3,
    /// Radius, positive.
    pub radius: f64,
}

impl Sphere {
    /// The smallest box around it.
    pub fn bounds(&self) -> Aabb {
        Aabb::new(self.centre - self.radius, self.centre + self.radius)
    }

    /// Area of the surface.
    pub fn area(&self) -> f64 {
        4.0 * std::f64::consts::PI * self.radius * self.radius
    }

    /// The outward normal at a point of the surface, not of unit length.
    pub fn normal(&self, point: DVec3) -> DVec3 {
        point - self.centre
    }

    /// Parameter of the first hit in the ray's range, or `None`.
    ///
    /// The discriminant is taken from the distance between the centre and the line, not from b^2 - 4ac, which
    /// cancels for small or far spheres (Haines, Guenther, Akenine-Moeller 2019, Ray Tracing Gems ch. 7). t is kept inside
    /// the ray's span of the sphere's own box.
    #[inline]
    pub fn intersect(&self, ray: &Ray) -> Option<f64> {
        let d = ray.line.direction;
        let a = d.length_squared();
        let to_centre = self.centre - ray.line.origin;
        let middle = to_centre.dot(d) / a;
        let nearest = to_centre - middle * d;
        let remainder = self.radius * self.radius - nearest.length_squared();
        if remainder < 0.0 {
            return None;
        }
        let half = (remainder / a).sqrt();
        let own = ray.within(&self.bounds())?;
        [middle - half, middle + half]
            .map(|t| t.clamp(own.t0, own.t1))
            .into_iter()
            .find(|&t| ray.covers(t))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::{Line, Span};

    #[test]
    fn first_hit_in_range() {
        let s = Sphere {
            centre: DVec3::new(0.0, 0.0, 5.0),
            radius: 2.0,
        };
        let line = Line::new(DVec3::ZERO, DVec3::Z);
        assert_eq!(s.intersect(&Ray::new(line, Span::FULL)), Some(3.0));
        assert_eq!(s.intersect(&Ray::new(line, Span::from(4.0))), Some(7.0));
        assert_eq!(s.intersect(&Ray::new(line, Span::from(8.0))), None);
        let beside = Line::new(DVec3::new(2.0 + 1e-12, 0.0, 0.0), DVec3::Z);
        assert_eq!(s.intersect(&Ray::new(beside, Span::FULL)), None);
        let tangent = Line::new(DVec3::new(2.0, 0.0, 0.0), 4.0 * DVec3::Z);
        assert_eq!(s.intersect(&Ray::new(tangent, Span::FULL)), Some(1.25));
    }

    #[test]
    fn a_small_far_sphere_keeps_its_radius() {
        let s = Sphere {
            centre: DVec3::new(1e6, 0.0, 0.0),
            radius: 1e-3,
        };
        for (y, hit) in [(0.999e-3, true), (1.001e-3, false)] {
            let line = Line::new(DVec3::new(0.0, y, 0.0), DVec3::X);
            assert_eq!(s.intersect(&Ray::new(line, Span::FULL)).is_some(), hit);
        }
    }
}
