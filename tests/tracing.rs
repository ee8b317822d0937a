//! Tracing: the nearest hit through any tree is brute force's, same object and same t, bit for bit.
#![allow(clippy::unwrap_used, missing_docs)]

mod common;

use common::{Leaves, rules, target};
use glam::DVec3;
use sahlab::geom::{Cone, Line, Objects, Polygon, Ray, Span, Sphere, Targets};
use sahlab::kd::hits::any_watched;
use sahlab::kd::{
    Hit, NodeKind, Rules, Stack, Strategy, Tracing, Tree, Work, build, build_objects, nearest,
    occluded, traverse,
};
use sahlab::rays::{SurfaceLines, Uniforms};
use sahlab::scene::Scene;

fn brute_force(objects: &Objects, ray: &Ray) -> Option<Hit> {
    (0..objects.len() as u32).fold(None, |best, object| match objects.intersect(object, ray) {
        Some(t) => Hit::nearer(best, object, t),
        None => best,
    })
}

/// Rays of every hard family.
fn rays(scene: &Scene, tree: &Tree, n: usize) -> Vec<Ray> {
    let mut rays = Vec::new();
    let world = scene.world;
    let size = world.extent().length();
    let mut uniforms = Uniforms::starting_at(77, 0);
    for (i, line) in (SurfaceLines { world, seed: 3 })
        .range(0..n as u64)
        .enumerate()
    {
        let [x, y, z, w] = uniforms.next4();
        let inside = world.lo + DVec3::new(x, y, z) * world.extent();
        let target = target(&scene.objects, (w * 1e6) as usize + i);
        let mut along = DVec3::ZERO;
        along[i % 3] = if i.is_multiple_of(2) { size } else { -size };
        // Isotropic from the surface; from inside; a whole line; to a corner or an edge; along an axis through it.
        rays.push(Ray::new(line, Span::from(0.0)));
        rays.push(Ray::new(Line::new(inside, line.direction), Span::from(0.0)));
        rays.push(Ray::new(line, Span::FULL));
        rays.push(Ray::new(
            Line::new(line.origin, target - line.origin),
            Span::from(0.0),
        ));
        rays.push(Ray::new(Line::new(target - along, along), Span::from(0.0)));
        // A shadow segment between two points; in a split plane, slanted and along an axis.
        let shadow = Span { t0: 1e-9, t1: 1.0 };
        if target != inside {
            rays.push(Ray::new(Line::new(inside, target - inside), shadow));
        }
        let node = (w * tree.nodes.len() as f64) as usize;
        if let NodeKind::Inner { axis, split, .. } = tree.nodes[node].kind() {
            let (mut origin, mut slanted) = (line.origin, line.direction);
            origin[axis] = split;
            slanted[axis] = if i.is_multiple_of(2) { 0.0 } else { -0.0 };
            if slanted != DVec3::ZERO {
                rays.push(Ray::new(Line::new(origin, slanted), Span::from(0.0)));
            }
            let mut straight = DVec3::ZERO;
            straight[(axis + 1) % 3] = 1.0;
            rays.push(Ray::new(Line::new(origin, straight), Span::FULL));
        }
    }
    rays
}

/// Cylinders along axes with spheres at their ends, tapering branches of any direction, tiny ones, and a large floor.
fn joints(n: usize, seed: u64) -> Scene {
    let mut uniforms = Uniforms::starting_at(seed, 0);
    let mut objects = Objects::default();
    for i in 0..n {
        let [x, y, z, w] = uniforms.next4();
        let [a, b, c, taper] = uniforms.next4();
        let base = (8.0 * DVec3::new(x, y, z)).round() / 8.0;
        let towards = DVec3::new(a, b, c) - DVec3::splat(0.5);
        let (axis, radius, apex) = match i % 4 {
            0 => (0.25 * DVec3::AXES[i / 4 % 3], 0.02, 0.02),
            1 => (0.5 * towards, 0.05 * w, 0.05 * w * taper),
            2 => (0.5 * towards, 0.03, 0.0),
            _ => (0.01 * towards, 2.5e-4, 2e-4),
        };
        objects.cones.push(Cone {
            base,
            base_radius: radius,
            apex: base + axis,
            apex_radius: apex,
        });
        objects.spheres.push(Sphere {
            centre: base,
            radius,
        });
    }
    let floor = [
        [-9.0, -9.0],
        [9.0, -9.0],
        [9.0, 9.0],
        [1.0, 1.0],
        [-9.0, 9.0],
    ];
    let floor = floor.map(|[x, y]| DVec3::new(x, y, 0.0));
    objects.polygons.push(Polygon::new(floor.into()).unwrap());
    Scene::new("joints", objects, Vec::new()).unwrap()
}

