//! Throughput of building and counting on one core, as ratios within one run.
//!
//! `cargo bench --bench throughput` prints a table and writes it to `data/bench/`. Jobs are interleaved, every job gives
//! the least time of its rounds: a shared machine can only add time. Read the ratios; the absolute figures are this
//! machine's.

use std::hint::black_box;
use std::path::Path;
use std::time::Instant;

use sahlab::cost::CostModel;
use sahlab::files::write_atomic;
use sahlab::geom::{Line, Span};
use sahlab::kd::stream::Streams;
use sahlab::kd::traverse::traverse_line;
use sahlab::kd::{Counts, NoProbe, Rules, Stack, Strategy, build};
use sahlab::rays::SurfaceLines;
use sahlab::scene::Scene;

const ROUNDS: usize = 7;
/// Lines counted per round, in one block.
const LINES: u64 = 1 << 17;

/// A name and what to time.
type Job<'a> = (&'a str, Box<dyn FnMut() + 'a>);

fn main() {
    let scene = Scene::load("simple:soup:100000").expect("a procedural scene");
    let triangles = scene.bounds.len() as f64;
    let mut rows =
        vec![["work", "unit", "per second and core", "over plain loop"].map(String::from)];
    for stop in ["cost-gain", "objects:2:16"] {
        let rules = |strategy| Rules {
            strategy,
            stop: stop.parse().expect("a stop rule"),
            cost: CostModel::WALD_HAVRAN,
        };
        let tree = build(&scene.bounds, scene.world, &rules(Strategy::Sah));
        let sampler = SurfaceLines {
            world: scene.world,
            seed: 1,
        };
        let lines: Vec<Line> = sampler.range(0..LINES).collect();
        let mut streams = Streams::default();
        let mut stack = Stack::default();
        let mut plain_counts = Counts::new(&tree);
        let mut stream_counts = Counts::new(&tree);
        let mut jobs: Vec<Job<'_>> = vec![
            (
                "lines",
                Box::new(|| {
                    black_box(
                        sampler
                            .range(0..LINES)
                            .fold(0.0, |sum, l| sum + l.direction.x),
                    );
                }),
            ),
            (
                "plain",
                Box::new(|| {
                    plain_counts = Counts::new(&tree);
                    plain_counts.lines = LINES;
                    for line in &lines {
                        traverse_line(&tree, line, Span::FULL, &mut stack, &mut plain_counts);
                    }
                }),
            ),
            (
                "streams",
                Box::new(|| {
                    stream_counts = Counts::new(&tree);
                    streams.count(&tree, &lines, &mut stream_counts);
                }),
            ),
            (
                "build sah",
                Box::new(|| {
                    black_box(build(&scene.bounds, scene.world, &rules(Strategy::Sah)));
                }),
            ),
            (
                "build spatial-median",
                Box::new(|| {
                    black_box(build(
                        &scene.bounds,
                        scene.world,
                        &rules(Strategy::SpatialMedian),
                    ));
                }),
            ),
        ];
        let mut least = vec![f64::INFINITY; jobs.len()];
        for _ in 0..ROUNDS {
            for (seconds, (_, job)) in least.iter_mut().zip(&mut jobs) {
                let started = Instant::now();
                job();
                *seconds = seconds.min(started.elapsed().as_secs_f64());
            }
        }
        let names: Vec<&str> = jobs.iter().map(|j| j.0).collect();
        drop(jobs);
        assert_eq!(
            plain_counts, stream_counts,
            "streams and plain loop disagree"
        );
        // The plain loop without counters, to show what the per-node counters cost it.
        let mut bare_stack = Stack::default();
        let bare = (0..ROUNDS).map(|_| {
            let started = Instant::now();
            for line in &lines {
                traverse_line(&tree, line, Span::FULL, &mut bare_stack, NoProbe);
            }
            started.elapsed().as_secs_f64()
        });
        let bare = bare.fold(f64::INFINITY, f64::min);

        let visits = stream_counts.visits() as f64;
        let plain = least[1];
        let what = format!(
            "soup of 100,000 triangles, {stop}, {} nodes, {:.0} visits a line",
            tree.nodes.len(),
            visits / LINES as f64
        );
        rows.push([what, String::new(), String::new(), String::new()]);
        rows.push([
            "plain loop, no counters".into(),
            "visits".into(),
            format!("{:.2e}", visits / bare),
            format!("{:.2}", plain / bare),
        ]);
        for (name, seconds) in names.iter().zip(&least) {
            rows.push(match *name {
                "lines" => [
                    "line generation".into(),
                    "lines".into(),
                    format!("{:.2e}", LINES as f64 / seconds),
                    String::new(),
                ],
                "plain" => [
                    "plain loop, hits per node".into(),
                    "visits".into(),
                    format!("{:.2e}", visits / seconds),
                    "1.00".into(),
                ],
                "streams" => [
                    "line streams, hits per node".into(),
                    "visits".into(),
                    format!("{:.2e}", visits / seconds),
                    format!("{:.2}", plain / seconds),
                ],
                build => [
                    build.into(),
                    "triangles".into(),
                    format!("{:.2e}", triangles / seconds),
                    String::new(),
                ],
            });
        }
    }
    let line = |r: &[String; 4]| format!("| {} |\n", r.join(" | "));
    let mut table =
        String::from("<!-- generated by `cargo bench --bench throughput`; do not edit -->\n\n");
    table += &line(&rows[0]);
    table += "|---|---|---:|---:|\n";
    rows[1..].iter().for_each(|r| table += &line(r));
    print!("{table}");
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/bench");
    write_atomic(&folder.join("throughput.md"), table.as_bytes())
        .expect("data/bench can be written");
}
