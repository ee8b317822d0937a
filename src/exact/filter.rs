//! The first stage: `f64` arithmetic that answers where its error, bounded beforehand, cannot matter.
//!
//! u = 2^-53 is the largest relative error of one operation whose result is in the normal range; n of them in a row are off by at
//! most gamma(n) = n u / (1 - n u) (Higham 2002, section 3.1). Each bound below needs a few u, and the stage answers only from
//! [`CERTAIN`] units of 2^-52 = 2 u on: the excess leaves the distances from a tie right to 1 in 200, so that whoever asks
//! "nearer than 8?" or "nearer than 1,000?" is told the same by both stages.

use std::cmp::Ordering;

use glam::DVec3;

use super::{Crossing, Incidence, Meeting, OTHERS, nearest_agreement};
use crate::geom::Aabb;

/// Distance, in units of 2^-52 of the terms, from which a sign is taken as certain.
const CERTAIN: f64 = 1024.0;

/// Parameters t within this range and its reciprocal are worked with: no difference of two, and no 2^-52 of one, underflows.
const LARGEST_T: f64 = f64::from_bits((1023 + 900) << 52);

/// Factors of triple products are within this range and its reciprocal, so that products of three are normal.
const LARGEST_FACTOR: f64 = f64::from_bits((1023 + 300) << 52);

/// As [`super::line_box`], or `None` if rounding could matter.
///
/// n and f are quotients of a rounded difference of inputs: (b - o)(1 + e1) / d (1 + e2), each |e| <= u, hence off by at most
/// gamma(2) of themselves. A difference of inputs does not underflow (it is a multiple of the smallest number there is), a
/// quotient is kept only in a safe range or as the exact zero it is. With M = max(|n|, |f|), the computed f - n is off by at most
/// 2 gamma(2) M + u 2 M (1 + gamma(2)) < 7 u M = 3.5 units of M: a distance beyond 1,024 units has the right sign.
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
    if ![direction, a, b, c].into_iter().all(is_safe) {
        return None;
    }
    let edges = [(b, c), (c, a), (a, b)].map(|(p, q)| triple(direction, p, q));
    let [sure_u, sure_v, sure_w] = edges.map(sure_sign);
    let signs = [sure_u, sure_v, sure_w];
    // One that is unsure has a distance below those that are sure, so that it changes no largest one.
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
    let height = sure_sign(triple(a, b, c))?;
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

/// Whether products of three such factors neither underflow nor overflow; an exact zero does no harm.
fn is_safe(v: DVec3) -> bool {
    let safe = |x: f64| x == 0.0 || (LARGEST_FACTOR.recip()..=LARGEST_FACTOR).contains(&x.abs());
    v.to_array().into_iter().all(safe)
}

/// p.(q x r) in units of 2^-52 of its permanent, the sum of the absolute values of its products; 0 if they are all 0.
///
/// At most eight roundings lead from the inputs to any term of the sum: up to three of differences to the origin, two products, the
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

/// The sign of a [`triple`], if it is certain.
fn sure_sign(distance: f64) -> Option<Ordering> {
    let sign = distance.partial_cmp(&0.0);
    sign.filter(|_| distance.abs() > CERTAIN)
}
