//! Lines (rays that never stop), rays, and spans of their parameter t.

use glam::DVec3;

use super::{Aabb, Axis};

/// Relative widening of plane parameters when tracing: 6 units in the last place.
///
/// Closed tests with this padding gave no mismatch against brute force on degenerate rays; counting uses none.
pub const PADDING: f64 = 6.0 * f64::EPSILON;

/// What a plane's parameter is widened by: `padding * |t|`; nothing for no padding, even where t has overflowed.
#[inline(always)]
pub fn slack(padding: f64, t: f64) -> f64 {
    // 0 * inf is NaN, which would pass over the plane.
    if padding == 0.0 {
        0.0
    } else {
        padding * t.abs()
    }
}

/// A closed range of the parameter t.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    /// Lower end.
    pub t0: f64,
    /// Upper end.
    pub t1: f64,
}

impl Span {
    /// All of the line.
    pub const FULL: Self = Self {
        t0: f64::NEG_INFINITY,
        t1: f64::INFINITY,
    };

    /// From `t0` on: a ray that never stops.
    pub const fn from(t0: f64) -> Self {
        Self {
            t0,
            t1: f64::INFINITY,
        }
    }
}

/// The points `origin + t direction` for every t: the SAH's own ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// Point at t = 0.
    pub origin: DVec3,
    /// Direction, not necessarily of unit length; never zero.
    pub direction: DVec3,
    /// Reciprocal of each direction part; 0 where the line counts as parallel (see [`Line::is_parallel`]).
    pub inverse: DVec3,
}

impl Line {
    /// A line through `origin`. `direction` must not be zero; both must be finite.
    pub fn new(origin: DVec3, direction: DVec3) -> Self {
        debug_assert!(origin.is_finite() && direction.is_finite() && direction != DVec3::ZERO);
        let reciprocal = direction.recip();
        let inverse = DVec3::select(reciprocal.is_finite_mask(), reciprocal, DVec3::ZERO);
        Self {
            origin,
            direction,
            inverse,
        }
    }

    /// Whether the line is parallel to the planes `x[axis] = const`: its direction part is zero, or so small that the
    /// reciprocal overflows.
    #[inline]
    pub fn is_parallel(&self, axis: Axis) -> bool {
        self.inverse[axis] == 0.0
    }

    /// Whether any of the three direction parts counts as zero.
    #[inline]
    pub fn is_axis_parallel(&self) -> bool {
        self.inverse.cmpeq(DVec3::ZERO).any()
    }

    /// Parameter at which the line crosses the plane `x[axis] = s`; the line must not be parallel to it.
    #[inline]
    pub fn t_at(&self, axis: Axis, s: f64) -> f64 {
        (s - self.origin[axis]) * self.inverse[axis]
    }

    /// The point at t.
    pub fn at(&self, t: f64) -> DVec3 {
        self.origin + t * self.direction
    }

    /// Which of the eight octants the direction points into: bit k is set where part k is negative.
    #[inline]
    pub fn octant(&self) -> usize {
        let d = self.inverse;
        usize::from(d.x < 0.0) | usize::from(d.y < 0.0) << 1 | usize::from(d.z < 0.0) << 2
    }
}

/// A line with a range of t and the constants of the watertight triangle test: what object tests take.
///
/// The shear maps the ray to the z axis (Woop, Benthin, Wald 2013, JCGT 2(1)): the direction's largest part becomes z.
#[derive(Clone, Copy, Debug)]
pub struct Ray {
    /// The line.
    pub line: Line,
    /// Hits outside this range do not count; both ends do.
    pub span: Span,
    /// The axis that becomes z, preceded by the two others in an order that keeps the winding.
    pub(super) axes: [Axis; 3],
    /// Shear in x and y, scale in z.
    pub(super) shear: DVec3,
}

impl Ray {
    /// The part of `line` with t in `span`.
    pub fn new(line: Line, span: Span) -> Self {
        let d = line.direction;
        let magnitude = d.abs();
        let kz = if magnitude.x >= magnitude.y && magnitude.x >= magnitude.z {
            0
        } else if magnitude.y >= magnitude.z {
            1
        } else {
            2
        };
        let (mut kx, mut ky) = ((kz + 1) % 3, (kz + 2) % 3);
        if d[kz] < 0.0 {
            std::mem::swap(&mut kx, &mut ky);
        }
        Self {
            line,
            span,
            axes: [kx, ky, kz],
            shear: DVec3::new(d[kx] / d[kz], d[ky] / d[kz], 1.0 / d[kz]),
        }
    }

    /// A point in the ray's own frame: relative to the origin, sheared so that the ray runs along z with z = t.
    #[inline]
    pub(super) fn sheared(&self, p: DVec3) -> DVec3 {
        let q = p - self.line.origin;
        let [kx, ky, kz] = self.axes;
        DVec3::new(
            q[kx] - self.shear.x * q[kz],
            q[ky] - self.shear.y * q[kz],
            self.shear.z * q[kz],
        )
    }

    /// The second coordinate of [`sheared`](Self::sheared) alone, bit for bit.
    #[inline]
    pub(super) fn sheared_height(&self, p: DVec3) -> f64 {
        let [_, ky, kz] = self.axes;
        let o = self.line.origin;
        (p[ky] - o[ky]) - self.shear.y * (p[kz] - o[kz])
    }

    /// The ray's span of an object's own box, widened as in tracing; `None` if it misses the box, or if none of that span
    /// is in the ray's range. A hit kept inside is found through any tree.
    #[inline]
    pub(super) fn within(&self, own: &Aabb) -> Option<Span> {
        let span = own.clip_conservative(&self.line, Span::FULL)?;
        (span.t0 <= self.span.t1 && span.t1 >= self.span.t0).then_some(span)
    }

    /// Whether t lies in the ray's range.
    #[inline]
    pub(super) fn covers(&self, t: f64) -> bool {
        self.span.t0 <= t && t <= self.span.t1
    }
}
