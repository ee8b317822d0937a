//! The first stage: `f64` arithmetic that answers where its error, bounded beforehand, cannot matter.
//!
//! u = 2^-53 is the largest relative error of one operation whose result is in the normal range; n of them in a row are off by at
//! most gamma(n) = n u / (1 - n u) (Higham 2002, section 3.1). Each bound below is a few units of 2^-52 = 2 u, and the stage answers
//! only from [`CERTAIN`] units on: the excess leaves the distances from a tie right to 1 in 200, so that whoever asks "nearer than
//! 8?" or "nearer than 1,000?" is told the same by both stages.

use std::cmp::Ordering;

use glam::DVec3;

use super::{Crossing, Incidence, Meeting, OTHERS, nearest_agreement};
use crate::geom::Aabb;

/// Distance from a tie, in its units, from which a sign is taken as certain.
const CERTAIN: f64 = 2048.0;

/// Parameters t within this range and its reciprocal are worked with: no difference of two, and no 2^-52 of one, underflows.
const LARGEST_T: f64 = f64::from_bits((1023 + 900) << 52);

/// Factors are within this range and its reciprocal, so that products of four neither underflow nor overflow, be they of two
/// differences of products: where two products are 0 or at least 2^-400, so is their difference 0 or at least 2^-452.
const LARGEST_FACTOR: f64 = f64::from_bits((1023 + 200) << 52);

/// As [`super::line_box`], or `None` if rounding could matter.
///
/// n and f are quotients of a rounded difference of inputs: (b - o)(1 + e1) / d (1 + e2), each |e| <= u, hence off by at most
/// gamma(2) of themselves. A difference of inputs does not underflow (it is a multiple of the smallest number there is), a
/// quotient is kept only in a safe range or as the exact zero it is. With M = max(|n|, |f|), the computed f - n is off by at most
/// 2 gamma(2) M + u 2 M (1 + gamma(2)) < 7 u M = 3.5 units of M: a distance beyond [`CERTAIN`] has the right sign.
pub(super) fn line_box(origin: DVec3, direction: DVec3, b: &Aabb) -> Option<Incidence> {
    let mut ends = [(f64::NEG_INFINITY, f64::INFINITY); 3];
    for k in 0..3 {
        let (o, d) = (origin[k], direction[k]);
        if d == 0.0 {
            if o < b.lo[k] || o > b.hi[k] {
                return Some(Incidence {
                    hit: false,
                    ulps: f64::INFINITY,
                });
            }
            continue;
        }
        let (near, far) = if d > 0.0 {
            (b.lo[k], b.hi[k])
        } else {
            (b.hi[k], b.lo[k])
        };
        ends[k] = (parameter(near - o, d)?, parameter(far - o, d)?);
    }
    let mut least = f64::INFINITY;
    for (i, others) in OTHERS.iter().enumerate() {
        let near = ends[i].0;
        for far in others.map(|j| ends[j].1) {
            // An axis that the line is parallel to has no say.
            if near.is_finite() && far.is_finite() {
                let largest = near.abs().max(far.abs());
                if largest == 0.0 {
                    return None;
                }
                least = least.min((far - near) / (f64::EPSILON * largest));
            }
        }
    }
    (least.abs() > CERTAIN).then_some(Incidence {
        hit: least > 0.0,
        ulps: least.abs(),
    })
}

/// `difference / direction`, if that is zero or far from under- and overflow.
fn parameter(difference: f64, direction: f64) -> Option<f64> {
    let t = difference / direction;
    let safe = difference == 0.0 || (LARGEST_T.recip()..=LARGEST_T).contains(&t.abs());
    safe.then_some(t)
}

/// As [`super::line_triangle`], or `None` if rounding could matter.
pub(super) fn line_triangle(
    origin: DVec3,
    direction: DVec3,
    corners: &[DVec3; 3],
) -> Option<Crossing> {
    let [a, b, c] = corners.map(|corner| corner - origin);
    // A.(B x C) = A.((B - A) x (C - A)), whose products are smaller where the triangle is small.
    let [side, other] = [corners[1] - corners[0], corners[2] - corners[0]];
    if ![direction, a, b, c, side, other].into_iter().all(is_safe) {
        return None;
    }
    let edges = edge_functions(direction, [a, b, c]);
    let [sure_u, sure_v, sure_w] = edges.map(sure_sign);
    let signs = [sure_u, sure_v, sure_w];
    // One that is unsure is below those that are sure, up to the same 1 in 200: it changes no largest one.
    if signs.contains(&Some(Ordering::Less)) && signs.contains(&Some(Ordering::Greater)) {
        return Some(Crossing {
            meeting: Meeting::Miss,
            ulps: nearest_agreement(edges),
        });
    }
    let sign = sure_u?;
    if sure_v? != sign || sure_w? != sign {
        return None;
    }
    let height = sure_sign(triple(a, side, other))?;
    let behind = height != sign;
    Some(Crossing {
        meeting: Meeting::Hit(if behind {
            Ordering::Less
        } else {
            Ordering::Greater
        }),
        ulps: edges
            .map(f64::abs)
            .into_iter()
            .fold(f64::INFINITY, f64::min),
    })
}

