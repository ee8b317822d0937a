//! Long runs: killed at any moment, told to stop, without room, without leave to write, two at once.
#![allow(clippy::unwrap_used, missing_docs)]

mod runs;

use std::fs;
use std::path::Path;
use std::process::{Child, Command as Process, Stdio};
use std::time::{Duration, Instant};

use predicates::prelude::*;
use predicates::str::contains;
use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use runs::{contents, folder, validate};

/// Twelve cells, of which two have their nodes.
const CELLS: &str = r#"kind = "hits-vs-area"
question = "Does it go on?"
seed = 5
scenes = ["simple:uniform:300", "simple:soup:300", "simple:clustered:300"]
strategies = ["sah", "spatial-median", "object-median", "sah-cyclic"]
stop = "objects:2:12"
nodes = true
cost = { c_k = 15.0, c_b = 0.0, c_t = 20.0 }
lines = { slope_error = 0.1, min = 262144, max = 262144 }
figure = { scene = "simple:uniform:300", strategy = "sah" }
expect = { slope_within = 0.1, family = 0.01, gate = 0.001 }
"#;

/// Trees that are counted one by one and timed together, with pictures.
const TREES: &str = r#"kind = "strategies"
question = "Does it go on?"
seed = 5
scenes = ["spd:balls:1", "spd:tetra:2"]
strategies = ["sah", "spatial-median", "object-median"]
stops = ["objects:2:12"]
clipped = false
pixels = 48
checked = 20
cost = { c_k = 15.0, c_b = 0.0, c_t = 20.0 }
lines = { slope_error = 0.1, min = 65536, max = 65536 }
timing = { rounds = 2, builds = 2, pass_s = 0.01 }
expect = { family = 0.01 }
"#;

/// The program at work in a folder, on one thread.
fn start(folder: &Path, more: &[&str]) -> Child {
    let program = assert_cmd::cargo::cargo_bin!("validate");
    let mut command = Process::new(program);
    command
        .args(["run", "e.toml", "--quiet", "--threads", "1"])
        .args(more)
        .current_dir(folder)
        .stdout(Stdio::null())
        .stderr(Stdio::piped());
    command.spawn().unwrap()
}

/// All but what a kill may leave behind: files under temporary names.
fn whole(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let all = contents(folder).into_iter();
    all.filter(|(name, _)| !name.ends_with(".part")).collect()
}

/// Killed at so many random moments, and then left alone, a run ends with the bytes of one that was never disturbed; and at no
/// moment is any file of it but half of one.
fn goes_on_after_kills(text: &str, kills: u32, seed: u64) {
    let undisturbed = folder(text);
    let started = Instant::now();
    validate(undisturbed.path()).arg("--quiet").assert().code(0);
    let took = started.elapsed();
    let wanted = contents(undisturbed.path());

    let killed = folder(text);
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut kept = 0;
    for _ in 0..kills {
        let mut child = start(killed.path(), &[]);
        // Now and then it gets to its end; then it begins anew.
        std::thread::sleep(took.mul_f64(random.random_range(0.0..0.6)));
        child.kill().unwrap();
        child.wait().unwrap();
        let cells = killed.path().join("data/e/cells");
        if cells.is_dir() {
            for (name, bytes) in whole(&cells) {
                if name.ends_with(".json") {
                    let read = serde_json::from_slice::<serde_json::Value>(&bytes);
                    assert!(read.is_ok(), "{name} is half a file");
                    kept += 1;
                }
            }
        }
        if killed.path().join("plots/e/figure3.svg").exists() {
            fs::remove_dir_all(killed.path().join("data")).unwrap();
            fs::remove_dir_all(killed.path().join("plots")).unwrap();
        }
    }
    assert!(kept > 0, "no kill came after a piece was finished");
    validate(killed.path()).arg("--quiet").assert().code(0);
    // Nothing is missing, nothing is left over: not even of files that were being written.
    let found = contents(killed.path());
    let names = |all: &std::collections::BTreeMap<String, Vec<u8>>| -> Vec<String> {
        all.keys().cloned().collect()
    };
    assert_eq!(names(&found), names(&wanted));
    let differing = found
        .iter()
        .filter(|(name, bytes)| wanted[*name] != **bytes);
    let differing: Vec<_> = differing.map(|(name, _)| name).collect();
    assert!(differing.is_empty(), "{differing:?}");
}

