//! Writing an archive: the same runs give the same bytes, whoever packs them and when.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{self, BufReader, BufWriter, Cursor, Read, Write};
use std::path::{Path, PathBuf};

use flate2::{Compression, GzBuilder};

use super::{
    ArchiveError, Digesting, EXPERIMENT, Facts, Files, LIMITS, MANIFEST, environment, is_plain,
    manifest, readme,
};
use crate::files::{is_unfinished, write_atomic_with};
use crate::study::Plan;
use crate::study::plan::Overrides;

/// The dependencies this program was built with.
const LOCKED: &str = include_str!("../../Cargo.lock");

/// The folder of `cells/`, only there to resume a stopped run.
const RESUME: &str = "cells";

/// The folders of a finished run.
pub struct RunFolders {
    /// Its name: that of both folders.
    pub name: String,
    /// Its data.
    pub data: PathBuf,
    /// Its figures.
    pub plots: PathBuf,
}

/// Where the bytes of a file in the archive come from.
enum Source {
    Memory(Vec<u8>),
    Disk(PathBuf),
}

impl Source {
    fn open(&self) -> Result<Box<dyn Read + '_>, ArchiveError> {
        Ok(match self {
            Self::Memory(bytes) => Box::new(Cursor::new(bytes)),
            Self::Disk(path) => {
                let file = File::open(path).map_err(|source| unreadable(path, source))?;
                Box::new(BufReader::new(file))
            }
        })
    }

    fn facts(&self, path: &str) -> Result<Facts, ArchiveError> {
        let facts = Digesting::new(self.open()?).finish();
        facts.map_err(|source| unreadable(&self.place(path), source))
    }

    /// How to name it in a message.
    fn place(&self, path: &str) -> PathBuf {
        match self {
            Self::Memory(_) => path.into(),
            Self::Disk(place) => place.clone(),
        }
    }
}

/// What will be in an archive.
pub struct Packed {
    name: String,
    sources: BTreeMap<String, Source>,
    files: Files,
}

/// Gather finished runs. The archive is named after them, if it is given no name of its own.
///
/// # Errors
/// If a run is not finished, lacks its experiment's text or its figures, was made by another program (whose dependencies
/// would be packed wrongly), or has files that do not belong in an archive.
pub fn pack(runs: &[RunFolders], name: Option<&str>) -> Result<Packed, ArchiveError> {
    let mut runs: Vec<_> = runs.iter().collect();
    runs.sort_by(|a, b| a.name.cmp(&b.name));
    for pair in runs.windows(2) {
        if pair[0].name == pair[1].name {
            return Err(unfit(&pair[1].data, "this run is to be packed twice"));
        }
    }
    let names: Vec<_> = runs.iter().map(|run| run.name.as_str()).collect();
    let name = name.map_or_else(|| names.join("-"), str::to_owned);
    let mut sources = BTreeMap::new();
    let mut plans = Vec::new();
    for run in runs {
        let (plan, text) = read_plan(run)?;
        let data = format!("data/{}", run.name);
        gather(&run.data, &data, Some(RESUME), &mut sources)?;
        if !run.plots.is_dir() {
            let what = "no such folder; `validate plots` draws the figures of a run";
            return Err(unfit(&run.plots, what));
        }
        gather(
            &run.plots,
            &format!("plots/{}", run.name),
            None,
            &mut sources,
        )?;
        let path = format!("experiments/{}.toml", run.name);
        sources.insert(path, Source::Memory(text.into_bytes()));
        plans.push(plan);
    }
    for (path, bytes) in [
        ("Cargo.lock", LOCKED.into()),
        ("README.md", readme::text(&name, &plans).into_bytes()),
        ("environment.json", environment::json()),
    ] {
        sources.insert(path.into(), Source::Memory(bytes));
    }
    let mut files = Files::new();
    let mut total = 0;
    for (path, source) in &sources {
        let facts = source.facts(path)?;
        total += facts.size;
        // The manifest is one more.
        if LIMITS.are_passed(files.len() + 2, facts.size, total) {
            let what = format!("too much for an archive, which holds {LIMITS}");
            return Err(unfit(&source.place(path), &what));
        }
        files.insert(path.clone(), facts);
    }
    let listed = manifest::write(&files).into_bytes();
    let source = Source::Memory(listed);
    files.insert(MANIFEST.into(), source.facts(MANIFEST)?);
    sources.insert(MANIFEST.into(), source);
    Ok(Packed {
        name,
        sources,
        files,
    })
}

