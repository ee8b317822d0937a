//! Runs that several machines share: put together they are the run of one.
#![allow(clippy::unwrap_used, missing_docs)]

mod runs;

use std::fs;
use std::path::{Path, PathBuf};

use assert_cmd::Command;
use predicates::prelude::*;
use predicates::str::contains;
use runs::{contents, folder, validate};
use sahlab::study::identity::digest;
use tempfile::TempDir;

const CELLS: &str = r#"kind = "hits-vs-area"
question = "Is it the same?"
seed = 5
scenes = ["simple:uniform:100", "simple:soup:100"]
strategies = ["sah", "spatial-median", "object-median"]
stop = "objects:2:10"
nodes = true
cost = { c_k = 15.0, c_b = 0.0, c_t = 20.0 }
lines = { slope_error = 0.1, min = 65536, max = 65536 }
figure = { scene = "simple:uniform:100", strategy = "sah" }
expect = { slope_within = 0.1, family = 0.01, gate = 0.001 }

[quick]
lines = { slope_error = 0.2, min = 4096, max = 4096 }
expect = { slope_within = 0.2, family = 0.01, gate = 0.001 }
"#;

fn shard(folder: &Path, share: &str, more: &[&str]) {
    validate(folder)
        .args(["--shard", share, "--quiet"])
        .args(more)
        .assert()
        .code(0);
}

fn merge(folder: &Path, shards: &[&str]) -> assert_cmd::assert::Assert {
    let mut command = Command::cargo_bin("validate").unwrap();
    command.current_dir(folder).args(["merge", "--quiet"]);
    for shard in shards {
        command.arg(format!("shards/e/{shard}"));
    }
    command.assert()
}

/// The same experiment measured by one.
fn whole(text: &str) -> TempDir {
    let folder = folder(text);
    validate(folder.path()).arg("--quiet").assert().code(0);
    folder
}

/// The files of data and figures of a run.
fn made(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let all = contents(folder).into_iter();
    all.filter(|(name, _)| name.starts_with("data/") || name.starts_with("plots/"))
        .collect()
}

#[test]
fn shards_put_together_are_the_run_of_one() {
    let one = made(whole(CELLS).path());
    let shared = folder(CELLS);
    let shared = shared.path();
    for (share, threads) in [("1/4", "1"), ("2/4", "2"), ("3/4", "3"), ("4/4", "1")] {
        shard(shared, share, &["--threads", threads]);
    }
    assert!(!shared.join("data").exists());
    merge(shared, &["4-of-4", "2-of-4", "1-of-4", "3-of-4"]).code(0);
    assert!(made(shared) == one);
    let run = fs::read_to_string(shared.join("data/e/times-run.json")).unwrap();
    let run: sahlab::study::records::RunTimes = serde_json::from_str(&run).unwrap();
    let pieces = run.machines.iter().map(|m| (m.machine.threads, m.pieces));
    assert_eq!(pieces.collect::<Vec<_>>(), [(1, 3), (2, 2), (3, 1)]);
    // Again, over what is there; and shares that overlap do no harm.
    shard(shared, "1/2", &[]);
    merge(shared, &["1-of-4", "2-of-4", "3-of-4", "4-of-4", "1-of-2"]).code(0);
    assert!(made(shared) == one);
}

#[test]
fn gaps_conflicts_and_strangers_are_refused_in_words() {
    let shared = folder(CELLS);
    let shared = shared.path();
    shard(shared, "1/3", &[]);
    shard(shared, "3/3", &[]);
    let refused = |shards: &[&str], told: &str| {
        merge(shared, shards)
            .code(2)
            .stdout("")
            .stderr(contains(told));
        assert!(!shared.join("data").exists(), "half-written");
    };
    refused(
        &["1-of-3", "3-of-3"],
        "2 of 6 pieces of the run are in none of these shards, the first simple:uniform:100 spatial-median (",
    );
    refused(&["1-of-3", "3-of-3"], "; run --shard 2/3 first");
    refused(
        &["1-of-3", "2-of-3"],
        "shards/e/2-of-3: no shard.json, so no finished shard; ",
    );

    // Another seed is another run.
    fs::rename(shared.join("shards/e"), shared.join("kept")).unwrap();
    shard(shared, "2/3", &["--seed", "6"]);
    fs::rename(shared.join("shards/e/2-of-3"), shared.join("kept/2-of-3")).unwrap();
    fs::remove_dir(shared.join("shards/e")).unwrap();
    fs::rename(shared.join("kept"), shared.join("shards/e")).unwrap();
    refused(
        &["1-of-3", "2-of-3", "3-of-3"],
        "shards/e/1-of-3: not of the same run as shards/e/2-of-3: in their experiment.toml, `seed = 6` (line ",
    );
    fs::remove_dir_all(shared.join("shards/e/2-of-3")).unwrap();
    shard(shared, "2/3", &[]);

    // A result that another shard has otherwise, though each is as it was written.
    shard(shared, "1/1", &[]);
    let cell = finished(&shared.join("shards/e/1-of-1"), ".json");
    let sound = fs::read_to_string(&cell).unwrap();
    fs::write(&cell, forged(&sound)).unwrap();
    let all = ["1-of-3", "2-of-3", "3-of-3", "1-of-1"];
    merge(shared, &all).code(2).stderr(
        contains(".json: differs from shards/e/")
            .and(contains("remove the shard that is wrong and run it again")),
    );
    fs::write(&cell, sound).unwrap();

    // Another program.
    let told = shared.join("shards/e/1-of-3/shard.json");
    let sound = fs::read_to_string(&told).unwrap();
    fs::write(&told, sound.replace(sahlab::REVISION, "000000000000")).unwrap();
    merge(shared, &all).code(2).stderr(contains(
        "measured by revision 000000000000 of the program, this is ",
    ));
    fs::write(&told, sound).unwrap();
    merge(shared, &all).code(0);
    assert!(made(shared) == made(whole(CELLS).path()));
}

