//! The kind `strategies` as a user meets it: files, resumption, equality for any number of threads, wrong input.
#![allow(clippy::unwrap_used, missing_docs)]

mod runs;

use std::fs;

use predicates::prelude::*;
use predicates::str::contains;
use runs::{contents, folder, validate};

const GOOD: &str = r#"kind = "strategies"
question = "Which tree?"
seed = 5
scenes = ["spd:balls:1", "spd:gears:1", "spd:tree:3"]
strategies = ["spatial-median", "object-median", "sah", "sah-cyclic"]
stops = ["objects:2:16", "automatic"]
lines = { slope_error = 1.0, min = 2048, max = 2048 }
pixels = 24
checked = 200

[cost]
c_k = 15.0
c_b = 0.0
c_t = 20.0

[timing]
rounds = 2
builds = 2
pass_s = 0.002

[expect]
family = 0.001
"#;

#[test]
fn data_is_the_same_for_any_threads_and_after_a_stop() {
    let folder = folder(GOOD);
    let run = |more: &[&str]| validate(folder.path()).args(more).assert().code(0);
    run(&["--threads", "1"])
        .stdout(contains("Which tree?"))
        .stderr(contains("24 trees"));
    let data = folder.path().join("data/e");
    let before = contents(&data);
    for file in [
        "cells.csv",
        "rays.csv",
        "summary.json",
        "pictures/spd-balls-1.ppm",
    ] {
        assert!(before.contains_key(file), "{file}");
    }
    // Three kinds of rays in each of 3 x 2 x 4 trees.
    let rays = String::from_utf8(before["rays.csv"].clone()).unwrap();
    assert_eq!(rays.lines().count(), 1 + 3 * 24);
    let times = fs::read_to_string(data.join("timings.csv")).unwrap();
    assert_eq!(times.lines().count(), 1 + 4 * 24);
    let again = |told: &str, more: &[&str]| {
        run(more).stderr(contains(told));
        assert!(before == contents(&data));
    };
    again("24 of 24 trees were finished", &[]);
    assert_eq!(times, fs::read_to_string(data.join("timings.csv")).unwrap());
    again(
        "tracing rays through 24 trees",
        &["--threads", "2", "--force"],
    );
    // A stopped run: one tree is missing, so its scene is timed again, all others are kept.
    let results = fs::read_dir(data.join("cells")).unwrap();
    let mut results = results.map(|file| file.unwrap().path());
    let lost = results.find(|path| {
        let name = path.display().to_string();
        name.ends_with(".json") && !name.ends_with(".times.json")
    });
    fs::remove_file(lost.unwrap()).unwrap();
    again("16 of 24 trees were finished", &[]);
    let times = fs::read_to_string(data.join("timings.csv")).unwrap();
    assert_eq!(times.lines().count(), 1 + 4 * 24);
}

#[test]
fn wrong_experiments_are_refused() {
    let cases = [
        ("rounds = 2", "rounds = 3", "e.toml:17:1", "even"),
        ("pass_s = 0.002", "pass_s = -1.0", "e.toml:19:1", "above 0"),
        (
            "family = 0.001",
            "family = 0.001\nprimary_hits_within = 3",
            "e.toml:23:1",
            "512 pixels only",
        ),
        ("pixels = 24", "pixels = 0", "e.toml:8:1", "1 to 2048"),
        (
            "\"automatic\"]",
            "\"objects:2:16\"]",
            "e.toml:6:1",
            "named twice",
        ),
        (
            "checked = 200",
            "checkd = 200",
            "e.toml:9:1",
            "unknown field",
        ),
        (
            "\"spd:gears:1\"",
            "\"simple:soup:9\"",
            "simple:soup:9",
            "no camera",
        ),
    ];
    for (old, new, place, wrong) in cases {
        assert!(GOOD.contains(old));
        let folder = folder(&GOOD.replacen(old, new, 1));
        let stderr = validate(folder.path()).assert().code(2);
        stderr.stderr(contains(place).and(contains(wrong)));
        assert!(!folder.path().join("data").exists(), "{new}");
    }
}
