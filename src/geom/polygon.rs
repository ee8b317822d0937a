//! Convex planar polygons.

use glam::{DVec2, DVec3};

use super::{Aabb, Ray, Span};

/// A convex planar polygon by its corners in order, hit from both sides.
#[derive(Clone, Debug, PartialEq)]
pub struct Polygon {
    corners: Box<[DVec3]>,
    /// Sum of the cross products of successive corners: twice the area, along the normal.
    normal: DVec3,
}

/// Corners further from the common plane than this share of the longest side make a polygon non-planar.
const FLATNESS: f64 = 1e-9;

impl Polygon {
    /// A polygon by its corners, or what is wrong with them: fewer than three, not planar, not convex.
    pub fn new(corners: Vec<DVec3>) -> Result<Self, &'static str> {
        if corners.len() < 3 {
            return Err("a polygon needs at least three corners");
        }
        let n = corners.len();
        let first = corners[0];
        let normal: DVec3 = (0..n)
            .map(|i| (corners[i] - first).cross(corners[(i + 1) % n] - first))
            .sum();
        let size = Aabb::around(corners.iter().copied()).extent().max_element();
        let length = normal.length();
        let unit = normal / length;
        if length > 0.0
            && corners
                .iter()
                .any(|&c| unit.dot(c - first).abs() > FLATNESS * size)
        {
            return Err("the corners of the polygon are not in one plane");
        }
        // Convex: every corner turns the same way, and the turns add up to one round (no star).
        let edge = |i: usize| corners[(i + 1) % n] - corners[i % n];
        let turns_back =
            |i: usize| normal.dot(edge(i).cross(edge(i + 1))) < -FLATNESS * length * size * size;
        let axis = edge(0);
        let forward = |i: usize| edge(i).dot(axis) >= 0.0;
        let reversals = (0..n).filter(|&i| forward(i) != forward(i + 1)).count();
        if (0..n).any(turns_back) || reversals > 2 {
            return Err("the polygon is not convex");
        }
        Ok(Self {
            corners: corners.into(),
            normal,
        })
    }

    /// The corners in order.
    pub fn corners(&self) -> &[DVec3] {
        &self.corners
    }

    /// The smallest box around it.
    pub fn bounds(&self) -> Aabb {
        Aabb::around(self.corners.iter().copied())
    }

    /// Area.
    pub fn area(&self) -> f64 {
        0.5 * self.normal.length()
    }

    /// Parameter of the hit in the ray's range, or `None`.
    ///
    /// Inside is decided by the edge functions of the triangle test, so polygons and triangles that share an edge leave
    /// no gap; t comes from the plane.
    #[inline]
    pub fn intersect(&self, ray: &Ray) -> Option<f64> {
        let (mut negative, mut positive) = (false, false);
        let last = self.corners[self.corners.len() - 1];
        let mut previous = ray.sheared(last).truncate();
        for &corner in &self.corners {
            let current = ray.sheared(corner).truncate();
            let side = DVec2::perp_dot(previous, current);
            negative |= side < 0.0;
            positive |= side > 0.0;
            if negative && positive {
                return None;
            }
            previous = current;
        }
        if !negative && !positive {
            return None;
        }
        let t = self.normal.dot(self.corners[0] - ray.line.origin)
            / self.normal.dot(ray.line.direction);
        let t = match self.bounds().clip_conservative(&ray.line, Span::FULL) {
            Some(own) => t.clamp(own.t0, own.t1),
            None => t,
        };
        (!t.is_nan() && ray.covers(t)).then_some(t)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::{Line, Triangle};

    fn square() -> Vec<DVec3> {
        [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]]
            .map(|[x, y]| DVec3::new(x, y, 0.5))
            .into()
    }

    #[test]
    fn what_is_no_convex_polygon_is_refused() {
        assert!(Polygon::new(square()).is_ok());
        assert!(Polygon::new(square()[..2].to_vec()).is_err());
        let mut bent = square();
        bent[0].z = 0.6;
        assert!(Polygon::new(bent).is_err());
        let mut dart = square();
        dart[0] = DVec3::new(-0.5, -0.5, 0.5);
        assert!(Polygon::new(dart).is_err());
        let star = (0..5)
            .map(|i| {
                let angle = f64::from(i * 2) * std::f64::consts::TAU / 5.0;
                DVec3::new(angle.cos(), angle.sin(), 0.0)
            })
            .collect();
        assert!(Polygon::new(star).is_err());
    }

    #[test]
    fn equals_its_two_triangles() {
        let quad = Polygon::new(square()).expect("a square");
        assert_eq!(quad.area(), 4.0);
        let [a, b, c, d] = <[DVec3; 4]>::try_from(square()).expect("four");
        let halves = [Triangle([a, b, c]), Triangle([a, c, d])];
        for i in -12..=12 {
            for j in -12..=12 {
                let target = DVec3::new(f64::from(i) / 10.0, f64::from(j) / 10.0, 0.5);
                let origin = DVec3::new(0.3, -0.2, 4.0);
                let ray = Ray::new(Line::new(origin, target - origin), Span::FULL);
                let by_halves = halves.iter().find_map(|h| h.intersect(&ray));
                let t = quad.intersect(&ray);
                assert_eq!(t.is_some(), by_halves.is_some(), "towards {target}");
                assert!(t.is_none_or(|t| (t - 1.0).abs() < 1e-15));
            }
        }
        let in_plane = Line::new(DVec3::new(-3.0, 0.0, 0.5), DVec3::X);
        assert_eq!(quad.intersect(&Ray::new(in_plane, Span::FULL)), None);
    }
}
