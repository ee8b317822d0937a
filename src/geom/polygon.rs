//! Planar polygons, convex or not, by the even-odd rule.

use std::f64::consts::TAU;
use std::ops::RangeInclusive;

use glam::DVec3;

use super::{Aabb, Ray};

/// A planar polygon by its corners in order, hit from both sides.
///
/// A point is inside if a half-line from it crosses the edges an odd number of times: what the corners go round twice is
/// a hole. The edges themselves belong to the polygon.
#[derive(Clone, Debug, PartialEq)]
pub struct Polygon {
    corners: Box<[DVec3]>,
    /// Sum of the cross products of successive corners over `scale`^2: twice the area, along the normal.
    normal: DVec3,
    /// The power of two by which the corners are divided before products are taken, so that none leaves f64.
    scale: f64,
    bounds: Aabb,
    /// Whether the corners lie in one plane but for rounding.
    flat: bool,
    /// Whether it is known to be strictly convex, so that signs of edge functions suffice.
    convex: bool,
}

/// What is this small against the longest side counts as zero: the width of all, turns at the corners of a convex polygon,
/// distances from the common plane of a flat one.
const FLATNESS: f64 = 1e-9;

/// Largest distance from the common plane against the longest side: corners written with six digits are often that far.
const PLANARITY: f64 = 1e-5;

/// Longest sides that are understood: their squares stay in f64.
const SIDES: RangeInclusive<f64> = 1e-150..=1e150;

impl Polygon {
    /// A polygon by its corners, or what is wrong with them: fewer than three, not finite, coinciding neighbours, no area
    /// (on one line, or parts that go round in opposite directions cancel), not planar, too small or too large.
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
        let bounds = Aabb::around(corners.iter().copied());
        let size = bounds.extent().max_element();
        if !SIDES.contains(&size) {
            return Err("the polygon is too small or too large: sides go from 1e-150 to 1e150");
        }
        // Relative to the first corner and divided by a power of two, so that the longest side is 1/2 to 1.
        let (size, exponent) = libm::frexp(size);
        let scale = libm::ldexp(1.0, exponent);
        let scaled: Vec<DVec3> = corners.iter().map(|&c| (c - corners[0]) / scale).collect();
        let normal: DVec3 = (0..n).map(|i| scaled[i].cross(scaled[(i + 1) % n])).sum();
        let length = normal.length();
        if length <= FLATNESS * size * size {
            return Err("the polygon has no area, or its parts cancel");
        }
        let unit = normal / length;
        let heights = scaled.iter().map(|c| unit.dot(*c).abs());
        let off_plane = heights.fold(0.0, f64::max) / size;
        if n > 3 && off_plane > PLANARITY {
            return Err("the corners of the polygon are not in one plane");
        }
        let flat = off_plane <= FLATNESS;
        Ok(Self {
            flat,
            convex: flat && is_convex(&scaled, unit),
            corners: corners.into(),
            normal,
            scale,
            bounds,
        })
    }

    /// The corners in order.
    pub fn corners(&self) -> &[DVec3] {
        &self.corners
    }

    /// The smallest box around it.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// How far corners and hits may lie from their common plane, or `None` if that is more than rounding: the part of such
    /// a polygon in a box cannot be told.
    pub(super) fn unevenness(&self) -> Option<f64> {
        self.flat
            .then(|| FLATNESS * self.bounds.extent().max_element())
    }

    /// Area: half the length of the summed cross products of successive corners. Where a polygon crosses itself, parts
    /// count as often as the corners go round them, clockwise ones negative.
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
    /// no gap; t comes from the plane and is kept inside the ray's span of the polygon's own box.
    #[inline]
    pub fn intersect(&self, ray: &Ray) -> Option<f64> {
        let own = ray.within(&self.bounds)?;
        let slope = self.normal.dot(ray.line.direction);
        if slope == 0.0 || !self.is_crossed(ray) {
            return None;
        }
        let t = self.normal.dot(self.corners[0] - ray.line.origin) / slope;
        let t = t.clamp(own.t0, own.t1);
        ray.covers(t).then_some(t)
    }

    fn is_crossed(&self, ray: &Ray) -> bool {
        if self.convex {
            one_sided(&self.corners, ray)
        } else {
            even_odd(&self.corners, ray)
        }
    }
}

