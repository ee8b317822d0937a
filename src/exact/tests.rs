//! The integers against cases worked by hand, and the filter against the integers.

use std::cmp::Ordering::{Equal, Greater, Less};

use glam::DVec3;
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};

use super::*;

mod aimed;
mod watertight;

const UNIT: Aabb = Aabb::new(DVec3::ZERO, DVec3::ONE);
const LEAST: f64 = f64::from_bits(1);

/// Both the two stages together and the integers alone.
fn box_verdict(o: [f64; 3], d: [f64; 3], b: &Aabb) -> Incidence {
    let both = line_box(o.into(), d.into(), b);
    let exact = integer::line_box(o.into(), d.into(), b);
    assert_same(both.ulps, exact.ulps);
    assert_eq!(both.hit, exact.hit, "{o:?} {d:?} {b:?}");
    exact
}

/// Distances agree to 1 in 200, and closely where a tie is near.
fn assert_same(filter: f64, exact: f64) {
    let fine = filter == exact || (filter - exact).abs() <= exact / 200.0 && exact > 2000.0;
    assert!(fine, "filter {filter}, exact {exact}");
}

#[test]
fn boxes_by_hand() {
    for zero in [0.0, -0.0] {
        for (o, d, hit) in [
            ([0.0, 0.5, -1.0], [zero, zero, 1.0], true),
            ([0.0, 0.0, -1.0], [zero, zero, 1.0], true),
            ([1.0, 1.0, 5.0], [zero, zero, 1.0], true),
            ([-LEAST, 0.5, -1.0], [zero, zero, 1.0], false),
            ([1.0 + f64::EPSILON, 0.5, -1.0], [zero, zero, 1.0], false),
        ] {
            let found = box_verdict(o, d, &UNIT);
            assert_eq!((found.hit, found.ulps), (hit, f64::INFINITY), "{o:?}");
        }
    }
    // Ties, and their neighbours at 2^-24 and 2^-50: t = 1 to 2 in x, up to 1 - 2^-k in y.
    for (o, d, hit, ulps) in [
        ([-1.0; 3], [1.0; 3], true, (1u64 << 51) as f64),
        ([-1.0, 1.0, 0.0], [1.0, -1.0, 0.0], true, 0.0),
        (
            [-1.0, 1.0 - 0.5f64.powi(24), 0.0],
            [1.0, -1.0, 0.0],
            false,
            2f64.powi(28),
        ),
        (
            [-1.0, 1.0 - 0.5f64.powi(50), 0.0],
            [1.0, -1.0, 0.0],
            false,
            4.0,
        ),
        (
            [-1.0, 1.0 + 0.5f64.powi(50), 0.0],
            [1.0, -1.0, 0.0],
            true,
            4.0 / (1.0 + 0.5f64.powi(50)),
        ),
        // A line has no start: the box is behind.
        ([3.0, 2.0, 0.5], [1.0, 1.0, 0.0], true, 0.0),
        // A direction part of the least size counts: x = 0 at t = 0 only, where z = -1.
        ([0.0, 0.5, -1.0], [LEAST, 0.0, 1.0], true, 2f64.powi(52)),
        ([0.0, 0.5, -1.0], [-LEAST, 0.0, 1.0], false, 2f64.powi(52)),
    ] {
        let found = box_verdict(o, d, &UNIT);
        assert_eq!((found.hit, found.ulps), (hit, ulps), "{o:?} {d:?}");
    }
}

#[test]
fn flat_point_and_huge_boxes_by_hand() {
    let flat = Aabb::new(DVec3::ZERO, DVec3::new(1.0, 1.0, 0.0));
    assert!(box_verdict([-1.0, 0.5, 0.0], [1.0, 0.0, 0.0], &flat).hit);
    assert!(box_verdict([0.3, 0.4, -1.0], [0.1, 0.2, 1.0], &flat).hit);
    let point = Aabb::new(DVec3::ONE, DVec3::ONE);
    assert_eq!(box_verdict([0.0; 3], [1.0; 3], &point).ulps, 0.0);
    assert!(box_verdict([0.0; 3], [1.0; 3], &point).hit);
    let beside = box_verdict([0.0; 3], [1.0, 1.0, 1.0 + f64::EPSILON], &point);
    assert!(!beside.hit && beside.ulps <= 1.0 && beside.ulps > 0.99);
    // Differences overflow in f64.
    let huge = Aabb::new(DVec3::splat(-f64::MAX), DVec3::splat(f64::MAX));
    assert!(box_verdict([-f64::MAX, 0.0, 0.0], [1.0, 0.0, 0.0], &huge).hit);
    assert!(box_verdict([-f64::MAX, -f64::MAX, 0.0], [1.0, 1.0, 0.0], &huge).hit);
    assert!(!box_verdict([-f64::MAX; 3], [1.0, -LEAST, 0.0], &UNIT).hit);
    let least = Aabb::new(DVec3::ZERO, DVec3::splat(LEAST));
    assert!(box_verdict([-LEAST, LEAST, 0.0], [1.0, -1.0, 0.0], &least).hit);
    assert!(!box_verdict([-LEAST, 0.0, 0.0], [1.0, -1.0, 0.0], &least).hit);
}

