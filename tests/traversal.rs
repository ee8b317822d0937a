//! The kind `traversal` as a user meets it: files, resumption, equal counts for any number of threads, wrong input.
#![allow(clippy::unwrap_used, missing_docs)]

mod runs;

use std::fs;
use std::path::Path;

use predicates::str::contains;
use runs::{contents, folder, validate};
use sahlab::study::records::{LinkRecord, PassTiming, Summary, TraversalRecord};
use serde::de::DeserializeOwned;

const TRAVERSAL: &str = r#"kind = "traversal"
question = "When do links pay?"
seed = 5
scenes = ["spd:balls:2", "spd:tetra:3", "simple:soup:200"]
strategy = "sah"
stop = "cost-gain"
rays = ["lines", "lines:nearest", "primary"]
number = 2048
pixels = 12
cost = { c_k = 15.0, c_b = 0.0, c_t = 20.0 }
timing = { rays = 600, work = 100_000, rounds = 2, builds = 2 }
expect = { fall_backs = { f64 = 1e-6, f32 = 1e-2 } }
"#;

fn rows<T: DeserializeOwned>(folder: &Path, name: &str) -> Vec<T> {
    let mut reader = csv::Reader::from_path(folder.join("data/e").join(name)).unwrap();
    reader.deserialize().collect::<Result<_, _>>().unwrap()
}

#[test]
fn ways_stand_beside_the_stack() {
    let folder = folder(TRAVERSAL);
    let folder = folder.path();
    let run = |more: &[&str]| validate(folder).args(more).assert().code(0);
    run(&["--threads", "1"]);
    let before = contents(folder);
    run(&[]).stderr(contains("3 of 3 scenes were finished"));
    assert!(before == contents(folder));
    run(&["--threads", "3", "--force"]);
    assert!(before == contents(folder));
    // A scene without its seconds is measured again.
    let cells = fs::read_dir(folder.join("data/e/cells")).unwrap();
    let mut cells = cells.map(|file| file.unwrap().path());
    let seconds = cells.find(|path| path.display().to_string().ends_with(".times.json"));
    fs::remove_file(seconds.unwrap()).unwrap();
    run(&[]).stderr(contains("2 of 3 scenes were finished"));
    assert!(before == contents(folder));
    for file in [
        "data/e/tables/traversal.md",
        "data/e/tables/traversal-summary.tex",
        "data/e/tables/link-memory.csv",
        "plots/e/traversal.svg",
    ] {
        assert!(before.contains_key(file), "{file}");
    }
    for file in [
        "data/e/tables/times-findings.md",
        "data/e/tables/times-traversal-summary.md",
        "plots/e/times-traversal.png",
        "plots/e/times-traversal-saved.svg",
    ] {
        assert!(folder.join(file).is_file(), "{file}");
    }

    let walks: Vec<TraversalRecord> = rows(folder, "traversal.csv");
    let of = |scene: &str, precision: &str| {
        let own = walks.iter().filter(|r| r.scene == scene);
        own.filter(|r| r.precision == precision).count()
    };
    // Four ways; three sets, of the soup two, as it has no picture; in f32 of spheres lines alone.
    assert_eq!(
        [of("spd:balls:2", "f64"), of("spd:balls:2", "f32")],
        [12, 4]
    );
    assert_eq!(
        [of("spd:tetra:3", "f64"), of("spd:tetra:3", "f32")],
        [12, 12]
    );
    let soup = ["f64", "f32"].map(|precision| of("simple:soup:200", precision));
    assert_eq!(soup, [8, 8]);
    for own in walks.chunks(4) {
        let ways: Vec<&str> = own.iter().map(|r| &*r.way).collect();
        assert_eq!(ways, ["stack", "restart", "links", "face-trees"]);
        let [stack, restart, links, faces] = own else {
            unreachable!("four ways")
        };
        assert_eq!((stack.links, stack.fall_backs), (0, 0));
        assert_eq!(stack.hits.is_none(), stack.rays == "lines");
        for other in [restart, links, faces] {
            assert_eq!(other.differing_leaves + other.broken, 0);
            assert_eq!((other.hits, other.cast), (stack.hits, stack.cast));
            // Fall-backs may visit a leaf again, and count no link for the rest.
            if other.fall_backs == 0 {
                assert_eq!(other.leaf_visits, stack.leaf_visits);
                assert_eq!(other.object_tests, stack.object_tests);
                assert_eq!(other.links + other.entered, other.leaf_visits);
            }
        }
        assert!(faces.inner_visits < links.inner_visits, "{}", stack.scene);
        assert!(links.inner_visits < stack.inner_visits, "{}", stack.scene);
        assert!(stack.inner_visits < restart.inner_visits, "{}", stack.scene);
    }
    let links: Vec<LinkRecord> = rows(folder, "link-memory.csv");
    assert_eq!(links.len(), 6);
    for row in &links {
        let all = row.links_to_leaves + row.links_to_inner + row.links_outside;
        assert_eq!((all, row.inner_nodes + 1), (6 * row.leaves, row.leaves));
        assert!(row.tree_bytes < row.link_bytes && row.link_bytes < row.face_tree_bytes);
    }
    let times: Vec<PassTiming> = rows(folder, "timings.csv");
    // A row each for a set along a way, for the tree, and for links and face trees in both precisions.
    assert_eq!(times.len(), walks.len() + 3 * 5);
    let timed = |what: &str| times.iter().find(|r| r.what == what).unwrap();
    let nearest = timed("lines:nearest f32 face-trees");
    assert_eq!((nearest.units, nearest.timed_units), (2048, 512));
    // One run of rays does not tell how they scatter.
    assert_eq!(nearest.sampling_se_s, f64::INFINITY);
    assert_eq!(timed("build face-trees f32").units, 1);
    let summary = fs::read(folder.join("data/e/summary.json")).unwrap();
    let summary: Summary = serde_json::from_slice(&summary).unwrap();
    let names: Vec<&str> = summary.verdicts.iter().map(|v| &*v.name).collect();
    let wanted = [
        "hits",
        "leaves",
        "identities",
        "certain-f64",
        "certain-f32",
        "fewer-inner",
    ];
    assert_eq!(names, wanted);
}

