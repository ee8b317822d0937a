//! Tracing: the nearest hit through any tree is brute force's, same object and same t, bit for bit.
#![allow(clippy::unwrap_used, missing_docs)]

mod common;

use common::scenes::{hard_rays, joints};
use common::{Leaves, rules};
use sahlab::geom::{Objects, Ray, Targets};
use sahlab::kd::hits::any_watched;
use sahlab::kd::{
    Hit, NodeKind, Rules, Stack, Strategy, Tracing, Work, build, build_objects, nearest, occluded,
    traverse,
};
use sahlab::scene::Scene;

fn brute_force(objects: &Objects, ray: &Ray) -> Option<Hit> {
    (0..objects.len() as u32).fold(None, |best, object| match objects.intersect(object, ray) {
        Some(t) => Hit::nearer(best, object, t),
        None => best,
    })
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
                for ray in hard_rays(&scene, &tree, 300) {
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
            for mut ray in hard_rays(&scene, &tree, 200) {
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