/// Whether the ray, the origin of its own frame, lies on no edge's wrong side: inside a convex polygon, or on its edges. `false` if all edges lie on
/// one line with it.
#[inline]
fn one_sided(corners: &[DVec3], ray: &Ray) -> bool {
    let (mut negative, mut positive) = (false, false);
    let mut a = ray.sheared(corners[corners.len() - 1]).truncate();
    for &corner in corners {
        let b = ray.sheared(corner).truncate();
        let side = a.perp_dot(b);
        a = b;
        negative |= side < 0.0;
        positive |= side > 0.0;
        if negative && positive {
            return false;
        }
    }
    negative || positive
}

/// Whether the half-axis y = 0 < x of the ray's own frame crosses an odd number of edges, or the ray lies on one. Most edges
/// lie above or below it: x is worked out for the few others.
///
/// The sign of a difference of rounded products is never wrong, only sometimes zero; so this is exact for the corners
/// given, and a corner on the half-axis counts as below it for both its edges.
#[inline]
fn even_odd(corners: &[DVec3], ray: &Ray) -> bool {
    let mut inside = false;
    let mut before = corners[corners.len() - 1];
    let mut height = ray.sheared_height(before);
    for &corner in corners {
        let (from, low) = (before, height);
        (before, height) = (corner, ray.sheared_height(corner));
        if (low > 0.0 && height > 0.0) || (low < 0.0 && height < 0.0) {
            continue;
        }
        let [a, b] = [from, corner].map(|p| ray.sheared(p).truncate());
        let side = a.perp_dot(b);
        if side == 0.0 && a.dot(b) <= 0.0 {
            return true;
        }
        let rises = b.y > 0.0;
        inside ^= (a.y > 0.0) != rises && (side > 0.0) == rises;
    }
    inside
}

