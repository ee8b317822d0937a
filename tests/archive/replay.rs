//! Runs repeated from an archive.

use super::*;

#[test]
fn replay_gives_the_same_data() {
    let (folder, file) = archive();
    let temporary = folder.path().join("tmp");
    fs::create_dir(&temporary).unwrap();
    let data = unpack(&file);
    let data = data
        .keys()
        .filter(|path| path.starts_with("e-e-quick/data/") && !holds_times(path));
    let told = format!("replayed: all {} files of data equal", data.count());
    for threads in ["1", "2"] {
        validate(folder.path())
            .args(["verify", "a.tar.gz", "--replay", "--threads", threads])
            .env("TMPDIR", &temporary)
            .assert()
            .code(0)
            .stdout(contains(&told))
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
            .stderr(contains("repeated as they were"));
    }
    verify(&file, &["--replay", "--dry-run", "--out", "none"])
        .code(0)
        .stdout(contains("simple:uniform:50"));
    assert!(!folder.path().join("none").exists());
}

/// Give a file other bytes and the manifest the digest of these.
fn forge(files: &mut BTreeMap<String, Vec<u8>>, path: &str, change: impl Fn(&str) -> String) {
    let digest = |bytes: &[u8]| -> String {
        Sha256::digest(bytes)
            .iter()
            .map(|b| format!("{b:02x}"))
            .collect()
    };
    let old = String::from_utf8(files[path].clone()).unwrap();
    let new = change(&old);
    assert_ne!(old, new, "{path}");
    let manifest = files.get_mut("e-e-quick/manifest-sha256.txt").unwrap();
    let text = String::from_utf8(manifest.clone()).unwrap();
    let (old, fresh) = (digest(old.as_bytes()), digest(new.as_bytes()));
    let below = path.split_once('/').unwrap().1;
    let line = |digest: &str| format!("{digest}  {below}\n");
    assert!(text.contains(&line(&old)));
    *manifest = text.replace(&line(&old), &line(&fresh)).into_bytes();
    files.insert(path.into(), new.into_bytes());
}

#[test]
fn replay_finds_forged_data() {
    let (folder, file) = archive();
    let files = unpack(&file);
    let replay = |files: &BTreeMap<String, Vec<u8>>| {
        fs::write(&file, repack(files)).unwrap();
        verify(&file, &[]).code(0);
        verify(&file, &["--replay", "--quiet"])
    };
    // One count of one node.
    let mut forged = files.clone();
    forge(&mut forged, "e-e-quick/data/e/nodes.csv", |text| {
        let mut lines: Vec<_> = text.lines().map(str::to_string).collect();
        let fields: Vec<_> = lines[1].split(',').collect();
        let hits: u64 = fields[8].parse().unwrap();
        assert_eq!(lines[0].split(',').nth(8), Some("hits"));
        let mut fields: Vec<_> = fields.into_iter().map(str::to_string).collect();
        fields[8] = (hits + 1).to_string();
        lines[1] = fields.join(",");
        lines.join("\n") + "\n"
    });
    let output = replay(&forged).code(1).get_output().stdout.clone();
    let output = String::from_utf8(output).unwrap();
    assert!(
        output.contains("\ndata/e/nodes.csv: differs, first in line 2\nreplayed: 1 of "),
        "{output}"
    );
    // What differs is kept, to be looked at.
    let kept = output.trim_end().rsplit(" are in ").next().unwrap();
    assert!(Path::new(kept).join("data/e/nodes.csv").is_file());
    fs::remove_dir_all(kept).unwrap();

    // Times may differ; so may what no run writes.
    let mut forged = files.clone();
    forge(&mut forged, "e-e-quick/data/e/timings.csv", |text| {
        text.replace("sah,", "sah,9")
    });
    replay(&forged).code(0);
    // The options under which it ran; a file that the run does not write, and one that it does.
    let mut forged = files.clone();
    for path in ["experiments/e-quick.toml", "data/e-quick/experiment.toml"] {
        forge(&mut forged, &format!("e-e-quick/{path}"), |text| {
            text.replace("lines = 5000", "lines = 5001")
        });
    }
    let assert = replay(&forged).code(1).stdout(
        contains("data/e-quick/cells.csv: differs, first in line 2").and(contains("data/e/").not()),
    );
    remove_kept(&assert);
    let mut forged = files.clone();
    forge(
        &mut forged,
        "e-e-quick/data/e-quick/experiment.toml",
        |text| text.replace("it |", "this |"),
    );
    let cells = forged.remove("e-e-quick/data/e/cells.csv").unwrap();
    forged.insert("e-e-quick/data/e/cellz.csv".into(), cells);
    let manifest = forged.get_mut("e-e-quick/manifest-sha256.txt").unwrap();
    let text = String::from_utf8(manifest.clone()).unwrap();
    *manifest = text
        .replace("data/e/cells.csv", "data/e/cellz.csv")
        .into_bytes();
    let assert = replay(&forged).code(1).stdout(
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
        forge(&mut older, &format!("e-e-quick/{path}"), |text| {
            text.replace(sahlab::REVISION, "0123456789ab")
        });
    }
    fs::write(&file, repack(&older)).unwrap();
    verify(&file, &["--replay"]).code(0).stderr(contains(
        "note: e: made by revision 0123456789ab of the program, repeated by",
    ));
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

fn remove_kept(assert: &Assert) {
    let output = String::from_utf8(assert.get_output().stdout.clone()).unwrap();
    let kept = output.trim_end().rsplit(" are in ").next().unwrap();
    fs::remove_dir_all(kept).unwrap();
}

#[test]
fn experiments_that_no_run_kept_are_not_replayed() {
    let (_folder, file) = archive();
    let files = unpack(&file);
    for (change, part) in [
        (EXPERIMENT, "not the text that was kept with the run 'e'"),
        ("kind = 3", "a.tar.gz:experiments/e.toml:1:8:"),
    ] {
        let mut forged = files.clone();
        forge(&mut forged, "e-e-quick/experiments/e.toml", |_| {
            change.into()
        });
        fs::write(&file, repack(&forged)).unwrap();
        verify(&file, &["--replay"]).code(2).stderr(contains(part));
    }
    let mut forged = files.clone();
    forge(&mut forged, "e-e-quick/experiments/e.toml", |text| {
        text.replace("experiment = \"e\"", "experiment = \"../e\"")
    });
    fs::write(&file, repack(&forged)).unwrap();
    verify(&file, &["--replay"])
        .code(2)
        .stderr(contains("'../e' cannot name"));
}