#[test]
fn killed_at_ten_random_moments_cells_go_on() {
    goes_on_after_kills(CELLS, 10, 1);
}

#[test]
fn killed_at_ten_random_moments_trees_and_pictures_go_on() {
    goes_on_after_kills(TREES, 10, 2);
}

/// What a run leaves but for what is there to go on from.
fn results(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let all = whole(folder).into_iter();
    all.filter(|(name, _)| !name.contains("/cells/")).collect()
}

#[test]
fn of_two_runs_in_turn_none_is_taken_for_finished_that_is_not() {
    // Few lines: what is stopped here is the writing.
    let folder = folder(&CELLS.replace("262144", "8192"));
    let seeds = ["5", "9"];
    let run = |seed: &str| {
        validate(folder.path())
            .args(["--quiet", "--seed", seed])
            .assert()
            .code(predicate::in_iter([0, 1]));
        results(folder.path())
    };
    let wanted = seeds.map(run);
    assert!(wanted[0] != wanted[1]);
    // All cells of both are there: from now on a run does little but write.
    let started = Instant::now();
    run(seeds[0]);
    let took = started.elapsed();
    let mut random = ChaCha8Rng::seed_from_u64(3);
    let (mut sound, mut refused) = (0, 0);
    for kill in 1..=12 {
        if kill % 3 == 0 {
            // One that is stopped leaves its mark until a run comes to its end.
            run(seeds[kill % 2]);
        }
        let mut child = start(folder.path(), &["--seed", seeds[(kill + 1) % 2]]);
        std::thread::sleep(took.mul_f64(random.random_range(0.0..1.2)));
        if kill % 12 == 0 {
            child.wait().unwrap();
        }
        child.kill().unwrap();
        child.wait().unwrap();
        let ask = |arguments: &[&str]| {
            let program = assert_cmd::cargo::cargo_bin!("validate");
            let mut command = Process::new(program);
            command.current_dir(folder.path()).args(arguments);
            let ran = command.output().unwrap();
            (ran.status.code(), String::from_utf8(ran.stderr).unwrap())
        };
        let found = results(folder.path());
        let (code, told) = ask(&["archive", "data/e", "--out", "../e.tar.gz", "--dry-run"]);
        if code == Some(0) {
            assert!(wanted.contains(&found), "two runs in one archive");
            sound += 1;
            continue;
        }
        refused += 1;
        let stopped = "data/e: a run is writing here, or was stopped before its end; run it again";
        assert!(code == Some(2) && told.contains(stopped), "{told}");
        if refused > 1 {
            continue;
        }
        // Nothing else takes it for a run either, or makes it look like one.
        for command in ["tables", "plots", "report"] {
            let (code, told) = ask(&[command, "data/e"]);
            assert!(
                code == Some(2) && told.contains(stopped),
                "{command}: {told}"
            );
        }
        let (code, told) = ask(&["publish", "e"]);
        assert!(
            code == Some(2) && told.contains("data/e: a run is"),
            "{told}"
        );
        assert!(results(folder.path()) == found);
    }
    assert!(sound > 0 && refused > 0, "{sound} {refused}");
    assert!(run(seeds[1]) == wanted[1]);
}

