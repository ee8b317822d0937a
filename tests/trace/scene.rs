//! Sets of rays counted in every tree: of an experiment, and a user's own.

use std::fs;
use std::path::Path;

use predicates::prelude::*;
use predicates::str::contains;
use sahlab::study::records::{StrategyChoiceRecord, WorkRecord};
use serde::de::DeserializeOwned;
use tempfile::tempdir;

use crate::{traced, validate};

/// From one side across the unit cube.
fn beam(n: usize, direction: &str) -> String {
    let mut text = String::from("ox,oy,oz,dx,dy,dz\n");
    for i in 0..n {
        let at = (0.5 + i as f64) / n as f64;
        text += &format!("-0.5,{at},{},{direction}\n", 7.0 * at % 1.0);
    }
    text
}

fn rows<T: DeserializeOwned>(folder: &Path, name: &str) -> Vec<T> {
    let mut reader = csv::Reader::from_path(folder.join(name)).unwrap();
    reader.deserialize().collect::<Result<_, _>>().unwrap()
}

#[test]
fn own_rays_are_the_real_ones_of_a_scene() {
    let folder = tempdir().unwrap();
    let here = folder.path();
    let scene = "simple:soup:200";
    fs::write(here.join("r.csv"), beam(500, "1,0.02,0.01")).unwrap();
    let run = |more: &[&str]| {
        let mut command = validate(here);
        command.args([
            "scene", scene, "--rays", "r.csv", "--lines", "4096", "--quick",
        ]);
        // So few lines may miss an expectation.
        command.args(more).assert().code(predicate::in_iter([0, 1]))
    };
    run(&["--dry-run"]).stdout(contains("rays own:nearest (500), lines, lines:nearest"));
    assert!(!here.join("data").exists());
    run(&[])
        .stdout(contains("For own:nearest take ").and(contains("Kendall's tau")))
        .stdout(contains("its lines cost").not());
    let data = here.join("data/scene-simple-soup-200-quick");
    let work: Vec<WorkRecord> = rows(&data, "work.csv");
    let sets = [
        "own:nearest",
        "lines",
        "lines:nearest",
        "volume-ray:nearest",
        "objects:nearest",
    ];
    assert_eq!(work.len(), 11 * sets.len());
    assert!(
        work.iter()
            .zip(sets.iter().cycle())
            .all(|(row, set)| row.rays == *set)
    );

    // The counts are those of `trace`, through the same tree.
    let own = work
        .iter()
        .find(|row| row.rays == "own:nearest" && row.strategy == "sah");
    let own = own.unwrap();
    assert!(own.complete && own.cast == 500 && own.c_se.is_none());
    let (_, record) = traced(here, scene, "r.csv", &[]);
    assert_eq!(
        [
            own.inner_visits,
            own.leaf_visits,
            own.object_tests,
            own.hits
        ],
        [
            record.inner_visits,
            record.leaf_visits,
            record.object_tests,
            record.hits
        ]
    );
    assert_eq!(own.c_predicted.to_bits(), record.c_predicted.to_bits());
    // Lines that never stop cost what areas predict.
    for row in work.iter().filter(|row| row.rays == "lines") {
        let far = (row.c_counted - row.c_predicted).abs();
        assert!(far <= 5.0 * row.c_se.unwrap(), "{row:?}");
    }
    let choices: Vec<StrategyChoiceRecord> = rows(&data, "choices.csv");
    assert_eq!(
        choices.iter().map(|c| c.rays.as_str()).collect::<Vec<_>>(),
        sets
    );
    for choice in &choices {
        let of_set = || work.iter().filter(|row| row.rays == choice.rays);
        assert!(of_set().all(|row| row.c_counted >= choice.least_c_counted));
        assert!(of_set().all(|row| row.c_predicted >= choice.predicted_c_predicted));
        assert!(choice.kendall_tau.is_some_and(|tau| tau.abs() <= 1.0));
    }

    // Tables come from files alone; what is finished is found again, but not for other rays.
    let table = fs::read_to_string(data.join("tables/work.md")).unwrap();
    assert!(table.contains("| own:nearest "));
    fs::remove_dir_all(data.join("tables")).unwrap();
    validate(here).arg("tables").arg(&data).assert().code(0);
    assert_eq!(
        fs::read_to_string(data.join("tables/work.md")).unwrap(),
        table
    );
    let finished = "11 of 11 cells were finished";
    let before = fs::read(data.join("work.csv")).unwrap();
    run(&[]).stderr(contains(finished));
    assert!(before == fs::read(data.join("work.csv")).unwrap());
    run(&["--threads", "3", "--force"]);
    assert!(before == fs::read(data.join("work.csv")).unwrap());
    run(&["--ask", "any"])
        .stderr(contains(finished).not())
        .stdout(contains("For own:any take "));
    fs::write(here.join("r.csv"), beam(500, "1,0.02,0.011")).unwrap();
    run(&[]).stderr(contains(finished).not());
    assert!(before != fs::read(data.join("work.csv")).unwrap());
    // Such a run is not packed: from its files alone it could not be repeated.
    validate(here)
        .arg("archive")
        .arg(&data)
        .assert()
        .code(2)
        .stderr(contains("`validate scene`").and(contains("cannot be repeated")));
}

