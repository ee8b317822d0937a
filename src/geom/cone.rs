//! Open cone frusta and cylinders: the lateral surface alone, without end caps.

use glam::DVec3;

use super::{Aabb, Ray};

/// An open frustum of a cone between two circles about one axis; with equal radii a cylinder. Hit on both sides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    /// Centre of the circle at the base.
    pub base: DVec3,
    /// Radius at the base, not negative.
    pub base_radius: f64,
    /// Centre of the circle at the apex; differs from `base`.
    pub apex: DVec3,
    /// Radius at the apex, not negative; at least one radius is positive.
    pub apex_radius: f64,
}

impl Cone {
    /// The smallest box around it: around both end circles, which reach r sqrt(1 - u_i^2) along axis i for a unit axis u.
    pub fn bounds(&self) -> Aabb {
        let axis = self.apex - self.base;
        let squared = axis * axis;
        let across = DVec3::new(
            squared.y + squared.z,
            squared.z + squared.x,
            squared.x + squared.y,
        );
        let reach = (across / axis.length_squared()).map(f64::sqrt);
        let circle = |centre: DVec3, radius: f64| {
            Aabb::new(centre - radius * reach, centre + radius * reach)
        };
        circle(self.base, self.base_radius).union(circle(self.apex, self.apex_radius))
    }

    /// Length of the axis.
    pub fn length(&self) -> f64 {
        self.base.distance(self.apex)
    }

    /// Area of the lateral surface, pi (r0 + r1) sqrt(L^2 + (r0 - r1)^2).
    pub fn area(&self) -> f64 {
        let slant = self.length().hypot(self.base_radius - self.apex_radius);
        std::f64::consts::PI * (self.base_radius + self.apex_radius) * slant
    }

    /// The outward normal at a point of the surface, not of unit length.
    pub fn normal(&self, point: DVec3) -> DVec3 {
        let axis = self.apex - self.base;
        let length = axis.length();
        let unit = axis / length;
        let from_base = point - self.base;
        let across = from_base - from_base.dot(unit) * unit;
        let taper = (self.apex_radius - self.base_radius) / length;
        across.normalize_or_zero() - taper * unit
    }

    /// Parameter of the first hit in the ray's range, or `None`.
    #[inline]
    pub fn intersect(&self, ray: &Ray) -> Option<f64> {
        let axis = self.apex - self.base;
        let length = axis.length();
        let unit = axis / length;
        let taper = (self.apex_radius - self.base_radius) / length;

        // From the point of the ray next to the middle: the coefficients below then do not cancel for far origins.
        let d = ray.line.direction;
        let middle = (0.5 * (self.base + self.apex) - ray.line.origin).dot(d) / d.length_squared();
        let start = ray.line.at(middle) - self.base;

        // |across|^2 = radius^2, both linear along the ray: a t^2 + 2 b t + c = 0.
        let (along, climb) = (start.dot(unit), d.dot(unit));
        let (across, drift) = (start - along * unit, d - climb * unit);
        let (radius, widening) = (self.base_radius + taper * along, taper * climb);
        let a = drift.length_squared() - widening * widening;
        let b = across.dot(drift) - radius * widening;
        let c = across.length_squared() - radius * radius;
        let discriminant = b * b - a * c;
        if discriminant < 0.0 || (a == 0.0 && b == 0.0) {
            return None;
        }
        // The root without cancellation first, the other by Vieta.
        let q = -(b + discriminant.sqrt().copysign(b));
        let (first, second) = if q == 0.0 { (0.0, 0.0) } else { (q / a, c / q) };
        let roots = if first <= second {
            [first, second]
        } else {
            [second, first]
        };
        roots.into_iter().find_map(|t| {
            let height = along + t * climb;
            let t = middle + t;
            (t.is_finite() && (0.0..=length).contains(&height) && ray.covers(t)).then_some(t)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::{Line, Span};

    fn first(cone: &Cone, o: [f64; 3], d: [f64; 3]) -> Option<f64> {
        cone.intersect(&Ray::new(Line::new(o.into(), d.into()), Span::FULL))
    }

    #[test]
    fn a_cylinder_and_a_cone_by_hand() {
        let cylinder = Cone {
            base: DVec3::ZERO,
            base_radius: 1.0,
            apex: DVec3::new(0.0, 0.0, 4.0),
            apex_radius: 1.0,
        };
        assert_eq!(
            first(&cylinder, [-3.0, 0.0, 1.0], [1.0, 0.0, 0.0]),
            Some(2.0)
        );
        assert_eq!(first(&cylinder, [-3.0, 0.0, 5.0], [1.0, 0.0, 0.0]), None);
        // Along the axis: through the open ends.
        assert_eq!(first(&cylinder, [0.5, 0.0, -1.0], [0.0, 0.0, 1.0]), None);
        // Through the open base to the far side from within.
        assert_eq!(
            first(&cylinder, [0.0, 0.0, -1.0], [0.5, 0.0, 1.0]),
            Some(2.0)
        );
        assert_eq!(cylinder.bounds().lo, DVec3::new(-1.0, -1.0, 0.0));
        assert_eq!(cylinder.bounds().hi, DVec3::new(1.0, 1.0, 4.0));
        let cone = Cone {
            apex_radius: 0.0,
            ..cylinder
        };
        assert_eq!(first(&cone, [-3.0, 0.0, 2.0], [1.0, 0.0, 0.0]), Some(2.5));
        assert_eq!(first(&cone, [-3.0, 0.9, 2.0], [1.0, 0.0, 0.0]), None);
        let normal = cone.normal(DVec3::new(-0.5, 0.0, 2.0));
        assert!(normal.dot(DVec3::new(1.0, 0.0, 4.0)).abs() < 1e-15 && normal.x < 0.0);
    }
}
