//! Rows a run of this kind could have left behind, for the tests of its report.

use super::Stability;
use crate::report::{Content, Run};
use crate::study::records::{
    CaseRecord, MetamorphicRecord, RandomRecord, Summary, TieRecord, Verdict,
};

pub const KERNELS: [&str; 3] = ["f64", "f32", "f32-padded"];
pub const STRATEGIES: [&str; 11] = [
    "spatial-median",
    "object-median",
    "sah",
    "sah-between-medians",
    "sah-cyclic",
    "median-midpoint",
    "sah-samples",
    "spatial-median-longest",
    "object-median-longest",
    "sah-longest",
    "median-midpoint-longest",
];
/// Groups whose cases have no tree, with the number of their cases.
const GROUPS: [(&str, usize); 3] = [("lines", 8), ("boxes", 9), ("triangles", 7)];

/// A row; `outcome` may carry how far off it is behind a colon.
fn case(group: &str, i: usize, strategy: &str, kernel: &str, outcome: &str) -> CaseRecord {
    let (outcome, off) = match outcome.split_once(':') {
        Some((outcome, off)) => (outcome, off.parse().ok()),
        None => (outcome, None),
    };
    let measured = match outcome {
        "pass" => "hit",
        "refused" => "coordinates too coarse for f32 numbers",
        _ => "miss",
    };
    CaseRecord {
        case: format!("{group}-corner-touch-{i}"),
        group: group.into(),
        stresses: "a line that touches a corner of a closed box, and nothing else of it".into(),
        strategy: strategy.into(),
        kernel: kernel.into(),
        expected: "hit".into(),
        measured: measured.into(),
        outcome: outcome.into(),
        off,
        demanded: kernel == "f64",
    }
}

/// Cases with and without trees; one that f64 numbers fail, which they must not.
pub fn cases() -> Vec<CaseRecord> {
    let mut rows = Vec::new();
    for (group, count) in GROUPS {
        for i in 0..count {
            for kernel in KERNELS {
                let outcome = match (kernel, i) {
                    ("f64", _) => "pass",
                    ("f32", 3) => "failed",
                    ("f32", 5) => "off:300",
                    (_, 6) => "refused",
                    _ => "pass",
                };
                rows.push(case(group, i, "", kernel, outcome));
            }
        }
    }
    for i in 0..12 {
        for kernel in KERNELS {
            for (j, strategy) in STRATEGIES.into_iter().enumerate() {
                let outcome = match (kernel, i, j) {
                    ("f64", 4, 2) => "failed",
                    ("f64", ..) => "pass",
                    ("f32", 2, 3) => "off:2e7",
                    ("f32", 2, _) => "off:1",
                    ("f32", 7, _) => "refused",
                    ("f32-padded", 9, _) => continue,
                    _ => "pass",
                };
                rows.push(case("trees", i, strategy, kernel, outcome));
            }
        }
    }
    for i in 0..5 {
        rows.push(case("files", i, "", "f64", "pass"));
    }
    rows
}

/// Every part.
pub fn parts() -> Stability {
    let mut run = Stability {
        cases: cases(),
        random: Vec::new(),
        ties: Vec::new(),
        metamorphic: Vec::new(),
    };
    for scene in ["simple:soup:2000", "spd:tetra:5"] {
        for kernel in KERNELS {
            for against in ["box", "triangle"] {
                for family in ["random", "aimed"] {
                    let exact = kernel == "f64" || family == "random";
                    let random = |strategy: &str| RandomRecord {
                        scene: scene.into(),
                        strategy: strategy.into(),
                        kernel: kernel.into(),
                        against: against.into(),
                        family: family.into(),
                        cases: 500_000,
                        hits: 250_000,
                        wrong: if exact { 0 } else { 3 },
                        missed: 0,
                        ties: if exact { 0 } else { 1000 },
                        tied_wrong: if exact { 0 } else { 400 },
                        tied_missed: if kernel == "f32" && !exact { 150 } else { 0 },
                    };
                    run.random.extend(["sah", "sah-cyclic"].map(random));
                }
            }
        }
    }
    for (exact, ulps) in [(true, 0.0), (true, 2.5), (false, 7.0)] {
        run.ties.push(TieRecord {
            scene: "spd:tetra:5".into(),
            strategy: "sah".into(),
            kernel: "f32".into(),
            against: "box".into(),
            family: "aimed".into(),
            target: 7,
            ulps,
            exact,
            ox: 0.0,
            oy: 0.0,
            oz: -1.0,
            dx: 0.0,
            dy: 0.0,
            dz: 1.0,
        });
    }
    for (transform, differing) in [("scale 2^-30", 0), ("reflect x", 0), ("axes yzx", 2)] {
        for rays in ["lines", "lines:nearest"] {
            run.metamorphic.push(MetamorphicRecord {
                scene: "spd:tetra:5".into(),
                strategy: "sah".into(),
                transform: transform.into(),
                rays: rays.into(),
                lines: 16_384,
                nodes: 999,
                differing_nodes: differing,
                differing_hits: 0,
            });
        }
    }
    run
}

pub fn summary() -> Summary {
    Summary {
        kind: "stability".into(),
        verdicts: vec![Verdict {
            name: "demanded".into(),
            held: false,
            message: "1 of 161 outcomes is not passed".into(),
        }],
        ..crate::report::fixture::summary("spd:tetra:5")
    }
}

pub fn run(parts: Stability) -> Run {
    Run {
        dir: "data/test".into(),
        summary: summary(),
        content: Content::Stability(parts),
    }
}
