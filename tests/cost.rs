//! The kind `cost-vs-work` as a user meets it: files, resumption, tables and figures redone, wrong input.
#![allow(clippy::unwrap_used, missing_docs)]

mod runs;

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use assert_cmd::Command;
use predicates::prelude::*;
use predicates::str::contains;
use runs::{contents, folder, validate};
use sahlab::study::records::{
    ConstantRecord, ModelRecord, PredictionRecord, ShareRecord, TreeOrderRecord, WorkRecord,
};
use serde::de::DeserializeOwned;

const COST: &str = r#"kind = "cost-vs-work"
question = "Does C tell the time?"
seed = 5
scenes = ["spd:balls:1", "spd:balls:2", "spd:tree:3"]
strategies = ["sah", "object-median", "spatial-median"]
stops = ["objects:2:16", "depth:5"]
lines = { slope_error = 1.0, min = 2048, max = 2048 }
rays = ["lines", "lines:nearest", "primary", "shadow"]
number = 600
pixels = 16
cost = { c_k = 15.0, c_b = 0.0, c_t = 20.0 }
timing = { rays = 512, work = 20000, rounds = 2 }
calibration = { draws = 20 }
expect = { family = 0.001 }
"#;

fn rows<T: DeserializeOwned>(folder: &Path, name: &str) -> Vec<T> {
    let mut reader = csv::Reader::from_path(folder.join("data/e").join(name)).unwrap();
    reader.deserialize().collect::<Result<_, _>>().unwrap()
}

/// Every table and figure, those of seconds too.
fn reported(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut all = BTreeMap::new();
    for part in ["data/e/tables", "plots/e"] {
        for entry in fs::read_dir(folder.join(part)).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap().to_str().unwrap();
            all.insert(format!("{part}/{name}"), fs::read(&path).unwrap());
        }
    }
    all
}

#[test]
fn work_is_the_same_for_any_threads_and_after_a_stop() {
    let folder = folder(COST);
    let run = |more: &[&str]| validate(folder.path()).args(more).assert().code(0);
    run(&["--threads", "1"]).stdout(
        contains("Does C tell the time?")
            .and(contains("counts-cover"))
            .and(contains("chosen terms")),
    );
    let before = contents(folder.path());
    for file in [
        "data/e/work.csv",
        "data/e/steps.csv",
        "data/e/tree-order.csv",
        "data/e/tables/work.tex",
        "data/e/tables/work-traced.md",
        "data/e/tables/work-traced-summary.csv",
        "plots/e/predicted-vs-counted.svg",
    ] {
        assert!(before.contains_key(file), "{file}");
    }
    let made = reported(folder.path());
    for name in ["models", "constants", "choice", "order", "findings"] {
        let file = format!("data/e/tables/times-{name}.md");
        assert!(made.contains_key(&file), "{file}");
    }
    for by in ["scenes", "strategies", "rays"] {
        let file = format!("data/e/tables/times-residuals-{by}.csv");
        assert!(made.contains_key(&file), "{file}");
    }
    for name in ["predicted", "residuals", "shares"] {
        let file = format!("plots/e/times-{name}.png");
        assert!(made.contains_key(&file), "{file}");
    }

    // A resumed run measures nothing, so even what is made of seconds stays; so it does where only it is made again.
    let times = fs::read(folder.path().join("data/e/timings.csv")).unwrap();
    run(&[]).stderr(contains("18 of 18 trees were finished"));
    assert!(before == contents(folder.path()));
    assert!(times == fs::read(folder.path().join("data/e/timings.csv")).unwrap());
    assert!(made == reported(folder.path()));
    for part in ["data/e/tables", "plots/e"] {
        fs::remove_dir_all(folder.path().join(part)).unwrap();
    }
    for redo in ["tables", "plots", "report"] {
        let mut command = Command::cargo_bin("validate").unwrap();
        command.current_dir(folder.path()).args([redo, "data/e"]);
        command.assert().code(0);
    }
    assert!(made == reported(folder.path()));

    run(&["--threads", "2", "--force"]).stderr(contains("tracing rays through 18 trees"));
    assert!(before == contents(folder.path()));
    // A stopped run: one tree is missing, so its scene is timed again, all others are kept.
    let cells = fs::read_dir(folder.path().join("data/e/cells")).unwrap();
    let mut cells = cells.map(|file| file.unwrap().path());
    let lost = cells.find(|path| path.display().to_string().ends_with(".times.json"));
    fs::remove_file(lost.unwrap()).unwrap();
    run(&[]).stderr(contains("12 of 18 trees were finished"));
    assert!(before == contents(folder.path()));
}

