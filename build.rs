//! Gives the program a revision that needs no git, a hash of its sources and locked dependencies, and tells it the compiler
//! and the target it was made with.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

use sha2::{Digest, Sha256};

fn main() {
    let root = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").expect("cargo sets it"));
    let mut files = vec![PathBuf::from("Cargo.lock"), PathBuf::from("Cargo.toml")];
    collect(&root, Path::new("src"), &mut files);
    files.sort();
    let mut hash = Sha256::new();
    for file in &files {
        println!("cargo::rerun-if-changed={}", file.display());
        hash.update(file.to_string_lossy().replace('\\', "/"));
        hash.update(fs::read(root.join(file)).expect("a source file can be read"));
    }
    println!("cargo::rerun-if-changed=src");
    let digits: String = hash
        .finalize()
        .iter()
        .take(6)
        .map(|b| format!("{b:02x}"))
        .collect();
    println!("cargo::rustc-env=SAHLAB_REVISION={digits}");
    println!("cargo::rustc-env=SAHLAB_RUSTC={}", compiler());
    let target = env::var("TARGET").expect("cargo sets it");
    println!("cargo::rustc-env=SAHLAB_TARGET={target}");
}

/// What `rustc --version` says, e.g. `rustc 1.89.0 (29483883e 2025-08-04)`.
fn compiler() -> String {
    let rustc = env::var_os("RUSTC").expect("cargo sets it");
    let output = Command::new(rustc).arg("--version").output();
    let output = output.expect("the compiler can be asked for its version");
    String::from_utf8_lossy(&output.stdout).trim().into()
}

fn collect(root: &Path, folder: &Path, files: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(root.join(folder))
        .expect("src is a folder")
        .flatten()
    {
        let path = folder.join(entry.file_name());
        if root.join(&path).is_dir() {
            collect(root, &path, files);
        } else if path
            .extension()
            .is_some_and(|e| e == "rs" || e == "txt" || e == "ttf")
        {
            files.push(path);
        }
    }
}
