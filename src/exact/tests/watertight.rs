//! How near to a tie the kernels' watertight test of triangles (Woop, Benthin & Wald 2013) may err: less than 4 units.
//!
//! With d_z the direction's largest part and S_x = d_x / d_z it takes a corner B, relative to the line's origin, to x = B_x - S_x B_z
//! and likewise y, and compares x_C y_B with y_C x_B. Let u be half a unit of the last place of 1, r and the unit
//! 2 u r (|d x B|_1 + |d x C|_1) those of the edge (see [`Crossing::ulps`]), and L = |x_B| + |y_B| + |x_C| + |y_C|, so that |d_z| L is at
//! most |d x B|_1 + |d x C|_1. To first order, and without underflow:
//! - B_x is off by u of itself, S_x B_z by 3 u (S_x, B_z, the product), their difference by u: x is off by 4 u r + u |x|.
//! - So the products' difference is off by 4 u r L, and by 3 u of each product. These are together at most r L, as |x| <= 2 r, and at
//!   most L^2 / 4. The comparison itself has the right sign, or says equal.
//!
//! Where it errs at k units, 2 k u r L <= L^2 / 4, so that L >= 8 k u r. The second order, 2 (4 u r)^2, is then at most 2 / k units.
//! In units the error is 2 + 1.5 min(1, L / (4 r)) + 16 u r / L, which is convex in L up to 4 r and falls beyond; so k is at most
//! 2 + 2 / k at the least L, which makes k < 2.8, or 3.5 at L = 4 r. An edge function beyond has its sign in the kernel, and with them a hit
//! or a miss beyond is seen as such; the triangle's own box, which the kernel takes larger, excludes no hit.

use glam::Vec3;

use super::aimed::pair;
use super::*;
use crate::geom::{Line, Ray, Span, Triangle, Vector};

/// No wrong verdict lies as far from a tie.
const BOUND: f64 = 4.0;

const CASES: usize = 200_000;

/// The kernel's verdict.
fn kernel<V: Vector>([origin, direction, a, b, c]: [V; 5]) -> bool {
    let ray = Ray::new(Line::new(origin, direction), Span::FULL);
    Triangle([a, b, c]).intersect(&ray).is_some()
}

/// Whether a verdict on origin, direction and corners is wrong, and their distance from a tie in units of `epsilon`.
fn judged(said: bool, [origin, direction, a, b, c]: [DVec3; 5], epsilon: f64) -> (bool, f64) {
    let right = line_triangle(origin, direction, &[a, b, c]);
    let met = matches!(right.meeting, Meeting::Hit(_));
    (said != met, right.ulps * f64::EPSILON / epsilon)
}

/// The farthest from a tie that a wrong verdict lies, and how many are wrong and how many beyond the bound.
fn farthest(verdicts: impl Iterator<Item = (bool, f64)>) -> (f64, usize, usize) {
    verdicts.fold((0.0, 0, 0), |(most, wrong, beyond), (is_wrong, ulps)| {
        let most = if is_wrong { ulps.max(most) } else { most };
        (
            most,
            wrong + usize::from(is_wrong),
            beyond + usize::from(ulps >= BOUND),
        )
    })
}

fn assert_bound((most, wrong, beyond): (f64, usize, usize)) {
    assert!(most < BOUND, "wrong at {most} units");
    // The bound is put to the test: many verdicts lie on either side of it, and it is not far too wide.
    assert!(most > BOUND / 16.0, "{most}");
    assert!(
        wrong > CASES / 50 && beyond > CASES / 10,
        "{wrong}, {beyond}"
    );
}

#[test]
fn in_double_precision_no_verdict_is_wrong_beyond_the_bound() {
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    let verdicts = (0..CASES).filter_map(|_| {
        let (o, d, [a, b, c]) = pair(&mut rng, 8.0, f64::EPSILON);
        let given = [o, d, a, b, c];
        (d != DVec3::ZERO).then(|| judged(kernel(given), given, f64::EPSILON))
    });
    assert_bound(farthest(verdicts));
}

#[test]
fn in_single_precision_no_verdict_is_wrong_beyond_the_bound() {
    let mut rng = ChaCha8Rng::seed_from_u64(6);
    let epsilon = f64::from(f32::EPSILON);
    let verdicts = (0..CASES).filter_map(|_| {
        let (o, d, [a, b, c]) = pair(&mut rng, 5.0, epsilon);
        let given = [o, d, a, b, c].map(|p| p.as_vec3());
        let wide = given.map(Vec3::as_dvec3);
        (given[1] != Vec3::ZERO).then(|| judged(kernel(given), wide, epsilon))
    });
    assert_bound(farthest(verdicts));
}

/// A test by the edge functions as they are written, whose products cancel where triangles are small and far, is found out.
#[test]
fn triple_products_are_wrong_far_beyond_the_bound() {
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    let verdicts = (0..CASES / 10).filter_map(|_| {
        let (o, d, corners) = pair(&mut rng, 8.0, f64::EPSILON);
        let [a, b, c] = corners.map(|p| p - o);
        let edges = [(b, c), (c, a), (a, b)].map(|(p, q)| d.dot(p.cross(q)));
        let met = edges.iter().all(|&e| e >= 0.0) || edges.iter().all(|&e| e <= 0.0);
        let [a, b, c] = corners;
        (d != DVec3::ZERO).then(|| judged(met, [o, d, a, b, c], f64::EPSILON))
    });
    let (most, ..) = farthest(verdicts);
    assert!(most > 100.0 * BOUND, "{most}");
}
