//! Publishing: finished runs go to `data/published` and `plots/published`, and README.md quotes the files there.
//!
//! README holds blocks `<!-- BEGIN data/published/NAME/FILE.md -->` ... `<!-- END -->`; each is replaced by the file it
//! names. No number in README is typed by hand.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result, bail};
use sahlab::files::write_atomic;

use crate::output::print;

const BEGIN: &str = "<!-- BEGIN ";
const END: &str = "<!-- END -->";

/// Publish the named runs under `root` and splice README.md.
pub fn publish(root: &Path, names: &[String], speak: bool) -> Result<bool> {
    for name in names {
        let data = root.join("data").join(name);
        check(&data)?;
    }
    for name in names {
        copy(
            &root.join("data").join(name),
            &root.join("data/published").join(name),
        )?;
        let plots = root.join("plots").join(name);
        if plots.is_dir() {
            copy(&plots, &root.join("plots/published").join(name))?;
        }
    }
    let readme = root.join("README.md");
    let text = fs::read_to_string(&readme)
        .with_context(|| format!("{}: cannot read", readme.display()))?;
    let spliced = splice(&text, root).with_context(|| readme.display().to_string())?;
    write_atomic(&readme, spliced.as_bytes())?;
    if speak {
        print(&format!(
            "published {}; {} is up to date\n",
            names.join(", "),
            readme.display()
        ))?;
    }
    Ok(true)
}

/// A run may be published if it is finished and not the quick form; a benchmark has no summary.
fn check(data: &Path) -> Result<()> {
    if !data.is_dir() {
        bail!("{}: no such run; run it first", data.display());
    }
    let summary = data.join("summary.json");
    if summary.exists() && sahlab::report::read_run(data)?.summary.quick {
        bail!(
            "{}: made with --quick; run it without to publish it",
            data.display()
        );
    }
    Ok(())
}

/// Copy a folder, without what is only there to resume (`cells/`) or too large to keep (`nodes.csv`).
fn copy(from: &Path, to: &Path) -> Result<()> {
    let wrong = |path: &Path| format!("{}: cannot copy", path.display());
    for entry in fs::read_dir(from).with_context(|| wrong(from))? {
        let path = entry.with_context(|| wrong(from))?.path();
        let name = path.file_name().unwrap_or_default();
        if name == "cells" || name == "nodes.csv" {
            continue;
        }
        if path.is_dir() {
            copy(&path, &to.join(name))?;
        } else {
            let bytes = fs::read(&path).with_context(|| wrong(&path))?;
            write_atomic(&to.join(name), &bytes)?;
        }
    }
    Ok(())
}

/// Replace what stands in each block by the file that the block names.
fn splice(text: &str, root: &Path) -> Result<String> {
    let mut out = String::new();
    let mut rest = text;
    while let Some(begin) = rest.find(BEGIN) {
        let after = begin + BEGIN.len();
        let close = rest[after..]
            .find(" -->")
            .context("a BEGIN marker is not closed by -->")?;
        let file = &rest[after..after + close];
        let body = after + close + " -->".len();
        let end = rest[body..]
            .find(END)
            .with_context(|| format!("no {END} after BEGIN {file}"))?;
        let content =
            fs::read_to_string(root.join(file)).with_context(|| format!("{file}: cannot read"))?;
        out += &rest[..body];
        out += &format!("\n{}\n", content.trim_end());
        out += END;
        rest = &rest[body + end + END.len()..];
    }
    Ok(out + rest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_are_replaced_and_nothing_else() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        fs::write(folder.path().join("t.md"), "| a |\n").expect("written");
        let text = "x\n<!-- BEGIN t.md -->\nold\n<!-- END -->\ny";
        let wanted = "x\n<!-- BEGIN t.md -->\n| a |\n<!-- END -->\ny";
        assert_eq!(splice(text, folder.path()).expect("spliced"), wanted);
        assert_eq!(splice(wanted, folder.path()).expect("spliced"), wanted);
        assert!(splice("<!-- BEGIN t.md -->", folder.path()).is_err());
        assert!(splice("<!-- BEGIN none.md -->\n<!-- END -->", folder.path()).is_err());
    }
}
