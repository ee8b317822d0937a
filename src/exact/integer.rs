//! The second stage: integers of any length, with addition, subtraction, multiplication and comparison alone.

use std::array;
use std::cmp::Ordering;

use dashu_int::IBig;
use dashu_int::ops::{Abs, BitTest};
use glam::DVec3;

use super::{Crossing, Incidence, Meeting, OTHERS, nearest_agreement};
use crate::geom::Aabb;

/// As [`super::line_box`]: t of each plane is kept as a fraction with a positive denominator.
///
/// Positions share one power of two and direction parts another: that scales every t alike, which no comparison notices.
pub(super) fn line_box(origin: DVec3, direction: DVec3, b: &Aabb) -> Incidence {
    let [o, lo, hi] = scaled([origin, b.lo, b.hi]);
    let [d] = scaled([direction]);
    let mut least = f64::INFINITY;
    let mut hit = true;
    for k in 0..3 {
        if d[k] == IBig::ZERO && (o[k] < lo[k] || o[k] > hi[k]) {
            return Incidence {
                hit: false,
                ulps: f64::INFINITY,
            };
        }
    }
    // Numerators of where each slab begins and ends; the denominator is |d|.
    let ends: [(IBig, IBig); 3] = array::from_fn(|k| {
        if d[k] > IBig::ZERO {
            (&lo[k] - &o[k], &hi[k] - &o[k])
        } else {
            (&o[k] - &hi[k], &o[k] - &lo[k])
        }
    });
    let size = d.map(Abs::abs);
    for (i, others) in OTHERS.into_iter().enumerate() {
        for j in others {
            if size[i] == IBig::ZERO || size[j] == IBig::ZERO {
                continue;
            }
            let near = &ends[i].0 * &size[j];
            let far = &ends[j].1 * &size[i];
            let gap = &far - &near;
            hit &= gap >= IBig::ZERO;
            least = least.min(units(&gap, &near.abs().max(far.abs())));
        }
    }
    Incidence {
        hit,
        ulps: least.abs(),
    }
}

/// As [`super::line_triangle`].
pub(super) fn line_triangle(origin: DVec3, direction: DVec3, corners: &[DVec3; 3]) -> Crossing {
    let [o, a, b, c] = scaled([origin, corners[0], corners[1], corners[2]]);
    let [a, b, c] = [a, b, c].map(|p| array::from_fn(|k| &p[k] - &o[k]));
    let [d] = scaled([direction]);
    let edges = [(&b, &c), (&c, &a), (&a, &b)].map(|(p, q)| edge(&d, p, q));
    let signs = edges.each_ref().map(|e| e.0.cmp(&IBig::ZERO));
    let distances = edges.each_ref().map(|(value, unit)| units(value, unit));
    let [positive, negative] =
        [Ordering::Greater, Ordering::Less].map(|sign| signs.contains(&sign));
    match (positive, negative) {
        (true, true) => Crossing {
            meeting: Meeting::Miss,
            ulps: nearest_agreement(distances),
        },
        (false, false) => Crossing {
            meeting: Meeting::Coplanar,
            ulps: 0.0,
        },
        _ => {
            let height = dot(&a, &cross(&b, &c)).cmp(&IBig::ZERO);
            Crossing {
                meeting: Meeting::Hit(if positive { height } else { height.reverse() }),
                ulps: distances
                    .map(f64::abs)
                    .into_iter()
                    .fold(f64::INFINITY, f64::min),
            }
        }
    }
}

/// d.(p x q), and 2^52 of its units: see [`Crossing::ulps`].
fn edge(d: &[IBig; 3], p: &[IBig; 3], q: &[IBig; 3]) -> (IBig, IBig) {
    let [about_p, about_q] = [cross(d, p), cross(d, q)];
    let value = dot(&about_p, q);
    let reach = p.iter().chain(q).map(Abs::abs).max().unwrap_or_default();
    let distances = about_p.iter().chain(&about_q).map(Abs::abs);
    (value, reach * distances.sum::<IBig>())
}

fn dot(p: &[IBig; 3], q: &[IBig; 3]) -> IBig {
    p.iter().zip(q).map(|(x, y)| x * y).sum()
}

fn cross(p: &[IBig; 3], q: &[IBig; 3]) -> [IBig; 3] {
    OTHERS.map(|[i, j]| &p[i] * &q[j] - &p[j] * &q[i])
}

/// The vectors as integers, all times the same power of two.
fn scaled<const N: usize>(vectors: [DVec3; N]) -> [[IBig; 3]; N] {
    let parts = vectors.map(|v| v.to_array().map(significand_and_exponent));
    let nonzero = parts.as_flattened().iter().filter(|p| p.0 != 0);
    let least = nonzero.map(|p| p.1).min().unwrap_or(0);
    parts.map(|v| {
        v.map(|(significand, exponent)| match significand {
            0 => IBig::ZERO,
            m => IBig::from(m) << (exponent - least) as usize,
        })
    })
}

/// The odd m (or 0) and the e with x = m 2^e.
fn significand_and_exponent(x: f64) -> (i64, i32) {
    let bits = x.to_bits();
    let exponent = (bits >> 52 & 0x7ff) as i32;
    let fraction = (bits & ((1 << 52) - 1)) as i64;
    // A subnormal has no hidden bit, and the exponent of the least normal number.
    let significand = if exponent == 0 {
        fraction
    } else {
        fraction | 1 << 52
    };
    if significand == 0 {
        return (0, 0);
    }
    let shift = significand.trailing_zeros();
    let signed = if x < 0.0 { -significand } else { significand };
    (signed >> shift, exponent.max(1) - 1075 + shift as i32)
}

/// `part / whole` in units of 2^-52, for |part| at most a few times `whole` (an edge function is at most half, as |d.(B x C)| =
/// |B.(C x d)| <= |B|_inf |C x d|_1, and likewise with B x d); 0 if both are.
fn units(part: &IBig, whole: &IBig) -> f64 {
    if *part == IBig::ZERO {
        return 0.0;
    }
    // Enough bits before the division that the quotient keeps 62 of them.
    let shift = (whole.bit_len() + 62).saturating_sub(part.bit_len());
    let quotient = (part << shift) / whole;
    libm::scalbn(quotient.to_f64().value(), 52 - shift as i32)
}