/// What a run was asked for, and that as text.
fn read_plan(run: &RunFolders) -> Result<(Plan, String), ArchiveError> {
    let missing = |file: &str, remedy: &str| {
        let what = format!("no {file}; {remedy}");
        unfit(&run.data, &what)
    };
    if !run.data.join("summary.json").is_file() {
        let remedy = "expected the folder of a finished run such as data/validate";
        return Err(missing("summary.json", remedy));
    }
    let path = run.data.join(EXPERIMENT);
    if !path.is_file() {
        let remedy = "what `validate scene` or an older program has made cannot be repeated from its files; write it as an \
                      experiment and run that";
        return Err(missing(EXPERIMENT, remedy));
    }
    let text = fs::read_to_string(&path).map_err(|source| unreadable(&path, source))?;
    let plan = Plan::parse(
        &text,
        &path.display().to_string(),
        &run.name,
        Overrides::default(),
    );
    let plan = plan.map_err(|error| {
        let what = format!("no experiment this program knows: {error}");
        unfit(&path, &what)
    })?;
    let revision = plan.record.as_ref().and_then(|r| r.revision.as_deref());
    if revision != Some(crate::REVISION) {
        let what = format!(
            "the run was made by revision {} of the program, this is {}; run it again with this one, or pack it with that one",
            revision.unwrap_or("(none told)"),
            crate::REVISION
        );
        return Err(unfit(&path, &what));
    }
    if plan.name != run.name {
        let what = format!("this run is named '{}', so must be its folder", plan.name);
        return Err(unfit(&path, &what));
    }
    Ok((plan, text))
}

/// All files below a folder but those in `without`, as `prefix/...`.
fn gather(
    folder: &Path,
    prefix: &str,
    without: Option<&str>,
    sources: &mut BTreeMap<String, Source>,
) -> Result<(), ArchiveError> {
    let entries = fs::read_dir(folder).map_err(|source| unreadable(folder, source))?;
    for entry in entries {
        let entry = entry.map_err(|source| unreadable(folder, source))?;
        let place = entry.path();
        let kind = entry
            .file_type()
            .map_err(|source| unreadable(&place, source))?;
        let name = entry.file_name();
        let name = name.to_str().filter(|name| is_plain(name)).ok_or_else(|| {
            unfit(
                &place,
                "the name of a file must be UTF-8 without '\\', ':' and control characters",
            )
        })?;
        if kind.is_dir() && without == Some(name) || is_unfinished(name) {
            continue;
        }
        let path = format!("{prefix}/{name}");
        if kind.is_dir() {
            gather(&place, &path, None, sources)?;
        } else if kind.is_file() {
            sources.insert(path, Source::Disk(place));
        } else {
            return Err(unfit(
                &place,
                "neither a file nor a folder; links are not packed",
            ));
        }
    }
    Ok(())
}

impl Packed {
    /// Name of the archive and of the folder in it.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Path and size of each file.
    pub fn files(&self) -> impl Iterator<Item = (&str, u64)> {
        self.files
            .iter()
            .map(|(path, facts)| (path.as_str(), facts.size))
    }

    /// Write the archive.
    ///
    /// # Errors
    /// If it cannot be written, or if a file is no longer what it was when it was gathered.
    pub fn write(&self, to: &Path) -> Result<(), ArchiveError> {
        let mtime = epoch()?;
        let written = write_atomic_with(to, |file| {
            let gzip = GzBuilder::new()
                .mtime(mtime)
                .operating_system(UNKNOWN_SYSTEM)
                .write(BufWriter::new(file), Compression::default());
            let mut tar = tar::Builder::new(gzip);
            for (path, source) in &self.sources {
                let facts = self.files[path];
                let reader = source.open().map_err(io::Error::other)?;
                let mut reader = Digesting::new(reader.take(facts.size));
                let mut header = header(mtime, facts.size);
                header.set_path(format!("{}/{path}", self.name))?;
                header.set_cksum();
                tar.append(&header, &mut reader)?;
                if reader.finish()? != facts {
                    let wrong = unfit(&source.place(path), "changed while it was packed");
                    return Err(io::Error::other(wrong));
                }
            }
            tar.into_inner()?.finish()?.flush()
        });
        written.map_err(|error| match error.downcast::<ArchiveError>() {
            Ok(own) => own,
            Err(source) => ArchiveError::Write {
                path: to.into(),
                source,
            },
        })
    }
}

/// What a gzip header says of the system it was made on.
const UNKNOWN_SYSTEM: u8 = 255;

/// The header of a file: nothing in it tells who packed it, or when.
fn header(mtime: u32, size: u64) -> tar::Header {
    let mut header = tar::Header::new_ustar();
    header.set_entry_type(tar::EntryType::Regular);
    header.set_mode(0o644);
    header.set_uid(0);
    header.set_gid(0);
    header.set_mtime(mtime.into());
    header.set_size(size);
    header
}

/// The time all files get: `SOURCE_DATE_EPOCH` (reproducible-builds.org), else 0.
fn epoch() -> Result<u32, ArchiveError> {
    match std::env::var("SOURCE_DATE_EPOCH") {
        Ok(text) => text.parse().map_err(|_| ArchiveError::Epoch(text)),
        Err(std::env::VarError::NotPresent) => Ok(0),
        Err(std::env::VarError::NotUnicode(text)) => {
            Err(ArchiveError::Epoch(text.to_string_lossy().into_owned()))
        }
    }
}

fn unreadable(path: &Path, source: io::Error) -> ArchiveError {
    ArchiveError::Read {
        path: path.into(),
        source,
    }
}

fn unfit(path: &Path, what: &str) -> ArchiveError {
    ArchiveError::Unfit {
        path: path.into(),
        what: what.into(),
    }
}
