//! Convex planar polygons.

use std::f64::consts::TAU;
use std::ops::RangeInclusive;

use glam::{DVec2, DVec3};

use super::{Aabb, Ray, Span};

/// A convex planar polygon by its corners in order, hit from both sides.
#[derive(Clone, Debug, PartialEq)]
pub struct Polygon {
    corners: Box<[DVec3]>,
    /// Sum of the cross products of successive corners over `scale`^2: twice the area, along the normal.
    normal: DVec3,
    /// The power of two by which the corners are divided before products are taken, so that none leaves f64.
    scale: f64,
}

/// What is this small against the longest side counts as zero: distances from the common plane, dents, the width of all.
const FLATNESS: f64 = 1e-9;

/// Longest sides that are understood: their squares stay in f64.
const SIDES: RangeInclusive<f64> = 1e-150..=1e150;

impl Polygon {
    /// A polygon by its corners, or what is wrong with them: fewer than three, not finite, coinciding neighbours, no area,
    /// not planar, not convex, more than once round.
    pub fn new(corners: Vec<DVec3>) -> Result<Self, &'static str> {
        let n = corners.len();
        if n < 3 {
            return Err("a polygon needs at least three corners");
        }
        if !corners.iter().all(|c| c.is_finite()) {
            return Err("a corner of the polygon is not finite");
        }
        if (0..n).any(|i| corners[i] == corners[(i + 1) % n]) {
            return Err("two successive corners of the polygon coincide");
        }
        let size = Aabb::around(corners.iter().copied()).extent().max_element();
        if !SIDES.contains(&size) {
            return Err("the polygon is too small or too large: sides go from 1e-150 to 1e150");
        }
        // Relative to the first corner and divided by a power of two, so that the longest side is 1/2 to 1.
        let (size, exponent) = libm::frexp(size);
        let scale = libm::ldexp(1.0, exponent);
        let scaled: Vec<DVec3> = corners.iter().map(|&c| (c - corners[0]) / scale).collect();
        let normal: DVec3 = (0..n).map(|i| scaled[i].cross(scaled[(i + 1) % n])).sum();
        check_shape(&scaled, normal, size)?;
        Ok(Self {
            corners: corners.into(),
            normal,
            scale,
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
        0.5 * self.normal.length() * self.scale * self.scale
    }

    /// Normal, to the side from which the corners go round counter-clockwise; not of unit length.
    pub fn normal(&self) -> DVec3 {
        self.normal
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

/// Whether the corners lie in one plane and go round it once, always turning the same way. The longest side, `size`, is
/// about 1.
fn check_shape(corners: &[DVec3], normal: DVec3, size: f64) -> Result<(), &'static str> {
    const CONVEX: &str = "the polygon is not convex";
    let n = corners.len();
    let length = normal.length();
    if length <= FLATNESS * size * size {
        // Either no width, or parts that go round in opposite directions: then some three corners span an area.
        let far =
            corners.iter().copied().fold(
                DVec3::ZERO,
                |a, c| if c.length() > a.length() { c } else { a },
            );
        let wide = |c: &DVec3| c.cross(far).length() > FLATNESS * size * far.length();
        return Err(if corners.iter().any(wide) {
            CONVEX
        } else {
            "the corners lie on one line"
        });
    }
    let unit = normal / length;
    if n > 3 && corners.iter().any(|c| unit.dot(*c).abs() > FLATNESS * size) {
        return Err("the corners of the polygon are not in one plane");
    }
    // Convex: no corner lies on the wrong side of an edge, no edge runs back along the one before, and the turns add up to
    // one round (a star or a polygon run through twice makes more).
    let edge = |i: usize| corners[(i + 1) % n] - corners[i % n];
    let mut turns = 0.0;
    for i in 0..n {
        let (this, next) = (edge(i), edge(i + 1));
        let tolerance = FLATNESS * size * this.length();
        let outside = |c: &DVec3| unit.dot(this.cross(*c - corners[i])) < -tolerance;
        let (sine, cosine) = (unit.dot(this.cross(next)), this.dot(next));
        let back = cosine < 0.0 && sine <= FLATNESS * size * this.length().max(next.length());
        if back || corners.iter().any(outside) {
            return Err(CONVEX);
        }
        turns += libm::atan2(sine, cosine);
    }
    if (turns - TAU).abs() > 1.0 {
        return Err("the polygon goes round more than once");
    }
    Ok(())
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
        let mut bent = square();
        bent[0].z = 0.6;
        let mut dart = square();
        dart[0] = DVec3::new(-0.5, -0.5, 0.5);
        let round = |step: i32, n: i32| -> Vec<DVec3> {
            let angle = |i: i32| f64::from(i * step) * TAU / 5.0;
            (0..n)
                .map(|i| DVec3::new(angle(i).cos(), angle(i).sin(), 0.0))
                .collect()
        };
        let triangle = [DVec3::X, DVec3::Y, DVec3::Z];
        let o = DVec3::ZERO;
        let (x, y) = (DVec3::X, DVec3::Y);
        let mut unknown = square();
        unknown[2].y = f64::NAN;
        let slanted = DVec3::new(0.1, 0.3, 0.7);
        let cases: [(&str, Vec<DVec3>, &str); 14] = [
            ("two corners", square()[..2].to_vec(), "at least three"),
            ("bent quad", bent, "not in one plane"),
            ("dart", dart, "not convex"),
            ("pentagram", round(2, 5), "not convex"),
            ("pentagon, twice round", round(1, 10), "more than once"),
            (
                "triangle, twice round",
                triangle.repeat(2),
                "more than once",
            ),
            ("bow-tie", vec![o, x, y, x + y], "not convex"),
            (
                "bow-tie through a corner",
                vec![o, x, x + y, o, -x, -x - y],
                "not convex",
            ),
            (
                "bow-tie of no area",
                vec![o, x, x + y, o, -x, y - x],
                "not convex",
            ),
            ("spike", vec![o, 2.0 * x, x, x + y, y], "not convex"),
            ("neighbours", vec![o, x, x, y], "coincide"),
            ("last and first", vec![o, x, y, o], "coincide"),
            (
                "line",
                vec![o, slanted, 3.0 * slanted, 2.0 * slanted],
                "on one line",
            ),
            ("NaN", unknown, "not finite"),
        ];
        for scale in [1.0, 1e-80, 1e80, 1e-140, 1e140] {
            for (name, corners, wanted) in &cases {
                let scaled = corners.iter().map(|&c| c * scale).collect();
                let error = Polygon::new(scaled).expect_err(name);
                assert!(error.contains(wanted), "{name} at {scale}: {error}");
            }
            for (corners, area) in [
                (square(), 4.0),
                (triangle.into(), 0.75_f64.sqrt()),
                // A corner within an edge.
                (vec![o, x, 2.0 * x, y], 1.0),
            ] {
                let scaled = corners.iter().map(|&c| c * scale).collect();
                let found = Polygon::new(scaled).expect("convex").area();
                assert!((found / (area * scale * scale) - 1.0).abs() < 1e-14);
            }
        }
        for huge in [f64::INFINITY, 1e200, 1e308] {
            assert!(Polygon::new(square().iter().map(|&c| c * huge).collect()).is_err());
        }
    }

    #[test]
    fn is_hit_at_any_scale() {
        for scale in [1.0, 1e-80, 1e80, 1e-140, 1e140] {
            let corners = square().iter().map(|&c| c * scale).collect();
            let quad = Polygon::new(corners).expect("a square");
            let line = |x| Line::new(DVec3::new(x, 0.2, 2.0) * scale, DVec3::NEG_Z);
            let t = quad.intersect(&Ray::new(line(0.3), Span::FULL));
            let t = t.expect("a hit") / scale;
            assert!((t - 1.5).abs() < 1e-14, "{t} at {scale}");
            assert_eq!(quad.intersect(&Ray::new(line(1.3), Span::FULL)), None);
        }
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
