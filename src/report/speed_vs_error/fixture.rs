//! Rows a run of this kind could have left behind, for the tests of its report.

use super::SpeedVsError;
use crate::report::{Content, Run};
use crate::study::records::{
    CoverageRecord, EnoughRecord, ErrorRecord, ExponentRecord, PassTiming, PlaneRecord,
    PrecisionRecord, Summary, Verdict,
};

pub const SCENES: [&str; 2] = ["simple:uniform:400", "spd:balls:3"];
/// A sampler, its error of C and of nodes at one line, its exponent, nanoseconds of a line.
const SAMPLERS: [(&str, f64, f64, f64, f64); 4] = [
    ("random", 0.5, 1.0, 0.5, 500.0),
    ("stratified", 0.6, 1.1, 0.55, 510.0),
    ("sobol", 0.7, 1.2, 0.65, 530.0),
    ("conditional", 0.3, 0.5, 0.5, 4000.0),
];

/// Seconds of something done with a tree.
pub fn timing(cell: &str, what: &str, units: u64, seconds: f64) -> PassTiming {
    PassTiming {
        cell: cell.into(),
        scene: cell.into(),
        strategy: "sah".into(),
        stop: "objects:2:16".into(),
        what: what.into(),
        units,
        timed_units: units,
        rounds: 8,
        pass_s: 1.0,
        seconds,
        sampling_se_s: 0.0,
        half_a_s: seconds,
        half_b_s: seconds,
        disturbed: false,
        load_average: None,
        revision: "test".into(),
    }
}

/// Every part, in two scenes.
pub fn parts() -> SpeedVsError {
    let mut run = SpeedVsError {
        errors: Vec::new(),
        exponents: Vec::new(),
        enough: Vec::new(),
        precision: Vec::new(),
        planes: Vec::new(),
        coverage: Vec::new(),
        timings: Vec::new(),
    };
    for scene in SCENES {
        samplers(&mut run, scene);
        precision(&mut run, scene);
        planes(&mut run, scene);
    }
    coverage(&mut run);
    run
}

fn samplers(run: &mut SpeedVsError, scene: &str) {
    for rays in ["lines", "lines:nearest"] {
        for (sampler, of_cost, of_nodes, exponent, ns) in SAMPLERS {
            if sampler == "conditional" && rays != "lines" {
                continue;
            }
            for lines in [256u64, 1024, 4096, 16_384, 65_536] {
                let what = format!("{sampler} {rays} {lines}");
                let seconds = 1e-9 * ns * lines as f64;
                run.timings.push(timing(scene, &what, lines, seconds));
                for (quantity, factor) in [("nodes", of_nodes), ("C", of_cost)] {
                    let rmse = factor * (lines as f64).powf(-exponent);
                    let random = [1.0, 0.5][usize::from(quantity == "C")] / (lines as f64).sqrt();
                    let gain = (random / rmse).powi(2);
                    let nearest = rays != "lines" && quantity == "C";
                    run.errors.push(ErrorRecord {
                        cell: scene.into(),
                        scene: scene.into(),
                        strategy: "sah".into(),
                        sampler: sampler.into(),
                        rays: rays.into(),
                        quantity: quantity.into(),
                        lines,
                        replicates: 64,
                        truth: (quantity == "C").then_some(300.0),
                        truth_error: nearest.then_some(1e-5),
                        bias: (quantity == "C").then_some(0.0),
                        rmse,
                        rmse_lo: 0.86 * rmse,
                        rmse_hi: 1.2 * rmse,
                        gain: Some(gain),
                        gain_lo: Some(0.7 * gain),
                        gain_hi: Some(1.4 * gain),
                    });
                }
            }
            for (quantity, factor) in [("nodes", of_nodes), ("C", of_cost)] {
                run.exponents.push(ExponentRecord {
                    scene: scene.into(),
                    sampler: sampler.into(),
                    rays: rays.into(),
                    quantity: quantity.into(),
                    from_lines: 256,
                    to_lines: 65_536,
                    factor,
                    exponent,
                    exponent_lo: exponent - 0.02,
                    exponent_hi: exponent + 0.02,
                });
            }
            run.enough.push(EnoughRecord {
                scene: scene.into(),
                sampler: sampler.into(),
                rays: rays.into(),
                wanted: 0.001,
                lines: 1 << 18,
                extrapolated: true,
            });
        }
    }
}

