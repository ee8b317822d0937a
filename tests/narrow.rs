//! Trees and triangles in single precision: what is rounded, what is kept, what is refused.
#![allow(clippy::unwrap_used, missing_docs)]

use glam::{DVec3, Vec3};
use sahlab::exact::line_box;
use sahlab::geom::{Aabb, Line, Objects, Ray, Span, Sphere, Triangle};
use sahlab::kd::narrow::{NarrowTree, Refusal, fitness, narrow_line, narrow_triangles, resolution};
use sahlab::kd::traverse;
use sahlab::kd::{Counting, Mode, NodeKind, Planes, Probe, Stack, Strategy, Tracing, Tree};
use sahlab::rays::SurfaceLines;
use sahlab::scene::Scene;

mod common;

/// The numbers of the nodes visited, in order.
#[derive(Default)]
struct Visited(Vec<u32>);

impl Probe for Visited {
    fn inner(&mut self, node: u32) {
        self.0.push(node);
    }

    fn leaf(&mut self, node: u32, _: u32) {
        self.0.push(node);
    }
}

fn visited<M: Mode>(tree: &NarrowTree, line: &Line<Vec3>) -> Vec<u32> {
    let mut visited = Visited::default();
    let mut stack = Stack::default();
    traverse::<M, _, _>(tree, line, Span::FULL, &mut stack, &mut visited, |_, _| {
        f32::INFINITY
    });
    visited.0.sort_unstable();
    visited.0
}

/// A soup and its tree, moved along x, y and z.
fn moved(offset: f64) -> (Vec<Triangle>, Tree) {
    let scene = Scene::load("simple:soup:300").unwrap();
    let by = DVec3::splat(offset);
    let triangles: Vec<Triangle> = scene
        .objects
        .triangles
        .iter()
        .map(|t| Triangle(t.0.map(|p| p + by)))
        .collect();
    let bounds: Vec<Aabb> = triangles.iter().map(Triangle::bounds).collect();
    let tree = common::tree(&bounds, Strategy::Sah, "objects:2:16");
    (triangles, tree)
}

/// Lines through the box at random, towards corners of nodes' boxes, and parallel to an axis in a face of one.
fn lines(tree: &NarrowTree) -> Vec<Line<Vec3>> {
    let world = tree.boxes[0];
    let random = (SurfaceLines { world, seed: 5 }).range(0..600);
    let mut all: Vec<Line<Vec3>> = random.map(|line| narrow_line(&line).unwrap()).collect();
    for i in 0..600 {
        let b = &tree.boxes[i * 7 % tree.boxes.len()];
        let corner = DVec3::new(b.lo.x, b.hi.y, b.lo.z).as_vec3();
        let random = all[i];
        if corner != random.origin {
            all.push(Line::new(random.origin, corner - random.origin));
        }
        let mut along = Vec3::ZERO;
        along[i % 3] = if i % 2 == 0 { 1.0 } else { -1.0 };
        all.push(Line::new(corner - along, along));
    }
    all
}

#[test]
fn boxes_and_planes_are_the_rounded_ones_and_hold_the_rounded_triangles() {
    let (triangles, tree) = moved(1000.0);
    let (narrow, _) = NarrowTree::of(&tree).unwrap();
    assert_eq!(
        narrow.bytes(),
        8 * tree.nodes.len() + 4 * tree.references.len()
    );
    let round = |p: DVec3| p.as_vec3().as_dvec3();
    for (wide, b) in tree.boxes.iter().zip(&narrow.boxes) {
        assert_eq!(*b, Aabb::new(round(wide.lo), round(wide.hi)));
    }
    let objects = Objects {
        triangles,
        ..Objects::default()
    };
    let small = narrow_triangles(&objects).unwrap();
    for (i, node) in tree.nodes.iter().enumerate() {
        let i = i as u32;
        match (node.kind(), narrow.node(i)) {
            (NodeKind::Inner { axis, split, left }, found) => {
                let split = split as f32;
                assert_eq!(found, NodeKind::Inner { axis, split, left });
            }
            (NodeKind::Leaf { first, count }, found) => {
                assert_eq!(found, NodeKind::Leaf { first, count });
                for &object in narrow.objects(first, count) {
                    let own = small[object as usize].bounds();
                    let leaf = &narrow.boxes[i as usize];
                    let (lo, hi) = (own.lo.as_dvec3(), own.hi.as_dvec3());
                    assert!(lo.cmple(leaf.hi).all() && hi.cmpge(leaf.lo).all());
                }
            }
        }
    }
}

