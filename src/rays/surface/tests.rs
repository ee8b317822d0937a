//! Every line is that of the plain law, starts on the box, and depends on nothing but seed and index.

use std::f64::consts::TAU;

use super::*;
use crate::geom::Span;

/// The law in plain words, line by line, with branches and libm's sine and cosine.
fn plain_line(world: &Aabb, u: [f64; 4]) -> Line {
    let areas = world.face_areas();
    let mut rest = u[0] * 2.0 * (areas.x + areas.y + areas.z);
    let last = (1..3).rev().find(|&k| areas[k] > 0.0).unwrap_or(0);
    let mut axis = 0;
    while axis < last && rest >= 2.0 * areas[axis] {
        rest -= 2.0 * areas[axis];
        axis += 1;
    }
    let mut share = rest / areas[axis];
    let upper = share >= 1.0;
    share -= f64::from(u8::from(upper));

    let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
    let extent = world.extent();
    let mut origin = if upper { world.hi } else { world.lo };
    origin[i] = (world.lo[i] + share * extent[i]).clamp(world.lo[i], world.hi[i]);
    origin[j] = (world.lo[j] + u[1] * extent[j]).clamp(world.lo[j], world.hi[j]);

    let radius = u[2].sqrt();
    let (sine, cosine) = libm::sincos(TAU * u[3]);
    let height = (1.0 - u[2]).max(0.0).sqrt();
    let mut direction = DVec3::ZERO;
    direction[i] = radius * cosine;
    direction[j] = radius * sine;
    direction[axis] = if upper { -height } else { height };
    Line::new(origin, direction)
}

fn bits(line: &Line) -> [[u64; 3]; 3] {
    [line.origin, line.direction, line.inverse].map(|v| v.to_array().map(f64::to_bits))
}

#[test]
fn lines_are_those_of_the_plain_law_to_the_bit() {
    let worlds = [
        Aabb::new(DVec3::ZERO, DVec3::new(1.0, 0.8, 0.5)),
        Aabb::new(DVec3::new(1e8, -3.0, 0.1), DVec3::new(1e8 + 1.0, -2.9, 0.3)),
        Aabb::new(DVec3::new(-0.0, -0.0, -0.0), DVec3::new(0.0, 2.0, 7.0)),
        Aabb::new(DVec3::new(-1.0, 5.0, -0.0), DVec3::new(2.0, 5.0, 0.1)),
        Aabb::new(DVec3::new(-1.0, -1.0, -0.0), DVec3::new(1.0, 3.0, -0.0)),
        Aabb::new(DVec3::ZERO, DVec3::new(1e6, 1.0, 1e-6)),
        Aabb::new(DVec3::splat(-1e70), DVec3::new(1e70, 1e60, -1e69)),
    ];
    for (seed, world) in worlds.into_iter().enumerate() {
        let seed = seed as u64;
        let mut uniforms = Uniforms::starting_at(seed, 5);
        let mut i = 5;
        for line in (SurfaceLines { world, seed }).range(5..200_000) {
            let u = uniforms.next4();
            let plain = bits(&plain_line(&world, u));
            assert_eq!(bits(&line), plain, "{world:?}, line {i}");
            assert_eq!(
                bits(&surface_line(&world, u)),
                plain,
                "{world:?}, line {i} alone"
            );
            i += 1;
        }
        assert_eq!(i, 200_000);
    }
}

/// With wider instructions, if the processor has them, and without.
#[test]
fn lines_are_the_same_whatever_the_instructions() {
    let world = Aabb::new(DVec3::new(1e3, -3.0, 0.1), DVec3::new(1e3 + 1.0, -2.9, 0.3));
    let lines = |wide: bool| {
        let mut uniforms = Uniforms::starting_at(3, 0);
        // Not a whole number of blocks.
        let points = (0..100_003).map(move |_| uniforms.next4());
        let mut lines = Lines::new(&world, points);
        lines.wide &= wide;
        lines
    };
    let [wide, plain] = [true, false].map(|wide| lines(wide).map(|line| bits(&line)).collect());
    let (wide, plain): (Vec<_>, Vec<_>) = (wide, plain);
    assert_eq!(wide.len(), 100_003);
    assert!(wide == plain);
}

/// Where faces meet, where the angle's quadrants do, and the ends of (0, 1).
#[test]
fn lines_of_borders_are_those_of_the_plain_law_to_the_bit() {
    let least = 0.5_f64.powi(53);
    let mut places = vec![least, 3.0 * least, 1e-9, 1.0 - least];
    for k in 1..24 {
        let u = f64::from(k) / 24.0;
        places.extend([u.next_down(), u, u.next_up()]);
    }
    for size in [
        DVec3::ONE,
        DVec3::new(1.0, 0.0, 1.0),
        DVec3::new(0.1, 0.7, 0.3),
    ] {
        let world = Aabb::new(DVec3::splat(0.1), DVec3::splat(0.1) + size);
        for &face in &places {
            for &u in &places {
                let u = [face, u, 1.0 - u, u];
                let line = surface_line(&world, u);
                assert_eq!(bits(&line), bits(&plain_line(&world, u)), "{u:?}");
            }
        }
    }
}

#[test]
fn every_line_starts_on_the_box_and_hits_it() {
    let worlds = [
        Aabb::new(DVec3::ZERO, DVec3::new(1.0, 0.8, 0.5)),
        Aabb::new(DVec3::new(1e8, -3.0, 0.1), DVec3::new(1e8 + 1.0, -2.9, 0.3)),
        Aabb::new(DVec3::ZERO, DVec3::new(1.0, 1.0, 0.0)),
        Aabb::new(DVec3::ZERO, DVec3::new(1e6, 1.0, 1.0)),
    ];
    for world in worlds {
        for line in (SurfaceLines { world, seed: 1 }).range(0..10_000) {
            assert!(world.contains(&Aabb::new(line.origin, line.origin)));
            let span = world.clip(&line, Span::FULL).expect("hits the box");
            assert!(span.t0 <= 0.0 && span.t1 >= 0.0);
            assert!((line.direction.length() - 1.0).abs() < 1e-15);
        }
    }
}

#[test]
fn a_face_without_area_is_never_taken() {
    let least = 0.5_f64.powi(53);
    for flat in 0..3 {
        for (a, b) in [(1.0, 1.0), (0.1, 0.7), (3.7, 1e-9), (1e70, 1e-70)] {
            let mut hi = DVec3::ZERO;
            hi[(flat + 1) % 3] = a;
            hi[(flat + 2) % 3] = b;
            let world = Aabb::new(DVec3::ZERO, hi);
            for u in [least, 0.5 - least, 0.5, 0.5 + least, 1.0 - least] {
                let line = surface_line(&world, [u, 0.3, 0.25, 0.1]);
                assert!(line.origin.is_finite() && line.direction.is_finite());
                // The face is the flat box itself, so its normal part of the direction is the cosine.
                assert!((line.direction[flat].abs() - 0.75_f64.sqrt()).abs() < 1e-15);
                assert!(world.contains(&Aabb::new(line.origin, line.origin)));
            }
        }
    }
}

#[test]
fn a_line_depends_on_seed_and_index_alone() {
    let lines = SurfaceLines {
        world: Aabb::new(DVec3::ZERO, DVec3::ONE),
        seed: 3,
    };
    let all: Vec<Line> = lines.range(0..1000).collect();
    for start in [0, 1, 64, 999] {
        let part: Vec<Line> = lines.range(start as u64..1000).collect();
        assert_eq!(part, all[start..]);
    }
}