const EXPERIMENT: &str = r#"kind = "hits-vs-area"
question = "Does it hold for rays that stop?"
seed = 5
scenes = ["simple:uniform:100", "spd:balls:1"]
strategies = ["sah", "spatial-median", "object-median"]
stop = "objects:2:10"
cost = { c_k = 15.0, c_b = 0.0, c_t = 20.0 }
lines = { slope_error = 0.1, min = 65536, max = 65536 }
figure = { scene = "simple:uniform:100", strategy = "sah" }
work = { rays = ["lines:nearest", "shadow", "beam:any"], number = 300, pixels = 8 }
expect = { slope_within = 0.2, family = 0.001, gate = 0.0001 }
"#;

#[test]
fn an_experiment_names_its_sets_of_rays() {
    let folder = tempdir().unwrap();
    let here = folder.path();
    let file = here.join("e.toml");
    let run = |text: &str| {
        fs::write(&file, text).unwrap();
        validate(here).args(["run", "e.toml"]).assert()
    };
    run(EXPERIMENT)
        .code(0)
        .stdout(contains("What areas tell of rays that are not isotropic"));
    let data = here.join("data/e");
    let work: Vec<WorkRecord> = rows(&data, "work.csv");
    let of = |scene: &str| {
        let of_scene = work
            .iter()
            .filter(|row| row.scene == scene && row.strategy == "sah");
        of_scene.map(|row| row.rays.as_str()).collect::<Vec<_>>()
    };
    // Without a look there is no picture.
    assert_eq!(of("simple:uniform:100"), ["lines:nearest", "beam:any"]);
    assert_eq!(of("spd:balls:1"), ["lines:nearest", "shadow", "beam:any"]);
    assert!(
        work.iter()
            .all(|row| row.complete == (row.rays == "shadow"))
    );
    assert!(work.iter().all(|row| row.complete == row.c_se.is_none()));

    // Packed and repeated to the byte.
    validate(here).args(["archive", "data/e"]).assert().code(0);
    validate(here)
        .args(["verify", "archives/e.tar.gz", "--replay"])
        .assert()
        .code(0)
        .stdout(contains("replayed: all "));
    // Other numbers are other cells; without the section there are no rays, and none of an earlier form stay.
    run(&EXPERIMENT.replace("300", "301"))
        .code(0)
        .stderr(contains("finished").not());
    let without = EXPERIMENT.replace("work = ", "# work = ");
    run(&without).code(0);
    assert!(!data.join("work.csv").exists() && !data.join("choices.csv").exists());
    assert!(!data.join("tables/work.md").exists());

    fs::remove_dir_all(here.join("data")).unwrap();
    for (old, new, parts) in [
        (
            "number = 300",
            "number = 3",
            ["e.toml:10:", "work.number = 3, but it must be 16 to"],
        ),
        (
            "number = 300",
            "numbers = 300",
            ["e.toml:10:", "unknown field `numbers`"],
        ),
        (
            "pixels = 8",
            "pixels = 0",
            ["e.toml:10:", "work.pixels = 0"],
        ),
        (
            "\"shadow\"",
            "\"own\"",
            ["e.toml:10:", "come from the command line"],
        ),
        (
            "\"shadow\"",
            "\"lines:nearest\"",
            ["e.toml:10:", "named twice"],
        ),
        (
            "\"shadow\"",
            "\"shade\"",
            ["e.toml:10:", "'shade' names no rays"],
        ),
        (", pixels = 8", "", ["e.toml:10:", "missing field `pixels`"]),
    ] {
        assert!(EXPERIMENT.contains(old), "{old}");
        let assert = run(&EXPERIMENT.replacen(old, new, 1)).code(2);
        assert.stderr(contains(parts[0]).and(contains(parts[1])));
        assert!(!here.join("data").exists());
    }
}
