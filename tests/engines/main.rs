//! Shards through Slurm and through Snakemake, where these are there: the run of one machine, to the byte.
#![allow(clippy::unwrap_used, missing_docs)]

#[path = "../runs/mod.rs"]
mod runs;

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use runs::{contents, folder, validate};

const CELLS: &str = r#"kind = "hits-vs-area"
question = "Is it the same?"
seed = 5
scenes = ["simple:uniform:100", "simple:soup:100", "simple:clustered:100"]
strategies = ["sah", "spatial-median", "object-median"]
stop = "objects:2:10"
nodes = true
cost = { c_k = 15.0, c_b = 0.0, c_t = 20.0 }
lines = { slope_error = 0.1, min = 65536, max = 65536 }
figure = { scene = "simple:uniform:100", strategy = "sah" }
expect = { slope_within = 0.1, family = 0.01, gate = 0.001 }
"#;

/// What a command that is there says; nothing where it is not, or where it fails.
fn answers(command: &mut Command) -> bool {
    command
        .output()
        .is_ok_and(|told| told.status.success() && !told.stdout.is_empty())
}

/// Print a plan into a file of the folder, and run it by this command, told the program.
fn run_plan(folder: &Path, arguments: &[&str], file: &str, engine: &mut Command) -> Output {
    let program = assert_cmd::cargo::cargo_bin!("validate");
    let plan = Command::new(program)
        .current_dir(folder)
        .args(["plan", "e.toml"])
        .args(arguments)
        .output()
        .unwrap();
    assert!(plan.status.success());
    fs::write(folder.join(file), plan.stdout).unwrap();
    engine.current_dir(folder).env("VALIDATE", program);
    engine.output().unwrap()
}

/// Data and figures are those of a run by one machine.
fn is_as_by_one(shared: &Path, what: &str) {
    let one = folder(&fs::read_to_string(shared.join("e.toml")).unwrap());
    validate(one.path()).arg("--quiet").assert().code(0);
    let wanted = contents(one.path()).into_iter();
    let wanted: Vec<_> = wanted
        .filter(|(name, _)| name.starts_with("data/") || name.starts_with("plots/"))
        .collect();
    let found = contents(shared);
    assert!(wanted.len() > 30);
    for (name, bytes) in wanted {
        assert!(found.get(&name) == Some(&bytes), "{what}: {name}");
    }
}

/// The environment names Snakemake, or it is on the path.
#[test]
fn two_shards_through_snakemake() {
    let snakemake = std::env::var("SAHLAB_SNAKEMAKE").unwrap_or_else(|_| "snakemake".into());
    if !answers(Command::new(&snakemake).arg("--version")) {
        eprintln!(
            "skipped: no snakemake on the path; `pip install snakemake`, or name it by SAHLAB_SNAKEMAKE"
        );
        return;
    }
    let shared = folder(CELLS);
    let shared = shared.path();
    let run = |more: &[&str]| {
        let mut engine = Command::new(&snakemake);
        engine.args(["--cores", "2"]).args(more);
        let ran = run_plan(
            shared,
            &["--shards", "2", "--format", "snakemake"],
            "Snakefile",
            &mut engine,
        );
        let told = String::from_utf8_lossy(&ran.stderr).into_owned();
        assert!(ran.status.success(), "{told}");
        told
    };
    run(&[]);
    is_as_by_one(shared, "snakemake");
    assert!(run(&[]).contains("Nothing to be done"));
    // Another question is another run.
    let other = CELLS.replace("seed = 5", "seed = 6");
    fs::write(shared.join("e.toml"), other).unwrap();
    run(&[]);
    is_as_by_one(shared, "snakemake, of an edited experiment");
}

/// Where a Slurm answers: that of the system, or the one of `tests/engines/slurm-node.sh`.
#[test]
fn an_array_of_six_through_slurm() {
    if !answers(Command::new("sinfo").arg("--noheader")) {
        eprintln!(
            "skipped: no Slurm answers; tests/engines/slurm-node.sh starts one of a single node"
        );
        return;
    }
    // Where the jobs run, the folder must be seen: on one node any is.
    let shared = folder(CELLS);
    let shared = shared.path();
    let mut engine = Command::new("sh");
    engine.arg("submit.sh").env("THREADS", "1");
    let ran = run_plan(
        shared,
        &["--shards", "6", "--format", "slurm"],
        "submit.sh",
        &mut engine,
    );
    let told =
        String::from_utf8_lossy(&ran.stdout).into_owned() + &String::from_utf8_lossy(&ran.stderr);
    assert!(ran.status.success(), "{told}");
    let merged = fs::read_to_string(shared.join("e-merge.log")).unwrap();
    assert!(merged.contains("held"), "{merged}");
    is_as_by_one(shared, "slurm");
    // One task again: the same share.
    let script = fs::read_to_string(shared.join("submit.sh")).unwrap();
    let again = script.replace("--array=1-6", "--wait --array=3");
    assert_ne!(again, script);
    fs::write(shared.join("again.sh"), again).unwrap();
    let mut engine = Command::new("sh");
    engine.arg("again.sh").current_dir(shared);
    engine.env("VALIDATE", assert_cmd::cargo::cargo_bin!("validate"));
    assert!(engine.status().unwrap().success());
    let log = fs::read_to_string(shared.join("e-3.log")).unwrap();
    assert!(log.contains("e, share 3/6: "), "{log}");
    is_as_by_one(shared, "slurm, one task again");
}
