//! What is packed, and how.

use sahlab::study::Plan;
use sahlab::study::plan::Overrides;

use super::*;

#[test]
fn the_same_runs_give_the_same_bytes() {
    let (_folder, file) = archive();
    let first = fs::read(&file).unwrap();
    // From elsewhere, in another order, to where it goes by itself, over what is there.
    let elsewhere = tempdir().unwrap();
    for _ in 0..2 {
        validate(elsewhere.path())
            .args(["archive", "--threads", "3"])
            .args(["data/e-quick", "data/e/../e"].map(|data| runs().join(data)))
            .assert()
            .code(0)
            .stdout("./archives/e-e-quick.tar.gz\n");
        let again = fs::read(elsewhere.path().join("archives/e-e-quick.tar.gz")).unwrap();
        assert!(first == again);
    }
    assert_eq!(files_below(elsewhere.path()).len(), 1);
    // No time, no system, sorted, plain files of nobody.
    assert_eq!(first[..10], [0x1f, 0x8b, 8, 0, 0, 0, 0, 0, 0, 255]);
    let mut archive = tar::Archive::new(GzDecoder::new(&first[..]));
    let mut paths = Vec::new();
    for entry in archive.entries().unwrap() {
        let entry = entry.unwrap();
        let h = entry.header();
        assert_eq!(h.entry_type(), EntryType::Regular);
        assert_eq!((h.mode().unwrap(), h.mtime().unwrap()), (0o644, 0));
        assert_eq!((h.uid().unwrap(), h.gid().unwrap()), (0, 0));
        assert_eq!((h.username(), h.groupname()), (Ok(Some("")), Ok(Some(""))));
        assert!(h.as_ustar().is_some());
        paths.push(entry.path().unwrap().to_str().unwrap().to_string());
    }
    // What checks the others comes first.
    let below = |path: &String| path.split_once('/').unwrap().1.to_string();
    let first: Vec<_> = paths[..4].iter().map(below).collect();
    assert_eq!(
        first,
        [
            "bagit.txt",
            "bag-info.txt",
            "manifest-sha256.txt",
            "tagmanifest-sha256.txt"
        ]
    );
    assert!(paths[4..].is_sorted());
    assert!(
        paths
            .iter()
            .all(|p| !p.contains("/cells/") && p.starts_with("e-e-quick/"))
    );
    for path in [
        "Cargo.lock",
        "README.md",
        "CLAIMS.md",
        "CITATION.cff",
        "LICENSE-MIT",
        "LICENSE-APACHE",
        "environment.json",
        "replay.json",
        "ro-crate-metadata.json",
        "experiments/e.toml",
        "experiments/e-quick.toml",
        "resolved/e.toml",
        "resolved/e-quick.toml",
        "data/e/experiment.toml",
        "data/e/nodes.csv",
        "data/e/timings.csv",
        "data/e/times-run.json",
        "data/e-quick/tables/cells.md",
        "plots/e-quick/figure3.png",
        "plots/e-quick/report.html",
    ] {
        assert!(paths.contains(&format!("e-e-quick/data/{path}")), "{path}");
    }

    // Another time, if asked for; nonsense is refused.
    let dated = |seconds: &str| {
        validate(runs())
            .env("SOURCE_DATE_EPOCH", seconds)
            .args(["archive", "data/e", "-o"])
            .arg(elsewhere.path().join("dated.tar.gz"))
            .assert()
    };
    dated("1700000000").code(0);
    let bytes = fs::read(elsewhere.path().join("dated.tar.gz")).unwrap();
    assert_eq!(bytes[4..8], 1_700_000_000_u32.to_le_bytes());
    let files = unpack(&elsewhere.path().join("dated.tar.gz"));
    let text = |path: &str| String::from_utf8(files[path].clone()).unwrap();
    assert!(text("e/bag-info.txt").contains("\nBagging-Date: 2023-11-14\n"));
    assert!(text("e/data/ro-crate-metadata.json").contains("\"datePublished\": \"2023-11-14\""));
    validate(elsewhere.path())
        .args(["verify", "dated.tar.gz"])
        .assert()
        .code(0);
    dated("yesterday")
        .code(2)
        .stderr(contains("SOURCE_DATE_EPOCH is 'yesterday'"));
}

