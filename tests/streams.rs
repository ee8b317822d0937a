//! Ray streams: the same hits, visits and tests as of one ray after the other, whatever the instructions, in either precision;
//! and single precision's hits are double precision's but where an exact oracle finds a tie.
#![allow(clippy::unwrap_used, missing_docs)]

mod common;

use std::fmt::Debug;

use common::rules;
use common::scenes::{hard_rays, joints};
use glam::{DVec3, Vec3};
use proptest::prelude::*;
use sahlab::exact::{Meeting, line_triangle};
use sahlab::geom::{Aabb, Line, Objects, Ray, Span, Targets, Triangle};
use sahlab::kd::narrow::{narrow_line, narrow_triangles};
use sahlab::kd::stream::{Lane, Lanes, RayStreams};
use sahlab::kd::{
    Ask, Hit, NarrowTree, Planes, Stack, Strategy, Work, build, build_objects, nearest,
};
use sahlab::rays::SurfaceLines;
use sahlab::scene::Scene;

/// Hold streams against rays one by one: hits to the last bit, visits and tests as integers.
fn assert_same<T: Planes<Vector: Lane + Debug>>(
    tree: &T,
    objects: &(impl Targets<Vector = T::Vector> + ?Sized),
    rays: &[Ray<T::Vector>],
    what: &str,
) {
    let mut stack = Stack::default();
    for ask in Ask::ALL {
        let mut work = Work::default();
        let trace = |ray| ask.trace(tree, objects, ray, &mut stack, &mut work);
        let hits: Vec<_> = rays
            .iter()
            .map(trace)
            .map(|hit| hit.map(Hit::bits))
            .collect();
        for lanes in Lanes::available() {
            let mut streamed = Vec::new();
            let mut streams = RayStreams::with(lanes);
            // The second time in arenas that are not new.
            for _ in 0..2 {
                let done = streams.trace(tree, objects, rays, ask, &mut streamed);
                let what = format!("{what}, {ask}, {}", lanes.name());
                let streamed: Vec<_> = streamed.iter().map(|hit| hit.map(Hit::bits)).collect();
                assert!(streamed == hits, "{what}: hits differ");
                assert_eq!(done, work, "{what}");
            }
        }
    }
}

fn narrow_ray(ray: &Ray) -> Ray<Vec3> {
    let Span { t0, t1 } = ray.span;
    let span = Span {
        t0: t0 as f32,
        t1: t1 as f32,
    };
    Ray::new(narrow_line(&ray.line).unwrap(), span)
}

#[test]
fn streams_find_what_single_rays_do() {
    let named = [
        "spd:tetra:4",
        "spd:balls:2",
        "simple:mixture:400",
        "simple:flat:300",
        "simple:overlapping:40",
        "simple:soup:2000",
    ];
    let named = named.map(|name| Scene::load(name).unwrap());
    let mut in_f32 = 0;
    for scene in named.into_iter().chain([joints(60, 1)]) {
        let mut hits = 0;
        for (strategy, stop) in [
            (Strategy::Sah, "cost-gain"),
            (Strategy::SpatialMedian, "objects:2:16"),
            (Strategy::Sah, "objects:1"),
        ] {
            let tree = build_objects(
                &scene.objects,
                &scene.bounds,
                scene.world,
                &rules(strategy, stop),
            );
            let rays = hard_rays(&scene, &tree, 400);
            let what = format!("{} {strategy} {stop}", scene.name);
            assert_same(&tree, &scene.objects, &rays, &what);
            let mut stack = Stack::default();
            hits += rays
                .iter()
                .filter(|ray| nearest(&tree, &scene.objects, ray, &mut stack).is_some())
                .count();
            if let Ok(triangles) = narrow_triangles(&scene.objects) {
                let (narrow, _) = NarrowTree::of(&tree).unwrap();
                let rays: Vec<_> = rays.iter().map(narrow_ray).collect();
                assert_same(&narrow, &triangles[..], &rays, &format!("{what} in f32"));
                in_f32 += 1;
            }
        }
        assert!(hits > 300, "{}: only {hits} hits", scene.name);
    }
    // The soup and the joints are of triangles alone; three trees each.
    assert_eq!(in_f32, 2 * 3);
}

/// Spans that begin at -infinity do not end with a hit; what is visited after it is not tested.
#[test]
fn what_is_met_after_any_hit_is_not_tested() {
    let triangle =
        |x: f64| Triangle([[x, 9.0, 0.0], [x, 0.0, 9.0], [x, -9.0, -9.0]].map(DVec3::from));
    let objects = Objects {
        triangles: (0..40).map(|i| triangle(f64::from(i % 20))).collect(),
        ..Objects::default()
    };
    let bounds = objects.bounds();
    let tree = build(
        &bounds,
        common::world(&bounds),
        &rules(Strategy::Sah, "objects:2"),
    );
    // So slow that every t beyond is beyond all numbers.
    let slow = Line::new(DVec3::splat(1e9), DVec3::splat(1e-302));
    let rays = vec![
        Ray::new(slow, Span::FULL),
        Ray::new(
            Line::new(DVec3::new(-1.0, 0.1, 0.2), DVec3::new(1.0, 1e-3, 2e-3)),
            Span::FULL,
        ),
    ];
    assert_same(&tree, &objects, &rays, "slow");
    let (mut stack, mut work) = (Stack::default(), Work::default());
    for ray in &rays {
        let before = work.tests;
        Ask::Any.trace(&tree, &objects, ray, &mut stack, &mut work);
        assert!(work.tests - before <= 40 && work.tests > before, "{work:?}");
    }
}

