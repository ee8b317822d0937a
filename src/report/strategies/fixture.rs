//! A small run whose averages can be checked by hand.

use super::Strategies;
use super::havran::NAMES;
use crate::report::{Content, Run, fixture};
use crate::study::records::{CellRecord, PassTiming, RayRecord, Summary};

pub const SCENES: [&str; 3] = ["spd:balls:4", "spd:gears:4", "spd:tree:11"];
pub const STOPS: [&str; 2] = ["objects:2:16", "automatic"];

/// Everything of a tree as a multiple of the reference's: by strategy (1 to 5), over each scene.
const RATIOS: [[f64; 3]; 5] = [
    [2.0, 4.0, 32.0],
    [3.0, 3.0, 3.0],
    [1.0, 1.0, 1.0],
    [1.0, 1.0, 0.9],
    [1.05, 1.0, 1.0],
];

/// Rays and hits of the kinds, as they are in `spd:gears:4`, but for three more eye rays that hit.
const RAYS: [(&str, u64, u64); 3] = [
    ("primary", 263_169, 245_335),
    ("shadow", 2_088_012, 1_057_557),
    ("secondary", 494_338, 100_000),
];

/// Trees of Havran's strategies over three scenes under two stop rules. A tree of the reference costs 100 and takes
/// 10 seconds.
pub fn strategies() -> Strategies {
    let mut run = Strategies {
        cells: Vec::new(),
        rays: Vec::new(),
        timings: Some(Vec::new()),
        pictures: "no/such/pictures".into(),
        slice: None,
    };
    for (i, scene) in SCENES.iter().enumerate() {
        for stop in STOPS {
            for (strategy, ratios) in NAMES.iter().zip(RATIOS) {
                add(&mut run, scene, stop, strategy, ratios[i]);
            }
        }
    }
    run
}

fn add(run: &mut Strategies, scene: &str, stop: &str, strategy: &str, ratio: f64) {
    let cell = CellRecord {
        cell: format!("{scene} {stop} {strategy}"),
        stop: stop.to_owned(),
        c_predicted: 100.0 * ratio,
        c_counted: 100.0 * ratio,
        ..fixture::cell(scene, strategy, 601)
    };
    for (kind, rays, hits) in RAYS {
        run.rays.push(RayRecord {
            cell: cell.cell.clone(),
            scene: scene.to_owned(),
            strategy: strategy.to_owned(),
            stop: stop.to_owned(),
            kind: kind.to_owned(),
            rays,
            hits,
            inner_visits: (1e6 * ratio) as u64,
            leaf_visits: (1e6 * ratio) as u64,
            object_tests: (1e6 * ratio) as u64,
        });
    }
    for (what, seconds) in [
        ("build", 1.0),
        ("primary", 2.0),
        ("shadow", 3.0),
        ("secondary", 4.0),
    ] {
        let seconds = seconds * ratio;
        run.timings.get_or_insert_default().push(PassTiming {
            cell: cell.cell.clone(),
            scene: scene.to_owned(),
            strategy: strategy.to_owned(),
            stop: stop.to_owned(),
            what: what.to_owned(),
            units: 1000,
            timed_units: 1000,
            rounds: 4,
            seconds,
            sampling_se_s: 0.0,
            half_a_s: seconds,
            half_b_s: 1.01 * seconds,
            disturbed: false,
            load_average: None,
            revision: String::new(),
            pass_s: 0.1,
        });
    }
    run.cells.push(cell);
}

/// The summary of such a run.
pub fn summary() -> Summary {
    Summary {
        kind: "strategies".to_owned(),
        stop: None,
        slope_within: None,
        figure_scene: None,
        figure_strategy: None,
        ..fixture::summary("")
    }
}

/// The run as it is read.
pub fn run(strategies: Strategies) -> Run {
    Run {
        dir: "data/test".into(),
        summary: summary(),
        content: Content::Strategies(strategies),
    }
}