#[test]
fn what_made_it_and_what_to_do_with_it_is_told() {
    let (folder, file) = archive();
    let files = unpack(&file);
    let text =
        |path: &str| String::from_utf8(files[&format!("e-e-quick/data/{path}")].clone()).unwrap();
    let environment: serde_json::Value = serde_json::from_str(&text("environment.json")).unwrap();
    let measured = &environment["measured"]["e-quick"][0];
    for machine in [&environment["packed"], measured] {
        assert_eq!(machine["revision"], sahlab::REVISION);
        assert!(machine["rustc"].as_str().unwrap().starts_with("rustc 1."));
        assert!(machine["target"].as_str().unwrap().contains('-'));
    }
    assert!(measured["seconds"].as_f64().unwrap() > 0.0);
    let told = files.keys().filter(|path| !path.contains("/data/data/"));
    let told = told.filter(|path| !path.contains("/plots/"));
    for path in told.map(|path| path.strip_prefix("e-e-quick/data/")) {
        let Some(path) = path else { continue };
        let host = fs::read_to_string("/etc/hostname").unwrap_or_default();
        let names = [
            runs().to_str().unwrap(),
            folder.path().to_str().unwrap(),
            host.trim(),
        ];
        assert!(
            names
                .iter()
                .all(|name| name.is_empty() || !text(path).contains(name)),
            "{path}"
        );
    }
    let readme = text("README.md");
    for part in [
        "sha256sum -c manifest-sha256.txt",
        "validate verify e-e-quick.tar.gz --replay",
        "validate run experiments/e-quick.toml --out again",
        "`validate run e.toml --quick --seed 7 --lines 5000`",
        "Does it \\| work?",
        "| `m.obj` | `",
        "sahlab 0.1.0, revision ",
    ] {
        assert!(readme.contains(part), "{part}");
    }
    assert!(!readme.contains("| `simple:"));
    assert_eq!(text("Cargo.lock"), include_str!("../../Cargo.lock"));
    // The experiment's own text comes first, word for word.
    let experiment = text("experiments/e.toml");
    assert!(experiment.starts_with(EXPERIMENT) && experiment.contains("\n[run]\n"));
    assert_eq!(experiment, text("data/e/experiment.toml"));
    // Written out whole it asks for the same.
    for run in ["e", "e-quick"] {
        let plan = |path: &str| {
            let path = format!("{path}/{run}.toml");
            let plan = Plan::parse(&text(&path), &path, run, Overrides::default());
            let plan = plan.unwrap();
            (plan.seed, plan.scenes, plan.cost, plan.kind)
        };
        assert_eq!(plan("experiments"), plan("resolved"));
        assert!(!text(&format!("resolved/{run}.toml")).contains("[quick]"));
    }
    // A row a verdict.
    let claims = text("CLAIMS.md");
    let summary: serde_json::Value = serde_json::from_str(&text("data/e/summary.json")).unwrap();
    let verdicts = summary["verdicts"].as_array().unwrap();
    let rows = claims.lines().filter(|line| line.starts_with("| e | "));
    assert_eq!(rows.count(), verdicts.len());
    assert!(claims.contains(
        "| `validate run experiments/e-quick.toml --out again` | `data/e-quick/summary.json` |"
    ));
}

#[test]
fn an_archive_of_other_runs_stays() {
    let folder = tempdir().unwrap();
    let here = folder.path().join("a.tar.gz");
    let pack = |run: &str, more: &[&str]| {
        let mut command = validate(folder.path());
        command.arg("archive").arg(runs().join("data").join(run));
        command.args(["--out", "a.tar.gz"]).args(more).assert()
    };
    pack("e", &[]).code(0);
    let first = fs::read(&here).unwrap();
    pack("e-quick", &[])
        .code(2)
        .stderr(contains("a.tar.gz: there is an archive of e; --force"));
    assert!(first == fs::read(&here).unwrap());
    pack("e", &[]).code(0);
    assert!(first == fs::read(&here).unwrap());
    pack("e-quick", &["--force"]).code(0);
    assert!(first != fs::read(&here).unwrap());
    fs::write(&here, "mine").unwrap();
    pack("e", &[])
        .code(2)
        .stderr(contains("no archive of runs"));
    assert_eq!(fs::read(&here).unwrap(), b"mine");
}

