//! Runs repeated from an archive.

use super::sealed::{change, reseal};
use super::*;

#[test]
fn replay_gives_the_same_data() {
    let (folder, file) = archive();
    let temporary = folder.path().join("tmp");
    fs::create_dir(&temporary).unwrap();
    let data = unpack(&file);
    let data = data
        .keys()
        .filter(|path| {
            ["data/", "plots/"]
                .iter()
                .any(|part| path.starts_with(&format!("e-e-quick/data/{part}")))
        })
        .filter(|path| !holds_times(path));
    // And CLAIMS.md, and two experiments with their defaults written out.
    let told = format!(
        "replayed: all {} files of data, figures and claims equal to the byte; times are only shown\n",
        data.count() + 3
    );
    for threads in ["1", "2"] {
        validate(folder.path())
            .args(["verify", "a.tar.gz", "--replay", "--threads", threads])
            .env("TMPDIR", &temporary)
            .assert()
            .code(0)
            .stdout(
                contains(&told)
                    .and(contains("\ne: "))
                    .and(contains("\ne-quick: "))
                    .and(contains(" s archived, ").count(2)),
            )
            .stderr("counting lines through 2 cells\ncounting lines through 1 cell\n");
        assert!(fs::read_dir(&temporary).unwrap().next().is_none());
    }
    // Kept where asked for, and never mixed with what is there.
    verify(&file, &["--replay", "--quiet", "--out", "again"])
        .code(0)
        .stderr("");
    assert!(
        folder
            .path()
            .join("again/data/e-quick/summary.json")
            .is_file()
    );
    verify(&file, &["--replay", "--out", "again"])
        .code(2)
        .stderr(contains("again: not empty"));
    for option in [&["--seed", "3"][..], &["--lines", "4096"], &["--quick"]] {
        verify(&file, option)
            .code(2)
            .stderr(contains(format!("leave {} away", option[0])));
    }
    verify(&file, &["--replay", "--dry-run", "--out", "none"])
        .code(0)
        .stdout(contains("simple:uniform:50"));
    assert!(!folder.path().join("none").exists());
}

#[test]
fn replay_finds_forged_data() {
    let (folder, file) = archive();
    let files = unpack(&file);
    let replay = |mut files: BTreeMap<String, Vec<u8>>| {
        reseal(&mut files);
        fs::write(&file, repack(&files)).unwrap();
        verify(&file, &[]).code(0);
        verify(&file, &["--replay", "--quiet"])
    };
    // One count of one node.
    let mut forged = files.clone();
    change(&mut forged, "data/data/e/nodes.csv", |text| {
        let mut lines: Vec<_> = text.lines().map(str::to_string).collect();
        let fields: Vec<_> = lines[1].split(',').collect();
        let hits: u64 = fields[8].parse().unwrap();
        assert_eq!(lines[0].split(',').nth(8), Some("hits"));
        let mut fields: Vec<_> = fields.into_iter().map(str::to_string).collect();
        fields[8] = (hits + 1).to_string();
        lines[1] = fields.join(",");
        lines.join("\n") + "\n"
    });
    let output = replay(forged).code(1).get_output().stdout.clone();
    let output = String::from_utf8(output).unwrap();
    assert!(
        output.contains("\ndata/e/nodes.csv: differs, first in line 2: \"")
            && output.contains("repeated\nreplayed: 1 of "),
        "{output}"
    );
    // What differs is kept, to be looked at.
    let kept = output.trim_end().rsplit(" are in ").next().unwrap();
    assert!(Path::new(kept).join("data/e/nodes.csv").is_file());
    fs::remove_dir_all(kept).unwrap();

    // Times may differ; so may what no run writes.
    let mut forged = files.clone();
    change(&mut forged, "data/data/e/timings.csv", |text| {
        text.replace("sah,", "sah,9")
    });
    replay(forged).code(0);
    // The options under which it ran; a file that the run does not write, and one that it does.
    let mut forged = files.clone();
    for path in ["experiments/e-quick.toml", "data/e-quick/experiment.toml"] {
        change(&mut forged, &format!("data/{path}"), |text| {
            text.replace("lines = 5000", "lines = 5001")
        });
    }
    let assert = replay(forged).code(1).stdout(
        contains("data/e-quick/cells.csv: differs, first in line 2").and(contains("data/e/").not()),
    );
    remove_kept(&assert);
    let mut forged = files.clone();
    change(&mut forged, "data/data/e-quick/experiment.toml", |text| {
        text.replace("it |", "this |")
    });
    let cells = forged.remove("e-e-quick/data/data/e/cells.csv").unwrap();
    forged.insert("e-e-quick/data/data/e/cellz.csv".into(), cells);
    let assert = replay(forged).code(1).stdout(
        contains("data/e-quick/experiment.toml: differs from the experiment's text\n")
            .and(contains(
                "data/e/cellz.csv: not written by the repeated run\n",
            ))
            .and(contains(
                "data/e/cells.csv: written by the repeated run only\n",
            )),
    );
    remove_kept(&assert);

    // Another program may repeat it, and says so.
    let mut older = files.clone();
    for path in ["experiments/e.toml", "data/e/experiment.toml"] {
        change(&mut older, &format!("data/{path}"), |text| {
            text.replace(sahlab::REVISION, "0123456789ab")
        });
    }
    reseal(&mut older);
    fs::write(&file, repack(&older)).unwrap();
    verify(&file, &["--replay"]).code(0).stderr(contains(
        "note: e: made by revision 0123456789ab of the program, repeated by",
    ));

    // What it shows and tells of the data, though the data are as they were.
    for (path, old, new) in [
        ("plots/e/slopes.svg", "<circle", "<square"),
        ("CLAIMS.md", "| yes |", "| no |"),
        ("resolved/e.toml", "seed = 5", "seed = 6"),
    ] {
        let mut forged = files.clone();
        change(&mut forged, &format!("data/{path}"), |text| {
            text.replacen(old, new, 1)
        });
        let told = format!("\n{path}: differs, first in line ");
        let assert = replay(forged).code(1);
        remove_kept(&assert.stdout(contains(told).and(contains("replayed: 1 of "))));
    }
    let mut forged = files.clone();
    let picture = forged.get_mut("e-e-quick/data/plots/e/slopes.png").unwrap();
    *picture.last_mut().unwrap() ^= 1;
    let assert = replay(forged)
        .code(1)
        .stdout(contains("plots/e/slopes.png: differs, first in line "));
    remove_kept(&assert);
    let mut forged = files.clone();
    forged.remove("e-e-quick/data/CLAIMS.md");
    let assert = replay(forged)
        .code(1)
        .stdout(contains("CLAIMS.md: written by the repeated run only\n"));
    remove_kept(&assert);
    // Another mesh is refused, before anything is counted.
    fs::write(folder.path().join("m.obj"), MESH.replace("0 0 1", "0 0 2")).unwrap();
    verify(&file, &["--replay"]).code(2).stderr(
        contains("m.obj: its objects and look have the digest").and(contains("counting").not()),
    );
    fs::remove_file(folder.path().join("m.obj")).unwrap();
    verify(&file, &["--replay"])
        .code(2)
        .stderr(contains("m.obj: cannot read"));
}

