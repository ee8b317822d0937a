//! The command line as a user meets it: exit codes, messages, files.
#![allow(clippy::unwrap_used, missing_docs)]

mod runs;

use std::fs;
use std::io::Read;
use std::path::Path;
use std::process::{Command as Process, Stdio};

use assert_cmd::Command;
use predicates::prelude::*;
use predicates::str::contains;
use runs::{contents, folder as with_experiment};
use tempfile::tempdir;

fn validate(folder: &Path) -> Command {
    let mut command = Command::cargo_bin("validate").unwrap();
    command.current_dir(folder);
    command
}

/// A small experiment that passes.
const GOOD: &str = r#"kind = "hits-vs-area"
question = "Does it work?"
seed = 5
scenes = ["simple:uniform:200"]
strategies = ["sah", "spatial-median"]
stop = "objects:2:10"
nodes = false
cost = { c_k = 15.0, c_b = 0.0, c_t = 20.0 }
lines = { slope_error = 0.1, min = 65536, max = 65536 }
figure = { scene = "simple:uniform:200", strategy = "sah" }
expect = { slope_within = 0.1, family = 0.01, gate = 0.001 }

[quick]
scenes = ["simple:uniform:100"]
lines = { slope_error = 0.1, min = 4096, max = 4096 }
figure = { scene = "simple:uniform:100", strategy = "sah" }
expect = { slope_within = 0.2, family = 0.01, gate = 0.001 }
"#;

