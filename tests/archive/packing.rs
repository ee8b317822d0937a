//! What is packed, and how.

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
    assert!(paths.is_sorted());
    assert!(
        paths
            .iter()
            .all(|p| !p.contains("/cells/") && p.starts_with("e-e-quick/"))
    );
    for path in [
        "Cargo.lock",
        "README.md",
        "environment.json",
        "manifest-sha256.txt",
        "experiments/e.toml",
        "experiments/e-quick.toml",
        "data/e/experiment.toml",
        "data/e/nodes.csv",
        "data/e/timings.csv",
        "data/e-quick/tables/cells.md",
        "plots/e-quick/figure3.png",
        "plots/e-quick/report.html",
    ] {
        assert!(paths.contains(&format!("e-e-quick/{path}")), "{path}");
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
    dated("yesterday")
        .code(2)
        .stderr(contains("SOURCE_DATE_EPOCH is 'yesterday'"));
}

#[test]
fn what_made_it_and_what_to_do_with_it_is_told() {
    let (folder, file) = archive();
    let files = unpack(&file);
    let text = |path: &str| String::from_utf8(files[&format!("e-e-quick/{path}")].clone()).unwrap();
    let environment: serde_json::Value = serde_json::from_str(&text("environment.json")).unwrap();
    assert_eq!(environment["revision"], sahlab::REVISION);
    assert!(
        environment["rustc"]
            .as_str()
            .unwrap()
            .starts_with("rustc 1.")
    );
    assert!(environment["target"].as_str().unwrap().contains('-'));
    for path in ["environment.json", "README.md", "experiments/e.toml"] {
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
    ] {
        assert!(readme.contains(part), "{part}");
    }
    assert!(!readme.contains("| `simple:"));
    assert_eq!(text("Cargo.lock"), include_str!("../../Cargo.lock"));
    // The experiment's own text comes first, word for word.
    let experiment = text("experiments/e.toml");
    assert!(experiment.starts_with(EXPERIMENT) && experiment.contains("\n[run]\n"));
    assert_eq!(experiment, text("data/e/experiment.toml"));
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
        "no summary.json; expected the folder of a finished run",
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
    validate(root)
        .args(["archive", "data/e", "--dry-run"])
        .assert()
        .code(0)
        .stdout(contains("  e/data/e/cells.csv\n"));
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
    validate(folder.path())
        .args(["--quick", "--quiet", "--lines", "2048"])
        .assert()
        .code(predicate::in_iter([0, 1]))
        .stdout(predicate::str::ends_with(
            "archive ./archives/validate-quick.tar.gz\n",
        ));
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