/// Corners on a coarse grid, so that planes, edges and rays coincide; some triangles flat, some without area.
fn triangles() -> impl Strategy_<Value = Vec<Triangle>> {
    let corner = || {
        (0..9i32, 0..9i32, 0..9i32).prop_map(|(x, y, z)| DVec3::new(x.into(), y.into(), z.into()))
    };
    let triangle = (corner(), corner(), corner()).prop_map(|(a, b, c)| Triangle([a, b, c]));
    prop::collection::vec(triangle, 1..60)
}

use proptest::strategy::Strategy as Strategy_;

/// Rays from half grid points in grid directions, with whole, half or short spans.
fn grid_rays() -> impl Strategy_<Value = Vec<Ray>> {
    let part = || -4i32..5;
    let ray = (
        (part(), part(), part()),
        (part(), part(), part()),
        prop_oneof![
            Just(Span::FULL),
            Just(Span::from(0.0)),
            Just(Span { t0: -0.5, t1: 1.0 })
        ],
    );
    let ray = ray.prop_filter_map("a direction", |(o, d, span)| {
        let origin = 2.0 * DVec3::new(o.0.into(), o.1.into(), o.2.into());
        let direction = DVec3::new(d.0.into(), d.1.into(), d.2.into());
        (direction != DVec3::ZERO).then(|| Ray::new(Line::new(origin, direction), span))
    });
    prop::collection::vec(ray, 1..80)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn streams_find_what_single_rays_do_at_ties(triangles in triangles(), rays in grid_rays(), which in 0..3usize) {
        let bounds: Vec<Aabb> = triangles.iter().map(Triangle::bounds).collect();
        let stop = ["objects:1", "cost-gain", "objects:2:16"][which];
        let tree = build(&bounds, common::world(&bounds), &rules(Strategy::Sah, stop));
        let objects = Objects { triangles, ..Objects::default() };
        assert_same(&tree, &objects, &rays, "f64");
        // What is flat and at the origin alone is too small for f32.
        match NarrowTree::of(&tree) {
            Ok((narrow, _)) => {
                let rays: Vec<_> = rays.iter().map(narrow_ray).collect();
                assert_same(&narrow, &narrow_triangles(&objects).unwrap()[..], &rays, "f32");
            }
            Err(refusal) => prop_assert!(tree.world.extent() == DVec3::ZERO, "{refusal}"),
        }
    }
}

/// In a scene and of rays whose numbers are those of f32, both precisions find the same object, unless one of the two objects is at a
/// tie of less than 8 units of f32, or the two hits are nearer than rounding of t.
#[test]
fn single_precision_differs_only_within_rounding() {
    let scene = Scene::load("simple:soup:5000").unwrap();
    let rounded = narrow_triangles(&scene.objects).unwrap();
    let exact = |t: &Triangle<Vec3>| Triangle(t.0.map(|p| p.as_dvec3()));
    let objects = Objects {
        triangles: rounded.iter().map(exact).collect(),
        ..Objects::default()
    };
    let bounds = objects.bounds();
    let tree = build(
        &bounds,
        common::world(&bounds),
        &rules(Strategy::Sah, "cost-gain"),
    );
    let (narrow, _) = NarrowTree::of(&tree).unwrap();
    let sampler = SurfaceLines {
        world: tree.world,
        seed: 9,
    };
    let (mut stack, mut small) = (Stack::default(), Stack::default());
    let (mut hits, mut differing) = (0, 0);
    for (i, line) in sampler.range(0..60_000).enumerate() {
        // A third at random, the others to a corner or a point of an edge.
        let Triangle([a, b, _]) = objects.triangles[i * 31 % objects.triangles.len()];
        let target = [line.at(1.0), a, a.midpoint(b)][i % 3];
        let origin = line.origin.as_vec3();
        let direction = (target - line.origin).as_vec3();
        let ray = Ray::new(Line::new(origin, direction), Span::from(0.0));
        let wide = Ray::new(
            Line::new(origin.as_dvec3(), direction.as_dvec3()),
            Span::from(0.0),
        );
        let in_f64 = nearest(&tree, &objects, &wide, &mut stack);
        let in_f32 = nearest(&narrow, &rounded[..], &ray, &mut small);
        hits += u32::from(in_f64.is_some());
        if in_f64.map(|hit| hit.object) == in_f32.map(|hit| hit.object) {
            continue;
        }
        differing += 1;
        let close = match (in_f64, in_f32) {
            (Some(a), Some(b)) => {
                (a.t - f64::from(b.t)).abs() < 64.0 * f64::from(f32::EPSILON) * a.t.abs()
            }
            _ => false,
        };
        let candidates = [in_f64.map(|hit| hit.object), in_f32.map(|hit| hit.object)];
        let at_a_tie = candidates.into_iter().flatten().any(|object| {
            let corners = &objects.triangles[object as usize].0;
            let crossing = line_triangle(wide.line.origin, wide.line.direction, corners);
            crossing.meeting == Meeting::Coplanar || crossing.ulps * 2f64.powi(-29) < 8.0
        });
        assert!(close || at_a_tie, "ray {i}: {in_f64:?} {in_f32:?}");
    }
    // Rays to corners and edges do end in ties.
    assert!(
        hits > 50_000 && differing > 10,
        "{hits} hits, {differing} differ"
    );
}