/// The first finished cell of a run, or what goes with it.
fn finished(run: &Path, end: &str) -> PathBuf {
    let files = fs::read_dir(run.join("cells")).unwrap();
    let name = |file: &PathBuf| file.file_name().unwrap().to_string_lossy().into_owned();
    let mut files: Vec<_> = files.map(|file| file.unwrap().path()).collect();
    files.retain(|file| match name(file).split_once('.') {
        Some((id, rest)) => !id.is_empty() && format!(".{rest}") == end,
        None => false,
    });
    files.sort();
    files.swap_remove(0)
}

/// A finished cell that says something else and is whole: only whoever has measured it knows better.
fn forged(cell: &str) -> String {
    let (head, content) = cell.split_once("\"content\":").unwrap();
    let content = content.strip_suffix('}').unwrap();
    let other = content.replacen("\"hits\":", "\"hits\":1", 1);
    assert_ne!(content, other);
    let [old, new] = [content, &other].map(|text| digest(text.as_bytes()));
    assert!(head.contains(&old));
    format!("{}\"content\":{other}}}", head.replace(&old, &new))
}

#[test]
fn what_is_broken_in_a_shard_is_told_before_anything_is_written() {
    let shared = folder(CELLS);
    let shared = shared.path();
    shard(shared, "1/2", &[]);
    shard(shared, "2/2", &[]);
    merge(shared, &["1-of-2", "2-of-2"]).code(0);
    let before = contents(shared);
    let one = shared.join("shards/e/1-of-2");
    let refused = |told: &str| {
        let before = contents(shared);
        merge(shared, &["1-of-2", "2-of-2"])
            .code(2)
            .stdout("")
            .stderr(contains(told).and(contains("shards/e/1-of-2")));
        assert!(contents(shared) == before, "something was written");
    };
    let broken = "1 pieces of the run are missing: simple:";
    let again = "; run --shard 1/2 again, which keeps what is sound";
    for end in [".json", ".times.json", ".nodes.csv"] {
        let file = finished(&one, end);
        let sound = fs::read(&file).unwrap();
        // One digit, wherever it is.
        let mut flipped = sound.clone();
        let digit = flipped.iter().rposition(u8::is_ascii_digit).unwrap();
        flipped[digit] = b'0' + (flipped[digit] - b'0' + 1) % 10;
        fs::write(&file, &flipped).unwrap();
        refused(broken);
        refused(again);
        fs::remove_file(&file).unwrap();
        refused(broken);
        // A shard that is run again is whole again.
        shard(shared, "1/2", &[]);
        merge(shared, &["1-of-2", "2-of-2"]).code(0);
        assert!(contents(shared) == before, "{end}");
    }

    let told = one.join("shard.json");
    let sound = fs::read_to_string(&told).unwrap();
    for (old, new, message) in [
        (
            "\"of\": 2",
            "\"of\": 5",
            "its pieces are not those of share 1/5",
        ),
        (
            "\"share\": 1",
            "\"share\": 2",
            "its pieces are not those of share 2/2",
        ),
        ("\"share\": 1", "\"share\": 7", "there is no share 7/2"),
        (
            "\"pieces\"",
            "\"parts\"",
            "shard.json: not what a shard has there",
        ),
    ] {
        let other = sound.replace(old, new);
        assert_ne!(other, sound);
        fs::write(&told, other).unwrap();
        refused(message);
    }
    fs::write(&told, sound).unwrap();
    // Files of a user's own are no matter.
    fs::create_dir(one.join("cells/more")).unwrap();
    merge(shared, &["1-of-2", "2-of-2"]).code(0);

    // Stopped while it was run again.
    fs::write(one.join("UNFINISHED"), "").unwrap();
    refused("a run is writing here, or was stopped before its end");
    shard(shared, "1/2", &[]);
    merge(shared, &["1-of-2", "2-of-2"]).code(0);
}

