//! Axis-aligned boxes: closed, possibly flat.

use glam::DVec3;

use super::{Axis, Line, Real, Span, Vector, slack};

/// A closed axis-aligned box. `lo <= hi` holds on every axis; a box may be flat, a segment or a point.
///
/// ```
/// use glam::DVec3;
/// use sahlab::geom::Aabb;
///
/// let cube = Aabb::new(DVec3::ZERO, DVec3::ONE);
/// let (left, _) = cube.split(0, 0.5);
/// // Half of the cube is hit by two thirds of the lines that hit the cube.
/// assert_eq!(left.surface_area() / cube.surface_area(), 4.0 / 6.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb<V = DVec3> {
    /// Lower corner.
    pub lo: V,
    /// Upper corner.
    pub hi: V,
}

impl Aabb {
    /// The box that contains nothing: the neutral element of [`union`](Self::union).
    pub const EMPTY: Self = Self {
        lo: DVec3::INFINITY,
        hi: DVec3::NEG_INFINITY,
    };

    /// The box between two corners.
    pub const fn new(lo: DVec3, hi: DVec3) -> Self {
        Self { lo, hi }
    }

    /// The smallest box around some points.
    pub fn around(points: impl IntoIterator<Item = DVec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, |b, p| Self {
            lo: b.lo.min(p),
            hi: b.hi.max(p),
        })
    }

    /// The smallest box around both.
    pub fn union(self, other: Self) -> Self {
        Self {
            lo: self.lo.min(other.lo),
            hi: self.hi.max(other.hi),
        }
    }

    /// Side lengths.
    pub fn extent(&self) -> DVec3 {
        self.hi - self.lo
    }

    /// The middle.
    pub fn centre(&self) -> DVec3 {
        0.5 * self.lo + 0.5 * self.hi
    }

    /// Areas of one face normal to x, y and z.
    pub fn face_areas(&self) -> DVec3 {
        let e = self.extent();
        DVec3::new(e.y * e.z, e.z * e.x, e.x * e.y)
    }

    /// Full surface area SA = 2(ab + bc + ca); a flat box of area A has SA = 2A.
    pub fn surface_area(&self) -> f64 {
        let f = self.face_areas();
        2.0 * (f.x + f.y + f.z)
    }

    /// Volume.
    pub fn volume(&self) -> f64 {
        let e = self.extent();
        e.x * e.y * e.z
    }

    /// The two parts below and above the plane `x[axis] = s`.
    pub fn split(&self, axis: Axis, s: f64) -> (Self, Self) {
        let (mut left, mut right) = (*self, *self);
        left.hi[axis] = s;
        right.lo[axis] = s;
        (left, right)
    }

    /// Whether `other` lies inside, faces included.
    pub fn contains(&self, other: &Self) -> bool {
        self.lo.cmple(other.lo).all() && self.hi.cmpge(other.hi).all()
    }

    /// Whether all six numbers are finite and in order.
    pub fn is_valid(&self) -> bool {
        self.lo.is_finite() && self.hi.is_finite() && self.lo.cmple(self.hi).all()
    }
}

impl<V: Vector> Aabb<V> {
    /// The part of `span` for which the line is in the closed box, or `None`: the slab test used for counting.
    ///
    /// A direction part of zero is a containment test, so no 0 * inf arises; otherwise the near plane is told by the
    /// direction's sign. The arithmetic is `(plane - origin) * inverse`, the same as in tree traversal, so that both
    /// agree bit for bit.
    #[inline]
    pub fn clip(&self, line: &Line<V>, span: Span<V::Real>) -> Option<Span<V::Real>> {
        self.clip_padded(line, span, V::Real::ZERO)
    }

    /// As [`clip`](Self::clip), each plane's t widened by [`Real::PADDING`] of itself: never a wrong miss (for tracing).
    #[inline]
    pub fn clip_conservative(&self, line: &Line<V>, span: Span<V::Real>) -> Option<Span<V::Real>> {
        self.clip_padded(line, span, V::Real::PADDING)
    }

