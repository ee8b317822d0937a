//! Publishing: finished runs go to `data/published` and `plots/published`, and README.md and the pages below docs/ quote the
//! files there, where their marks say so (see [`splice`]).

use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use sahlab::files::{PART, is_unfinished, write_atomic};
use sahlab::report::REPORT;
use sahlab::study::plan::is_folder_name;
use sahlab::study::store::{check_finished, hold};

use crate::output::{note, print};
use crate::splice::{Spliced, splice};

/// Publish the named runs under `root` and splice the pages.
pub fn publish(root: &Path, names: &[String], speak: bool) -> Result<bool> {
    let mut held = Vec::new();
    for name in names {
        let data = root.join("data").join(name);
        held.push(hold(&data)?);
        check(name, &data)?;
    }
    // Before anything is copied: this may not be the project's folder.
    let texts = read_pages(root)?;
    for name in names {
        for part in ["data", "plots"] {
            let from = root.join(part).join(name);
            let to = root.join(part).join("published").join(name);
            if name != BENCH {
                replace(&from, &to)?;
                continue;
            }
            // A benchmark belongs to no other.
            if from.is_dir() {
                copy(&from, &to)?;
            }
            if to.is_dir() {
                drop_gone(root, &to)?;
            }
        }
    }
    let pages = spliced(root, texts)?;
    for (page, now) in &pages {
        if !now.stale.is_empty() {
            write_atomic(&root.join(page), now.text.as_bytes())?;
        }
        for mark in now.absent.iter().filter(|_| speak) {
            note(&format!(
                "{}: {mark}: not published yet; what the page has of it stays as it was",
                page.display()
            ));
        }
    }
    if speak {
        let what = match names {
            [] => "published nothing new".into(),
            _ => format!("published {}", names.join(", ")),
        };
        print(&format!("{what}; up to date: {}\n", counted(&pages)))?;
    }
    Ok(true)
}

/// Name every mark of a page between which something else stands than in the published files, and change nothing. Says
/// whether there is none.
pub fn check_pages(root: &Path) -> Result<bool> {
    let pages = spliced(root, read_pages(root)?)?;
    let mut wrong = String::new();
    for (page, now) in &pages {
        for (marks, what) in [
            (&now.stale, "out of date; `validate publish` renews it"),
            (&now.absent, "no such file is published"),
        ] {
            for mark in marks {
                wrong += &format!("{}: {mark}: {what}\n", page.display());
            }
        }
    }
    if wrong.is_empty() {
        print(&format!("up to date: {}\n", counted(&pages)))?;
        return Ok(true);
    }
    print(&wrong)?;
    Ok(false)
}

fn counted(pages: &[(PathBuf, Spliced)]) -> String {
    let marks: usize = pages.iter().map(|(_, page)| page.marks).sum();
    format!("all quotations ({marks} in README.md and docs/)")
}

/// README.md and every page below docs, relative to `root`, with their texts.
fn read_pages(root: &Path) -> Result<Vec<(PathBuf, String)>> {
    let mut pages = vec![PathBuf::from("README.md")];
    find_pages(root, Path::new("docs"), &mut pages)?;
    let text = |page: PathBuf| {
        let text = fs::read_to_string(root.join(&page)).with_context(|| {
            format!(
                "{}: cannot read; expected the project's own folder, here or in --out",
                root.join(&page).display()
            )
        })?;
        Ok((page, text))
    };
    pages.into_iter().map(text).collect()
}

/// Pages with what belongs between their marks.
fn spliced(root: &Path, pages: Vec<(PathBuf, String)>) -> Result<Vec<(PathBuf, Spliced)>> {
    let splice = |(page, text): (PathBuf, String)| {
        let spliced = splice(&text, root).with_context(|| page.display().to_string())?;
        Ok((page, spliced))
    };
    pages.into_iter().map(splice).collect()
}

/// The Markdown files below a folder, in order; none if there is no such folder.
fn find_pages(root: &Path, folder: &Path, pages: &mut Vec<PathBuf>) -> Result<()> {
    let here = root.join(folder);
    if !here.is_dir() {
        return Ok(());
    }
    let wrong = || format!("{}: cannot read", here.display());
    let names = fs::read_dir(&here)
        .with_context(wrong)?
        .map(|entry| Ok(entry?.file_name()));
    let mut names: Vec<_> = names.collect::<std::io::Result<_>>().with_context(wrong)?;
    names.sort();
    for name in names {
        let path = folder.join(name);
        if root.join(&path).is_dir() {
            find_pages(root, &path, pages)?;
        } else if path.extension().is_some_and(|ending| ending == "md") {
            pages.push(path);
        }
    }
    Ok(())
}

/// Publish a folder in place of what an earlier publication left, which may not belong to this run: that goes when the new one is
/// there as a whole.
fn replace(from: &Path, to: &Path) -> Result<()> {
    let mut name = std::ffi::OsString::from(".");
    name.push(to.file_name().unwrap_or_default());
    name.push(PART);
    let new = to.with_file_name(name);
    remove(&new)?;
    let copied = if from.is_dir() {
        copy(from, &new)
    } else {
        Ok(())
    };
    if copied.is_err() {
        // The first failure is the one to tell.
        let _ = remove(&new);
    }
    copied?;
    remove(to)?;
    if new.is_dir() {
        fs::rename(&new, to).with_context(|| format!("{}: cannot replace", to.display()))?;
    }
    Ok(())
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
    check_finished(data)?;
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
    ["cells", "nodes.csv", "pictures", REPORT].contains(&name)
        || name.starts_with("render-")
        || is_unfinished(name)
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