#[test]
fn options_are_kept_and_shares_resume() {
    let one = folder(CELLS);
    validate(one.path())
        .args(["--quick", "--seed", "9", "--quiet"])
        .assert()
        .code(0);
    let shared = folder(CELLS);
    let shared = shared.path();
    let auto = |id: &str| {
        let mut command = validate(shared);
        for (name, value) in [
            ("ID", id),
            ("MIN", "0"),
            ("MAX", "1"),
            ("COUNT", "2"),
            ("STEP", "1"),
        ] {
            command.env(format!("SLURM_ARRAY_TASK_{name}"), value);
        }
        command
            .args(["--shard", "auto", "--quick", "--seed", "9"])
            .assert()
            .code(0)
    };
    auto("0").stdout(contains("e-quick, share 1/2: 3 pieces in "));
    auto("1");
    auto("1").stderr(contains("3 of 3 cells were finished by an earlier run"));
    let mut command = Command::cargo_bin("validate").unwrap();
    let shards = ["shards/e-quick/1-of-2", "shards/e-quick/2-of-2"];
    command
        .current_dir(shared)
        .args(["merge", "--json", "--quiet"])
        .args(shards);
    let told = command.assert().code(0).get_output().stdout.clone();
    let summary: serde_json::Value = serde_json::from_slice(&told).unwrap();
    assert_eq!(summary["seed"], 9);
    assert!(made(shared) == made(one.path()));
    // A task that is submitted again knows how many there are only if it is told.
    let mut again = validate(shared);
    for (name, value) in [("ID", "2"), ("MIN", "2"), ("MAX", "2"), ("COUNT", "1")] {
        again.env(format!("SLURM_ARRAY_TASK_{name}"), value);
    }
    again.args(["--quick", "--seed", "9", "--shard", "auto/2"]);
    again
        .assert()
        .code(0)
        .stderr(contains("3 of 3 cells were finished by an earlier run"));
    again.args(["--shard", "auto"]).assert().code(2);
    // Options would ask for another run.
    command
        .arg("--seed=9")
        .assert()
        .code(2)
        .stderr(contains("leave --seed"));
    for (wrong, told) in [
        ("0/3", "there is no share 0/3"),
        ("auto", "SLURM_ARRAY_TASK_ID is not set"),
        ("auto/3", "SLURM_ARRAY_TASK_ID is not set"),
        ("auto/x", "expected auto/N"),
        ("x", "expected I/N"),
    ] {
        validate(shared)
            .env_remove("SLURM_ARRAY_TASK_ID")
            .args(["--shard", wrong])
            .assert()
            .code(2)
            .stderr(contains(told));
    }
}

#[test]
fn scripts_name_what_they_are_given() {
    let folder = folder(CELLS);
    let script = |arguments: &[&str]| {
        let mut command = Command::cargo_bin("validate").unwrap();
        command
            .current_dir(folder.path())
            .args(["plan", "e.toml", "--shards", "6"]);
        command
            .args(arguments)
            .assert()
            .code(0)
            .get_output()
            .stdout
            .clone()
    };
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    let slurm = text(script(&[
        "--format", "slurm", "--quick", "--seed", "3", "--out", "o",
    ]));
    for part in [
        "--array=1-6",
        "threads=${THREADS:-2}\n",
        "run e.toml --shard auto/6 --threads $threads --quick --seed 3 --out o\"",
        "merge o/shards/e-quick/*-of-6 --out o ||",
    ] {
        assert!(slurm.contains(part), "{part}\n{slurm}");
    }
    if let Ok(checked) = std::process::Command::new("sh")
        .arg("-n")
        .stdin(std::process::Stdio::piped())
        .spawn()
    {
        use std::io::Write;
        let mut checked = checked;
        checked
            .stdin
            .take()
            .unwrap()
            .write_all(slurm.as_bytes())
            .unwrap();
        assert!(checked.wait().unwrap().success());
    }
    let snakemake = text(script(&["--format", "snakemake", "--threads", "3"]));
    for part in [
        "run e.toml --shard {wildcards.i}/6 --threads {threads}\"",
        "    input:\n        \"e.toml\",\n    output:\n        \"shards/e/{i}-of-6/shard.json\",\n    threads: 3\n",
        "\"data/e/summary.json\"",
    ] {
        assert!(snakemake.contains(part), "{part}\n{snakemake}");
    }
    let mut command = Command::cargo_bin("validate").unwrap();
    command.current_dir(folder.path());
    command.args([
        "plan", "e.toml", "--shards", "6", "--format", "slurm", "--out", "a b",
    ]);
    command
        .assert()
        .code(2)
        .stderr(contains("a b: a script can only name paths of"));
}
