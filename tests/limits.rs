//! The kinds `speed-vs-error` and `stability`, and `--error`, as a user meets them: files, resumption, wrong input.
#![allow(clippy::unwrap_used, missing_docs)]

mod runs;

use std::collections::BTreeMap;
use std::path::Path;

use predicates::prelude::*;
use predicates::str::contains;
use runs::{contents, folder, validate};
use sahlab::study::records::{
    CaseRecord, CellRecord, CoverageRecord, EnoughRecord, ErrorRecord, ExponentRecord,
    MetamorphicRecord, PassTiming, PlaneRecord, PrecisionRecord, RandomRecord, Summary,
};
use serde::de::DeserializeOwned;

const SPEED: &str = r#"kind = "speed-vs-error"
question = "What is enough?"
seed = 7
scenes = ["simple:uniform:60", "simple:soup:80"]
strategy = "sah"
stop = "objects:2:12"
samplers = { scenes = ["simple:uniform:60"], methods = ["random", "stratified", "sobol", "conditional"], from = 64, to = 512, replicates = 32, reference = 65_536, wanted = [0.1, 0.001], rounds = 2 }
precision = { scenes = ["simple:soup:80"], kernels = ["f64", "f32", "f32-padded"], offsets = [0.0, 1e3, 1e7], lines = 512, rounds = 2 }
planes = { scenes = ["simple:soup:80"], strategies = ["sah", "sah-samples:4", "sah-bins:16"], clipped = [false, true], builds = 2 }
coverage = { scene = "simple:uniform:60", seeds = 40, lines = 1024, replicates = 20, stops = 20, error = 0.1 }
cost = { c_k = 15.0, c_b = 0.0, c_t = 20.0 }
expect = { sobol = { scenes = ["simple:uniform:60"], nodes = 1.0, gain = 1.0, exponent = 0.4 }, planes = { strategy = "sah-bins:16", above = 1.0 } }
"#;

const STABILITY: &str = r#"kind = "stability"
question = "Is every answer right?"
seed = 7
scenes = ["simple:soup:80"]
strategies = ["sah", "object-median"]
stop = "objects:2:12"
kernels = ["f64", "f32", "f32-padded"]
random = 4000
aimed = 4000
lines = 200
cost = { c_k = 15.0, c_b = 0.0, c_t = 20.0 }
"#;

fn rows<T: DeserializeOwned>(folder: &Path, name: &str) -> Vec<T> {
    let mut reader = csv::Reader::from_path(folder.join("data/e").join(name)).unwrap();
    reader.deserialize().collect::<Result<_, _>>().unwrap()
}

/// Data but for seconds; figures may show these.
fn data(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    contents(&folder.join("data"))
}

/// A run, the same again from what is finished, and the same with another number of threads.
fn runs_alike(folder: &Path, finished: &str) {
    let run = |more: &[&str]| validate(folder).args(more).assert().code(0);
    run(&["--threads", "1"]);
    let before = data(folder);
    run(&[]).stderr(contains(finished));
    assert!(before == data(folder));
    run(&["--threads", "3", "--force"]);
    assert!(before == data(folder));
}

fn plots(folder: &Path, files: &[&str]) {
    for file in files {
        for extension in ["svg", "png"] {
            let path = folder.join(format!("plots/e/{file}.{extension}"));
            assert!(path.is_file(), "{}", path.display());
        }
    }
}