#[test]
fn a_run_writes_data_tables_plots_and_a_summary() {
    let folder = with_experiment(GOOD);
    validate(folder.path())
        .args(["run", "e.toml"])
        .assert()
        .code(0)
        .stdout(
            contains("Does it work?")
                .and(contains("held    slope-within"))
                .and(contains("sah"))
                .and(contains("report ./plots/e/report.html\n")),
        )
        .stderr("counting lines through 2 cells\n");
    for file in [
        "data/e/README.md",
        "data/e/cells.csv",
        "data/e/bins.csv",
        "data/e/nodes.csv",
        "data/e/timings.csv",
        "data/e/summary.json",
        "data/e/tables/cells.md",
        "data/e/tables/cells.tex",
        "data/e/tables/costs.csv",
        "plots/e/figure3.svg",
        "plots/e/figure3.png",
        "plots/e/slopes.svg",
        "plots/e/predicted-vs-measured.png",
        "plots/e/report.html",
    ] {
        assert!(folder.path().join(file).is_file(), "{file}");
    }
    assert!(
        contents(folder.path())
            .iter()
            .all(|(name, _)| !name.ends_with(".part"))
    );

    // Every estimate is named and has its interval.
    let summary = fs::read_to_string(folder.path().join("data/e/summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_str(&summary).unwrap();
    let estimates = summary["estimates"].as_array().unwrap();
    assert_eq!(estimates.len(), 2 * 5);
    for e in estimates {
        for key in ["name", "scene", "strategy"] {
            assert!(e[key].is_string(), "{key}");
        }
        let [value, lo, hi] = ["value", "lo", "hi"].map(|key| e[key].as_f64().unwrap());
        assert!(lo <= value && value <= hi && e["n"] == 65536);
    }
}

#[test]
fn data_is_byte_identical_for_any_threads_and_from_run_to_run() {
    let folder = with_experiment(GOOD);
    let run = |threads: &str, out: &str| {
        let args = [
            "run",
            "e.toml",
            "--quiet",
            "--threads",
            threads,
            "--out",
            out,
            "--lines",
            "300000",
        ];
        validate(folder.path()).args(args).assert().code(0);
        contents(&folder.path().join(out).join("data"))
    };
    let one = run("1", "a");
    assert!(one.len() > 10);
    for (threads, out) in [("1", "b"), ("2", "c"), ("3", "d"), ("7", "e")] {
        let again = run(threads, out);
        assert!(one == again, "{threads} threads");
    }
}

#[test]
fn finished_cells_are_kept_unless_forced() {
    let folder = with_experiment(GOOD);
    let run = |more: &[&str]| {
        validate(folder.path())
            .args(["run", "e.toml"])
            .args(more)
            .assert()
            .code(0)
    };
    let first = folder.path().join("data");
    run(&[]);
    let before = contents(&first);
    run(&[]).stderr(contains("2 of 2 cells were finished by an earlier run"));
    assert!(before == contents(&first));
    run(&["--force"]).stderr("counting lines through 2 cells\n");
    assert!(before == contents(&first));

    // A stopped run: one cell is missing, the other is kept.
    let cells = fs::read_dir(folder.path().join("data/e/cells")).unwrap();
    let lost = cells
        .map(|c| c.unwrap().path())
        .find(|p| p.display().to_string().ends_with(".times.json"))
        .unwrap();
    fs::remove_file(lost).unwrap();
    run(&[]).stderr(contains("through 1 cell\n").and(contains("1 of 2 cells")));
    assert!(before == contents(&first));
    run(&["--quiet"]).stderr(predicate::str::is_empty());
    // Another seed is another cell, never the old one.
    run(&["--seed", "6"]).stderr("counting lines through 2 cells\n");
    assert!(before != contents(&first));
    // Times are this run's alone. They are put together from those of the cells, which stay.
    let timings = folder.path().join("data/e/timings.csv");
    let seconds = fs::read_to_string(&timings).unwrap();
    assert_eq!(seconds.lines().count(), 1 + 2);
    fs::remove_file(&timings).unwrap();
    run(&["--quiet"]).stdout(contains("speed"));
    assert!(seconds != fs::read_to_string(&timings).unwrap());
    run(&["--seed", "6"]).stderr(contains("2 of 2 cells"));
    assert_eq!(seconds, fs::read_to_string(&timings).unwrap());
}

#[test]
fn damaged_cells_are_measured_again() {
    let folder = with_experiment(&GOOD.replace("nodes = false", "nodes = true"));
    let run = |told: &str| {
        validate(folder.path())
            .args(["run", "e.toml"])
            .assert()
            .code(0)
            .stderr(contains(told));
    };
    run("through 2 cells");
    let data = folder.path().join("data");
    let before = contents(&data);
    let files = |ending: &str| -> Vec<std::path::PathBuf> {
        let all = fs::read_dir(data.join("e/cells")).unwrap();
        let mut found: Vec<_> = all
            .map(|c| c.unwrap().path())
            .filter(|p| p.display().to_string().ends_with(ending))
            .collect();
        found.sort();
        found
    };
    let (nodes, mut cells) = (files(".nodes.csv"), files(".json"));
    cells.retain(|path| !path.display().to_string().ends_with(".times.json"));
    assert_eq!((nodes.len(), cells.len()), (2, 2));
    let text = fs::read_to_string(&nodes[0]).unwrap();
    let digit = text.rfind('1').unwrap();
    let corrupted = format!("{}2{}", &text[..digit], &text[digit + 1..]);
    let last_row = text.trim_end().rfind('\n').unwrap();
    let truncated = &text[..=last_row];
    let foreign = fs::read_to_string(&nodes[1]).unwrap();
    for wrong in [&corrupted, truncated, &foreign, ""] {
        fs::write(&nodes[0], wrong).unwrap();
        run("1 of 2 cells");
        assert!(before == contents(&data));
    }
    fs::remove_file(&nodes[0]).unwrap();
    run("1 of 2 cells");
    assert!(before == contents(&data));
    // Another cell under this one's name, and another program's.
    let own = fs::read_to_string(&cells[0]).unwrap();
    let other = fs::read_to_string(&cells[1]).unwrap();
    let older = own.replacen("\"revision\":\"", "\"revision\":\"0", 1);
    assert_ne!(older, own);
    for wrong in [&other, &older, "{"] {
        fs::write(&cells[0], wrong).unwrap();
        run("1 of 2 cells");
        assert!(before == contents(&data));
    }
}

#[test]
fn quick_runs_have_folders_of_their_own() {
    let folder = with_experiment(GOOD);
    validate(folder.path())
        .args(["run", "e.toml", "--quick", "--quiet"])
        .assert()
        .code(0);
    assert!(folder.path().join("data/e-quick/summary.json").is_file());
    assert!(folder.path().join("plots/e-quick/figure3.svg").is_file());
    assert!(!folder.path().join("data/e").exists());
    // Without the section there is no quick form, but the full one.
    let full = GOOD.split("[quick]").next().unwrap();
    let folder = with_experiment(full);
    refused(
        folder.path(),
        &["run", "e.toml", "--quick"],
        &["e.toml", "section [quick]", "figure and expect"],
    );
    validate(folder.path())
        .args(["run", "e.toml", "--dry-run"])
        .assert()
        .code(0);
}

#[test]
fn runs_are_published_one_by_one() {
    let folder = with_experiment(GOOD);
    let root = folder.path();
    for name in ["e", "f"] {
        fs::write(root.join(format!("{name}.toml")), GOOD).unwrap();
        validate(root)
            .args(["run", &format!("{name}.toml"), "--quiet", "--lines", "4096"])
            .assert()
            .code(predicate::in_iter([0, 1]));
    }
    let block = |name: &str, text: &str| {
        format!("<!-- BEGIN data/published/{name}/tables/cells.md -->\n{text}\n<!-- END -->\n")
    };
    let readme = || fs::read_to_string(root.join("README.md")).unwrap();
    let text = block("e", "old") + &block("f", "old");
    let publish = |names: &[&str]| validate(root).arg("publish").args(names).assert();

    // Not the project's folder.
    publish(&["e"])
        .code(2)
        .stderr(contains("README.md: cannot read"));
    assert!(!root.join("data/published").exists());
    fs::write(root.join("README.md"), &text).unwrap();

    // One that is not finished: none is copied.
    fs::create_dir_all(root.join("data/unfinished")).unwrap();
    for wrong in ["unfinished", "published", "../e", "", "nowhere"] {
        publish(&["e", wrong]).code(2);
        assert!(!root.join("data/published").exists() && readme() == text);
    }
    publish(&["unfinished"])
        .code(2)
        .stderr(contains("no summary.json"));
    publish(&["e"]).code(0).stderr(contains(
        "data/published/f/tables/cells.md: not published yet",
    ));
    assert!(readme().ends_with(&block("f", "old")) && !readme().starts_with(&block("e", "old")));
    // What is published replaces what was.
    let stale = [
        root.join("data/published/e/tables/stale.md"),
        root.join("plots/published/e/stale.svg"),
    ];
    for file in &stale {
        fs::write(file, "old").unwrap();
    }
    publish(&["e", "f"])
        .code(0)
        .stderr(predicate::str::is_empty());
    assert!(!readme().contains("old"));
    assert!(stale.iter().all(|file| !file.exists()));
    assert!(root.join("plots/published/f/figure3.svg").is_file());
    // The page is large, and quickly made again.
    assert!(root.join("plots/f/report.html").is_file());
    assert!(!root.join("plots/published/f/report.html").exists());
    // A benchmark has no summary.
    fs::create_dir_all(root.join("data/bench")).unwrap();
    // Each of its files is published by itself: the other one stays.
    for bench in ["count.md", "trace.md"] {
        fs::write(root.join("data/bench").join(bench), "| 1 |\n").unwrap();
        publish(&["bench"]).code(0);
        fs::remove_file(root.join("data/bench").join(bench)).unwrap();
    }
    assert!(root.join("data/published/bench/count.md").is_file());
    assert!(root.join("data/published/bench/trace.md").is_file());
    // The table of a benchmark that is no more goes.
    fs::create_dir_all(root.join("benches")).unwrap();
    fs::write(root.join("benches/count.rs"), "").unwrap();
    publish(&["bench"]).code(0);
    assert!(root.join("data/published/bench/count.md").is_file());
    assert!(!root.join("data/published/bench/trace.md").exists());
}

#[test]
fn pages_are_checked_and_renewed() {
    let folder = tempdir().unwrap();
    let root = folder.path();
    let write = |name: &str, text: &str| {
        let path = root.join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    };
    let read = |name: &str| fs::read_to_string(root.join(name)).unwrap();
    write("data/published/e/t.md", "| a | b |\n|:--|--:|\n| x | 7 |\n");
    let stale = "# d\n\nIt is <!-- = data/published/e/t.md :: x :: b -->6<!-- / -->.\n";
    let fresh = stale.replace("6", "7");
    write("docs/deep/d.md", stale);
    write("README.md", "# r\n");
    let check = || validate(root).args(["publish", "--check"]).assert();
    check()
        .code(1)
        .stdout("docs/deep/d.md: data/published/e/t.md :: x :: b: out of date; `validate publish` renews it\n");
    assert_eq!(read("docs/deep/d.md"), stale);
    validate(root).arg("publish").assert().code(0);
    assert_eq!(
        (read("docs/deep/d.md"), read("README.md")),
        (fresh, "# r\n".into())
    );
    check()
        .code(0)
        .stdout("up to date: all quotations (1 in README.md and docs/)\n");
    // What is not there to be quoted is out of date; what cannot be told is an error.
    write(
        "docs/e.md",
        "<!-- BEGIN data/published/e/none.md -->\n<!-- END -->\n",
    );
    check().code(1).stdout(contains(
        "docs/e.md: data/published/e/none.md: no such file is published",
    ));
    write(
        "docs/e.md",
        "a <!-- = data/published/e/t.md :: y :: b -->7<!-- / -->\n",
    );
    check().code(2).stderr(contains(
        "docs/e.md: data/published/e/t.md :: y :: b: 0 such cells, expected one",
    ));
}

#[test]
fn completions_are_scripts_of_each_shell() {
    let folder = tempdir().unwrap();
    for (shell, word) in [
        ("bash", "complete -F"),
        ("zsh", "#compdef validate"),
        ("fish", "complete -c validate"),
        ("powershell", "Register-ArgumentCompleter"),
        ("elvish", "edit:completion"),
    ] {
        let done = validate(folder.path())
            .args(["completions", shell])
            .assert()
            .code(0)
            .stdout(contains(word).and(contains("dry-run")));
        let script = folder.path().join(shell);
        fs::write(&script, &done.get_output().stdout).unwrap();
        // Where the shell is there, it reads the script.
        if ["bash", "zsh", "fish"].contains(&shell)
            && let Ok(read) = Process::new(shell).arg("-n").arg(&script).output()
        {
            assert!(
                read.status.success(),
                "{}",
                String::from_utf8_lossy(&read.stderr)
            );
        }
    }
    validate(folder.path())
        .args(["completions", "cmd"])
        .assert()
        .code(2)
        .stderr(contains("possible values"));
}

#[test]
fn tables_and_plots_are_redone_from_data_alone() {
    let folder = with_experiment(GOOD);
    validate(folder.path())
        .args(["run", "e.toml", "--quiet"])
        .assert()
        .code(0);
    let plots = folder.path().join("plots");
    let before = contents(&plots);
    // What holds times, as the page does, is not among these.
    let page = fs::read(plots.join("e/report.html")).unwrap();
    fs::remove_dir_all(&plots).unwrap();
    fs::remove_dir_all(folder.path().join("data/e/cells")).unwrap();
    fs::remove_dir_all(folder.path().join("data/e/tables")).unwrap();
    validate(folder.path())
        .args(["plots", "data/e"])
        .assert()
        .code(0)
        .stdout(contains("figure3.svg"));
    validate(folder.path())
        .args(["tables", "data/e"])
        .assert()
        .code(0)
        .stdout(contains("cells.tex"));
    validate(folder.path())
        .args(["report", "data/e"])
        .assert()
        .code(0)
        .stdout("plots/e/report.html\n");
    assert!(page == fs::read(plots.join("e/report.html")).unwrap());
    assert!(before == contents(&plots));
    // Elsewhere, if asked for.
    for command in ["plots", "tables", "report"] {
        validate(folder.path())
            .args([command, "data/e", "--out", "x"])
            .assert()
            .code(0);
    }
    assert!(before == contents(&folder.path().join("x/plots")));
    // From within the folder of data, and from within that of the run.
    for (within, name) in [("data", "e"), ("data/e", ".")] {
        fs::remove_file(plots.join("e/report.html")).unwrap();
        validate(&folder.path().join(within))
            .args(["report", name])
            .assert()
            .code(0);
        assert!(page == fs::read(plots.join("e/report.html")).unwrap());
    }
    // A page links no figure that is not beside it.
    validate(folder.path())
        .args(["report", "data/e", "--out", "y"])
        .assert()
        .code(0);
    let alone = fs::read_to_string(folder.path().join("y/plots/e/report.html")).unwrap();
    assert!(!alone.contains(".svg\""));
    assert!(folder.path().join("x/data/e/tables/cells.md").is_file());
}

#[test]
fn a_missed_expectation_writes_everything_and_exits_with_1() {
    let folder = with_experiment(&GOOD.replace("slope_within = 0.1", "slope_within = 0.0001"));
    validate(folder.path())
        .args(["run", "e.toml"])
        .assert()
        .code(1)
        .stdout(contains("MISSED  slope-within"));
    assert!(folder.path().join("plots/e/figure3.png").is_file());
}

#[test]
fn json_is_all_that_stdout_holds() {
    let folder = with_experiment(GOOD);
    let output = validate(folder.path())
        .args(["run", "e.toml", "--json", "--quick"])
        .output()
        .unwrap();
    let summary: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(summary["quick"], true);
    assert_eq!(summary["experiment"], "e-quick");
    // Several summaries are one array.
    fs::write(folder.path().join("f.toml"), GOOD).unwrap();
    let output = validate(folder.path())
        .args(["run", "e.toml", "f.toml", "--json", "--quick"])
        .output()
        .unwrap();
    let summaries: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let names = [0, 1].map(|i| summaries[i]["experiment"].as_str().unwrap());
    assert_eq!(names, ["e-quick", "f-quick"]);
}

#[test]
fn a_dry_run_writes_nothing() {
    let folder = with_experiment(GOOD);
    validate(folder.path())
        .args(["run", "e.toml", "--dry-run"])
        .assert()
        .code(0)
        .stdout(
            contains("simple:uniform:200")
                .and(contains("spatial-median"))
                .and(contains(
                    "in all: 2 pieces, at least 0.13 million lines and rays, about ",
                ))
                .and(contains(" MB on disk\n")),
        );
    validate(folder.path())
        .args([
            "run",
            "e.toml",
            "--dry-run",
            "--seed",
            "1e3",
            "--lines",
            "2^11",
        ])
        .assert()
        .code(0)
        .stdout(contains("seed 1000").and(contains("at least 2048 lines")));
    assert!(!folder.path().join("data").exists());
}

#[test]
fn one_scene_says_which_strategy_to_take() {
    let folder = tempdir().unwrap();
    fs::write(
        folder.path().join("two.obj"),
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 9\nf 1 2 3\nf 2 3 4\n",
    )
    .unwrap();
    validate(folder.path())
        .args(["scene", "two.obj", "--lines", "2^14"])
        .assert()
        .code(predicate::in_iter([0, 1]))
        .stdout(contains("two.obj: 2 objects").and(contains("sah-between-medians")));
    assert!(
        folder
            .path()
            .join("plots/scene-two-obj/figure3.svg")
            .is_file()
    );
    // A single object is a tree of one leaf: defined, nothing to fit.
    fs::write(
        folder.path().join("one.obj"),
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
    )
    .unwrap();
    validate(folder.path())
        .args(["scene", "one.obj", "--lines", "2^14"])
        .assert()
        .code(0)
        .stdout(contains("Every strategy gives a tree of the same cost"));
    let cells = fs::read_to_string(folder.path().join("data/scene-one-obj/cells.csv")).unwrap();
    assert!(!cells.contains("NaN") && !cells.contains("inf"));
}

#[test]
fn lists_and_help() {
    let folder = tempdir().unwrap();
    let list = |what: &str| {
        validate(folder.path())
            .args(["list", what])
            .assert()
            .code(0)
    };
    list("scenes").stdout(contains("simple:greedy").and(contains("spd:balls")));
    list("strategies").stdout(contains("median-midpoint-longest"));
    list("samplers").stdout(contains("axes-only"));
    list("rays").stdout(contains("beam").and(contains("secondary")));
    list("experiments").stdout(contains("experiments/figure3.toml"));
    validate(folder.path())
        .arg("list")
        .assert()
        .code(0)
        .stdout(contains("strategies\n"));
    for command in [
        &["--help"][..],
        &["run", "--help"],
        &["scene", "--help"],
        &["trace", "--help"],
        &["publish", "--help"],
    ] {
        validate(folder.path())
            .args(command)
            .assert()
            .code(0)
            .stdout(contains("--threads"));
    }
    validate(folder.path()).arg("--version").assert().code(0);
}

#[test]
fn a_closed_pipe_is_no_panic() {
    let folder = tempdir().unwrap();
    let mut child = Process::new(assert_cmd::cargo::cargo_bin("validate"))
        .arg("list")
        .current_dir(folder.path())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let mut complaints = String::new();
    child
        .stderr
        .take()
        .unwrap()
        .read_to_string(&mut complaints)
        .unwrap();
    assert!(child.wait().unwrap().success());
    assert_eq!(complaints, "");
}

/// Bad input: exit code 2, one message with place, fault and remedy, and nothing written.
fn refused(folder: &Path, args: &[&str], parts: &[&str]) {
    let output = validate(folder).args(args).output().unwrap();
    let message = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{args:?}: {message}");
    assert!(output.stdout.is_empty());
    for part in parts {
        assert!(message.contains(part), "'{part}' is not in: {message}");
    }
    assert!(
        !folder.join("data").exists() && !folder.join("plots").exists(),
        "half-written output"
    );
}

#[test]
fn bad_experiments_are_refused() {
    let cases: [(&str, &str, &[&str]); 21] = [
        (
            "kind = \"hits-vs-area\"",
            "kind = \"hits\"",
            &["e.toml:1:8", "'hits'", "hits-vs-area"],
        ),
        (
            "seed = 5",
            "seed = 5\nsed = 6",
            &["e.toml:4:1", "unknown field `sed`", "expected"],
        ),
        (
            "seed = 5",
            "seed = \"five\"",
            &["e.toml:3:8", "invalid type", "u64"],
        ),
        ("seed = 5\n", "", &["e.toml", "missing field `seed`"]),
        (
            "\"sah\", \"spatial",
            "\"sahh\", \"spatial",
            &["e.toml:5", "'sahh'", "sah-between-medians"],
        ),
        (
            "objects:2:10",
            "objects:0",
            &["e.toml:6", "'objects:0'", "objects:N[:D]"],
        ),
        (
            "[\"simple:uniform:200\"]",
            "[]",
            &["e.toml:4:1", "scenes", "at least one"],
        ),
        (
            "[\"sah\", \"spatial-median\"]",
            "[\"sah\", \"sah\"]",
            &["e.toml:5:1", "'sah' is named twice"],
        ),
        (
            "[\"simple:uniform:200\"]",
            "[\"simple:uniform:200\", \"simple:uniform:2000\", \"simple:uniform\"]",
            &["e.toml", "'simple:uniform:2000' is named twice"],
        ),
        (
            "c_t = 20.0",
            "c_t = -1.0",
            &["e.toml:8:1", "c_t = -1", "none negative"],
        ),
        (
            "c_t = 20.0",
            "c_t = 1e101",
            &["e.toml:8:1", "c_t = 1", "at most 1e100"],
        ),
        (
            "family = 0.01",
            "family = 0.0",
            &["e.toml:11:32", "expect.family = 0,", "1e-12"],
        ),
        (
            "family = 0.01",
            "family = 1.0",
            &["e.toml:11:32", "expect.family = 1,"],
        ),
        (
            "slope_within = 0.1",
            "slope_within = 0.0",
            &["e.toml:11:12", "expect.slope_within = 0,"],
        ),
        (
            "\"Does it work?\"",
            "\" \"",
            &["e.toml:2:1", "question is empty"],
        ),
        (
            "\"objects:2:10\"",
            "\"depth:23\"",
            &["e.toml:6", "'depth:23'", "at most 22", "2^23 nodes"],
        ),
        (
            "min = 65536, max = 65536",
            "min = 65536, max = 5",
            &["e.toml:9:43", "lines.max = 5", "lines.min = 65536"],
        ),
        (
            "min = 65536, max",
            "min = 5, max",
            &["e.toml:9:30", "5 lines", "at least 1024"],
        ),
        (
            "gate = 0.001 }\n\n[quick]",
            "gate = 2.0 }\n\n[quick]",
            &["e.toml:11:47", "expect.gate = 2", "0 to 1"],
        ),
        (
            "strategy = \"sah\" }\nexpect = { slope_within = 0.1",
            "strategy = \"sah-cyclic\" }\nexpect = { slope_within = 0.1",
            &["e.toml:10:1", "figure", "not among"],
        ),
        (
            "question = \"Does it work?\"",
            "question = \"Does it work?",
            &["e.toml:2:"],
        ),
    ];
    for (old, new, parts) in cases {
        assert!(GOOD.contains(old), "{old}");
        let folder = with_experiment(&GOOD.replacen(old, new, 1));
        refused(folder.path(), &["run", "e.toml"], parts);
    }
    // The quick form's values stand in its own section.
    let folder = with_experiment(&GOOD.replace("slope_within = 0.2", "slope_within = -1.0"));
    refused(
        folder.path(),
        &["run", "e.toml", "--quick"],
        &["e.toml:17:12", "expect.slope_within = -1,"],
    );
    for name in ["published", "Bench", "reference", "a b", ".x", "a,b"] {
        let folder = tempdir().unwrap();
        let file = format!("{name}.toml");
        fs::write(folder.path().join(&file), GOOD).unwrap();
        refused(folder.path(), &["run", &file], &[&file, "cannot name"]);
    }
}

#[test]
fn bad_scenes_are_refused() {
    let with_scene = |scene: &str| with_experiment(&GOOD.replace("simple:uniform:200", scene));
    let cases: [(&str, &[&str]); 6] = [
        ("simple:unifrom", &["simple:unifrom", "simple:uniform"]),
        ("spd:balls:0", &["spd:balls:0", "sizes"]),
        ("spd:balls:many", &["spd:balls:many"]),
        ("nowhere.obj", &["nowhere.obj", "cannot read"]),
        ("model.xyz", &["model.xyz", ".obj"]),
        ("bad.obj", &["bad.obj:3", "vertex"]),
    ];
    for (scene, parts) in cases {
        let folder = with_scene(scene);
        fs::write(folder.path().join("bad.obj"), "v 0 0 0\nv 1 0 0\nf 1 2 3\n").unwrap();
        refused(folder.path(), &["run", "e.toml"], parts);
        refused(folder.path(), &["scene", scene], parts);
    }
    // A mesh that has not been fetched: the message first, then what to do.
    let folder = with_scene("models/none.ply");
    refused(
        folder.path(),
        &["run", "e.toml"],
        &[
            "error: e.toml: models/none.ply: cannot read the file: ",
            "; experiments/fetch-meshes.sh fetches",
        ],
    );
    // An empty scene.
    let folder = tempdir().unwrap();
    fs::write(folder.path().join("empty.obj"), "v 0 0 0\n").unwrap();
    refused(
        folder.path(),
        &["scene", "empty.obj"],
        &["empty.obj", "empty", "at least one"],
    );
    fs::write(folder.path().join("strange.obj"), "v 0 0 0\nfoo 1\nfoo 2\n").unwrap();
    refused(
        folder.path(),
        &["scene", "strange.obj"],
        &[
            "empty",
            "2 lines with the unknown keyword 'foo' passed over",
        ],
    );
}

#[test]
fn bad_arguments_are_refused() {
    let folder = with_experiment(GOOD);
    for (command, flag) in [
        (&["plots", "data/e", "--seed=3"][..], "--seed"),
        (&["tables", "data/e", "--quick"], "--quick"),
        (&["report", "data/e", "--dry-run"], "--dry-run"),
        (&["list", "--json"], "--json"),
        (&["verify", "a.tar.gz", "--out=x"], "--out"),
        (&["verify", "a.tar.gz", "--replay", "--error=1%"], "--error"),
        (&["archive", "data/e", "--lines=9"], "--lines"),
        (&["publish", "--force"], "--force"),
    ] {
        let told = format!(
            "leave {flag} away: it means nothing to `validate {}",
            command[0]
        );
        refused(folder.path(), command, &[&told]);
    }
    // An experiment that comes with the program needs no file.
    validate(folder.path())
        .args(["run", "experiments/traversal.toml", "--quick", "--dry-run"])
        .assert()
        .code(0)
        .stdout(contains("in all: "));
    refused(
        folder.path(),
        &["run", "none.toml"],
        &["none.toml", "cannot read"],
    );
    refused(folder.path(), &["run"], &["EXPERIMENT.toml"]);
    refused(
        folder.path(),
        &["run", "e.toml", "--lines", "many"],
        &["--lines", "2^20"],
    );
    for option in ["--seed", "--lines"] {
        for wrong in ["-1", "-1e3", "1.5"] {
            refused(
                folder.path(),
                &["run", "e.toml", option, wrong],
                &[option, wrong, "expected a whole number"],
            );
        }
    }
    refused(
        folder.path(),
        &["run", "e.toml", "--threads", "-1"],
        &["--threads", "-1", "1..=1024"],
    );
    refused(
        folder.path(),
        &["run", "e.toml", "--lines", "10"],
        &["--lines 10:", "10 lines", "at least 1024"],
    );
    refused(
        folder.path(),
        &["run", "e.toml", "--threads", "0"],
        &["--threads"],
    );
    refused(
        folder.path(),
        &["run", "e.toml", "--sed", "3"],
        &["--sed", "--seed"],
    );
    refused(folder.path(), &["rum"], &["rum", "run"]);
    refused(
        folder.path(),
        &["run", "e.toml", "./e.toml"],
        &["named 'e'", "--out"],
    );
    refused(
        folder.path(),
        &["plots", "nowhere"],
        &["nowhere", "summary.json", "such as data/validate"],
    );
    refused(
        folder.path(),
        &["publish", "nowhere"],
        &["nowhere", "run it first"],
    );
    refused(
        folder.path(),
        &["scene", "simple:uniform", "--stop", "never"],
        &["never", "cost-gain"],
    );
}

#[test]
fn unwritable_output_is_refused() {
    let folder = with_experiment(GOOD);
    fs::write(folder.path().join("file"), "").unwrap();
    let output = validate(folder.path())
        .args(["run", "e.toml", "--out", "file"])
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2));
    let message = String::from_utf8(output.stderr).unwrap();
    assert!(message.contains("cannot write"), "{message}");
    // Found before anything is counted, for the figures too.
    fs::write(folder.path().join("plots"), "").unwrap();
    validate(folder.path())
        .args(["run", "e.toml"])
        .assert()
        .code(2)
        .stderr(contains("plots/e: cannot write").and(contains("counting").not()));
}

