//! A small run whose ratios can be checked by hand.

use super::Traversal;
use super::against::{PRECISIONS, STACK, WAYS};
use crate::report::{Content, Run};
use crate::study::records::{LinkRecord, PassTiming, Summary, TraversalRecord, Verdict};

pub const SCENES: [&str; 4] = ["spd:balls:3", "spd:gears:2", "spd:tree:8", "spd:balls:4"];
pub const SETS: [&str; 2] = ["lines", "lines:nearest"];

/// Seconds of links over the stack's, by scene.
pub const LINKS: [f64; 4] = [0.5, 1.0, 2.0, 4.0];

fn walk(scene: &str, rays: &str, precision: &str, way: &str, inner: u64) -> TraversalRecord {
    let tests = (rays != "lines").then_some(3000);
    TraversalRecord {
        cell: format!("cell of {scene}"),
        scene: scene.into(),
        strategy: "sah".into(),
        stop: "cost-gain".into(),
        rays: rays.into(),
        random: true,
        precision: precision.into(),
        way: way.into(),
        cast: 1000,
        entered: 1000,
        hits: tests.map(|_| 700),
        inner_visits: inner,
        leaf_visits: 5000,
        object_tests: tests,
        links: if way == STACK { 0 } else { 4000 },
        fall_backs: u64::from(way != STACK && precision == "f32"),
        thin_fall_backs: 0,
        differing_hits: tests.map(|_| 0),
        differing_leaves: 0,
        broken: 0,
    }
}

/// A time whose odd rounds took a share `apart` longer than the even ones.
fn time(scene: &str, what: String, seconds: f64, apart: f64) -> PassTiming {
    PassTiming {
        cell: format!("cell of {scene}"),
        scene: scene.into(),
        strategy: "sah".into(),
        stop: "cost-gain".into(),
        what,
        units: 1000,
        timed_units: 1000,
        rounds: 4,
        pass_s: f64::INFINITY,
        seconds,
        sampling_se_s: 0.0,
        half_a_s: seconds,
        half_b_s: seconds * (1.0 + apart),
        disturbed: apart > 0.03,
        load_average: None,
        revision: String::new(),
    }
}

/// Along links and face trees half of the inner nodes, by restarts twice as many; in f32 only the first scene has a test.
pub fn traversal() -> Traversal {
    let mut run = Traversal {
        walks: Vec::new(),
        links: Vec::new(),
        timings: Vec::new(),
    };
    for (number, (scene, factor)) in SCENES.into_iter().zip(LINKS).enumerate() {
        for precision in PRECISIONS {
            for rays in SETS {
                if (precision, rays) == ("f32", "lines:nearest") && number > 0 {
                    continue;
                }
                let inner = [10_000, 5_000, 5_000, 20_000];
                let seconds = [1.0, factor, 1.005, 2.0];
                let ways = [STACK].into_iter().chain(WAYS);
                for ((way, inner), seconds) in ways.zip(inner).zip(seconds) {
                    run.walks.push(walk(scene, rays, precision, way, inner));
                    // The last scene was disturbed along links.
                    let apart = if number == 3 && way == "links" {
                        8.0
                    } else {
                        0.002
                    };
                    let what = format!("{rays} {precision} {way}");
                    run.timings.push(time(scene, what, seconds, apart));
                }
            }
            run.links.push(LinkRecord {
                cell: format!("cell of {scene}"),
                scene: scene.into(),
                strategy: "sah".into(),
                stop: "cost-gain".into(),
                precision: precision.into(),
                objects: 1000,
                depth: 16,
                inner_nodes: 999,
                leaves: 1000,
                thin_leaves: 3,
                tree_bytes: 40_000 + number as u64,
                links_to_leaves: 4000,
                links_to_inner: 1000,
                links_outside: 1000,
                link_bytes: 80_000 + 2 * number as u64,
                face_tree_bytes: 120_000 + 3 * number as u64,
            });
            for (way, seconds) in [("links", 0.1), ("face-trees", 0.3)] {
                let what = format!("build {way} {precision}");
                run.timings.push(time(scene, what, seconds, 0.0));
            }
        }
        run.timings.push(time(scene, "build".into(), 1.0, 0.0));
    }
    run
}

pub fn summary() -> Summary {
    Summary {
        kind: "traversal".into(),
        verdicts: vec![Verdict {
            name: "hits".into(),
            held: true,
            message: "0 of 15000 rays differ".into(),
        }],
        ..crate::report::fixture::summary("")
    }
}

pub fn run(content: Traversal) -> Run {
    Run {
        dir: "data/test".into(),
        summary: summary(),
        content: Content::Traversal(content),
    }
}