#[test]
fn unpadded_visits_are_the_slab_tests_and_padded_ones_miss_nothing() {
    for offset in [0.0, 30.0] {
        let narrow = NarrowTree::of(&moved(offset).1).unwrap().0;
        let (mut differences, mut visits) = (0, 0);
        for line in lines(&narrow) {
            let plain = visited::<Counting>(&narrow, &line);
            let padded = visited::<Tracing>(&narrow, &line);
            let [o, d] = [line.origin, line.direction].map(|p| p.as_dvec3());
            let mut slabs = Vec::new();
            for (i, b) in (0..).zip(&narrow.boxes) {
                let own = Aabb {
                    lo: b.lo.as_vec3(),
                    hi: b.hi.as_vec3(),
                };
                if own.clip(&line, Span::FULL).is_some() {
                    slabs.push(i);
                }
                let exact = line_box(o, d, b).hit;
                if exact {
                    assert!(padded.binary_search(&i).is_ok(), "{line:?} loses {b:?}");
                }
                differences += usize::from(exact != plain.binary_search(&i).is_ok());
            }
            assert_eq!(plain, slabs, "{line:?}");
            visits += plain.len();
        }
        // Lines aimed at corners are what single precision gets wrong without padding.
        assert!(
            differences > 100 && differences < visits / 10,
            "{differences} of {visits}"
        );
    }
}

#[test]
fn the_triangle_test_leaks_at_no_edge() {
    // A fan around a point: a line to any point of an inner edge hits one of the two neighbours.
    let rim = |i: u32| {
        let (s, c) = (std::f32::consts::TAU * (i % 7) as f32 / 7.0).sin_cos();
        Vec3::new(c, s, 0.3 * c)
    };
    let middle = Vec3::new(0.03, -0.02, 0.1);
    let fan: Vec<Triangle<Vec3>> = (0..7)
        .map(|i| Triangle([middle, rim(i), rim(i + 1)]))
        .collect();
    let origin = Vec3::new(0.2, 0.1, 2.7);
    for i in 0..7 {
        for step in 0..=1000 {
            let target = middle.lerp(rim(i), 0.999 * step as f32 / 1000.0);
            let ray = Ray::new(Line::new(origin, target - origin), Span::from(0.0));
            let hits: Vec<f32> = fan.iter().filter_map(|t| t.intersect(&ray)).collect();
            assert!(!hits.is_empty(), "leak towards {target}");
            assert!(hits.iter().all(|t| (t - 1.0).abs() < 1e-5));
        }
    }
}

#[test]
fn resolution_warns_and_refuses() {
    let unit = |offset: f64| Aabb::new(DVec3::splat(offset - 0.5), DVec3::splat(offset + 0.5));
    for (offset, exponent) in [
        (0.0, 24),
        (1e3, 14),
        (-1e3, 14),
        (1e4, 10),
        (1e5, 7),
        (1e7, 0),
    ] {
        assert_eq!(
            resolution(&unit(offset)),
            f64::from(1 << exponent),
            "{offset}"
        );
    }
    let huge = Aabb::new(DVec3::ZERO, DVec3::splat(1e39));
    assert_eq!(resolution(&huge), 0.0);
    let warned = |offset| NarrowTree::of(&moved(offset).1).map(|found| found.1.is_some());
    assert_eq!(warned(0.0), Ok(false));
    assert_eq!(warned(1e4), Ok(true));
    let refusal = warned(1e6).unwrap_err();
    assert!(matches!(refusal, Refusal::TooCoarse { resolution, .. } if resolution < 256.0));
    let message = refusal.to_string();
    assert!(
        message.contains("256 are wanted") && message.contains("subtract the centre"),
        "{message}"
    );
    assert!(NarrowTree::however_coarse(&moved(1e6).1).is_ok());
}

