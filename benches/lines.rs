//! Making lines: what it costs beside counting them, and the samplers against independent points.
//!
//! `cargo bench --bench lines` takes seconds.

mod common;

use common::{Jobs, Table, rules};
use glam::DVec3;
use sahlab::geom::Line;
use sahlab::kd::stream::{BLOCK, Streams};
use sahlab::kd::{Counts, Strategy, build};
use sahlab::rays::{PointSet, Sampler, SurfaceLines};
use sahlab::scene::Scene;

const ROUNDS: usize = 15;

fn main() {
    let mut table = Table::new("lines", &["M/s", "ratio"]);
    let scene = Scene::load("simple:soup:100000").expect("a procedural scene");
    against_counting(&scene, &mut table);
    samplers(&scene, &mut table);
    table.finish();
}

/// Lines made, and lines counted by streams.
fn against_counting(scene: &Scene, table: &mut Table) {
    let rules = rules(Strategy::Sah, "cost-gain", false);
    let tree = build(&scene.bounds, scene.world, &rules);
    let sampler = SurfaceLines {
        world: scene.world,
        seed: 1,
    };
    let lines: Vec<Line> = sampler.range(0..BLOCK).collect();
    let mut buffer = lines.clone();
    let mut streams = Streams::default();
    let mut jobs = Jobs::default();
    jobs.add(|| {
        let mut counts = Counts::new(&tree);
        streams.count(&tree, &lines, &mut counts);
        counts
    });
    // Into a buffer that is kept, as counting does: memory that is asked for anew costs more than the lines.
    jobs.add(|| {
        buffer.clear();
        buffer.extend(sampler.range(0..BLOCK));
        buffer.last().copied()
    });
    let seconds = jobs.least(ROUNDS, table);
    rows(
        "**making against counting**",
        [
            "lines counted by streams, soup of 100,000 triangles, `cost-gain`",
            "lines made",
        ]
        .map(str::to_owned)
        .into_iter()
        .zip(seconds.iter().map(|s| BLOCK as f64 / s)),
        table,
    );
}

/// The samplers: their points alone, and as lines.
fn samplers(scene: &Scene, table: &mut Table) {
    let sets = Sampler::ALL.map(|sampler| {
        let size = sampler.nearest_size(BLOCK);
        (sampler, size, PointSet::new(sampler, 1, 0, size))
    });
    let mut jobs = Jobs::default();
    for (_, size, set) in &sets {
        jobs.add(|| {
            let points = set.range(0..*size);
            points.fold(0.0, |sum, u| sum + u[0] + u[1] + u[2] + u[3])
        });
    }
    for (_, size, set) in &sets {
        jobs.add(|| {
            let lines = set.lines(&scene.world, 0..*size);
            lines.fold(DVec3::ZERO, |sum, l| sum + l.origin + l.inverse)
        });
    }
    let seconds = jobs.least(ROUNDS, table);
    for (what, seconds) in ["points", "lines"]
        .into_iter()
        .zip(seconds.chunks(sets.len()))
    {
        let rates = sets
            .iter()
            .zip(seconds)
            .map(|((sampler, size, _), seconds)| {
                (format!("{what}, `{sampler}`"), *size as f64 / seconds)
            });
        rows(&format!("**samplers, their {what}**"), rates, table);
    }
}

/// A heading, and rows with their ratio to the first.
fn rows(heading: &str, rates: impl Iterator<Item = (String, f64)>, table: &mut Table) {
    table.row(&[heading.into(), String::new(), String::new()]);
    let mut first = None;
    for (what, rate) in rates {
        let ratio = rate / *first.get_or_insert(rate);
        table.row(&[what, format!("{:.2}", 1e-6 * rate), format!("{ratio:.2}")]);
    }
}
