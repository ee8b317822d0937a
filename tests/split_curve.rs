//! The split cost across a node, against examples worked out by hand and against counting.
#![allow(clippy::unwrap_used, missing_docs)]

mod common;

use common::{gridded_boxes, random_boxes, rules, world};
use glam::DVec3;
use sahlab::geom::Aabb;
use sahlab::kd::curve::{SplitCurve, for_each_node, split_curve};
use sahlab::kd::{NodeKind, Rules, Strategy, build, build_objects};
use sahlab::scene::Scene;

const CUBE: Aabb = Aabb::new(DVec3::ZERO, DVec3::ONE);

fn minimum_is_between_medians(curve: &SplitCurve) -> bool {
    let minimum = curve.minimum.unwrap();
    curve.medians().unwrap().contains(&minimum.position)
}

/// n points equally spaced on the x axis in [a, b], in the middle of their shares.
fn points(n: u32, a: f64, b: f64) -> impl Iterator<Item = Aabb> {
    (0..n).map(move |i| {
        let x = a + (b - a) * (f64::from(i) + 0.5) / f64::from(n);
        let p = DVec3::new(x, 0.5, 0.5);
        Aabb::new(p, p)
    })
}

/// A thousand points in the part [0, e] of a cube: the best plane is at (e + 1)/4 if e >= 1/3, else behind them all at e.
#[test]
fn uniform_points_have_their_known_minimum() {
    for (end, at, tests) in [
        (0.2, 0.2, 1400.0 / 3.0),
        (0.5, 0.375, 625.0),
        (1.0, 0.5, 2000.0 / 3.0),
    ] {
        let objects: Vec<Aabb> = points(1000, 0.0, end).collect();
        let curve = split_curve(&objects, &CUBE, 0, 10, &[end]);
        let minimum = curve.minimum.unwrap();
        assert!((minimum.position - at).abs() < 2e-3, "{minimum:?}");
        assert!((minimum.f - tests).abs() < 1.0, "{minimum:?}");
        assert_eq!(curve.spatial_median, 0.5);
        assert!((curve.object_median.unwrap() - 0.5 * end).abs() < 1e-12);
        // MacDonald & Booth: without straddlers the minimum lies between the medians (which meet if end = 1: the nearest
        // point lies half a step beside them).
        assert_eq!(minimum_is_between_medians(&curve), end < 1.0);
        // Points straddle nothing: both ways of counting are one.
        assert!(
            curve
                .points
                .iter()
                .all(|p| p.f == p.f_centres && p.left + p.right == 1000)
        );
    }
}

#[test]
fn two_clusters_are_parted_where_the_larger_begins() {
    let clusters = points(400, 0.0, 0.4).chain(points(600, 0.6, 1.0));
    let objects: Vec<Aabb> = clusters.collect();
    let curve = split_curve(&objects, &CUBE, 0, 10, &[0.4, 0.6]);
    let at = |x: f64| curve.points.iter().find(|p| p.position == x).unwrap();
    // 400 (1 + 1.2)/3 + 600 (1 + 0.8)/3, and 400 (1 + 0.8)/3 + 600 (1 + 1.2)/3.
    assert!((at(0.6).f - (880.0 + 1080.0) / 3.0).abs() < 1e-9);
    assert!((at(0.4).f - (720.0 + 1320.0) / 3.0).abs() < 1e-9);
    assert!((curve.minimum.unwrap().position - 0.6).abs() < 1e-3);
}

/// Objects [0, 6] and [4, 8] of a cube of side 10: straddlers put the minimum outside the medians' interval.
#[test]
fn straddlers_move_the_minimum_out() {
    let node = Aabb::new(DVec3::ZERO, DVec3::splat(10.0));
    let slab = |a: f64, b: f64| Aabb::new(DVec3::new(a, 0.0, 0.0), DVec3::new(b, 10.0, 10.0));
    let curve = split_curve(&[slab(0.0, 6.0), slab(4.0, 8.0)], &node, 0, 1, &[5.0]);
    assert_eq!(
        (curve.spatial_median, curve.object_median),
        (5.0, Some(4.5))
    );
    assert_eq!(curve.samples, [4.5, 4.75, 5.0]);
    let found: Vec<_> = curve
        .points
        .iter()
        .map(|p| (p.position, p.left, p.right))
        .collect();
    let wanted = [
        (0.0, 0, 2),
        (4.0, 1, 2),
        (4.5, 2, 2),
        (4.75, 2, 2),
        (5.0, 2, 2),
        (6.0, 2, 1),
        (8.0, 2, 0),
    ];
    assert_eq!(found, wanted);
    let inside: Vec<f64> = curve.inside().map(|p| p.position).collect();
    assert_eq!(inside, [4.0, 4.5, 4.75, 5.0, 6.0, 8.0]);
    // A part of x of the cube has (1 + 2x)/3 of its area: at 4 (1.8 + 2 * 2.2)/3, at 5 4 * 2/3, at 8 2 * 2.6/3.
    let f = |i: usize| curve.points[i].f;
    for (found, wanted) in [(f(1), 6.2), (f(4), 8.0), (f(5), 6.2), (f(6), 5.2)] {
        assert!((found - wanted / 3.0).abs() < 1e-12, "{found}");
    }
    // By centres 3 and 6: at 5 one on each side, at 6 the second on the cheaper, right side.
    assert!((curve.points[4].f_centres - 4.0 / 3.0).abs() < 1e-12);
    assert!((curve.points[5].f_centres - (2.2 + 1.8) / 3.0).abs() < 1e-12);
    assert_eq!(curve.minimum.unwrap().position, 8.0);
    assert!(!minimum_is_between_medians(&curve));
}