#[test]
fn nearest_hits_are_brute_forces() {
    let named = [
        "spd:tetra:4",
        "spd:balls:2",
        "simple:mixture:400",
        "simple:flat:300",
        "simple:overlapping:40",
        "simple:soup:300",
    ];
    let named = named.map(|name| Scene::load(name).unwrap());
    for scene in named.into_iter().chain([joints(60, 1), joints(200, 2)]) {
        let name = &scene.name;
        let (mut all, mut hits) = (0, 0);
        for strategy in Strategy::ALL {
            for (stop, clipped) in [
                ("objects:1", false),
                ("cost-gain", false),
                ("objects:1", true),
                ("cost-gain", true),
            ] {
                let rules = Rules {
                    clipped,
                    ..rules(strategy, stop)
                };
                let tree = build_objects(&scene.objects, &scene.bounds, scene.world, &rules);
                let mut stack = Stack::default();
                for ray in rays(&scene, &tree, 300) {
                    let expected = brute_force(&scene.objects, &ray);
                    let found = nearest(&tree, &scene.objects, &ray, &mut stack);
                    assert_eq!(found, expected, "{name} {rules:?}: {ray:?}");
                    all += 1;
                    hits += usize::from(found.is_some());
                }
            }
        }
        assert!(
            10 * hits > all,
            "{name}: {hits} hits of {all} rays: too few to mean anything"
        );
    }
}

#[test]
fn any_hits_are_brute_forces_and_end_at_the_first_object() {
    for name in ["spd:tetra:4", "simple:mixture:400", "simple:soup:300"] {
        let scene = Scene::load(name).unwrap();
        let (mut blocked, mut free) = (0, 0);
        for strategy in Strategy::ALL {
            let tree = build(&scene.bounds, scene.world, &rules(strategy, "cost-gain"));
            let mut stack = Stack::default();
            for mut ray in rays(&scene, &tree, 200) {
                // Whole, and cut short just before, at and behind the nearest hit.
                let hit = brute_force(&scene.objects, &ray);
                let ends = hit.map(|h| [0.999, 1.0, 1.5].map(|f| h.t * f));
                for end in ends.iter().flatten().chain([&ray.span.t1.clone()]) {
                    ray.span.t1 = *end;
                    let expected = brute_force(&scene.objects, &ray).is_some();
                    let found = occluded(&tree, &scene.objects, &ray, &mut stack);
                    assert_eq!(found, expected, "{name} {strategy}: {ray:?}");
                    blocked += usize::from(found);
                    free += usize::from(!found);

                    // The same leaves as without an end, up to the first object that is hit.
                    let mut all = Leaves::default();
                    let endless = |_: &[u32], _: &mut Leaves| f64::INFINITY;
                    traverse::<Tracing, _, _>(
                        &tree, &ray.line, ray.span, &mut stack, &mut all, endless,
                    );
                    let (mut leaves, mut tests) = (0, 0);
                    'search: for &leaf in &all.0 {
                        leaves += 1;
                        let NodeKind::Leaf { first, count } = tree.nodes[leaf as usize].kind()
                        else {
                            panic!("a leaf is a leaf");
                        };
                        for &object in tree.objects(first, count) {
                            tests += 1;
                            if scene.objects.intersect(object, &ray).is_some() {
                                break 'search;
                            }
                        }
                    }
                    let mut work = Work::default();
                    any_watched(&tree, &scene.objects, &ray, &mut stack, &mut work);
                    assert_eq!((work.leaves, work.tests), (leaves, tests));
                }
            }
        }
        assert!(
            blocked > 1000 && free > 1000,
            "{name}: {blocked} {free}: too few to mean anything"
        );
    }
}