#[test]
fn what_cannot_be_rounded_is_refused() {
    let far = Line::new(DVec3::new(0.0, 1e39, 0.0), DVec3::X);
    assert_eq!(narrow_line(&far), Err(Refusal::NotFinite(1e39)));
    let slow = Line::new(DVec3::ZERO, DVec3::splat(1e-60));
    assert_eq!(
        narrow_line(&slow),
        Err(Refusal::NoDirection(slow.direction))
    );
    let mut objects = Objects::default();
    objects.spheres.push(Sphere {
        centre: DVec3::ZERO,
        radius: 1.0,
    });
    assert_eq!(narrow_triangles(&objects), Err(Refusal::NoTriangles(1)));
}

#[test]
fn scales_whose_products_leave_f32_are_refused() {
    let soup = moved(0.0).0;
    let scaled = |exponent: i32| {
        let factor = 2f64.powi(exponent);
        let corners = |t: &Triangle| Triangle(t.0.map(|p| factor * p));
        let triangles: Vec<Triangle> = soup.iter().map(corners).collect();
        let bounds: Vec<Aabb> = triangles.iter().map(Triangle::bounds).collect();
        let tree = common::tree(&bounds, Strategy::Sah, "objects:2:16");
        (triangles, tree)
    };
    // Hits of the triangles by lines through their centres, as the tree's boxes are not asked.
    let hits = |exponent: i32| {
        let objects = Objects {
            triangles: scaled(exponent).0,
            ..Objects::default()
        };
        let narrow = narrow_triangles(&objects).unwrap();
        let hit = |t: &&Triangle<Vec3>| {
            let middle = (t.0[0] + t.0[1] + t.0[2]) / 3.0;
            let line = Line::new(middle, Vec3::new(0.48, 0.6, 0.64));
            t.intersect(&Ray::new(line, Span::FULL)).is_some()
        };
        narrow.iter().filter(hit).count()
    };
    let all = hits(0);
    assert!(all > 290, "{all}");
    for exponent in [-30, 30] {
        assert!(NarrowTree::of(&scaled(exponent).1).is_ok());
        assert_eq!(hits(exponent), all);
    }
    for exponent in [-100, -42, 42, 100] {
        let refusal = NarrowTree::of(&scaled(exponent).1).unwrap_err();
        assert!(matches!(refusal, Refusal::OutOfRange { .. }), "{refusal:?}");
        let message = refusal.to_string();
        assert!(
            message.contains("scale the scene by a power of two"),
            "{message}"
        );
        assert!(message.len() < 300, "{message}");
    }
    for exponent in [-100, 100] {
        assert!(hits(exponent) < all / 10, "{}", hits(exponent));
    }
    // Beyond f32 itself, and below its smallest number, where f32 is coarse too.
    let cube = |side: f64| fitness(&Aabb::new(DVec3::ZERO, DVec3::splat(side)));
    assert_eq!(cube(1e200), Err(Refusal::NotFinite(1e200)));
    assert!(matches!(cube(1e-200), Err(Refusal::OutOfRange { .. })));
    // What is small and far away is first to be centred.
    let far = Aabb::new(DVec3::splat(1e20), DVec3::splat(1e20 + 1e8));
    let refusal = fitness(&far).unwrap_err();
    assert!(
        matches!(refusal, Refusal::TooCoarse { .. }) && refusal.to_string().len() < 300,
        "{refusal}"
    );
    let slow = Line::new(DVec3::ZERO, DVec3::new(1e-150, 0.0, 0.0));
    let message = narrow_line(&slow).unwrap_err().to_string();
    assert!(message.contains("[1e-150, 0e0, 0e0]"), "{message}");
}
