//! Planar polygons, convex or not, by the even-odd rule.

use std::f64::consts::TAU;
use std::ops::RangeInclusive;

use glam::{DVec2, DVec3};

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

/// A point in the ray's own frame, seen along the ray.
#[inline]
fn flat(ray: &Ray, p: &DVec3) -> DVec2 {
    let [x, y, _] = ray.sheared(p);
    DVec2::new(x, y)
}

/// Whether the ray, the origin of its own frame, lies on no edge's wrong side: inside a convex polygon, or on its edges. `false` if all edges lie on
/// one line with it.
#[inline]
fn one_sided(corners: &[DVec3], ray: &Ray) -> bool {
    let (mut negative, mut positive) = (false, false);
    let mut a = flat(ray, &corners[corners.len() - 1]);
    for &corner in corners {
        let b = flat(ray, &corner);
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
    let mut height = ray.sheared_height(&before);
    for &corner in corners {
        let (from, low) = (before, height);
        (before, height) = (corner, ray.sheared_height(&corner));
        if (low > 0.0 && height > 0.0) || (low < 0.0 && height < 0.0) {
            continue;
        }
        let [a, b] = [from, corner].map(|p| flat(ray, &p));
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
mod tests;
