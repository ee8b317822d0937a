//! The number types that kernels are written for: one source, an instance each for `f64` and `f32`.

use std::fmt::Debug;
use std::ops::{Add, Div, Index, Mul, Sub};

use glam::{DVec3, Vec3};

use super::Axis;

/// A floating-point number.
pub trait Real:
    Copy
    + Debug
    + Default
    + PartialOrd
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
{
    /// 0.
    const ZERO: Self;
    /// 1.
    const ONE: Self;
    /// The largest finite number.
    const MAX: Self;
    /// +inf.
    const INFINITY: Self;
    /// -inf.
    const NEG_INFINITY: Self;
    /// Relative widening of plane parameters when tracing: 6 units in the last place.
    ///
    /// A computed t is off by at most gamma(3) = 1.5 units, so that twice that and the rounding of the widening itself are
    /// covered on both sides. Closed tests with this padding gave no mismatch against brute force on degenerate rays;
    /// counting uses none.
    const PADDING: Self;

    /// Absolute value.
    fn abs(self) -> Self;
    /// The lesser of two; the other one if one is not a number.
    fn min(self, other: Self) -> Self;
    /// The greater of two; the other one if one is not a number.
    fn max(self, other: Self) -> Self;
    /// The nearest number within a closed range.
    fn clamp(self, least: Self, most: Self) -> Self;
    /// Whether it is neither infinite nor NaN.
    fn is_finite(self) -> bool;
    /// The same number in double precision.
    fn to_f64(self) -> f64;
}

/// Three of them: a point or a direction.
pub trait Vector:
    Copy
    + Debug
    + PartialEq
    + From<[Self::Real; 3]>
    + Index<Axis, Output = Self::Real>
    + Sub<Output = Self>
{
    /// The type of its parts.
    type Real: Real;

    /// Its parts in memory: read by an axis that is not known beforehand, they need no branch.
    fn parts(&self) -> &[Self::Real; 3];

    /// The lesser of each pair of parts.
    fn min(self, other: Self) -> Self;
    /// The greater of each pair of parts.
    fn max(self, other: Self) -> Self;
}

macro_rules! precision {
    ($real:ident, $vector:ty) => {
        impl Real for $real {
            const ZERO: Self = 0.0;
            const ONE: Self = 1.0;
            const MAX: Self = $real::MAX;
            const INFINITY: Self = $real::INFINITY;
            const NEG_INFINITY: Self = $real::NEG_INFINITY;
            const PADDING: Self = 6.0 * $real::EPSILON;

            #[inline(always)]
            fn abs(self) -> Self {
                self.abs()
            }

            #[inline(always)]
            fn min(self, other: Self) -> Self {
                self.min(other)
            }

            #[inline(always)]
            fn max(self, other: Self) -> Self {
                self.max(other)
            }

            #[inline(always)]
            fn clamp(self, least: Self, most: Self) -> Self {
                self.clamp(least, most)
            }

            #[inline(always)]
            fn is_finite(self) -> bool {
                self.is_finite()
            }

            #[inline(always)]
            fn to_f64(self) -> f64 {
                self.into()
            }
        }

        impl Vector for $vector {
            type Real = $real;

            #[inline(always)]
            fn parts(&self) -> &[$real; 3] {
                self.as_ref()
            }

            #[inline(always)]
            fn min(self, other: Self) -> Self {
                self.min(other)
            }

            #[inline(always)]
            fn max(self, other: Self) -> Self {
                self.max(other)
            }
        }
    };
}

precision!(f64, DVec3);
precision!(f32, Vec3);