#[test]
fn a_finished_cell_that_was_changed_is_measured_again() {
    let folder = folder(TREES);
    let run = || validate(folder.path()).assert().code(0);
    run();
    let before = contents(folder.path());
    let changed = |file: &Path| {
        let mut bytes = fs::read(file).unwrap();
        let digit = bytes.iter().rposition(u8::is_ascii_digit).unwrap();
        bytes[digit] ^= 1;
        fs::write(file, bytes).unwrap();
    };
    let below = |part: &str| {
        let files = fs::read_dir(folder.path().join("data/e").join(part)).unwrap();
        let files = files.map(|file| file.unwrap().path());
        let own = |file: &std::path::PathBuf| !file.ends_with(".lock");
        files.filter(own).collect::<Vec<_>>()
    };
    let all = [below("cells"), below("pictures")].concat();
    // Two scenes: three trees each, their times, a picture and the costs of its pixels.
    assert_eq!(all.len(), 2 * (3 + 1 + 2));
    for file in all {
        changed(&file);
        run().stderr(contains("3 of 6 trees were finished by an earlier run"));
        assert!(contents(folder.path()) == before, "{}", file.display());
    }
    run().stderr(contains("6 of 6 trees were finished by an earlier run"));
    // A pipe, on which reading would wait for ever.
    #[cfg(unix)]
    {
        let cell = &below("cells")[0];
        fs::remove_file(cell).unwrap();
        if Process::new("mkfifo")
            .arg(cell)
            .status()
            .is_ok_and(|made| made.success())
        {
            run();
            assert!(contents(folder.path()) == before);
        }
    }
}

/// An archive is not made of a folder in which a run is writing, nor the other way round.
#[test]
fn what_is_read_is_not_written() {
    let folder = folder(CELLS);
    validate(folder.path()).arg("--quiet").assert().code(0);
    let busy = "data/e: another process is at work in this folder; wait for it";
    let ask = |arguments: &[&str]| {
        let mut command = assert_cmd::Command::cargo_bin("validate").unwrap();
        command.current_dir(folder.path()).args(arguments);
        command.assert().code(2).stderr(contains(busy));
    };
    let lock = fs::File::create(folder.path().join("data/e/cells/.lock")).unwrap();
    lock.lock().unwrap();
    ask(&["archive", "data/e"]);
    ask(&["publish", "e"]);
    lock.unlock().unwrap();
    lock.lock_shared().unwrap();
    ask(&["run", "e.toml"]);
    // Many may read.
    let mut command = assert_cmd::Command::cargo_bin("validate").unwrap();
    command
        .current_dir(folder.path())
        .args(["archive", "data/e"]);
    command.assert().code(0);
}

#[test]
fn two_runs_in_one_folder_are_kept_apart() {
    let folder = folder(CELLS);
    let mut first = start(folder.path(), &[]);
    let lock = folder.path().join("data/e/cells/.lock");
    while !lock.exists() {
        assert!(first.try_wait().unwrap().is_none(), "ended before it began");
        std::thread::sleep(Duration::from_millis(1));
    }
    // Until the first has the folder for itself, the second may: whichever comes second is refused.
    let second = validate(folder.path()).arg("--quiet").output().unwrap();
    let first = first.wait_with_output().unwrap();
    let codes = [first.status.code(), second.status.code()];
    assert!(
        codes == [Some(0), Some(2)] || codes == [Some(2), Some(0)],
        "{codes:?}"
    );
    let refused = if codes[0] == Some(2) { first } else { second };
    let told = String::from_utf8(refused.stderr).unwrap();
    assert!(
        told.starts_with("error: ./data/e: another process is at work in this folder; ")
            && told.lines().count() == 1,
        "{told}"
    );
    // The folder is free again.
    validate(folder.path())
        .assert()
        .code(0)
        .stderr(contains("12 of 12 cells"));
}

#[cfg(unix)]
#[test]
fn told_to_stop_it_stops_between_two_files() {
    for signal in ["INT", "TERM"] {
        let folder = folder(CELLS);
        let mut child = start(folder.path(), &[]);
        let first = |entry: std::io::Result<fs::DirEntry>| {
            entry
                .unwrap()
                .path()
                .display()
                .to_string()
                .ends_with(".times.json")
        };
        let cells = folder.path().join("data/e/cells");
        while !fs::read_dir(&cells).is_ok_and(|mut files| files.any(first)) {
            assert!(
                child.try_wait().unwrap().is_none(),
                "ended before a piece did"
            );
            std::thread::sleep(Duration::from_millis(1));
        }
        let mut sent = Process::new("kill");
        sent.arg(format!("-{signal}")).arg(child.id().to_string());
        assert!(sent.status().unwrap().success());
        let ended = child.wait_with_output().unwrap();
        assert_eq!(ended.status.code(), Some(130), "{signal}");
        let told = String::from_utf8(ended.stderr).unwrap();
        assert!(told.contains("the same command goes on"), "{told}");
        let left = contents(folder.path());
        assert!(left.keys().all(|name| !name.ends_with(".part")));
        validate(folder.path())
            .assert()
            .code(0)
            .stderr(contains("of 12 cells were finished by an earlier run"));
    }
}

