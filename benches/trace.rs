//! Tracing on one core: nearest, any and all hits of isotropic rays.
//!
//! `cargo bench --bench trace` takes less than a minute. The dragon is measured where `experiments/fetch-meshes.sh` has
//! fetched it.

mod common;

use std::path::Path;

use common::{Jobs, Table, rules};
use sahlab::geom::{Ray, Span};
use sahlab::kd::{Ask, NoProbe, Stack, Strategy, Tree, build_objects};
use sahlab::rays::SurfaceLines;
use sahlab::scene::Scene;

const ROUNDS: usize = 15;

const RAYS: u64 = 1 << 14;

fn main() {
    let mut table = Table::new("trace", &["M rays/s", "over nearest hits, not clipped"]);
    let soup = Scene::load("simple:soup:100000").expect("a procedural scene");
    rows("soup of 100,000 triangles", &soup, &mut table);
    let dragon = Path::new(env!("CARGO_MANIFEST_DIR")).join("models/dragon_res3.ply");
    match Scene::load(&dragon.to_string_lossy()) {
        Ok(dragon) => rows("dragon of 47,794 triangles", &dragon, &mut table),
        Err(error) => eprintln!("left out: {error}; experiments/fetch-meshes.sh fetches it"),
    }
    table.finish();
}

/// Each question, through a tree of boxes and one of clipped triangles.
fn rows(what: &str, scene: &Scene, table: &mut Table) {
    let trees = [false, true].map(|clipped| {
        let rules = rules(Strategy::Sah, "cost-gain", clipped);
        build_objects(&scene.objects, &scene.bounds, scene.world, &rules)
    });
    let sampler = SurfaceLines {
        world: scene.world,
        seed: 1,
    };
    let lines = sampler.range(0..RAYS);
    let rays: Vec<Ray> = lines.map(|l| Ray::new(l, Span::from(0.0))).collect();
    let ways: Vec<(Ask, &Tree)> = [Ask::Nearest, Ask::Any, Ask::All]
        .into_iter()
        .flat_map(|ask| trees.iter().map(move |tree| (ask, tree)))
        .collect();

    let mut jobs = Jobs::default();
    for &(ask, tree) in &ways {
        let (rays, mut stack) = (&rays, Stack::default());
        jobs.add(move || {
            let hit = |ray: &&Ray| ask.hits(tree, &scene.objects, ray, &mut stack, NoProbe);
            rays.iter().filter(hit).count()
        });
    }
    let seconds = jobs.least(ROUNDS);

    table.row(&[format!("**{what}**"), String::new(), String::new()]);
    for (i, (ask, _)) in ways.iter().enumerate() {
        let clipped = if i % 2 == 1 { ", clipped splits" } else { "" };
        table.row(&[
            format!("{ask}, one ray at a time, f64{clipped}"),
            format!("{:.3}", 1e-6 * RAYS as f64 / seconds[i]),
            format!("{:.2}", seconds[0] / seconds[i]),
        ]);
    }
}
