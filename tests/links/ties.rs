//! Boxes, triangles and lines on a small integer grid, where planes tie, and where rounding makes them fall together.

use glam::DVec3;
use proptest::prelude::*;
use proptest::strategy::Strategy as Values;
use sahlab::geom::{Aabb, Line, Ray, Span, Triangle};
use sahlab::kd::narrow::{narrow_line, narrow_triangle};
use sahlab::kd::{Counting, NarrowTree, Strategy, Tracing};

use super::common::{STOPS, tree};
use super::watch::Ways;
use super::{Both, narrow_span, same_hits};

/// A point of a small integer grid.
fn grid() -> impl Values<Value = DVec3> {
    prop::array::uniform3(-3i8..4).prop_map(|p| DVec3::from_array(p.map(f64::from)))
}

/// Lines on the grid: many run along axes, in planes and through edges and corners.
fn lines() -> impl Values<Value = (Line, Span)> {
    let spans = prop::sample::select(vec![
        Span::FULL,
        Span::from(0.0),
        Span::from(-2.0),
        Span::from(1.5),
        Span { t0: -1.0, t1: 0.5 },
        Span { t0: 0.25, t1: 2.0 },
        Span { t0: 1.0, t1: 1.0 },
    ]);
    let parts = prop::array::uniform3(prop::sample::select(vec![
        0.0, -0.0, 1.0, -1.0, 2.0, -3.0, 0.5, 1e-30, -1e30,
    ]));
    (grid(), parts, prop::bool::ANY, spans).prop_filter_map(
        "no direction",
        |(origin, parts, shifted, span)| {
            let direction = DVec3::from_array(parts);
            let origin = origin + f64::from(u8::from(shifted)) * DVec3::new(0.25, 0.5, 1.0 / 3.0);
            (direction != DVec3::ZERO).then(|| (Line::new(origin, direction), span))
        },
    )
}

const LIMITS: [f64; 4] = [-1.0, 0.0, 1.0, 1.5];

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn leaves_are_the_stacks_where_planes_tie(
        raw in prop::collection::vec((grid(), prop::array::uniform3(0u8..4)), 1..40),
        which in 0..Strategy::ALL.len(),
        stop in prop::sample::select(STOPS.to_vec()),
        lines in prop::collection::vec(lines(), 24),
    ) {
        let bounds: Vec<Aabb> = raw.iter().map(|&(lo, size)| {
            Aabb::new(lo, lo + DVec3::from_array(size.map(f64::from)))
        }).collect();
        let wide = tree(&bounds, Strategy::ALL[which], stop);
        let narrow = NarrowTree::however_coarse(&wide).unwrap();
        let both = Both { wide: Ways::new(&wide), narrow: Ways::new(&narrow) };
        for (line, span) in lines {
            both.check(&line, span, &LIMITS);
        }
    }

    #[test]
    fn hits_are_the_stacks_where_planes_tie(
        raw in prop::collection::vec(prop::array::uniform3(grid()), 1..40),
        which in 0..Strategy::ALL.len(),
        stop in prop::sample::select(STOPS.to_vec()),
        lines in prop::collection::vec(lines(), 24),
    ) {
        let triangles: Vec<Triangle> = raw.into_iter().map(Triangle).collect();
        let bounds: Vec<Aabb> = triangles.iter().map(Triangle::bounds).collect();
        let wide = tree(&bounds, Strategy::ALL[which], stop);
        let narrow = NarrowTree::however_coarse(&wide).unwrap();
        let small: Vec<_> = triangles.iter().map(|t| narrow_triangle(t).unwrap()).collect();
        let both = Both { wide: Ways::new(&wide), narrow: Ways::new(&narrow) };
        for (line, span) in lines {
            same_hits(&both.wide, &triangles, &Ray::new(line, span));
            let line = narrow_line(&line).unwrap();
            same_hits(&both.narrow, &small, &Ray::new(line, narrow_span(span)));
        }
    }

    // Rounded to f32 far from the origin, planes fall together and on faces, and leaves become flat.
    #[test]
    fn leaves_are_the_stacks_where_planes_fall_together(
        raw in prop::collection::vec((grid(), prop::array::uniform3(0u8..4)), 1..40),
        which in 0..Strategy::ALL.len(),
        stop in prop::sample::select(STOPS.to_vec()),
        lines in prop::collection::vec(lines(), 24),
    ) {
        let far = DVec3::new(16_777_216.0, -33_554_432.0, 16_777_210.0);
        let bounds: Vec<Aabb> = raw.iter().map(|&(lo, size)| {
            Aabb::new(far + lo, far + lo + DVec3::from_array(size.map(f64::from)))
        }).collect();
        let wide = tree(&bounds, Strategy::ALL[which], stop);
        let narrow = NarrowTree::however_coarse(&wide).unwrap();
        let ways = Ways::new(&narrow);
        for (line, span) in lines {
            let line = narrow_line(&Line::new(far + line.origin, line.direction)).unwrap();
            let span = narrow_span(span);
            ways.check_up_to::<Counting>(&line, span, &[0.0, 1.0]);
            ways.check_up_to::<Tracing>(&line, span, &[0.0, 1.0]);
        }
    }
}