#[cfg(unix)]
#[test]
fn a_repeated_run_that_is_stopped_leaves_nothing() {
    let folder = folder(CELLS);
    validate(folder.path()).arg("--quiet").assert().code(0);
    let program = assert_cmd::cargo::cargo_bin!("validate");
    let temporary = folder.path().join("temporary");
    fs::create_dir(&temporary).unwrap();
    let run = |arguments: &[&str]| {
        let mut command = Process::new(program);
        command.args(arguments).current_dir(folder.path());
        command.env("TMPDIR", &temporary);
        command.stdout(Stdio::null()).stderr(Stdio::null());
        command.spawn().unwrap()
    };
    assert!(run(&["archive", "data/e"]).wait().unwrap().success());
    let replay = ["verify", "archives/e.tar.gz", "--replay", "--threads", "1"];
    let mut child = run(&replay);
    let begun = || fs::read_dir(&temporary).unwrap().count() > 0;
    while !begun() {
        assert!(child.try_wait().unwrap().is_none(), "ended before it began");
        std::thread::sleep(Duration::from_millis(1));
    }
    let mut stop = Process::new("kill");
    assert!(
        stop.arg("-INT")
            .arg(child.id().to_string())
            .status()
            .unwrap()
            .success()
    );
    assert_eq!(child.wait().unwrap().code(), Some(130));
    assert!(!begun(), "something is left");
    assert!(run(&replay).wait().unwrap().success());
    assert!(!begun(), "something is left");
}

#[cfg(unix)]
#[test]
fn a_folder_that_cannot_be_written_is_told_before_anything_is_measured() {
    let folder = folder(CELLS);
    // A file where a folder is to be: refused even to those who may write anywhere.
    fs::write(folder.path().join("data"), "").unwrap();
    validate(folder.path())
        .assert()
        .code(2)
        .stdout("")
        .stderr(contains("data/e/cells/.lock: cannot write").and(contains("counting").not()));
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
}

/// On a file system of one megabyte, where the system lets us make one.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_one_message_and_the_run_goes_on_elsewhere() {
    let folder = folder(CELLS);
    let program = assert_cmd::cargo::cargo_bin!("validate");
    let script = format!(
        "mkdir small && mount -t tmpfs -o size=1m none small && cp e.toml small/ && cd small && \
         {} run e.toml --quiet; code=$?; find . -name '*.part' | grep . && exit 99; cp -r . ../kept; exit $code",
        program.display()
    );
    let ran = Process::new("unshare")
        .args(["--user", "--map-root-user", "--mount", "sh", "-c", &script])
        .current_dir(folder.path())
        .output();
    let ran = match ran {
        Ok(ran) if folder.path().join("kept").is_dir() || ran.status.code() == Some(99) => ran,
        _ => {
            eprintln!("skipped: no small file system can be made here");
            return;
        }
    };
    let told = String::from_utf8(ran.stderr).unwrap();
    assert_eq!(ran.status.code(), Some(2), "{told}");
    assert_eq!(told.lines().count(), 1, "{told}");
    assert!(
        told.contains("cannot write: No space left on device"),
        "{told}"
    );
    // With room it goes on from what was finished, and nothing of it is half.
    let undisturbed = runs::folder(CELLS);
    validate(undisturbed.path()).arg("--quiet").assert().code(0);
    validate(&folder.path().join("kept"))
        .assert()
        .code(0)
        .stderr(contains("of 12 cells were finished by an earlier run"));
    assert!(contents(&folder.path().join("kept")) == contents(undisturbed.path()));
}
