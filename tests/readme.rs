//! README quotes published files word for word, and names no number of its own run.
#![allow(clippy::unwrap_used, missing_docs)]

use std::fs;
use std::path::Path;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

#[test]
fn every_block_is_the_file_it_names() {
    let readme = fs::read_to_string(root().join("README.md")).unwrap();
    let mut blocks = 0;
    for block in readme.split("<!-- BEGIN ").skip(1) {
        let (file, rest) = block.split_once(" -->\n").unwrap();
        let quoted = rest.split("<!-- END -->").next().unwrap();
        let content = fs::read_to_string(root().join(file)).unwrap();
        assert_eq!(
            quoted.trim_end(),
            content.trim_end(),
            "{file}: run `validate publish`"
        );
        blocks += 1;
    }
    assert!(blocks >= 3);
}

#[test]
fn every_picture_and_file_it_names_is_there() {
    let readme = fs::read_to_string(root().join("README.md")).unwrap();
    for link in readme.split("](").skip(1) {
        let path = link.split(')').next().unwrap();
        assert!(root().join(path).is_file(), "{path}");
    }
    for file in [
        "experiments/figure3.toml",
        "experiments/fetch-meshes.sh",
        "src/kd/strategy.rs",
        "tests/faults.rs",
    ] {
        assert!(
            readme.contains(file) && root().join(file).is_file(),
            "{file}"
        );
    }
}

/// Published results are whole runs, and the expectations they were held to are told with them.
#[test]
fn published_runs_are_not_quick_ones() {
    for (name, cells) in [
        ("figure3", 132),
        ("validate", 45),
        ("strategies", 660),
        ("termination", 100),
    ] {
        let folder = root().join("data/published").join(name);
        let run = sahlab::report::read_run(&folder).unwrap();
        assert!(!run.summary.quick);
        assert!(!run.summary.verdicts.is_empty());
        let rows = fs::read_to_string(folder.join("cells.csv")).unwrap();
        assert!(rows.lines().count() > cells, "{name}");
    }
}