#[test]
fn rows_are_of_all_trees_and_sets() {
    let folder = folder(COST);
    validate(folder.path()).assert().code(0);
    let work: Vec<WorkRecord> = rows(folder.path(), "work.csv");
    assert_eq!(work.len(), 18 * 4);
    // Rays that never stop do at least the work of the same rays up to their first hit.
    let tests = |rays: &str| -> u64 {
        let own = work.iter().filter(|row| row.rays == rays);
        own.map(|row| row.object_tests).sum()
    };
    assert!(tests("lines") >= tests("lines:nearest"));
    // Of each scene and set: two stop rules, and both together.
    let orders: Vec<TreeOrderRecord> = rows(folder.path(), "tree-order.csv");
    assert_eq!(orders.len(), 3 * 4 * 3);
    let all = orders.iter().filter(|row| row.stop == "all");
    assert!(all.clone().count() == 12 && all.clone().all(|row| (row.trees, row.pairs) == (6, 15)));
    assert!(
        orders
            .iter()
            .all(|row| row.regret.is_some_and(|regret| regret >= 0.0))
    );
    // What makes the time of a set makes all of it.
    let shares: Vec<ShareRecord> = rows(folder.path(), "times-shares.csv");
    for rays in ["lines", "lines:nearest", "primary", "shadow"] {
        let own = shares.iter().filter(|row| row.rays == rays);
        let sum: f64 = own.map(|row| row.share).sum();
        assert!((sum - 1.0).abs() < 1e-9, "{rays} {sum}");
    }
    // The shares of all rows together are those of the constants fitted to all scenes.
    let times: Vec<PredictionRecord> = rows(folder.path(), "times-predictions.csv");
    let constants: Vec<ConstantRecord> = rows(folder.path(), "times-constants.csv");
    let chosen = constants.iter().filter(|c| c.model == ModelRecord::CHOSEN);
    for constant in chosen {
        let own = shares.iter().filter(|row| row.term == constant.term);
        let of_set = |share: &ShareRecord| times.iter().filter(|t| t.rays == share.rays).count();
        let sum: f64 = own.map(|share| share.share * of_set(share) as f64).sum();
        assert!(
            (sum / times.len() as f64 - constant.share).abs() < 1e-9,
            "{constant:?}"
        );
        // Two groups of scenes are too few for an interval.
        assert_eq!((constant.lo, constant.hi), (None, None));
    }
}

#[test]
fn two_scenes_are_too_few_for_constants() {
    // One of them has no camera, so it has no rays of a picture.
    let two = "[\"spd:balls:1\", \"simple:soup:60\"]";
    let three = "[\"spd:balls:1\", \"spd:balls:2\", \"spd:tree:3\"]";
    let folder = folder(&COST.replace(three, two));
    let told = contains("constants are fitted to at least 3 scenes").and(contains("these are 2"));
    let run = validate(folder.path()).assert().code(0).stderr(told);
    run.stdout(contains("No constants were fitted"));
    // What was expected and cannot be judged is missed.
    let file = folder.path().join("e.toml");
    let text = fs::read_to_string(&file).unwrap();
    fs::write(
        &file,
        text.replace("family = 0.001", "family = 0.001, tau = 0.5"),
    )
    .unwrap();
    let judged = validate(folder.path()).assert().code(1);
    judged.stdout(contains("MISSED").and(contains("not judged")));
    for name in [
        "models",
        "constants",
        "choice",
        "predictions",
        "order",
        "shares",
    ] {
        let file = folder.path().join(format!("data/e/times-{name}.csv"));
        assert_eq!(fs::read(file).unwrap(), b"", "{name}");
    }
    let work: Vec<WorkRecord> = rows(folder.path(), "work.csv");
    assert_eq!(work.len(), 6 * 4 + 6 * 2);
    let times: Vec<String> = reported(folder.path())
        .into_keys()
        .filter(|file| file.contains("/times-"))
        .collect();
    assert_eq!(times, ["data/e/tables/times-findings.md"]);
    let text = fs::read_to_string(folder.path().join(&times[0])).unwrap();
    assert!(text.contains("No constants were fitted"), "{text}");
}

#[test]
fn wrong_experiments_are_refused() {
    let cases = [
        ("rounds = 2", "rounds = 3", "e.toml:12", "even"),
        ("work = 20000", "work = 0", "e.toml:12", "must be 1 to"),
        ("rays = 512", "rais = 512", "e.toml:12", "unknown field"),
        ("draws = 20", "draws = 0", "e.toml:13", "must be 1 to"),
        (
            "\"shadow\"",
            "\"lines\"",
            "e.toml:8",
            "set of rays 'lines' is named twice",
        ),
        (
            "\"shadow\"",
            "\"lines:near\"",
            "e.toml:8",
            "nothing a ray can ask",
        ),
        ("\"shadow\"", "\"own\"", "e.toml:8", "from the command line"),
        ("\"depth:5\"", "\"objects:2:16\"", "e.toml:6", "named twice"),
        ("number = 600", "number = 0", "e.toml:9", "must be 1 to"),
        (
            "pixels = 16",
            "pixels = 9999",
            "e.toml:10",
            "must be 1 to 2048",
        ),
        (
            "family = 0.001",
            "family = 0.001, tau = 1.5",
            "e.toml:14",
            "must be 0 to 1",
        ),
    ];
    for (old, new, place, wrong) in cases {
        assert!(COST.contains(old));
        let folder = folder(&COST.replacen(old, new, 1));
        let stderr = validate(folder.path()).assert().code(2);
        stderr.stderr(contains(place).and(contains(wrong)));
        assert!(!folder.path().join("data").exists(), "{new}");
    }
}
