//! Walks along links, through face trees and by restarting: the stack's leaves in the stack's order, and its hits to the bit.
#![allow(clippy::unwrap_used, missing_docs)]

#[path = "../common/mod.rs"]
mod common;
mod ties;
mod watch;

use glam::DVec3;
use sahlab::geom::{Aabb, Line, Ray, Span, Targets, Triangle, Vector};
use sahlab::kd::hits::nearest_in;
use sahlab::kd::narrow::{narrow_line, narrow_triangles};
use sahlab::kd::{
    Ask, Counting, Hit, NarrowTree, NoProbe, Planes, Restart, Stack, Strategy, Tracing, Tree, Walk,
    Work, build,
};
use sahlab::rays::SurfaceLines;
use sahlab::scene::Scene;

use common::{random_boxes, rules, tree, world};
use watch::{FallBacks, Ways};

type Hits<T> = Vec<Option<Hit<T>>>;

/// What a ray hits, whatever it asks and in either mode; and how many leaves that took.
fn hits<W: Walk>(
    walk: &W,
    objects: &[Triangle<W::Vector>],
    ray: &Ray<W::Vector>,
) -> Hits<<W::Vector as Vector>::Real>
where
    [Triangle<W::Vector>]: Targets<Vector = W::Vector>,
{
    let mut stack = Stack::default();
    let mut hits: Vec<_> = Ask::ALL
        .map(|ask| ask.trace(walk, objects, ray, &mut stack, NoProbe))
        .into();
    hits.push(nearest_in::<Counting, W>(
        walk, objects, ray, &mut stack, NoProbe,
    ));
    hits
}

/// The same hits along every way.
fn same_hits<T: Planes>(ways: &Ways<T>, objects: &[Triangle<T::Vector>], ray: &Ray<T::Vector>) {
    let expected = hits(ways.tree, objects, ray);
    let each = [
        hits(&ways.links.walk(ways.tree), objects, ray),
        hits(&ways.faces.walk(ways.tree), objects, ray),
        hits(&Restart(ways.tree), objects, ray),
    ];
    for found in each {
        // Hits are never NaN, and 0 of either sign is the same t.
        assert_eq!(found, expected, "{:?} {:?}", ray.line, ray.span);
    }
}

/// A ray in both precisions, checked in both modes.
struct Both<'a> {
    wide: Ways<'a, Tree>,
    narrow: Ways<'a, NarrowTree>,
}

impl Both<'_> {
    fn check(&self, line: &Line, span: Span, limits: &[f64]) -> FallBacks {
        let mut sum = self.wide.check_up_to::<Counting>(line, span, limits);
        sum += self.wide.check_up_to::<Tracing>(line, span, limits);
        let line = narrow_line(line).unwrap();
        let span = narrow_span(span);
        let limits: Vec<f32> = limits.iter().map(|&t| t as f32).collect();
        sum += self.narrow.check_up_to::<Counting>(&line, span, &limits);
        sum += self.narrow.check_up_to::<Tracing>(&line, span, &limits);
        sum
    }
}

fn narrow_span(span: Span) -> Span<f32> {
    Span {
        t0: span.t0 as f32,
        t1: span.t1 as f32,
    }
}

/// Rays through a box, of which not one is special.
fn random_lines(world: Aabb, n: u64) -> impl Iterator<Item = Line> {
    SurfaceLines { world, seed: 11 }.range(0..n)
}

#[test]
fn random_rays_hardly_ever_fall_back() {
    let bounds = random_boxes(3000, 3);
    let (mut counting, mut tracing) = (FallBacks::default(), FallBacks::default());
    let (mut narrow_counting, mut narrow_tracing) = (counting, counting);
    for strategy in Strategy::ALL {
        let wide = tree(&bounds, strategy, "objects:2:20");
        let narrow = NarrowTree::however_coarse(&wide).unwrap();
        let both = Both {
            wide: Ways::new(&wide),
            narrow: Ways::new(&narrow),
        };
        for line in random_lines(world(&bounds), 1000) {
            let inside = Line::new(line.at(0.4), line.direction);
            for line in [line, inside] {
                let (span, limits) = (Span::from(0.0), [0.3]);
                counting += both.wide.check_up_to::<Counting>(&line, span, &limits);
                tracing += both.wide.check_up_to::<Tracing>(&line, span, &limits);
                let line = narrow_line(&line).unwrap();
                let (span, limits) = (Span::from(0.0), [0.3]);
                narrow_counting += both.narrow.check_up_to::<Counting>(&line, span, &limits);
                narrow_tracing += both.narrow.check_up_to::<Tracing>(&line, span, &limits);
            }
        }
    }
    println!("{counting:?}\n{tracing:?}\n{narrow_counting:?}\n{narrow_tracing:?}");
    assert!(tracing.leaves > 10 * tracing.rays);
    // A traced ray falls back where two planes are within twelve units in the last place of each other: about once in 10^13
    // leaves in f64, once in 50,000 in f32; a counted one only where they are equal.
    assert_eq!(counting.by, [0; 3]);
    assert_eq!(tracing.by, [0; 3]);
    for by in narrow_counting.by {
        assert!(5000 * by <= narrow_counting.rays, "{narrow_counting:?}");
    }
    for by in narrow_tracing.by {
        assert!(1000 * by <= narrow_tracing.rays, "{narrow_tracing:?}");
    }
}

