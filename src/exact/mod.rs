//! Exact answers: whether a line meets a box or a triangle, decided from the numbers as they are given.
//!
//! Every finite `f64` is m 2^e with integers m and e, so that signs of sums and products can be told without any rounding. Two
//! stages, as in Shewchuk (1997, Discrete & Computational Geometry 18:305): arithmetic in `f64` with a proven bound of its error
//! (`filter`), and integers of any length (`integer`) where that cannot decide. Both stages answer the same question with the
//! same verdict; only speed tells them apart.
//!
//! An `f32` is an exact `f64`: converted, the inputs of a kernel in single precision are judged just so.

mod filter;
mod integer;
#[cfg(test)]
mod tests;

use std::cmp::Ordering;

use glam::DVec3;

use crate::geom::Aabb;

/// Whether a line meets a closed box, and how near to a tie that is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Incidence {
    /// Whether they have a point in common; touching is enough.
    pub hit: bool,
    /// Distance from a tie, at least 0: the closest call among the comparisons that make the verdict.
    ///
    /// The line enters the slab of axis i at t = n_i and leaves that of axis j at t = f_j. It meets the box if and only if
    /// n_i <= f_j for every two different axes it is not parallel to. This is the absolute value of the least
    /// (f_j - n_i) / (2^-52 max(|f_j|, |n_i|)). Where the exact interval's ends, the largest n and the least f, are of
    /// two axes, that is their difference in units of the last place of the larger |end|, a unit being 2^-52 of that end (so
    /// between once and twice the distance of neighbouring numbers). For another precision scale it: 2^-29 as much in `f32`.
    ///
    /// Zero means that the verdict hangs on equality. Infinite where nothing is rounded: the line is parallel to two axes, or is
    /// outside a slab that it is parallel to. Right to 1 in 200 (see [`line_box`]).
    pub ulps: f64,
}

/// How a line and a triangle meet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Meeting {
    /// In one point of the triangle, its edges and corners included; the sign of that point's parameter t.
    Hit(Ordering),
    /// Nowhere.
    Miss,
    /// The line lies in the triangle's plane, or the triangle has no area and some plane holds it and the line.
    Coplanar,
}

/// How a line and a triangle meet, and how near to a tie that is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// How they meet.
    pub meeting: Meeting,
    /// Distance from a tie, at least 0: about how far the corners would have to move for another verdict, in units of the last place of
    /// their distance from the line's origin.
    ///
    /// With the corners A, B, C relative to the line's origin and its direction d, the edge functions are d.(B x C), d.(C x A) and
    /// d.(A x B). The unit of d.(B x C) is 2^-52 r (|d x B|_1 + |d x C|_1), r = max(|B|_inf, |C|_inf): the most that it changes, to
    /// first order, when every coordinate of B and C moves by up to 2^-52 r, as d.(δ x C) = δ.(C x d) and d.(B x δ) = δ.(d x B). The
    /// length of d x B is the distance of B from the line, times that of d; so a small triangle far away has as small a unit as its
    /// size allows, and an edge function is never more than 2^51 units.
    ///
    /// A hit (no two edge functions of opposite sign) is as far from a tie as the least of them. A miss is as far as the positive ones
    /// or the negative ones, whichever is nearer to being gone: the lesser of the two signs' largest. Zero for [`Meeting::Coplanar`].
    /// For another precision scale it, as [`Incidence::ulps`]. Without underflow the kernels' test of triangles errs below 4
    /// units only, in either precision: `tests/watertight.rs` has the proof.
    pub ulps: f64,
}

/// Whether the whole line `origin + t direction` meets the closed box, exactly, and its distance from a tie.
///
/// A direction part of zero (of either sign) asks for `lo <= origin <= hi`; any other, however small, is taken as it is. `direction`
/// must not be zero, every number must be finite, and `b` must have `lo <= hi`. The distance is right to 1 in 200 where it exceeds
/// 2,040, and to some 1e-15 of itself below.
pub fn line_box(origin: DVec3, direction: DVec3, b: &Aabb) -> Incidence {
    debug_assert!(origin.is_finite() && direction.is_finite() && direction != DVec3::ZERO);
    debug_assert!(b.is_valid());
    filter::line_box(origin, direction, b)
        .unwrap_or_else(|| integer::line_box(origin, direction, b))
}

/// How the whole line `origin + t direction` meets the triangle, exactly, and its distance from a tie, as in [`line_box`].
///
/// Signs of d.(B x C), d.(C x A), d.(A x B): none negative or none positive, and not all zero, is a hit; then t has the sign of
/// A.(B x C) over their sum. `direction` must not be zero, and every number must be finite.
pub fn line_triangle(origin: DVec3, direction: DVec3, corners: &[DVec3; 3]) -> Crossing {
    debug_assert!(origin.is_finite() && direction.is_finite() && direction != DVec3::ZERO);
    debug_assert!(corners.iter().all(|c| c.is_finite()));
    filter::line_triangle(origin, direction, corners)
        .unwrap_or_else(|| integer::line_triangle(origin, direction, corners))
}

/// The two axes that follow each axis in turn.
const OTHERS: [[usize; 2]; 3] = [[1, 2], [2, 0], [0, 1]];

/// Distance of a miss from a tie, from the edge functions in their units: see [`Crossing::ulps`].
fn nearest_agreement(edges: [f64; 3]) -> f64 {
    let largest = |sign: f64| edges.iter().map(|e| sign * e).fold(0.0, f64::max);
    largest(1.0).min(largest(-1.0))
}
