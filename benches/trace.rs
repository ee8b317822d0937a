//! Tracing on one core: nearest, any and all hits of isotropic rays, one by one and in streams, in either precision.
//!
//! `cargo bench --bench trace` takes about a minute. The dragon is measured where `experiments/fetch-meshes.sh` has fetched
//! it.

mod common;

use std::path::Path;

use common::{Jobs, Table, rules};
use glam::Vec3;
use sahlab::geom::{Ray, Span, Targets};
use sahlab::kd::narrow::{narrow_line, narrow_triangles};
use sahlab::kd::stream::{Lane, Lanes, RayStreams};
use sahlab::kd::{Ask, NarrowTree, NoProbe, Planes, Stack, Strategy, build_objects};
use sahlab::rays::SurfaceLines;
use sahlab::scene::Scene;

const ROUNDS: usize = 7;

/// Rays of a stream.
const RAYS: usize = 1 << 20;

/// As many of them are traced one by one, which takes longer: enough that most of what they read is not in the nearest caches.
const SINGLE: usize = 1 << 14;

fn main() {
    let mut table = Table::new("trace", &["M rays/s", "over nearest hits one by one, f64"]);
    let soup = Scene::load("simple:soup:100000").expect("a procedural scene");
    rows("soup of 100,000 triangles", &soup, &mut table);
    let dragon = Path::new(env!("CARGO_MANIFEST_DIR")).join("models/dragon_res3.ply");
    match Scene::load(&dragon.to_string_lossy()) {
        Ok(dragon) => rows("dragon of 47,794 triangles", &dragon, &mut table),
        Err(error) => eprintln!("left out: {error}; experiments/fetch-meshes.sh fetches it"),
    }
    table.finish();
}

/// Each question, each way, through a tree of boxes and one of clipped triangles.
fn rows(what: &str, scene: &Scene, table: &mut Table) {
    let sampler = SurfaceLines {
        world: scene.world,
        seed: 1,
    };
    let lines: Vec<_> = sampler.range(0..RAYS as u64).collect();
    let wide: Vec<Ray> = lines
        .iter()
        .map(|l| Ray::new(*l, Span::from(0.0)))
        .collect();
    let small: Vec<Ray<Vec3>> = lines
        .iter()
        .map(|l| Ray::new(narrow_line(l).expect("a line in range"), Span::from(0.0)))
        .collect();
    let triangles = narrow_triangles(&scene.objects).expect("triangles alone");
    let trees = [false, true].map(|clipped| {
        let rules = rules(Strategy::Sah, "cost-gain", clipped);
        let tree = build_objects(&scene.objects, &scene.bounds, scene.world, &rules);
        let (narrow, _) = NarrowTree::of(&tree).expect("a scene near the origin");
        (tree, narrow)
    });

    let (mut jobs, mut names) = (Jobs::default(), Vec::new());
    for ask in [Ask::Nearest, Ask::Any, Ask::All] {
        for ((tree, narrow), clipped) in trees.iter().zip(["", ", clipped splits"]) {
            for lanes in [None, Some(Lanes::widest())] {
                add(&mut jobs, tree, &scene.objects, &wide, ask, lanes);
                add(&mut jobs, narrow, &triangles[..], &small, ask, lanes);
                let way = match lanes {
                    None => "one by one".to_owned(),
                    Some(lanes) => format!("streams ({})", lanes.name()),
                };
                let rays = if lanes.is_some() { RAYS } else { SINGLE };
                for numbers in ["f64", "f32"] {
                    names.push((format!("{ask}, {way}, {numbers}{clipped}"), rays as f64));
                }
            }
        }
    }
    let seconds = jobs.least(ROUNDS, table);

    table.row(&[format!("**{what}**"), String::new(), String::new()]);
    let plain = names[0].1 / seconds[0];
    for ((name, rays), seconds) in names.into_iter().zip(seconds) {
        let rate = rays / seconds;
        table.row(&[
            name,
            format!("{:.3}", 1e-6 * rate),
            format!("{:.2}", rate / plain),
        ]);
    }
}

/// One way to ask.
fn add<'a, T: Planes<Vector: Lane>>(
    jobs: &mut Jobs<'a>,
    tree: &'a T,
    objects: &'a (impl Targets<Vector = T::Vector> + ?Sized),
    rays: &'a [Ray<T::Vector>],
    ask: Ask,
    lanes: Option<Lanes>,
) {
    if let Some(lanes) = lanes {
        let (mut streams, mut hits) = (RayStreams::with(lanes), Vec::new());
        jobs.add(move || streams.trace(tree, objects, rays, ask, &mut hits));
    } else {
        let mut stack = Stack::default();
        jobs.add(move || {
            let hit = |ray: &&Ray<T::Vector>| ask.hits(tree, objects, ray, &mut stack, NoProbe);
            rays[..SINGLE].iter().filter(hit).count()
        });
    }
}