#[test]
fn speed_stands_beside_error() {
    let folder = folder(SPEED);
    let folder = folder.path();
    runs_alike(folder, "4 of 4 parts were finished");
    plots(
        folder,
        &[
            "times-speed-vs-error",
            "times-precision",
            "precision-offset",
            "times-plane-search",
            "coverage",
        ],
    );

    let errors: Vec<ErrorRecord> = rows(folder, "errors.csv");
    assert!(
        errors
            .iter()
            .all(|r| r.rmse_lo <= r.rmse && r.rmse <= r.rmse_hi)
    );
    // Independent lines have the errors that theory gives them; every method has all quantities.
    let nodes = errors
        .iter()
        .filter(|r| r.quantity == "nodes" && r.rays == "lines");
    for row in nodes.filter(|r| r.sampler == "random") {
        let scaled = row.rmse * (row.lines as f64).sqrt();
        assert!((scaled - 1.0).abs() < 0.15, "{scaled} at {}", row.lines);
    }
    for quantity in ["nodes", "n_K", "n_B", "n_t", "C"] {
        for sampler in ["random", "stratified", "sobol", "conditional"] {
            let own = errors.iter().filter(|r| r.rays == "lines");
            let own = own.filter(|r| (&*r.quantity, &*r.sampler) == (quantity, sampler));
            assert!(own.count() >= 3, "{quantity} {sampler}");
        }
    }
    let exponents: Vec<ExponentRecord> = rows(folder, "exponents.csv");
    assert!(exponents.iter().all(|r| r.exponent_lo < r.exponent_hi));
    let enough: Vec<EnoughRecord> = rows(folder, "enough.csv");
    assert!(enough.iter().any(|r| r.wanted == 0.001 && r.extrapolated));

    let precision: Vec<PrecisionRecord> = rows(folder, "precision.csv");
    let verdict = |kernel: &str, offset: f64| {
        let own = |r: &&PrecisionRecord| r.kernel == kernel && r.offset == offset;
        precision.iter().find(own).unwrap().verdict.clone()
    };
    assert_eq!(verdict("f64", 1e7), "clean");
    let f32s = [0.0, 1e3, 1e7].map(|offset| verdict("f32", offset));
    assert_eq!(f32s, ["clean", "warned", "refused"]);
    // What a kernel gets wrong at all, lines aimed at edges show.
    let tied = |r: &&PrecisionRecord| r.family == "aimed" && r.tied_visits > 0;
    assert!(precision.iter().any(|r| tied(&r)));

    // The exact search without clipping is what the others are held against.
    let planes: Vec<PlaneRecord> = rows(folder, "planes.csv");
    assert_eq!(planes.len(), 6);
    for row in planes.iter().filter(|r| r.strategy == "sah") {
        assert_eq!(row.above, 0.0);
        assert!(row.above_unclipped <= 0.0);
    }

    // Everything that has an error has its seconds.
    let seconds: Vec<PassTiming> = rows(folder, "timings.csv");
    for what in [
        "sobol lines 512",
        "random lines:nearest 64",
        "f32 ray 1e3",
        "f64 visit 0e0",
        "build",
    ] {
        assert!(
            seconds.iter().any(|r| r.what == what && r.seconds > 0.0),
            "{what}"
        );
    }
    let coverage: Vec<CoverageRecord> = rows(folder, "coverage.csv");
    assert!(
        coverage
            .iter()
            .all(|r| r.counted <= r.runs && r.least <= r.most)
    );
}

#[test]
fn hard_cases_are_right_or_told() {
    let folder = folder(STABILITY);
    let folder = folder.path();
    runs_alike(folder, "parts were finished");
    plots(folder, &["stability", "stability-2"]);
    let cases: Vec<CaseRecord> = rows(folder, "cases.csv");
    for group in [
        "lines",
        "boxes",
        "triangles",
        "spheres",
        "cones",
        "polygons",
        "trees",
        "files",
        "statistics",
    ] {
        assert!(cases.iter().any(|r| r.group == group), "{group}");
    }
    assert!(
        cases
            .iter()
            .filter(|r| r.demanded)
            .all(|r| ["pass", "off"].contains(&&*r.outcome))
    );
    let off = |r: &&CaseRecord| r.demanded && r.outcome == "off" && r.kernel == "f64";
    let ulps = cases.iter().filter(off).map(|r| r.off.unwrap());
    assert!(ulps.fold(0.0, f64::max) < 8.0);
    assert!(cases.iter().filter(|r| r.kernel == "f64").count() > 300);
    let random: Vec<RandomRecord> = rows(folder, "random.csv");
    let f64s = random.iter().filter(|r| r.kernel == "f64");
    let (cases, wrong) = f64s.fold((0, 0), |(n, w), r| (n + r.cases, w + r.wrong + r.missed));
    assert!(cases >= 16_000 && wrong == 0, "{wrong} of {cases}");
    let moved: Vec<MetamorphicRecord> = rows(folder, "metamorphic.csv");
    assert!(moved.len() > 20);
    assert!(
        moved
            .iter()
            .all(|r| r.differing_nodes + r.differing_hits == 0)
    );
    // One case alone.
    let text = STABILITY.replace("random = ", "cases = [\"box-corner-touch\"]\nrandom = ");
    let one = runs::folder(&text);
    validate(one.path()).assert().code(0);
    let cases: Vec<CaseRecord> = rows(one.path(), "cases.csv");
    assert!(cases.iter().all(|r| r.case == "box-corner-touch") && !cases.is_empty());
}