#[test]
fn figures_may_differ_in_their_last_digits_counts_may_not() {
    let (_folder, file) = archive();
    let files = unpack(&file);
    // The first figure with many digits in the first row, and another that is so much larger.
    let forged = |factor: f64| {
        let mut forged = files.clone();
        change(&mut forged, "data/data/e/cells.csv", |text| {
            let row = text.lines().nth(1).unwrap();
            let figure = row
                .split(',')
                .find(|field| field.contains('.') && field.len() > 15);
            let figure = figure.unwrap();
            let other = figure.parse::<f64>().unwrap() * factor;
            text.replacen(figure, &other.to_string(), 1)
        });
        reseal(&mut forged);
        fs::write(&file, repack(&forged)).unwrap();
        verify(&file, &["--replay", "--quiet"])
    };
    forged(1.0 + 4e-12).code(0).stdout(
        contains("\ndata/e/cells.csv: equal within 1e-9\nreplayed: all ")
            .and(contains(" to the byte, 1 within 1e-9 (relative, counts")),
    );
    let assert = forged(1.0 + 4e-9)
        .code(1)
        .stdout(contains("data/e/cells.csv: differs, first in line 2: \""));
    remove_kept(&assert);
}

fn remove_kept(assert: &Assert) {
    let output = String::from_utf8(assert.get_output().stdout.clone()).unwrap();
    let kept = output.trim_end().rsplit(" are in ").next().unwrap();
    fs::remove_dir_all(kept).unwrap();
}

#[test]
fn experiments_that_no_run_kept_are_not_replayed() {
    let (_folder, file) = archive();
    let files = unpack(&file);
    for (other, part) in [
        (EXPERIMENT, "not the text that was kept with the run 'e'"),
        ("kind = 3", "a.tar.gz:experiments/e.toml:1:8:"),
    ] {
        let mut forged = files.clone();
        change(&mut forged, "data/experiments/e.toml", |_| other.into());
        reseal(&mut forged);
        fs::write(&file, repack(&forged)).unwrap();
        verify(&file, &["--replay"]).code(2).stderr(contains(part));
    }
    let mut forged = files.clone();
    change(&mut forged, "data/experiments/e.toml", |text| {
        text.replace("experiment = \"e\"", "experiment = \"../e\"")
    });
    reseal(&mut forged);
    fs::write(&file, repack(&forged)).unwrap();
    verify(&file, &["--replay"])
        .code(2)
        .stderr(contains("'../e' cannot name"));
}