#[test]
fn ties_fall_back() {
    let bounds = common::gridded_boxes(200, 1);
    let wide = tree(&bounds, Strategy::Sah, "objects:2:16");
    let narrow = NarrowTree::of(&wide).unwrap().0;
    let both = Both {
        wide: Ways::new(&wide),
        narrow: Ways::new(&narrow),
    };
    let mut sum = FallBacks::default();
    for line in common::hard_lines(&bounds, 400).into_iter().skip(400) {
        for span in [Span::FULL, Span::from(0.0)] {
            sum += both.check(&line, span, &[0.2, 0.5]);
        }
    }
    println!("{sum:?}");
    for by in sum.by {
        assert!(4 * by > sum.rays, "{sum:?}");
    }
}

#[test]
fn scenes_are_hit_alike_along_every_way() {
    let (mut rays, mut hit) = (0, 0);
    for name in [
        "simple:soup:400",
        "spd:tetra:4",
        "hard:coplanar",
        "hard:lattice",
        "hard:planar",
        "hard:touching",
        "hard:needles",
        "hard:degenerate",
        "hard:terrain:8",
    ] {
        let scene = Scene::load(name).unwrap();
        let triangles = &scene.objects.triangles;
        let small = narrow_triangles(&scene.objects).unwrap();
        for strategy in Strategy::ALL {
            let wide = build(&scene.bounds, scene.world, &rules(strategy, "cost-gain"));
            let narrow = NarrowTree::however_coarse(&wide).unwrap();
            let (wide, narrow) = (Ways::new(&wide), Ways::new(&narrow));
            for (i, line) in random_lines(scene.world, 150).enumerate() {
                let target = common::target(&scene.objects, i);
                let to_it = Line::new(line.origin, target - line.origin);
                let mut along = DVec3::ZERO;
                along[i % 3] = if i % 2 == 0 { 1.0 } else { -1.0 };
                let through = Line::new(target - along, along);
                for line in [line, to_it, through] {
                    for span in [Span::from(0.0), Span::FULL, Span { t0: 1e-9, t1: 1.0 }] {
                        let ray = Ray::new(line, span);
                        same_hits(&wide, &triangles[..], &ray);
                        let found = Ask::Any.hits(
                            &wide.links.walk(wide.tree),
                            &triangles[..],
                            &ray,
                            &mut Stack::default(),
                            NoProbe,
                        );
                        (rays, hit) = (rays + 1, hit + usize::from(found));
                        let ray = Ray::new(narrow_line(&line).unwrap(), narrow_span(span));
                        same_hits(&narrow, &small[..], &ray);
                    }
                }
            }
        }
    }
    assert!(4 * hit > rays, "{hit} hits of {rays} rays");
}

#[test]
fn work_is_the_stacks_for_rays_that_stop() {
    let scene = Scene::load("simple:soup:2000").unwrap();
    let triangles = &scene.objects.triangles[..];
    let tree = build(
        &scene.bounds,
        scene.world,
        &rules(Strategy::Sah, "cost-gain"),
    );
    let ways = Ways::new(&tree);
    let mut stack = Stack::default();
    for line in random_lines(scene.world, 3000) {
        let ray = Ray::new(line, Span::from(0.0));
        for ask in Ask::ALL {
            let mut works = [Work::default(); 4];
            let [a, b, c, d] = &mut works;
            ask.trace(&tree, triangles, &ray, &mut stack, a);
            ask.trace(&ways.links.walk(&tree), triangles, &ray, &mut stack, b);
            ask.trace(&ways.faces.walk(&tree), triangles, &ray, &mut stack, c);
            ask.trace(&Restart(&tree), triangles, &ray, &mut stack, d);
            let [by_stack, by_links, by_faces, by_restart] = works;
            for work in [by_links, by_faces, by_restart] {
                assert_eq!((work.leaves, work.tests), (by_stack.leaves, by_stack.tests));
            }
            assert!(by_faces.inner <= by_links.inner && by_links.inner <= by_stack.inner);
            assert!(by_stack.inner <= by_restart.inner);
        }
    }
}

#[test]
fn a_line_whose_planes_overflow_falls_back() {
    let bounds: Vec<Aabb> = (0..8)
        .map(|i| {
            let lo = DVec3::splat(f64::from(i));
            Aabb::new(lo, lo + DVec3::ONE)
        })
        .collect();
    let tree = tree(&bounds, Strategy::Sah, "objects:1");
    let ways = Ways::new(&tree);
    let mut sum = FallBacks::default();
    for direction in [
        DVec3::new(1e-308, 1e-308, 1.1e-308),
        DVec3::new(-1e-308, 0.0, 1e-308),
        DVec3::new(1e-308, 0.0, 0.0),
    ] {
        for origin in [DVec3::splat(3.5), DVec3::splat(-1e10), DVec3::splat(1e10)] {
            for span in [Span::FULL, Span::from(0.0)] {
                let line = Line::new(origin, direction);
                sum += ways.check_up_to::<Counting>(&line, span, &[0.0, 1e300]);
                sum += ways.check_up_to::<Tracing>(&line, span, &[0.0, 1e300]);
            }
        }
    }
    assert!(sum.by.iter().all(|&by| by > 0), "{sum:?}");
}

#[test]
fn one_leaf_has_no_links() {
    let unit = Aabb::new(DVec3::ZERO, DVec3::ONE);
    let tree = tree(&[unit], Strategy::Sah, "objects:1");
    assert_eq!(tree.nodes.len(), 1);
    let ways = Ways::new(&tree);
    assert_eq!(ways.links.facts().outside, 6);
    let line = Line::new(DVec3::splat(0.5), DVec3::new(0.3, -0.2, 0.9));
    let sum = ways.check_up_to::<Tracing>(&line, Span::FULL, &[0.0]);
    assert_eq!((sum.by, sum.leaves), ([0; 3], 2));
}
