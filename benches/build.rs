//! Building: triangles per second by size, the exponent of the time in the size, and all cores against one.
//!
//! `cargo bench --bench build` takes about a minute. Soups of 10^4, 10^5 and 10^6 triangles, stop rule `cost-gain`.

mod common;

use std::thread::available_parallelism;

use common::{Jobs, Table, rules};
use rayon::{ThreadPool, ThreadPoolBuilder};
use sahlab::kd::{Rules, Strategy, Tree, build_objects};
use sahlab::scene::Scene;

/// Sizes, with their rounds.
const SIZES: [(u32, usize); 3] = [(10_000, 15), (100_000, 7), (LARGEST, 2)];

const LARGEST: u32 = 1_000_000;

fn main() {
    let cores = available_parallelism().map_or(1, usize::from);
    let pools = [1, cores].map(|threads| {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("a pool of threads")
    });
    let ways = [
        (Strategy::Sah, false),
        (Strategy::Sah, true),
        (Strategy::SahBins(32), false),
        (Strategy::SahCyclic, false),
        (Strategy::SpatialMedian, false),
    ]
    .map(|(strategy, clipped)| rules(strategy, "cost-gain", clipped));

    let all = format!("{cores} cores over one, 10⁶");
    let columns = ["10⁴, M/s", "10⁵, M/s", "10⁶, M/s", "exponent", &all];
    let mut table = Table::new("build", &columns);
    // Seconds of each way in each pool, by size.
    let seconds = SIZES.map(|(size, rounds)| {
        let scene = Scene::load(&format!("simple:soup:{size}")).expect("a procedural scene");
        let mut jobs = Jobs::default();
        for way in &ways {
            for pool in &pools {
                let scene = &scene;
                jobs.add(move || make(scene, way, pool));
            }
            // Seconds more for the largest, to the same end.
            if size == LARGEST {
                continue;
            }
            let [one, all] = pools.each_ref().map(|pool| make(&scene, way, pool));
            assert!(one == all, "the number of threads changes the tree");
        }
        jobs.least(rounds, &mut table)
    });

    for (i, way) in ways.iter().enumerate() {
        let clipped = if way.clipped { ", clipped" } else { "" };
        let one = seconds.each_ref().map(|seconds| seconds[2 * i]);
        let mut cells = vec![format!("`{}`{clipped}", way.strategy)];
        for ((size, _), seconds) in SIZES.iter().zip(one) {
            cells.push(format!("{:.2}", 1e-6 * f64::from(*size) / seconds));
        }
        // The slope of a line fitted to three points equally far apart is that from the first to the last.
        cells.push(format!("{:.2}", (one[2] / one[0]).log10() / 2.0));
        cells.push(format!("{:.2}", one[2] / seconds[2][2 * i + 1]));
        table.row(&cells);
    }
    table.finish();
}

fn make(scene: &Scene, rules: &Rules, pool: &ThreadPool) -> Tree {
    pool.install(|| build_objects(&scene.objects, &scene.bounds, scene.world, rules))
}