fn precision(run: &mut SpeedVsError, scene: &str) {
    let visits = 10_000_000u64;
    for (k, offset) in [0.0, 1e2, 1e4, 1e6, 1e8].into_iter().enumerate() {
        let cell = format!("{scene}+{offset}");
        for (kernel, ns, wrong) in [
            ("f64", 40.0, 0),
            ("f32", 38.0, 20),
            ("f32-padded", 41.0, 60),
        ] {
            for (step, units) in [("visit", visits), ("ray", visits / 10)] {
                let what = format!("{kernel} {step} {offset:e}");
                let seconds = 1e-9 * ns * units as f64;
                run.timings.push(timing(&cell, &what, units, seconds));
            }
            let verdict = match (kernel, k) {
                ("f64", _) | (_, 0 | 1) => "clean",
                (_, 2) => "warned",
                _ => "refused",
            };
            for (family, times) in [("random", 1), ("aimed", 50)] {
                let random = family == "random";
                let wrong = wrong * times * 10u64.pow(k as u32) / 10;
                let rate = |n: f64| Some(1e9 * n / visits as f64);
                let n = wrong as f64;
                let (lo, hi) = match wrong {
                    0 => (0.0, 3.7),
                    _ => ((n - 2.0 * n.sqrt()).max(0.1), n + 2.0 * n.sqrt()),
                };
                run.precision.push(PrecisionRecord {
                    cell: cell.clone(),
                    scene: scene.into(),
                    strategy: "sah".into(),
                    offset,
                    kernel: kernel.into(),
                    family: family.into(),
                    verdict: verdict.into(),
                    resolution: (kernel != "f64").then_some(1e7 / offset.max(1.0)),
                    lines: 1 << 18,
                    visits,
                    wrong_visits: wrong / 2,
                    missed_visits: 0,
                    tied_visits: wrong - wrong / 2,
                    tied_missed_visits: 0,
                    visits_per_1e9: rate(n),
                    visits_per_1e9_lo: rate(lo),
                    visits_per_1e9_hi: rate(hi),
                    tests: visits,
                    wrong_hits: 0,
                    missed_hits: 0,
                    tied_hits: wrong,
                    hits_per_1e9: rate(n),
                    hits_per_1e9_lo: rate(lo),
                    hits_per_1e9_hi: rate(hi),
                    slope_error: random.then_some(1e-4 * (1.0 + wrong as f64)),
                    slope_se: random.then_some(3e-4),
                    max_z: random.then_some(3.0 + wrong as f64 / 10.0),
                    flat_nodes: 0,
                });
            }
        }
    }
}

fn planes(run: &mut SpeedVsError, scene: &str) {
    let searches = [
        ("sah", 0.0, 1.0),
        ("sah-samples:1", 0.4, 0.2),
        ("sah-samples:8", 0.05, 0.5),
        ("sah-samples:64", 0.01, 2.0),
        ("sah-bins:8", 0.09, 0.15),
        ("sah-bins:32", 0.02, 0.25),
        ("sah-bins:256", 0.002, 0.9),
    ];
    for clipped in [false, true] {
        for (strategy, above, seconds) in searches {
            let cell = format!("{scene} {strategy} {clipped}");
            let (better, slower) = if clipped { (0.9, 3.0) } else { (1.0, 1.0) };
            run.timings
                .push(timing(&cell, "build", 1, 0.02 * slower * seconds));
            run.planes.push(PlaneRecord {
                cell,
                scene: scene.into(),
                objects: 10_000,
                strategy: strategy.into(),
                clipped,
                c: 500.0 * better * (1.0 + above),
                above,
                above_unclipped: better * (1.0 + above) - 1.0,
                depth: 16,
                inner_nodes: 9_000,
                leaves: 9_001,
                references: 30_000,
            });
        }
    }
}

fn coverage(run: &mut SpeedVsError) {
    let row =
        |check: &str, sampler: &str, nominal: f64, counted: u64, band: (u64, u64)| CoverageRecord {
            check: check.into(),
            scene: SCENES[0].into(),
            sampler: sampler.into(),
            lines: 16_384,
            nominal,
            runs: 1000,
            counted,
            least: band.0,
            most: band.1,
        };
    for sampler in ["random", "sobol"] {
        for quantity in ["n_K", "n_B", "n_t", "C"] {
            let rows = &mut run.coverage;
            rows.push(row(quantity, sampler, 0.99, 991, (978, 1000)));
        }
    }
    run.coverage
        .push(row("slope", "random", 0.99, 940, (978, 1000)));
    for test in ["p-slope", "p-tail", "p-contrasts"] {
        run.coverage.push(row(test, "random", 0.01, 8, (0, 22)));
    }
    run.coverage
        .push(row("error", "sobol", 0.01, 960, (930, 1000)));
}

pub fn summary() -> Summary {
    Summary {
        kind: "speed-vs-error".into(),
        verdicts: vec![Verdict {
            name: "sobol-gain".into(),
            held: true,
            message: "the mean square error of C is that of random lines over 14".into(),
        }],
        ..crate::report::fixture::summary(SCENES[0])
    }
}

pub fn run(parts: SpeedVsError) -> Run {
    Run {
        dir: "data/test".into(),
        summary: summary(),
        content: Content::SpeedVsError(parts),
    }
}