#[test]
fn a_bound_that_does_not_hold_is_told() {
    // Of so many rays some meet two planes nearer together than f32 tells apart.
    let text = TRAVERSAL.replace("f32 = 1e-2", "f32 = 0.0");
    let text = text
        .replace("\"spd:balls:2\", \"spd:tetra:3\", ", "")
        .replace("number = 2048", "number = 65_536");
    let folder = folder(&text.replace("soup:200", "soup:2000"));
    let told = contains("MISSED  certain-f32");
    validate(folder.path()).assert().code(1).stdout(told);
}

#[test]
fn quick_and_dry_runs_say_what_they_do() {
    let quick = "[quick]\nscenes = [\"spd:tetra:3\"]\nnumber = 512\n";
    let folder = folder(&format!("{TRAVERSAL}\n{quick}"));
    let dry = validate(folder.path()).arg("--dry-run").assert().code(0);
    for told in [
        "rays lines, lines:nearest, primary: 2048 of each source, 13 x 13 of a picture",
        "timed: 600 rays of each set, fewer above 100000 visits and tests, 2 times; builds 2 times",
    ] {
        let output = String::from_utf8_lossy(&dry.get_output().stdout).into_owned();
        assert!(output.contains(told), "{output}");
    }
    assert!(!folder.path().join("data").exists());
    validate(folder.path()).arg("--quick").assert().code(0);
    let name = folder.path().join("data/e-quick/traversal.csv");
    let mut reader = csv::Reader::from_path(name).unwrap();
    let rows: Vec<TraversalRecord> = reader.deserialize().collect::<Result<_, _>>().unwrap();
    assert!(rows.iter().all(|row| row.scene == "spd:tetra:3"));
    let cast = |rays: &str| rows.iter().find(|row| row.rays == rays).map(|row| row.cast);
    assert_eq!([cast("lines"), cast("primary")], [Some(512), Some(169)]);
}

#[test]
fn a_scene_too_fine_for_single_precision_is_walked_in_double() {
    let text = TRAVERSAL.replace(
        "\"spd:balls:2\", \"spd:tetra:3\", \"simple:soup:200\"",
        "\"far.obj\"",
    );
    let folder = folder(&text.replace(", \"primary\"", ""));
    // A tetrahedron of side 1, so far out that neighbouring f32 numbers are 1/16 apart.
    let corners = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
    ];
    let vertex = |[x, y, z]: [f64; 3]| format!("v {} {} {}\n", 1e6 + x, 1e6 + y, 1e6 + z);
    let vertices: String = corners.map(vertex).concat();
    let faces = "f 1 2 3\nf 1 2 4\nf 1 3 4\nf 2 3 4\n";
    fs::write(folder.path().join("far.obj"), vertices + faces).unwrap();
    let told = contains("single precision is too coarse here");
    validate(folder.path()).assert().code(0).stderr(told);
    let walks: Vec<TraversalRecord> = rows(folder.path(), "traversal.csv");
    assert!(walks.iter().all(|row| row.precision == "f64") && walks.len() == 8);
    let names = fs::read_to_string(folder.path().join("data/e/summary.json")).unwrap();
    assert!(names.contains("certain-f64") && !names.contains("certain-f32"));
}

#[test]
fn wrong_experiments_are_refused() {
    for (from, to, place, told) in [
        (
            "\"lines\", ",
            "\"lines:any\", ",
            "e.toml:7",
            "end with any hit",
        ),
        ("number = 2048", "number = 0", "e.toml:8", "must be 1 to"),
        ("pixels = 12", "pixels = 0", "e.toml:9", "must be 1 to"),
        ("rounds = 2", "rounds = 3", "e.toml:11", "must be even"),
        ("rays = 600", "rays = 0", "e.toml:11", "at least 1"),
        ("f64 = 1e-6", "f64 = 1.5", "e.toml:12", "must be 0 to 1"),
        ("stop = ", "halt = ", "e.toml:6", "unknown field"),
        (
            "\"lines\", ",
            "\"lanes\", ",
            "e.toml:7",
            "'lanes' is no source of rays",
        ),
    ] {
        let folder = folder(&TRAVERSAL.replacen(from, to, 1));
        let assert = validate(folder.path()).assert().code(2);
        assert.stderr(contains(place)).stderr(contains(told));
        assert!(!folder.path().join("data").exists(), "{to}");
    }
    let folder = folder(TRAVERSAL);
    let mut asked = validate(folder.path());
    let error = asked.args(["--error", "1%"]).assert().code(2);
    error.stderr(contains("no wanted error settles"));
    let mut asked = validate(folder.path());
    let error = asked.args(["--lines", "2^40"]).assert().code(2);
    error.stderr(contains("must be 1 to 4194304"));
}