#[test]
fn triangles_by_hand() {
    let corners = [DVec3::ZERO, DVec3::X, DVec3::Y];
    let verdict = |o: [f64; 3], d: [f64; 3], corners: &[DVec3; 3]| {
        let both = line_triangle(o.into(), d.into(), corners);
        let exact = integer::line_triangle(o.into(), d.into(), corners);
        assert_eq!(both.meeting, exact.meeting, "{o:?} {d:?}");
        assert_same(both.ulps, exact.ulps);
        exact
    };
    let [down, up] = [[0.0, 0.0, -1.0], [0.0, 0.0, 1.0]];
    for (o, d, meeting) in [
        ([0.25, 0.25, 3.0], down, Meeting::Hit(Greater)),
        ([0.25, 0.25, 3.0], up, Meeting::Hit(Less)),
        ([0.25, 0.25, 0.0], up, Meeting::Hit(Equal)),
        // Corner, edges, and one step beyond an edge.
        ([0.0, 0.0, 1.0], down, Meeting::Hit(Greater)),
        ([0.5, 0.5, 1.0], down, Meeting::Hit(Greater)),
        ([0.5, 0.0, 1.0], down, Meeting::Hit(Greater)),
        ([0.5, -LEAST, 1.0], down, Meeting::Miss),
        ([0.5, 0.5 + f64::EPSILON, 1.0], down, Meeting::Miss),
        ([0.5, 0.25, 1.0], [LEAST, 0.0, 1.0], Meeting::Hit(Less)),
        // In the plane, across it or beside; parallel above it.
        ([-1.0, 0.2, 0.0], [1.0, 0.0, 0.0], Meeting::Coplanar),
        ([-1.0, 7.0, 0.0], [1.0, 0.0, 0.0], Meeting::Coplanar),
        ([-1.0, 0.2, LEAST], [1.0, 0.0, 0.0], Meeting::Miss),
    ] {
        assert_eq!(verdict(o, d, &corners).meeting, meeting, "{o:?} {d:?}");
    }
    // Before the hypotenuse by e in y, d.(B x C) = e in size. |d x B|_1 + |d x C|_1 = (1 - e) + (1 + e), r = 1: units of 2^-51.
    let near_edge = verdict([0.5, 0.5 - 0.5f64.powi(50), 1.0], down, &corners);
    assert_eq!(near_edge.ulps, 2.0);
    // A point, a segment met, a segment passed, a corner twice.
    let [o, d] = [[0.5, 0.0, 1.0], down];
    assert_eq!(verdict(o, d, &[DVec3::X; 3]).meeting, Meeting::Coplanar);
    let segment = [DVec3::ZERO, DVec3::X, 2.0 * DVec3::X];
    assert_eq!(verdict(o, d, &segment).meeting, Meeting::Coplanar);
    assert_eq!(verdict([0.5, 0.1, 1.0], d, &segment).meeting, Meeting::Miss);
}

/// A right triangle of legs s = 2^-20 around (1, 1, 1), whose hypotenuse passes the line from 0 along (1, 1, 1) at e in y.
///
/// In x - z and y - z its corners are (-s/2, -s/2 + e), (s/2, -s/2 + e) and (-s/2, s/2 + e), so that d.(B x C) = s e. |d x B|_1 +
/// |d x C|_1 = (2 s - 2 e) + (2 s + 2 e), r = 1 + s/2 + e: it is e / (4 r) in units of 2^-52. Against its products it would be noise:
/// they add up to 6, so that s e is 2^-14 / 6 units of 2^-52 of them at e = 2^-46.
#[test]
fn a_small_triangle_far_away_is_told_by_its_distance_not_by_its_products() {
    let s = 0.5f64.powi(20);
    for (exponent, ulps) in [(46, 16.0), (49, 2.0), (51, 0.5)] {
        for (sign, met) in [(1.0, true), (-1.0, false)] {
            let e = sign * 0.5f64.powi(exponent);
            let a = DVec3::new(1.0 - s / 2.0, 1.0 - s / 2.0 + e, 1.0);
            let corners = [a, a + s * DVec3::X, a + s * DVec3::Y];
            for found in [
                line_triangle(DVec3::ZERO, DVec3::ONE, &corners),
                integer::line_triangle(DVec3::ZERO, DVec3::ONE, &corners),
            ] {
                let right = if met {
                    Meeting::Hit(Greater)
                } else {
                    Meeting::Miss
                };
                assert_eq!(found.meeting, right);
                let r = 1.0 + s / 2.0 + e.max(0.0);
                let off = (found.ulps * r / ulps - 1.0).abs();
                assert!(off < 1e-15, "{} for {ulps}", found.ulps);
            }
        }
    }
}