/// Whether every corner turns to the left, clearly so, and the turns add up to one round (a star makes more).
fn is_convex(corners: &[DVec3], unit: DVec3) -> bool {
    let n = corners.len();
    let edge = |i: usize| corners[(i + 1) % n] - corners[i % n];
    let mut turns = 0.0;
    for i in 0..n {
        let (this, next) = (edge(i), edge(i + 1));
        let sine = unit.dot(this.cross(next));
        if sine <= FLATNESS * this.length() * next.length() {
            return false;
        }
        turns += libm::atan2(sine, this.dot(next));
    }
    (turns - TAU).abs() < 1.0
}

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::*;
    use crate::geom::{Line, Span, Triangle};

    fn square() -> Vec<DVec3> {
        [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]]
            .map(|[x, y]| DVec3::new(x, y, 0.5))
            .into()
    }

    /// The points at these angles (in steps of 1/n round) and radii.
    fn round(n: u32, points: impl IntoIterator<Item = (f64, f64)>) -> Vec<DVec2> {
        let on_circle = |(step, radius): (f64, f64)| {
            let angle = TAU * step / f64::from(n);
            radius * DVec2::new(angle.cos(), angle.sin())
        };
        points.into_iter().map(on_circle).collect()
    }

    /// Outlines in the plane, with half the sum of their cross products.
    fn outlines() -> Vec<(&'static str, Vec<DVec2>, f64)> {
        let points = |flat: &[f64]| flat.chunks(2).map(DVec2::from_slice).collect::<Vec<_>>();
        let teeth = (0..36).flat_map(|m| {
            let g = f64::from(m);
            [
                (g - 0.19, 0.995),
                (g + 0.19, 0.995),
                (g + 0.3, 0.9),
                (g + 0.7, 0.9),
            ]
        });
        let tau: fn(f64) -> f64 = |share| (TAU * share).sin();
        let tooth = 0.995 * 0.995 * tau(0.38 / 36.0)
            + 2.0 * 0.995 * 0.9 * tau(0.11 / 36.0)
            + 0.81 * tau(0.4 / 36.0);
        vec![
            ("triangle", points(&[0.0, 0.0, 1.0, 0.2, 0.1, 0.9]), 0.44),
            (
                "hexagon",
                round(6, (0..6).map(|i| (f64::from(i), 1.0))),
                6.75_f64.sqrt(),
            ),
            (
                "corner within an edge",
                points(&[0.0, 0.0, 0.3, 0.3, 0.9, 0.9, 0.0, 1.0]),
                0.45,
            ),
            (
                "dart",
                points(&[-0.5, -0.5, -1.0, 1.0, -1.0, -1.0, 1.0, -1.0]),
                1.0,
            ),
            ("gear", round(36, teeth), 18.0 * tooth),
            (
                "pentagram",
                round(5, (0..5).map(|i| (f64::from(2 * i), 1.0))),
                2.5 * tau(0.4),
            ),
            (
                "bow-tie",
                points(&[0.0, 0.0, 1.0, 0.0, 0.2, 0.8, 0.8, 0.8]),
                0.5 * 0.8 * 0.4,
            ),
            // The hole is joined to the outline by an edge that is run through twice.
            (
                "frame",
                points(&[
                    -1.0, -1.0, 1.0, -1.0, 1.0, 1.0, -1.0, 1.0, -1.0, -1.0, -0.5, -0.4, -0.5, 0.6,
                    0.5, 0.5, 0.5, -0.5, -0.5, -0.4,
                ]),
                3.0,
            ),
            (
                "spike",
                points(&[0.0, 0.0, 2.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0]),
                1.0,
            ),
        ]
    }

    /// A plane that is parallel to no axis: places its points, exactly linear in x and y.
    fn slanted(p: DVec2) -> DVec3 {
        DVec3::new(3.0, -1.0, 2.0)
            + p.x * DVec3::new(0.75, 0.25, -0.5)
            + p.y * DVec3::new(0.25, 0.75, 0.625)
    }

    /// Odd winding number of the outline round a point, by the angles under which the edges are seen.
    fn winds_oddly(outline: &[DVec2], point: DVec2) -> bool {
        let n = outline.len();
        let angles = (0..n).map(|i| {
            let (a, b) = (outline[i] - point, outline[(i + 1) % n] - point);
            a.perp_dot(b).atan2(a.dot(b))
        });
        let rounds = (angles.sum::<f64>() / TAU).round();
        rounds.rem_euclid(2.0) == 1.0
    }

    fn distance_to_outline(outline: &[DVec2], point: DVec2) -> f64 {
        let n = outline.len();
        let distances = (0..n).map(|i| {
            let (a, b) = (outline[i], outline[(i + 1) % n]);
            let along = ((point - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
            point.distance(a.lerp(b, along))
        });
        distances.fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn what_is_no_polygon_is_refused() {
        let mut bent = square();
        bent[0].z = 0.6;
        let o = DVec3::ZERO;
        let (x, y) = (DVec3::X, DVec3::Y);
        let mut unknown = square();
        unknown[2].y = f64::NAN;
        let slope = DVec3::new(0.1, 0.3, 0.7);
        let cases: [(&str, Vec<DVec3>, &str); 8] = [
            ("two corners", square()[..2].to_vec(), "at least three"),
            ("bent quad", bent, "not in one plane"),
            (
                "bow-tie of two equal parts",
                vec![o, x, y, x + y],
                "no area",
            ),
            ("to and fro", vec![o, x, x + y, x], "no area"),
            ("neighbours", vec![o, x, x, y], "coincide"),
            ("last and first", vec![o, x, y, o], "coincide"),
            ("line", vec![o, slope, 3.0 * slope, 2.0 * slope], "no area"),
            ("NaN", unknown, "not finite"),
        ];
        for scale in [1.0, 1e-80, 1e80, 1e-140, 1e140] {
            for (name, corners, wanted) in &cases {
                let scaled = corners.iter().map(|&c| c * scale).collect();
                let error = Polygon::new(scaled).expect_err(name);
                assert!(error.contains(wanted), "{name} at {scale}: {error}");
            }
        }
        for huge in [f64::INFINITY, 1e200, 1e308] {
            assert!(Polygon::new(square().iter().map(|&c| c * huge).collect()).is_err());
        }
    }

    #[test]
    fn outlines_have_their_areas_and_the_convex_are_known() {
        let stretch = slanted(DVec2::X) - slanted(DVec2::ZERO);
        let stretch = stretch
            .cross(slanted(DVec2::Y) - slanted(DVec2::ZERO))
            .length();
        for (name, outline, area) in outlines() {
            for scale in [1.0, 1e-80, 1e80, 1e-140, 1e140] {
                let corners = outline.iter().map(|&p| slanted(p) * scale).collect();
                let polygon = Polygon::new(corners).expect(name);
                let found = polygon.area() / (stretch * scale * scale);
                assert!(
                    (found / area - 1.0).abs() < 1e-12,
                    "{name}: {found}, not {area}"
                );
                let convex = matches!(name, "triangle" | "hexagon");
                assert_eq!(polygon.convex, convex, "{name} at {scale}");
            }
        }
        let six_digits = |mut corners: Vec<DVec3>| {
            corners[2].z += 1e-6;
            Polygon::new(corners).expect("nearly planar")
        };
        assert!(!six_digits(square()).convex);
    }

    /// Against winding numbers in the plane, from many sides, and by the convex test where that is taken.
    #[test]
    fn inside_is_where_the_winding_number_is_odd() {
        for (name, outline, _) in outlines() {
            let polygon = Polygon::new(outline.iter().copied().map(slanted).collect()).expect(name);
            let turned = Polygon {
                convex: false,
                ..polygon.clone()
            };
            let (mut inside, mut all) = (0, 0);
            for i in 0..40_000_u32 {
                // A lattice of no regular period: multiples of the golden ratio and its powers.
                let part = |alpha: f64| (f64::from(i) * alpha).fract();
                let point = DVec2::new(part(0.618_033_988_75), part(0.754_877_666_25));
                let point = 3.0 * point - 1.5 * DVec2::ONE;
                if distance_to_outline(&outline, point) < 1e-12 {
                    continue;
                }
                let eye = DVec3::new(
                    part(0.569_840_291),
                    part(0.819_172_513),
                    part(0.671_043_607),
                );
                let eye = 20.0 * (eye - 0.5 * DVec3::ONE);
                let target = slanted(point);
                let ray = Ray::new(Line::new(eye, target - eye), Span::FULL);
                let expected = winds_oddly(&outline, point);
                let t = polygon.intersect(&ray);
                assert_eq!(t.is_some(), expected, "{name} at {point}");
                assert_eq!(turned.intersect(&ray), t, "{name} at {point}");
                // Rays that all but lie in the plane lose digits of t.
                let facing = polygon
                    .normal
                    .normalize()
                    .dot((target - eye).normalize())
                    .abs();
                assert!(
                    t.is_none_or(|t| (t - 1.0).abs() < 1e-14 / facing),
                    "{name}: {t:?}"
                );
                inside += u32::from(expected);
                all += 1;
            }
            assert!(
                all > 39_000 && 50 * inside > all,
                "{name}: {inside} of {all}"
            );
        }
    }

    #[test]
    fn edges_and_corners_belong_to_it() {
        for (name, outline, _) in outlines() {
            let corners: Vec<DVec3> = outline.iter().map(|p| p.extend(0.5)).collect();
            let n = corners.len();
            let polygon = Polygon::new(corners.clone()).expect(name);
            for (i, corner) in corners.iter().enumerate() {
                let down = Ray::new(Line::new(*corner + DVec3::Z, DVec3::NEG_Z), Span::FULL);
                assert_eq!(polygon.intersect(&down), Some(1.0), "{name}, corner {i}");
                let (a, b) = (*corner, corners[(i + 1) % n]);
                // Only where the middle is a point of the edge exactly.
                if a.x == b.x || a.y == b.y {
                    let down = Ray::new(
                        Line::new(0.5 * (a + b) + DVec3::Z, DVec3::NEG_Z),
                        Span::FULL,
                    );
                    assert_eq!(polygon.intersect(&down), Some(1.0), "{name}, edge {i}");
                }
            }
        }
    }

    /// A dart, the triangle that fills its notch and a polygon beside it: no ray slips through the shared edges.
    #[test]
    fn shared_edges_do_not_leak() {
        let [a, b, c, d, e] = [
            DVec2::new(-1.0, -1.0),
            DVec2::new(1.1, -0.9),
            DVec2::new(-0.3, -0.2),
            DVec2::new(-0.9, 1.2),
            DVec2::new(1.3, 1.1),
        ];
        let polygon = |outline: &[DVec2]| {
            Polygon::new(outline.iter().copied().map(slanted).collect()).expect("a polygon")
        };
        let dart = polygon(&[a, b, c, d]);
        let notch = Triangle([b, d, c].map(slanted));
        let beside = polygon(&[b, e, DVec2::new(0.5, 0.6), d]);
        assert!(!dart.convex && !beside.convex);
        let eye = DVec3::new(0.3, 4.0, -1.0);
        for (from, to) in [(b, c), (c, d), (b, d)] {
            for step in 1..2000 {
                let target = slanted(from.lerp(to, f64::from(step) / 2000.0));
                let ray = Ray::new(Line::new(eye, target - eye), Span::from(0.0));
                let hit = dart.intersect(&ray).or(notch.intersect(&ray));
                assert!(hit.or(beside.intersect(&ray)).is_some(), "leak at {target}");
            }
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