#[test]
fn every_point_is_what_counting_finds() {
    for (seed, bounds) in [(1, gridded_boxes(50, 1)), (2, random_boxes(50, 2))] {
        let node = world(&bounds);
        for axis in 0..3 {
            let curve = split_curve(&bounds, &node, axis, 10, &[]);
            assert!(curve.points.is_sorted_by(|a, b| a.position < b.position));
            for p in &curve.points {
                let s = p.position;
                let left = bounds.iter().filter(|b| b.lo[axis] < s).count();
                let right = bounds.iter().filter(|b| b.hi[axis] > s).count();
                let planar = bounds.len()
                    - bounds
                        .iter()
                        .filter(|b| b.lo[axis] < s || b.hi[axis] > s)
                        .count();
                assert!(
                    (left, right + planar) == (p.left, p.right)
                        || (left + planar, right) == (p.left, p.right)
                );
                let (l, r) = node.split(axis, s);
                let sum = l.surface_area() * p.left as f64 + r.surface_area() * p.right as f64;
                assert!(
                    (sum / node.surface_area() - p.f).abs() < 1e-9,
                    "{seed} {axis} {p:?}"
                );
            }
            let bound = |s: f64| bounds.iter().any(|b| b.lo[axis] == s || b.hi[axis] == s);
            let least = curve
                .inside()
                .filter(|p| bound(p.position))
                .map(|p| p.f)
                .fold(f64::INFINITY, f64::min);
            assert_eq!(curve.minimum.unwrap().f, least);
        }
    }
}

/// The walk finds each node's objects; there, the least minimum of the axes is the plane that the builder took.
#[test]
fn at_every_node_the_reference_takes_the_least_minimum() {
    let scene = Scene::load("simple:soup:500").unwrap();
    let tree = build(
        &scene.bounds,
        scene.world,
        &rules(Strategy::Sah, "cost-gain"),
    );
    let (mut nodes, mut between) = (0, 0);
    for_each_node(&tree, |node, depth, objects| {
        let b = &tree.boxes[node as usize];
        let meets = |o: &Aabb| o.lo.cmplt(b.hi).all() && o.hi.cmpgt(b.lo).all();
        let wanted = (0_u32..)
            .zip(&scene.bounds)
            .filter(|(_, o)| meets(o))
            .map(|(i, _)| i);
        assert_eq!(objects, wanted.collect::<Vec<u32>>());
        assert_eq!(depth, tree.depths()[node as usize]);
        if let NodeKind::Inner { axis, split, .. } = tree.nodes[node as usize].kind() {
            let boxes: Vec<Aabb> = objects.iter().map(|&o| scene.bounds[o as usize]).collect();
            let curves = [0, 1, 2].map(|k| split_curve(&boxes, b, k, 10, &[]));
            let least = curves
                .iter()
                .filter_map(|c| c.minimum)
                .map(|m| m.f)
                .fold(f64::INFINITY, f64::min);
            let taken = curves[axis].minimum.unwrap();
            assert_eq!(taken.position, split);
            assert!(taken.f <= least * (1.0 + 1e-12));
            between += usize::from(minimum_is_between_medians(&curves[axis]));
            nodes += 1;
        }
    });
    assert_eq!(nodes, tree.inner_nodes());
    assert!(0 < between && between < nodes, "{between} of {nodes}");

    // A clipped tree's nodes have fewer objects, its root all.
    let clipped = Rules {
        clipped: true,
        ..rules(Strategy::Sah, "cost-gain")
    };
    let tree = build_objects(&scene.objects, &scene.bounds, scene.world, &clipped);
    let mut root = 0;
    for_each_node(&tree, |node, _, objects| {
        if node == 0 {
            root = objects.len();
        }
    });
    assert_eq!(root, 500);
}
