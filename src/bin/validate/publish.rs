//! Publishing: finished runs go to `data/published` and `plots/published`, and README.md quotes the files there.
//!
//! README holds blocks `<!-- BEGIN data/published/NAME/FILE.md -->` ... `<!-- END -->`; each is replaced by the file it
//! names. No number in README is typed by hand.

use std::fs;
use std::io::ErrorKind;
use std::path::Path;

use anyhow::{Context, Result, bail};
use sahlab::files::write_atomic;
use sahlab::study::plan::is_folder_name;

use crate::output::{note, print};

const BEGIN: &str = "<!-- BEGIN ";
const END: &str = "<!-- END -->";

/// Publish the named runs under `root` and splice README.md.
pub fn publish(root: &Path, names: &[String], speak: bool) -> Result<bool> {
    for name in names {
        let data = root.join("data").join(name);
        check(name, &data)?;
    }
    for name in names {
        for part in ["data", "plots"] {
            let from = root.join(part).join(name);
            let to = root.join(part).join("published").join(name);
            // What an earlier publication left may not belong to this run; a benchmark belongs to no other.
            if name != BENCH {
                remove(&to)?;
            }
            if from.is_dir() {
                copy(&from, &to)?;
            }
            if name == BENCH && to.is_dir() {
                drop_gone(root, &to)?;
            }
        }
    }
    let readme = root.join("README.md");
    let text = fs::read_to_string(&readme)
        .with_context(|| format!("{}: cannot read", readme.display()))?;
    let (spliced, absent) = splice(&text, root).with_context(|| readme.display().to_string())?;
    write_atomic(&readme, spliced.as_bytes())?;
    if speak {
        for file in absent {
            note(&format!(
                "{file}: not published yet; its block in README.md stays as it was"
            ));
        }
        print(&format!(
            "published {}; {} is up to date\n",
            names.join(", "),
            readme.display()
        ))?;
    }
    Ok(true)
}

/// Remove a folder, if there is one.
fn remove(folder: &Path) -> Result<()> {
    match fs::remove_dir_all(folder) {
        Err(error) if error.kind() != ErrorKind::NotFound => {
            Err(error).with_context(|| format!("{}: cannot replace", folder.display()))
        }
        _ => Ok(()),
    }
}

/// Remove the tables of benchmarks that are no more: of a source that is neither in `benches` nor in that of a member.
fn drop_gone(root: &Path, published: &Path) -> Result<()> {
    let wrong = |path: &Path| format!("{}: cannot read", path.display());
    let folders = ["benches", "peers/benches"].map(|folder| root.join(folder));
    if !folders[0].is_dir() {
        return Ok(());
    }
    for entry in fs::read_dir(published).with_context(|| wrong(published))? {
        let path = entry.with_context(|| wrong(published))?.path();
        let source = path.with_extension("rs");
        let source = source.file_name().unwrap_or_default();
        if !folders.iter().any(|folder| folder.join(source).is_file()) {
            fs::remove_file(&path).with_context(|| format!("{}: cannot remove", path.display()))?;
        }
    }
    Ok(())
}

/// The folder of benchmarks, a file each. It has no summary, and those that were not run again stay published.
const BENCH: &str = "bench";

/// A run may be published if it is finished and not the quick form.
fn check(name: &str, data: &Path) -> Result<()> {
    if !is_folder_name(name) {
        bail!("'{name}' is no name of a run; expected that of a folder in data/, e.g. validate");
    }
    if !data.is_dir() {
        bail!("{}: no such run; run it first", data.display());
    }
    if name == BENCH {
        return Ok(());
    }
    if !data.join("summary.json").is_file() {
        bail!(
            "{}: no summary.json, so not a finished run; run it to its end first",
            data.display()
        );
    }
    if sahlab::report::read_run(data)?.summary.quick {
        bail!(
            "{}: made with --quick; run it without to publish it",
            data.display()
        );
    }
    Ok(())
}

/// What is not published: what is only there to resume, and what is too large to keep and quickly made again.
fn stays_behind(name: &str) -> bool {
    ["cells", "nodes.csv", "pictures"].contains(&name) || name.starts_with("render-")
}

/// Copy a folder, without what [`stays_behind`].
fn copy(from: &Path, to: &Path) -> Result<()> {
    let wrong = |path: &Path| format!("{}: cannot copy", path.display());
    for entry in fs::read_dir(from).with_context(|| wrong(from))? {
        let path = entry.with_context(|| wrong(from))?.path();
        let name = path.file_name().unwrap_or_default();
        if stays_behind(&name.to_string_lossy()) {
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

/// Replace what stands in each block by the file that the block names. Where there is no such file the block stays; gives
/// these files too.
fn splice(text: &str, root: &Path) -> Result<(String, Vec<String>)> {
    let mut out = String::new();
    let mut absent = Vec::new();
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
        out += &rest[..body];
        match fs::read_to_string(root.join(file)) {
            Ok(content) => out += &format!("\n{}\n", content.trim_end()),
            Err(error) if error.kind() == ErrorKind::NotFound => {
                absent.push(file.into());
                out += &rest[body..body + end];
            }
            Err(error) => return Err(error).with_context(|| format!("{file}: cannot read")),
        }
        out += END;
        rest = &rest[body + end + END.len()..];
    }
    Ok((out + rest, absent))
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
        let spliced = |text: &str| splice(text, folder.path()).expect("spliced");
        assert_eq!(spliced(text), (wanted.into(), vec![]));
        assert_eq!(spliced(wanted), (wanted.into(), vec![]));
        let kept = format!("{wanted}<!-- BEGIN none.md -->\nold\n<!-- END -->");
        assert_eq!(spliced(&kept), (kept.clone(), vec!["none.md".into()]));
        assert!(splice("<!-- BEGIN t.md -->", folder.path()).is_err());
    }
}
