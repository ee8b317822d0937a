//! The layers: which module may use which, read from the sources.
#![allow(clippy::unwrap_used, missing_docs)]

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// A module and the modules it may use.
const ALLOWED: [(&str, &[&str]); 13] = [
    ("cost", &[]),
    ("files", &[]),
    ("geom", &[]),
    ("stats", &[]),
    ("exact", &["geom"]),
    ("scene", &["geom"]),
    ("rays", &["geom", "scene", "stats"]),
    ("kd", &["cost", "geom"]),
    ("tracer", &["cost", "geom", "kd", "scene"]),
    (
        "study",
        &[
            "cost", "exact", "files", "geom", "kd", "rays", "scene", "stats", "tracer",
        ],
    ),
    // Only the records of a study: checked below.
    ("report", &["cost", "files", "study"]),
    ("archive", &["files", "study"]),
    (
        "lib",
        &[
            "archive", "cost", "exact", "files", "geom", "kd", "rays", "report", "scene", "stats",
            "study", "tracer",
        ],
    ),
];

fn sources(path: &Path, files: &mut Vec<PathBuf>) {
    if path.is_dir() {
        for entry in fs::read_dir(path).unwrap() {
            sources(&entry.unwrap().path(), files);
        }
    } else if path.extension().is_some_and(|e| e == "rs") {
        files.push(path.into());
    }
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// What follows each `crate::` in a file.
fn crate_paths(text: &str) -> impl Iterator<Item = &str> {
    let word = |s: &str| {
        s.find(|c: char| !(c.is_alphanumeric() || c == '_' || c == ':'))
            .unwrap_or(s.len())
    };
    text.match_indices("crate::").map(move |(i, m)| {
        let rest = &text[i + m.len()..];
        &rest[..word(rest)]
    })
}

#[test]
fn modules_use_only_the_layers_below() {
    let names: BTreeSet<&str> = ALLOWED.iter().map(|a| a.0).collect();
    let mut seen = 0;
    for (module, allowed) in ALLOWED {
        let mut files = Vec::new();
        for path in [format!("src/{module}.rs"), format!("src/{module}")] {
            let path = root().join(path);
            if path.exists() {
                sources(&path, &mut files);
            }
        }
        assert!(!files.is_empty(), "no module {module}");
        for file in files {
            let text = fs::read_to_string(&file).unwrap();
            seen += 1;
            for path in crate_paths(&text) {
                let used = path.split("::").next().unwrap();
                let fine = used == module || allowed.contains(&used) || !names.contains(used);
                assert!(fine, "{}: {module} may not use {used}", file.display());
                if module == "report" && used == "study" {
                    assert!(
                        path.starts_with("study::records"),
                        "{}: uses {path}",
                        file.display()
                    );
                }
            }
        }
    }
    assert!(seen > 50, "{seen} files read");
    // Every module of the library is listed.
    for entry in fs::read_dir(root().join("src")).unwrap() {
        let name = entry
            .unwrap()
            .path()
            .file_stem()
            .unwrap()
            .to_string_lossy()
            .into_owned();
        assert!(
            name == "bin" || names.contains(name.as_str()),
            "{name} is in no layer"
        );
    }
}

#[test]
fn the_tree_knows_no_files_clocks_or_random_numbers() {
    for module in [
        "src/geom",
        "src/kd",
        "src/cost.rs",
        "src/exact/filter.rs",
        "src/exact/integer.rs",
    ] {
        let mut files = Vec::new();
        sources(&root().join(module), &mut files);
        for file in files {
            let text = fs::read_to_string(&file).unwrap();
            for word in ["std::fs", "std::time", "Instant", "rand::", "ChaCha"] {
                assert!(!text.contains(word), "{}: {word}", file.display());
            }
        }
    }
}

/// What feeds a count takes no transcendental function from the platform: its last bit differs between systems.
#[test]
fn nothing_that_feeds_a_count_depends_on_the_platforms_mathematics() {
    for module in [
        "src/geom",
        "src/kd",
        "src/cost.rs",
        "src/exact/filter.rs",
        "src/exact/integer.rs",
        "src/rays",
        "src/scene",
        "src/study",
        "src/tracer",
    ] {
        let mut files = Vec::new();
        sources(&root().join(module), &mut files);
        for file in files {
            let text = fs::read_to_string(&file).unwrap();
            // Tests inside a file may.
            let text = text.split("#[cfg(test)]").next().unwrap();
            for call in [
                ".sin()",
                ".cos()",
                ".tan()",
                ".sin_cos()",
                ".ln()",
                ".log10()",
                ".log2()",
                ".exp()",
                ".powf(",
                ".cbrt()",
                ".mul_add(",
                ".acos()",
                ".atan2(",
            ] {
                assert!(!text.contains(call), "{}: {call}", file.display());
            }
        }
    }
}