/// `scene --nff` writes a file that can be read again, and says why where it cannot.
#[test]
fn scenes_with_a_look_are_written_as_nff() {
    let folder = tempdir().unwrap();
    let here = folder.path();
    let view = "v from 1 2 3 at 0 0 0 up 0 0 1 angle 45 hither 0 resolution 8 8";
    let text = format!("b 0 0 .1\n{view}\ns 0 0 0 .3333333333333333\n");
    fs::write(here.join("a.nff"), text).unwrap();
    let written = |arguments: &[&str]| {
        let mut command = validate(here);
        command.args(["scene", "a.nff", "--nff", "sub/b.nff"]);
        command.args(arguments).assert()
    };
    let last = || {
        let text = fs::read_to_string(here.join("sub/b.nff")).unwrap();
        text.lines().last().unwrap().to_owned()
    };
    written(&["--dry-run"]).success();
    assert!(!here.join("sub").exists());
    written(&[])
        .success()
        .stdout("sub/b.nff: 1 sphere, 17 significant digits\n")
        .stderr(contains("they are white"));
    assert_eq!(last(), "s 0 0 0 0.33333333333333331");
    written(&["--digits", "6", "--quiet"]).success().stderr("");
    assert_eq!(last(), "s 0 0 0 0.333333");
    written(&["--digits", "18"])
        .code(2)
        .stderr(contains("1..=17"));
    assert!(!here.join("data").exists());

    let mut bare = validate(here);
    bare.args(["scene", "simple:flat:5", "--nff", "c.nff"])
        .assert()
        .code(2)
        .stderr(contains("has no camera, lights and materials"));
    validate(here)
        .args(["scene", "a.nff", "--digits", "6"])
        .assert()
        .code(2);
    assert!(!here.join("c.nff").exists());
}