/// Whether such factors meet the conditions of [`LARGEST_FACTOR`]; an exact zero does no harm.
fn is_safe(v: DVec3) -> bool {
    let safe = |x: f64| x == 0.0 || (LARGEST_FACTOR.recip()..=LARGEST_FACTOR).contains(&x.abs());
    v.to_array().into_iter().all(safe)
}

/// The edge functions d.(B x C), d.(C x A), d.(A x B) of corners relative to the line's origin, in their units: see
/// [`Crossing::ulps`].
///
/// Products of d, B and C are off by u of their own size, however near the corners are to the line. But as (d x B) x (d x C) =
/// d (d.(B x C)), two parts i, j of m = d x B and n = d x C will do, whose products are small where the corners are near:
///
/// d.(B x C) = (m_i n_j - m_j n_i) / d_k, d_k being the largest part of d, D = |d_k|.
///
/// To first order, with S = |m|_1 + |n|_1 and so the unit 2 u r S:
/// - B is off by u of each part, its products with d by u again, their difference by u of itself; a part of m is at most 2 D r. So it is
///   off by 4 u D r + u |m_i| <= 6 u D r, and S by 24 u D r + 6 u S.
/// - m_i n_j and m_j n_i are off by 4 u D r times their four factors, 4 u D r S at most, and each by 3 u of itself, two for
///   the factors and one for the product. Both are at most D r S together (|m_i n_j| is at most 2 D r |m_i| and 2 D r |n_j|), so
///   that the difference is off by 7 u D r S: 3.5 units. The rest, by 8 u of the quotient, is as nothing, and so is what is of second
///   order, 72 (u D r)^2 (see below).
///
/// The quotient is at most S^2 / (4 D). Where it is beyond [`CERTAIN`] = 2^11 units, S is thus beyond 2^14 u D r, so that S is off by
/// 24 / 2^14 < 1 in 680 and the quotient by 3.5 / 2^11 < 1 in 580 of themselves. That holds for the exact numbers and for those
/// computed alike: each is within 1 in 300 of the other if either is beyond. Beyond, the sign is right.
fn edge_functions(d: DVec3, corners: [DVec3; 3]) -> [f64; 3] {
    let k = d.abs().max_position();
    let [i, j] = OTHERS[k];
    let [a, b, c] = corners.map(|p| {
        let moment = d.cross(p);
        let distance = moment.abs().element_sum();
        (moment, distance, p.abs().max_element())
    });
    [(b, c), (c, a), (a, b)].map(|((m, near_m, r_m), (n, near_n, r_n))| {
        let unit = f64::EPSILON * r_m.max(r_n) * (near_m + near_n);
        if unit == 0.0 {
            // Both corners lie on the line, as far as can be told.
            return 0.0;
        }
        // One quotient: that by d_k alone could underflow.
        (m[i] * n[j] - m[j] * n[i]) / (unit * d[k])
    })
}

/// p.(q x r) in units of 2^-52 of its permanent, the sum of the absolute values of its products; 0 if they are all 0.
///
/// At most eight roundings lead from the inputs to any term of the sum: up to three of differences of points, two products, the
/// difference in the cross product, and two sums. The computed value is therefore off by at most gamma(8) of the exact permanent, and
/// the computed permanent, all of whose terms are positive, by gamma(8) of itself: less than 9 u = 4.5 units in all.
fn triple(p: DVec3, q: DVec3, r: DVec3) -> f64 {
    let (size_p, size_q, size_r) = (p.abs(), q.abs(), r.abs());
    let (mut value, mut permanent) = (0.0, 0.0);
    for (k, [i, j]) in OTHERS.into_iter().enumerate() {
        value += p[k] * (q[i] * r[j] - q[j] * r[i]);
        permanent += size_p[k] * (size_q[i] * size_r[j] + size_q[j] * size_r[i]);
    }
    if permanent == 0.0 {
        return 0.0;
    }
    value / (f64::EPSILON * permanent)
}

/// The sign of a distance from zero, if it is certain.
fn sure_sign(distance: f64) -> Option<Ordering> {
    let sign = distance.partial_cmp(&0.0);
    sign.filter(|_| distance.abs() > CERTAIN)
}