/// Numbers that the filter must be afraid of: zeros, powers of two of any size, and neighbours of 1.
fn hard_number(rng: &mut ChaCha8Rng) -> f64 {
    let sign = if rng.random() { 1.0 } else { -1.0 };
    sign * match rng.random_range(0..6) {
        0 => 0.0,
        1 => f64::from_bits(rng.random_range(1..100)),
        2 => libm::scalbn(1.0, rng.random_range(-1074..1023)),
        3 => f64::from_bits(1f64.to_bits() + rng.random_range(0..8) - 4),
        4 => rng.random_range(0.0..1.0),
        _ => f64::from(rng.random_range(0..4)),
    }
}

fn vector(rng: &mut ChaCha8Rng, number: impl Fn(&mut ChaCha8Rng) -> f64) -> DVec3 {
    DVec3::from_array([0; 3].map(|_| number(rng)))
}

fn uniform(rng: &mut ChaCha8Rng) -> f64 {
    rng.random_range(-1.0..1.0)
}

/// How many of the cases the filter decided, having compared it with the integers on all of them.
fn decided(cases: impl Iterator<Item = (DVec3, DVec3, [DVec3; 3])>) -> [usize; 2] {
    let mut decided = [0; 2];
    for (origin, direction, corners) in cases {
        if direction == DVec3::ZERO {
            continue;
        }
        let b = Aabb::around(corners);
        if let Some(quick) = filter::line_box(origin, direction, &b) {
            decided[0] += 1;
            let exact = integer::line_box(origin, direction, &b);
            assert_eq!(quick.hit, exact.hit, "{origin} {direction} {b:?}");
            assert_same(quick.ulps, exact.ulps);
        }
        if let Some(quick) = filter::line_triangle(origin, direction, &corners) {
            decided[1] += 1;
            let exact = integer::line_triangle(origin, direction, &corners);
            assert_eq!(
                quick.meeting, exact.meeting,
                "{origin} {direction} {corners:?}"
            );
            assert_same(quick.ulps, exact.ulps);
        }
    }
    decided
}

#[test]
fn the_filter_agrees_with_the_integers_and_decides_nearly_all_random_cases() {
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let cases = (0..30_000).map(|_| {
        let corners = [0; 3].map(|_| vector(&mut rng, uniform));
        (
            vector(&mut rng, uniform),
            vector(&mut rng, uniform),
            corners,
        )
    });
    assert!(decided(cases).iter().all(|&n| n >= 29_990));
}

#[test]
fn the_filter_leaves_what_touches_to_the_integers() {
    let mut rng = ChaCha8Rng::seed_from_u64(2);
    // Towards a point of an edge of the box, which is a corner of the triangle, or of an edge of the triangle.
    for on_box in [true, false] {
        let cases = (0..20_000).map(|_| {
            let corners = [0; 3].map(|_| vector(&mut rng, uniform));
            let origin = vector(&mut rng, uniform);
            let b = Aabb::around(corners);
            let target = if on_box {
                let mut on_edge = b.lo.lerp(b.hi, rng.random());
                on_edge.x = b.lo.x;
                on_edge.y = b.hi.y;
                on_edge
            } else {
                corners[0].lerp(corners[1], rng.random())
            };
            (origin, target - origin, corners)
        });
        let [boxes, triangles] = decided(cases);
        // Half the edges of a box are on its outline; the others are not in doubt.
        assert!(
            if on_box {
                boxes < 15_000
            } else {
                triangles < 100
            },
            "{boxes} {triangles}"
        );
    }
}

#[test]
fn the_filter_agrees_with_the_integers_on_hard_numbers() {
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    let cases = (0..100_000).map(|_| {
        let corners = [0; 3].map(|_| vector(&mut rng, hard_number));
        (
            vector(&mut rng, hard_number),
            vector(&mut rng, hard_number),
            corners,
        )
    });
    let [boxes, triangles] = decided(cases);
    assert!(boxes > 1000 && triangles > 1000, "{boxes} {triangles}");
}

/// Reflections, permutations of axes and powers of two change no verdict and no distance.
#[test]
fn the_integers_do_not_care_about_scale_axes_or_reflections() {
    let mut rng = ChaCha8Rng::seed_from_u64(4);
    for _ in 0..5_000 {
        let corners = [0; 3].map(|_| vector(&mut rng, uniform));
        let origin = vector(&mut rng, uniform);
        let direction = corners[0].lerp(corners[1], rng.random()) - origin;
        let scale = libm::scalbn(1.0, rng.random_range(-900..900));
        let turned = |p: DVec3| DVec3::new(-p.z, p.x, p.y);
        let moved = corners.map(|p| scale * turned(p));
        let b = integer::line_box(origin, direction, &Aabb::around(corners));
        let [o, d] = [scale * turned(origin), turned(direction)];
        assert_eq!(integer::line_box(o, d, &Aabb::around(moved)), b);
        let t = integer::line_triangle(origin, direction, &corners);
        // The reflection changes the signs of edge functions and of heights alike.
        assert_eq!(integer::line_triangle(o, d, &moved), t);
    }
}