#[test]
fn a_wanted_error_settles_the_lines() {
    let text = include_str!("../experiments/validate-cost.toml").replace(
        "lines = { slope_error = 1.0, min = 16_384, max = 16_384 }",
        "lines = { error = 0.02, min = 1024, max = 1_000_000 }",
    );
    let start = text.find("scenes = [").unwrap();
    let end = text.find("]\nstrategies").unwrap();
    let text = format!(
        "{}scenes = [\"simple:soup:200\"{}",
        &text[..start],
        &text[end..]
    );
    let folder = folder(&text);
    validate(folder.path())
        .assert()
        .code(predicate::in_iter([0, 1]));
    let cells: Vec<CellRecord> = rows(folder.path(), "cells.csv");
    for r in &cells {
        let off = (r.c_counted / r.c_predicted - 1.0).abs();
        assert!(1.96 * r.c_se.unwrap() <= 0.02 * r.c_counted && off < 0.04);
        assert!((1024..60_000).contains(&r.lines), "{}", r.lines);
    }
    // On the command line it is kept with the run.
    validate(folder.path())
        .args(["--error", "5%", "--force"])
        .assert()
        .code(predicate::in_iter([0, 1]));
    let summary = std::fs::read(folder.path().join("data/e/summary.json")).unwrap();
    let summary: Summary = serde_json::from_slice(&summary).unwrap();
    assert!(
        summary.command.ends_with("--error 0.05"),
        "{}",
        summary.command
    );
    assert!(summary.verdicts.iter().any(|v| v.name == "error" && v.held));
}

#[test]
fn wrong_input_is_told_with_its_place() {
    let fails = |text: &str, args: &[&str], told: &str| {
        let folder = folder(text);
        validate(folder.path())
            .args(args)
            .assert()
            .code(2)
            .stderr(contains(told).and(contains('\n').count(1)));
        assert!(!folder.path().join("data").exists(), "{told}");
    };
    let speed = |from: &str, to: &str, told: &str| {
        assert!(SPEED.contains(from), "{from}");
        fails(&SPEED.replacen(from, to, 1), &[], told);
    };
    speed("\"sobol\"", "\"sobel\"", "e.toml:7:");
    speed("to = 512", "to = 500", "must be a power of two");
    speed("replicates = 32,", "replicates = 31,", "must be 32 to");
    speed(
        "reference = 65_536",
        "reference = 4_096",
        "from 128 times samplers.to",
    );
    speed(
        "methods = [\"random\", ",
        "methods = [",
        "must name 'random'",
    );
    speed(
        "methods = [\"random\", ",
        "methods = [\"random\", \"random\", ",
        "method 'random' is named twice",
    );
    speed(
        "precision = { scenes = [\"simple:soup:80\"]",
        "precision = { scenes = [\"simple:uniform:60\"]",
        "no triangles",
    );
    speed("\"f32\", \"f32-padded\"", "\"f16\"", "'f16' is no kernel");
    speed(
        "strategies = [\"sah\", ",
        "strategies = [",
        "must name 'sah'",
    );
    speed(
        "clipped = [false, true]",
        "clipped = [true]",
        "must be [false] or [false, true]",
    );
    speed(
        "sah-bins:16\", above",
        "sah-bins:17\", above",
        "must be among planes.strategies",
    );
    speed(
        "error = 0.1",
        "error = 1.5",
        "must be at least 1e-6 and below 1",
    );
    speed(
        "rounds = 2 }\nplanes",
        "rounds = 3 }\nplanes",
        "must be even",
    );
    fails(STABILITY, &["--error", "1%"], "no wanted error settles");
    let stability = |from: &str, to: &str, told: &str| {
        fails(&STABILITY.replacen(from, to, 1), &[], told);
    };
    stability(
        "random = ",
        "cases = [\"box-corner-tuch\"]\nrandom = ",
        "box-corner-touch",
    );
    stability(
        "random = ",
        "cases = [\"box-corner-touch\", \"box-corner-touch\"]\nrandom = ",
        "case 'box-corner-touch' is named twice",
    );
    stability("\"f64\", ", "", "must name 'f64'");
    stability(
        "\"f64\", ",
        "\"f64\", \"f64\", ",
        "kernel 'f64' is named twice",
    );
    stability("random = 4000", "random = 0", "must be 1 to 2^40");
}
