//! Lines (rays that never stop), rays, and spans of their parameter t.

use glam::DVec3;

use super::{Aabb, Axis, Real, Vector};

/// What a plane's parameter is widened by: `padding * |t|`; nothing for no padding, and never infinite: a t that has overflowed stays
/// where it is, beyond all others.
#[inline(always)]
pub fn slack<T: Real>(padding: T, t: T) -> T {
    // 0 * inf and inf - inf are NaN, which would pass over the plane.
    let slack = padding * t.abs();
    if padding == T::ZERO {
        T::ZERO
    } else if slack < T::MAX {
        slack
    } else {
        T::MAX
    }
}

/// A closed range of the parameter t.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span<T = f64> {
    /// Lower end.
    pub t0: T,
    /// Upper end.
    pub t1: T,
}

impl<T: Real> Span<T> {
    /// All of the line.
    pub const FULL: Self = Self {
        t0: T::NEG_INFINITY,
        t1: T::INFINITY,
    };

    /// From `t0` on: a ray that never stops.
    pub const fn from(t0: T) -> Self {
        Self {
            t0,
            t1: T::INFINITY,
        }
    }
}

/// The points `origin + t direction` for every t: the SAH's own ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line<V = DVec3> {
    /// Point at t = 0.
    pub origin: V,
    /// Direction, not necessarily of unit length; never zero. A part whose reciprocal overflows is 0: see [`Line::new`].
    pub direction: V,
    /// Reciprocal of each direction part; 0 where the line counts as parallel (see [`Line::is_parallel`]).
    pub inverse: V,
}

impl<V: Vector> Line<V> {
    /// A line through `origin`. Both must be finite, and the reciprocal of at least one part of `direction` too.
    ///
    /// A direction part whose reciprocal overflows (up to about 2^-1024 in `f64`, 2^-128 in `f32`) is kept as 0: the line that is meant
    /// is the one with that part 0, for every test alike.
    #[inline]
    pub fn new(origin: V, direction: V) -> Self {
        debug_assert!((0..3).all(|k| origin[k].is_finite() && direction[k].is_finite()));
        // Three calls, not an array's `map`: that is not inlined.
        let part = |k: Axis| {
            let reciprocal = V::Real::ONE / direction[k];
            if reciprocal.is_finite() {
                (direction[k], reciprocal)
            } else {
                (V::Real::ZERO, V::Real::ZERO)
            }
        };
        let (x, y, z) = (part(0), part(1), part(2));
        debug_assert!([x, y, z].iter().any(|part| part.0 != V::Real::ZERO));
        Self {
            origin,
            direction: [x.0, y.0, z.0].into(),
            inverse: [x.1, y.1, z.1].into(),
        }
    }

    /// Whether the line is parallel to the planes `x[axis] = const`: its direction part is zero, or was so small that the
    /// reciprocal overflows.
    #[inline]
    pub fn is_parallel(&self, axis: Axis) -> bool {
        self.inverse.parts()[axis] == V::Real::ZERO
    }

    /// Parameter at which the line crosses the plane `x[axis] = s`; the line must not be parallel to it.
    #[inline]
    pub fn t_at(&self, axis: Axis, s: V::Real) -> V::Real {
        (s - self.origin.parts()[axis]) * self.inverse.parts()[axis]
    }

    /// Whether any of the three direction parts counts as zero.
    #[inline]
    pub fn is_axis_parallel(&self) -> bool {
        (0..3).any(|k| self.is_parallel(k))
    }

    /// Which of the eight octants the direction points into: bit k is set where part k is negative.
    #[inline]
    pub fn octant(&self) -> usize {
        let negative = |k: Axis| usize::from(self.inverse[k] < V::Real::ZERO) << k;
        negative(0) | negative(1) | negative(2)
    }
}

impl Line {
    /// The point at t.
    pub fn at(&self, t: f64) -> DVec3 {
        self.origin + t * self.direction
    }
}

