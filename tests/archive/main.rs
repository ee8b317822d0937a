//! Archives as a user meets them: the same bytes for the same runs, every change found, nothing hostile let in, runs
//! repeated byte for byte.
#![allow(clippy::unwrap_used, missing_docs)]

mod flipped;
mod hostile;
mod packing;
mod replay;
mod sealed;
mod unpacked;
mod validators;

use std::collections::BTreeMap;
use std::fs;
use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use std::process::Command as Process;
use std::sync::OnceLock;

use assert_cmd::Command;
use assert_cmd::assert::Assert;
use flate2::read::GzDecoder;
use flate2::write::GzEncoder;
use flate2::{Compression, GzBuilder};
use predicates::prelude::*;
use predicates::str::contains;
use sahlab::archive::holds_times;
use sha2::{Digest, Sha256};
use tar::{EntryType, Header};
use tempfile::{TempDir, tempdir};

const EXPERIMENT: &str = r#"kind = "hits-vs-area"
question = "Does it | work?"
seed = 5
scenes = ["simple:uniform:100", "m.obj"]
strategies = ["sah"]
stop = "objects:2:10"
cost = { c_k = 15.0, c_b = 0.0, c_t = 20.0 }
lines = { slope_error = 0.5, min = 4096, max = 4096 }
figure = { scene = "m.obj", strategy = "sah" }
expect = { slope_within = 1.0, family = 0.01, gate = 0.0 }

[quick]
scenes = ["simple:uniform:50"]
lines = { slope_error = 0.5, min = 4096, max = 4096 }
figure = { scene = "simple:uniform:50", strategy = "sah" }
expect = { slope_within = 1.0, family = 0.01, gate = 0.0 }
"#;

const MESH: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 2 3 4\nf 1 2 4\n";

fn validate(folder: &Path) -> Command {
    let mut command = Command::cargo_bin("validate").unwrap();
    command.current_dir(folder).env_remove("SOURCE_DATE_EPOCH");
    command
}

/// A folder with two finished runs, `e` and, with other options, `e-quick`; made once.
fn runs() -> &'static Path {
    static RUNS: OnceLock<TempDir> = OnceLock::new();
    let folder = RUNS.get_or_init(|| {
        let folder = tempdir().unwrap();
        fs::write(folder.path().join("e.toml"), EXPERIMENT).unwrap();
        fs::write(folder.path().join("m.obj"), MESH).unwrap();
        for options in [&[][..], &["--quick", "--seed", "7", "--lines", "5000"]] {
            validate(folder.path())
                .args(["run", "e.toml", "--quiet"])
                .args(options)
                .assert()
                .code(predicate::in_iter([0, 1]));
        }
        folder
    });
    folder.path()
}

/// An archive of both runs in a folder of its own, with the mesh beside it.
fn archive() -> (TempDir, PathBuf) {
    let folder = tempdir().unwrap();
    let file = folder.path().join("a.tar.gz");
    validate(runs())
        .args(["archive", "data/e", "data/e-quick", "--out"])
        .arg(&file)
        .assert()
        .code(0);
    fs::write(folder.path().join("m.obj"), MESH).unwrap();
    (folder, file)
}

fn verify(file: &Path, more: &[&str]) -> Assert {
    validate(file.parent().unwrap())
        .arg("verify")
        .arg(file.file_name().unwrap())
        .args(more)
        .assert()
}

/// The files of an archive, by path.
fn unpack(file: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut archive = tar::Archive::new(GzDecoder::new(fs::File::open(file).unwrap()));
    let entries = archive.entries().unwrap().map(|entry| {
        let mut entry = entry.unwrap();
        let path = entry.path().unwrap().to_str().unwrap().to_string();
        let mut bytes = Vec::new();
        entry.read_to_end(&mut bytes).unwrap();
        (path, bytes)
    });
    entries.collect()
}

fn gzip() -> GzEncoder<Vec<u8>> {
    let gzip = GzBuilder::new().operating_system(255);
    gzip.write(Vec::new(), Compression::default())
}