    /// As [`clip`](Self::clip), each plane's t widened by `padding * |t|`.
    #[inline]
    pub fn clip_padded(
        &self,
        line: &Line<V>,
        span: Span<V::Real>,
        padding: V::Real,
    ) -> Option<Span<V::Real>> {
        let Span { mut t0, mut t1 } = span;
        for k in 0..3 {
            if line.is_parallel(k) {
                if line.origin[k] < self.lo[k] || line.origin[k] > self.hi[k] {
                    return None;
                }
                continue;
            }
            let (near, far) = if line.inverse[k] > V::Real::ZERO {
                (self.lo[k], self.hi[k])
            } else {
                (self.hi[k], self.lo[k])
            };
            let near = line.t_at(k, near);
            let far = line.t_at(k, far);
            t0 = t0.max(near - slack(padding, near));
            t1 = t1.min(far + slack(padding, far));
        }
        (t0 <= t1).then_some(Span { t0, t1 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const UNIT: Aabb = Aabb::new(DVec3::ZERO, DVec3::ONE);

    fn hits(b: &Aabb, o: [f64; 3], d: [f64; 3]) -> bool {
        b.clip(&Line::new(o.into(), d.into()), Span::FULL).is_some()
    }

    #[test]
    fn areas_by_hand() {
        let b = Aabb::new(DVec3::ZERO, DVec3::new(2.0, 1.0, 1.0));
        assert_eq!(b.surface_area(), 10.0);
        // Split areas of a 2 x 1 x 1 box: the plane across x is 1/5 of SA (two-sided), across y 2/5.
        assert_eq!(2.0 * b.face_areas().x / b.surface_area(), 0.2);
        assert_eq!(2.0 * b.face_areas().y / b.surface_area(), 0.4);
        let flat = Aabb::new(DVec3::ZERO, DVec3::new(3.0, 2.0, 0.0));
        assert_eq!(flat.surface_area(), 12.0);
    }

    #[test]
    fn touching_lines_hit_and_near_misses_miss() {
        // Parallel to and in a face, an edge; the same with -0.0.
        for zero in [0.0, -0.0] {
            assert!(hits(&UNIT, [0.0, 0.5, -1.0], [zero, zero, 1.0]));
            assert!(hits(&UNIT, [0.0, 0.0, -1.0], [zero, zero, 1.0]));
            assert!(hits(&UNIT, [1.0, 1.0, -1.0], [zero, zero, -1.0]));
            assert!(!hits(
                &UNIT,
                [-f64::from_bits(1), 0.5, -1.0],
                [zero, zero, 1.0]
            ));
        }
        // Through a corner, along the diagonal, and one step beside it.
        assert!(hits(&UNIT, [-1.0; 3], [1.0; 3]));
        assert!(hits(&UNIT, [-1.0, 1.0, 0.0], [1.0, -1.0, 0.0]));
        assert!(!hits(
            &UNIT,
            [-1.0, 1.0 - f64::EPSILON, 0.0],
            [1.0, -1.0, 0.0]
        ));
        // Behind the origin: a line has no start.
        assert!(hits(&UNIT, [2.0, 0.5, 0.5], [1.0, 0.0, 0.0]));
        // A direction part whose reciprocal overflows counts as zero.
        assert!(hits(&UNIT, [0.0, 0.5, -1.0], [f64::from_bits(1), 0.0, 1.0]));
    }

    #[test]
    fn flat_and_point_boxes() {
        let flat = Aabb::new(DVec3::ZERO, DVec3::new(1.0, 1.0, 0.0));
        assert!(hits(&flat, [-1.0, 0.5, 0.0], [1.0, 0.0, 0.0]));
        assert!(hits(&flat, [0.3, 0.4, -1.0], [0.1, 0.2, 1.0]));
        let point = Aabb::new(DVec3::ONE, DVec3::ONE);
        assert!(hits(&point, [0.0; 3], [1.0; 3]));
        assert!(!hits(&point, [0.0; 3], [1.0, 1.0, 1.0 + f64::EPSILON]));
        assert_eq!(point.surface_area(), 0.0);
    }

    #[test]
    fn padding_never_shrinks_the_span() {
        let line = Line::new(DVec3::new(3.0, 0.4, 0.3), DVec3::new(1.0, 0.1, 0.05));
        let exact = UNIT
            .clip(&line, Span::FULL)
            .expect("hit, behind the origin");
        let wide = UNIT.clip_conservative(&line, Span::FULL).expect("hit");
        assert!(exact.t1 < 0.0 && wide.t0 < exact.t0 && wide.t1 > exact.t1);
    }

    /// A plane whose t overflows is beyond every other, padded or not: a box that begins there is missed, one that ends there is not.
    #[test]
    fn overflowing_planes_count_when_padded() {
        let line = Line::new(DVec3::splat(-2.0), DVec3::new(0.5, 2.0, 1e-303));
        let far = Aabb::new(DVec3::new(-9.0, -9.0, 1e16), DVec3::new(9.0, 9.0, 1e75));
        let around = Aabb { lo: -far.hi, ..far };
        for padding in [0.0, f64::PADDING] {
            assert_eq!(far.clip_padded(&line, Span::FULL, padding), None);
            assert!(around.clip_padded(&line, Span::FULL, padding).is_some());
        }
    }
}
