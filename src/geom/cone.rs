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
        let slant = libm::hypot(self.length(), self.base_radius - self.apex_radius);
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
    ///
    /// Distance from the axis and radius are both linear along the ray, so |A + sD|^2 = (R + sW)^2 is to be solved, with
    /// A and D across the axis. The discriminant is taken as |RD - WA|^2 - |A x D|^2, which unlike b^2 - ac does not cancel
    /// for thin cones, and s counts from the ray's point next to the middle of the axis, which serves far origins. t is
    /// kept inside the ray's span of the cone's own box.
    #[inline]
    pub fn intersect(&self, ray: &Ray) -> Option<f64> {
        let axis = self.apex - self.base;
        let squared = axis.length_squared();
        let to_base = self.base - ray.line.origin;
        let direction = ray.line.direction;
        let speed_squared = direction.length_squared();
        let middle = (to_base + 0.5 * axis).dot(direction) / speed_squared;
        let start = middle * direction - to_base;
        let step = speed_squared.sqrt().recip();
        let unit = step * direction;

        // Heights above the base are times the axis' length: 0 at the base, exactly `squared` at the apex.
        let (height, climb) = (start.dot(axis), unit.dot(axis));
        let taper = (self.apex_radius - self.base_radius) / squared;
        let (radius, widening) = (self.base_radius + taper * height, taper * climb);
        let across = start - (height / squared) * axis;
        let drift = unit - (climb / squared) * axis;

        let discriminant = (radius * drift - widening * across).length_squared()
            - across.cross(drift).length_squared();
        let a = drift.length_squared() - widening * widening;
        let b = across.dot(drift) - radius * widening;
        let c = across.length_squared() - radius * radius;
        // The larger root without cancellation, the other by Vieta; none along the axis of a cylinder.
        let q = -(b + discriminant.sqrt().copysign(b));
        if discriminant < 0.0 || (q == 0.0 && a == 0.0) {
            return None;
        }
        let (one, other) = if q == 0.0 { (0.0, 0.0) } else { (q / a, c / q) };
        let roots = [one.min(other), one.max(other)];

        let between_ends = roots.map(|s| (0.0..=squared).contains(&(height + s * climb)));
        if between_ends == [false; 2] {
            return None;
        }
        let own = ray.within(&self.bounds())?;
        let hits = roots.into_iter().zip(between_ends);
        hits.filter(|&(_, between)| between)
            .map(|(s, _)| (middle + s * step).clamp(own.t0, own.t1))
            .find(|&t| ray.covers(t))
    }
}

#[cfg(test)]
mod tests;
