//! Files in, files out: two forms of the same rays, any number of threads, wrong input.

use std::fs;
use std::path::Path;

use predicates::prelude::*;
use predicates::str::contains;
use sahlab::geom::{Cast, Line, Span};
use sahlab::rays::SurfaceLines;
use sahlab::scene::Scene;
use tempfile::tempdir;

use crate::{as_csv, as_npy, numbers, traced, validate};

const SCENE: &str = "simple:soup:300";

/// Lines into the scene's box, some with an end.
fn casts(n: u64) -> Vec<Cast> {
    let world = Scene::load(SCENE).unwrap().world;
    let cast = |(i, line): (usize, Line)| Cast {
        origin: line.origin,
        direction: line.direction,
        span: Span {
            t0: 0.0,
            t1: if i % 3 == 0 { 0.4 } else { f64::INFINITY },
        },
    };
    let lines = SurfaceLines { world, seed: 9 }.range(0..n);
    lines.enumerate().map(cast).collect()
}

fn hits(folder: &Path) -> Vec<u8> {
    fs::read(folder.join("data/trace/hits.csv")).unwrap()
}

#[test]
fn both_forms_and_any_number_of_threads_give_the_same_bytes() {
    let folder = tempdir().unwrap();
    let here = folder.path();
    let casts = casts(5000);
    fs::write(here.join("r.csv"), as_csv(&casts)).unwrap();
    fs::write(
        here.join("r.npy"),
        as_npy(7, casts.iter().flat_map(numbers)),
    )
    .unwrap();
    let (rows, first) = traced(here, SCENE, "r.csv", &["--threads", "1"]);
    assert_eq!(rows.len(), 5000);
    let bytes = hits(here);
    assert!(bytes.starts_with(b"ray,object,t,n_K,n_B,n_t\n0,"));
    let whole = fs::read(here.join("data/trace/trace.json")).unwrap();
    for threads in ["2", "3", "7"] {
        traced(here, SCENE, "r.csv", &["--threads", threads]);
        assert!(bytes == hits(here), "{threads} threads");
        assert!(whole == fs::read(here.join("data/trace/trace.json")).unwrap());
    }
    let (_, second) = traced(here, SCENE, "r.npy", &[]);
    assert!(bytes == hits(here));
    assert_eq!(
        (second.file.as_str(), &second.content),
        ("r.npy", &first.content)
    );
    let readme = fs::read_to_string(here.join("data/trace/README.md")).unwrap();
    assert!(readme.contains("## hits.csv"));

    // Without an end: six columns are seven with none.
    let endless: Vec<Cast> = casts
        .iter()
        .map(|cast| Cast {
            span: Span::from(0.0),
            ..*cast
        })
        .collect();
    fs::write(here.join("r.csv"), as_csv(&endless)).unwrap();
    traced(here, SCENE, "r.csv", &[]);
    let bytes = hits(here);
    let six = endless
        .iter()
        .flat_map(|cast| numbers(cast).into_iter().take(6));
    fs::write(here.join("r.npy"), as_npy(6, six)).unwrap();
    traced(here, SCENE, "r.npy", &[]);
    assert!(bytes == hits(here));
}

#[test]
fn the_summary_is_told_in_words_or_as_json() {
    let folder = tempdir().unwrap();
    let here = folder.path();
    fs::write(here.join("r.csv"), as_csv(&casts(100))).unwrap();
    let trace = |more: &[&str]| {
        let mut command = validate(here);
        command.args(["trace", SCENE, "--rays", "r.csv"]).args(more);
        command
    };
    trace(&["--dry-run"]).assert().code(0).stdout(contains(
        "would trace 100 rays of r.csv, asking nearest, through the tree of sah",
    ));
    assert!(!here.join("data").exists());
    trace(&["--out", "sub"])
        .assert()
        .code(0)
        .stdout(
            contains("100 rays asking nearest, 100 meet the scene's box")
                .and(contains("object tests n_t")),
        )
        .stderr("");
    assert!(here.join("sub/data/trace/hits.csv").is_file());
    let output = trace(&["--json", "--ask", "all"]).output().unwrap();
    let told: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!((&told["rays"], &told["ask"]), (&100.into(), &"all".into()));
    assert!(told["trace_s"].as_f64().unwrap() > 0.0);
    let file = fs::read_to_string(here.join("data/trace/trace.json")).unwrap();
    assert!(!file.contains("_s\""), "no file holds seconds: {file}");
}