/// A ray's own frame, in which it runs along z: the constants of the watertight triangle test.
///
/// The shear maps the ray to the z axis (Woop, Benthin, Wald 2013, JCGT 2(1)): the direction's largest part becomes z.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Frame<T> {
    /// The line's origin in the order of these axes.
    pub origin: [T; 3],
    /// Shear in x and y, scale in z.
    pub shear: [T; 3],
    /// The axis that becomes x, that which becomes y, and that which becomes z, in an order that keeps the winding; and 0,
    /// so that these are a word without padding.
    pub axes: [u8; 4],
}

/// A line with a range of t and the constants of the watertight triangle test: what object tests take.
///
/// ```
/// use glam::DVec3;
/// use sahlab::geom::{Line, Ray, Span, Triangle};
///
/// let triangle = Triangle([DVec3::ZERO, DVec3::X, DVec3::Y]);
/// let line = Line::new(DVec3::new(0.25, 0.25, 3.0), DVec3::NEG_Z);
/// assert_eq!(triangle.intersect(&Ray::new(line, Span::from(0.0))), Some(3.0));
/// // A ray that ends before the triangle misses it.
/// assert_eq!(triangle.intersect(&Ray::new(line, Span { t0: 0.0, t1: 2.0 })), None);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Ray<V: Vector = DVec3> {
    /// The line.
    pub line: Line<V>,
    /// Hits outside this range do not count; both ends do.
    pub span: Span<V::Real>,
    /// The ray's own frame.
    pub frame: Frame<V::Real>,
}

impl<V: Vector> Ray<V> {
    /// The part of `line` with t in `span`.
    pub fn new(line: Line<V>, span: Span<V::Real>) -> Self {
        let d = line.direction;
        let [x, y, z] = [0, 1, 2].map(|k| d[k].abs());
        let kz = if x >= y && x >= z {
            0
        } else if y >= z {
            1
        } else {
            2
        };
        let (mut kx, mut ky) = ((kz + 1) % 3, (kz + 2) % 3);
        if d[kz] < V::Real::ZERO {
            std::mem::swap(&mut kx, &mut ky);
        }
        let frame = Frame {
            origin: [kx, ky, kz].map(|k| line.origin[k]),
            shear: [d[kx] / d[kz], d[ky] / d[kz], V::Real::ONE / d[kz]],
            axes: [kx, ky, kz, 0].map(|k| k as u8),
        };
        Self { line, span, frame }
    }

    /// A point in the ray's own frame: relative to the origin, sheared so that the ray runs along z with z = t.
    #[inline(always)]
    pub(super) fn sheared(&self, p: &V) -> [V::Real; 3] {
        let (p, frame) = (p.parts(), &self.frame);
        let [kx, ky, kz, _] = frame.axes.map(usize::from);
        let z = p[kz] - frame.origin[2];
        [
            (p[kx] - frame.origin[0]) - frame.shear[0] * z,
            (p[ky] - frame.origin[1]) - frame.shear[1] * z,
            frame.shear[2] * z,
        ]
    }

    /// The ray's span of an object's own box, widened as in tracing; `None` if it misses the box, or if none of that span
    /// is in the ray's range. A hit kept inside is found through any tree.
    #[inline]
    pub(super) fn within(&self, own: &Aabb<V>) -> Option<Span<V::Real>> {
        let span = own.clip_conservative(&self.line, Span::FULL)?;
        (span.t0 <= self.span.t1 && span.t1 >= self.span.t0).then_some(span)
    }

    /// Whether t lies in the ray's range.
    #[inline]
    pub(super) fn covers(&self, t: V::Real) -> bool {
        self.span.t0 <= t && t <= self.span.t1
    }
}

impl Ray {
    /// The second coordinate of [`sheared`](Self::sheared) alone, bit for bit.
    #[inline]
    pub(super) fn sheared_height(&self, p: &DVec3) -> f64 {
        let (p, frame) = (p.parts(), &self.frame);
        let [_, ky, kz, _] = frame.axes.map(usize::from);
        (p[ky] - frame.origin[1]) - frame.shear[1] * (p[kz] - frame.origin[2])
    }
}