/// A header that claims what it is told to, with a right checksum.
fn header(path: &str, kind: EntryType, size: u64) -> Header {
    let mut header = Header::new_ustar();
    // Past all checks of the crate.
    header.as_old_mut().name[..path.len()].copy_from_slice(path.as_bytes());
    header.set_entry_type(kind);
    header.set_size(size);
    header.set_mode(0o644);
    header.set_uid(0);
    header.set_gid(0);
    header.set_mtime(0);
    header.set_cksum();
    header
}

fn pack<'a>(entries: impl IntoIterator<Item = (&'a str, EntryType, &'a [u8])>) -> Vec<u8> {
    let mut tar = tar::Builder::new(gzip());
    for (path, kind, bytes) in entries {
        tar.append(&header(path, kind, bytes.len() as u64), bytes)
            .unwrap();
    }
    tar.into_inner().unwrap().finish().unwrap()
}

fn repack(files: &BTreeMap<String, Vec<u8>>) -> Vec<u8> {
    pack(
        files
            .iter()
            .map(|(path, bytes)| (path.as_str(), EntryType::Regular, &bytes[..])),
    )
}

/// Every file below a folder.
fn files_below(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            files.extend(files_below(&path));
        } else {
            files.push(path);
        }
    }
    files.sort();
    files
}

#[test]
fn plain_tools_can_check_it() {
    let (folder, file) = archive();
    let has = |tool: &str| Process::new(tool).arg("--version").output().is_ok();
    if !has("tar") || !has("sha256sum") {
        return;
    }
    let tar = Process::new("tar")
        .arg("-xzf")
        .arg(&file)
        .current_dir(folder.path())
        .output();
    let tar = tar.unwrap();
    assert!(tar.status.success() && tar.stderr.is_empty(), "{tar:?}");
    let root = folder.path().join("e-e-quick");
    let sums = || {
        let mut sums = Process::new("sha256sum");
        sums.args(["--strict", "--quiet", "-c", "manifest-sha256.txt"])
            .current_dir(&root);
        sums.output().unwrap()
    };
    let good = sums();
    assert!(good.status.success() && good.stdout.is_empty(), "{good:?}");
    let listed = fs::read_to_string(root.join("manifest-sha256.txt")).unwrap();
    assert_eq!(listed.lines().count() + 4, files_below(&root).len());
    let mut sorted: Vec<_> = listed.lines().map(|line| &line[66..]).collect();
    sorted.sort_unstable();
    assert!(listed.lines().map(|line| &line[66..]).eq(sorted));
    let bins = root.join("data/data/e/bins.csv");
    let before = fs::read(&bins).unwrap();
    fs::write(&bins, "x").unwrap();
    assert!(!sums().status.success());
    fs::write(&bins, before).unwrap();

    // The payload is laid out as where the program has run: its figures are drawn again, the same.
    let root = root.join("data");
    let figure = root.join("plots/e-quick/figure3.svg");
    let before = fs::read(&figure).unwrap();
    fs::remove_file(&figure).unwrap();
    validate(&root)
        .args(["plots", "data/e-quick"])
        .assert()
        .code(0);
    assert!(before == fs::read(&figure).unwrap());
    // By hand, as the README says: the unpacked experiment is the run.
    fs::copy(folder.path().join("m.obj"), root.join("m.obj")).unwrap();
    validate(&root)
        .args([
            "run",
            "experiments/e-quick.toml",
            "--out",
            "again",
            "--quiet",
        ])
        .assert()
        .code(predicate::in_iter([0, 1]));
    for path in files_below(&root.join("data/e-quick")) {
        let below = path.strip_prefix(&root).unwrap();
        if !holds_times(path.to_str().unwrap()) {
            let again = fs::read(root.join("again").join(below)).unwrap();
            assert!(again == fs::read(&path).unwrap(), "{}", below.display());
        }
    }
}

#[test]
fn a_sound_archive_is_verified() {
    let (folder, file) = archive();
    let files = unpack(&file).len() - 4;
    verify(&file, &[]).code(0).stderr("").stdout(
        contains(format!("e-e-quick: {files} files, ")).and(contains("all as in the manifest")),
    );
    // In another order it is as sound.
    fs::write(&file, repack(&unpack(&file))).unwrap();
    verify(&file, &[]).code(0);
    assert_eq!(files_below(folder.path()).len(), 2);
}