#[test]
fn bad_input_is_refused_in_one_line_and_writes_nothing() {
    const HEAD: &str = "ox,oy,oz,dx,dy,dz,tmax\n";
    let folder = tempdir().unwrap();
    let here = folder.path();
    let refused = |args: &[&str], parts: &[&str]| {
        let output = validate(here).args(args).output().unwrap();
        let message = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{args:?}: {message}");
        assert_eq!(message.trim_end().lines().count(), 1, "{message}");
        assert!(output.stdout.is_empty());
        for part in parts {
            assert!(message.contains(part), "'{part}' is not in: {message}");
        }
        let written = ["data", "plots"].map(|part| here.join(part).exists());
        assert_eq!(written, [false; 2]);
    };
    let wrong = |name: &str, bytes: &[u8], parts: &[&str]| {
        fs::write(here.join(name), bytes).unwrap();
        refused(&["trace", SCENE, "--rays", name], parts);
        refused(&["scene", SCENE, "--rays", name], parts);
    };
    for (row, parts) in [
        ("0,0,0,1,0", ["r.csv:2: 5 fields", "expected 7"]),
        ("0,0,0,1,0,x,", ["r.csv:2: dz is 'x'", "expected a number"]),
        (
            "0,0,inf,1,0,0,",
            ["r.csv:2: oz is inf", "must be a finite number"],
        ),
        (
            "0,0,0,0,0,0,",
            ["r.csv:2: the direction is zero", "at least one"],
        ),
        ("0,0,0,1e60,0,0,", ["r.csv:2: the largest part", "1e50"]),
        ("0,0,0,1,0,0,-1", ["r.csv:2: tmax is -1", "0 or more"]),
        ("0,0,0,1,0,0,nan", ["r.csv:2: tmax is NaN", "0 or more"]),
    ] {
        wrong("r.csv", format!("{HEAD}{row}\n").as_bytes(), &parts);
    }
    wrong("r.csv", b"", &["r.csv: the file is empty", "ox,oy,oz"]);
    wrong(
        "r.csv",
        HEAD.as_bytes(),
        &["r.csv: there are no rays in it"],
    );
    wrong(
        "r.csv",
        b"x,y\n1,2\n",
        &["r.csv:1: the header is 'x,y'", "expected 'ox,"],
    );
    wrong(
        "r.txt",
        b"0,0,0,1,0,0\n",
        &["r.txt: is no file of rays", ".csv or .npy"],
    );

    let good = as_npy(6, [0.0, 0.0, 0.0, 1.0, 0.0, 0.0].into_iter());
    let edited = |old: &str, new: &str| {
        assert_eq!(old.len(), new.len());
        let at = good
            .windows(old.len())
            .position(|w| w == old.as_bytes())
            .unwrap();
        let mut bytes = good.clone();
        bytes[at..at + old.len()].copy_from_slice(new.as_bytes());
        bytes
    };
    for (old, new, part) in [
        ("<f8", "<f4", "r.npy: its type is '<f4'"),
        ("(1, 6)", "(6, 1)", "r.npy: its shape is (6, 1)"),
        (
            "(1, 6)",
            "(2, 6)",
            "r.npy: row 1: the file ends before its end",
        ),
        ("False", "True ", "r.npy: it is in Fortran order"),
    ] {
        wrong("r.npy", &edited(old, new), &[part]);
    }
    wrong(
        "r.npy",
        &good[..20],
        &["r.npy: the file ends within its header"],
    );
    wrong("r.npy", b"", &["r.npy: does not begin as a .npy file does"]);
    refused(
        &["trace", SCENE, "--rays", "none.csv"],
        &["none.csv: cannot read the file"],
    );
    fs::write(here.join("g.npy"), &good).unwrap();
    refused(
        &["trace", "nothing", "--rays", "g.npy"],
        &["nothing: no such scene"],
    );
    for option in [&["--seed", "3"][..], &["--lines", "2048"], &["--quick"]] {
        let args = [&["trace", SCENE, "--rays", "g.npy"], option].concat();
        refused(&args, &[&format!("leave {} away", option[0])]);
    }
    fs::write(here.join("file"), "").unwrap();
    refused(
        &["trace", SCENE, "--rays", "g.npy", "--out", "file"],
        &["cannot write"],
    );
    // These the command line itself refuses, with how it is used.
    for args in [
        &["trace", SCENE][..],
        &["trace", SCENE, "--rays", "g.npy", "--ask", "first"],
        &["trace", SCENE, "--rays", "g.npy", "--strategy", "best"],
        &["scene", SCENE, "--ask", "any"],
        &["scene", SCENE, "--rays", "g.npy", "--nff", "x.nff"],
    ] {
        validate(here).args(args).assert().code(2);
        assert!(!here.join("data").exists());
    }
}
