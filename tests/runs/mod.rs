//! Small runs of an experiment, for tests of kinds as a user meets them.
#![allow(clippy::unwrap_used, dead_code)]

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use assert_cmd::Command;
use tempfile::{TempDir, tempdir};

/// A folder with the experiment `e.toml`.
pub fn folder(text: &str) -> TempDir {
    let folder = tempdir().unwrap();
    fs::write(folder.path().join("e.toml"), text).unwrap();
    folder
}

/// `validate run e.toml` in a folder.
pub fn validate(folder: &Path) -> Command {
    let mut command = Command::cargo_bin("validate").unwrap();
    command.current_dir(folder).args(["run", "e.toml"]);
    command
}

/// What must not differ between runs: everything but seconds and what is made of them.
pub fn contents(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut all = BTreeMap::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        if path.is_dir() {
            let inside = contents(&path).into_iter();
            all.extend(inside.map(|(file, bytes)| (format!("{name}/{file}"), bytes)));
        } else if !sahlab::archive::holds_times(&name) {
            all.insert(name, fs::read(path).unwrap());
        }
    }
    all
}