#[test]
fn what_cannot_be_repeated_is_not_archived() {
    let folder = tempdir().unwrap();
    let root = folder.path();
    fs::write(root.join("e.toml"), EXPERIMENT).unwrap();
    fs::write(root.join("m.obj"), MESH).unwrap();
    validate(root)
        .args(["run", "e.toml", "--quiet"])
        .assert()
        .code(predicate::in_iter([0, 1]));
    let archive = |data: &[&str], part: &str| {
        validate(root)
            .arg("archive")
            .args(data)
            .assert()
            .code(2)
            .stderr(contains(part));
        assert!(!root.join("archives").exists());
    };
    archive(&["nowhere"], "nowhere: cannot read");
    archive(&["data/e", "data/../data/e"], "packed twice");
    archive(
        &["data"],
        "not below a folder `data`, so none of figures belongs to it",
    );
    let link = root.join("data/e/link");
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("/etc/passwd", &link).unwrap();
        archive(&["data/e"], "links are not packed");
        fs::remove_file(&link).unwrap();
    }
    let kept = root.join("data/e/experiment.toml");
    let text = fs::read_to_string(&kept).unwrap();
    fs::write(&kept, text.replace(sahlab::REVISION, "0123456789ab")).unwrap();
    archive(
        &["data/e"],
        "made by revision 0123456789ab of the program, this is ",
    );
    fs::write(
        &kept,
        text.replace("experiment = \"e\"", "experiment = \"f\""),
    )
    .unwrap();
    archive(&["data/e"], "this run is named 'f'");
    fs::remove_file(&kept).unwrap();
    archive(&["data/e"], "no experiment.toml; what `validate scene`");
    fs::write(&kept, &text).unwrap();
    let times = root.join("data/e/times-run.json");
    let told = fs::read(&times).unwrap();
    fs::remove_file(&times).unwrap();
    archive(&["data/e"], "no times-run.json; run it again");
    fs::write(&times, "{}").unwrap();
    archive(
        &["data/e"],
        "times-run.json: not as this program writes it: ",
    );
    fs::write(&times, told).unwrap();
    let odd = root.join("data/e/50%.csv");
    fs::write(&odd, "").unwrap();
    archive(&["data/e"], "must be one on every system");
    fs::remove_file(&odd).unwrap();
    let other = root.join("data/e/Cells.csv");
    if !other.exists() {
        fs::write(&other, "").unwrap();
        archive(&["data/e"], "cannot be unpacked side by side");
        fs::remove_file(&other).unwrap();
    }
    let mark = root.join("data/e/UNFINISHED");
    fs::write(&mark, "").unwrap();
    archive(
        &["data/e"],
        "data/e: a run is writing here, or was stopped before its end; run it again",
    );
    fs::remove_file(&mark).unwrap();
    for inside in ["data/e", "plots/e", "data/e/tables/e.tar.gz", "plots/e/new"] {
        validate(root)
            .args(["archive", "data/e", "--out", inside])
            .assert()
            .code(2)
            .stderr(contains("in the folder of the run itself"));
    }
    let long = root.join("data/e").join("x".repeat(101));
    fs::write(&long, "").unwrap();
    archive(&["data/e"], "its path is too long");
    fs::remove_file(&long).unwrap();
    validate(root)
        .args(["archive", "data/e", "--dry-run"])
        .assert()
        .code(0)
        .stdout(contains("  e/data/data/e/cells.csv\n"));
    assert!(!root.join("archives").exists());
    fs::remove_dir_all(root.join("plots/e")).unwrap();
    archive(&["data/e"], "`validate plots` draws");

    // A kept text gives its run again; options of the command line go before its own.
    let run = |more: &[&str]| {
        validate(root)
            .args(["run", "data/e/experiment.toml", "--quiet", "--out", "x"])
            .args(more)
            .assert()
            .code(predicate::in_iter([0, 1]));
        fs::read_to_string(root.join("x/data/e/cells.csv")).unwrap()
    };
    let first = fs::read_to_string(root.join("data/e/cells.csv")).unwrap();
    assert_eq!(run(&[]), first);
    assert_ne!(run(&["--seed", "8"]), first);
}

#[test]
fn the_default_study_ends_with_its_archive() {
    let folder = tempdir().unwrap();
    let study = validate(folder.path())
        .args(["--quick", "--quiet", "--lines", "2048"])
        .assert()
        .code(predicate::in_iter([0, 1]))
        .stdout(predicate::str::ends_with(
            "archive ./archives/validate-quick.tar.gz\n",
        ));
    // Before that, all of it once more on a screen: each part and each expectation, as in the pages.
    let output = String::from_utf8_lossy(&study.get_output().stdout).into_owned();
    let (_, short) = output.split_once("\n7 experiments: ").unwrap();
    assert!(short.lines().count() < 50, "{short}");
    let (mut held, mut missed) = (0, 0);
    for part in fs::read_dir(folder.path().join("data")).unwrap() {
        let path = part.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap();
        let (_, own) = short.split_once(&format!("\n{name} ")).unwrap();
        let text = fs::read_to_string(path.join("tables/verdicts.csv")).unwrap();
        for row in csv::Reader::from_reader(text.as_bytes()).records() {
            let row = row.unwrap();
            let told = match &row[1] {
                "held" => row[0].to_string(),
                _ => format!("MISSED: {}: ", &row[0]),
            };
            assert!(own.contains(&told), "{told}: {short}");
            *(if &row[1] == "held" {
                &mut held
            } else {
                &mut missed
            }) += 1;
        }
    }
    assert!(
        held > 20
            && short.starts_with(&format!(
                "{held} of {} expectations held, {missed} missed\n",
                held + missed
            ))
    );
    verify(&folder.path().join("archives/validate-quick.tar.gz"), &[]).code(0);
    let output = validate(folder.path())
        .args(["--quick", "--lines", "2048", "--json", "--out", "j"])
        .output()
        .unwrap();
    assert!(serde_json::from_slice::<serde_json::Value>(&output.stdout).is_ok());
    assert!(
        folder
            .path()
            .join("j/archives/validate-quick.tar.gz")
            .is_file()
    );
}
