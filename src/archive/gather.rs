//! Finished runs on disk: what they were asked for, what they found, and their files.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{self, BufReader, Cursor, Read};
use std::path::{Path, PathBuf};

use serde::de::DeserializeOwned;

use super::names::{NOT_PLAIN, is_plain};
use super::{ArchiveError, Digesting, Facts};
use crate::files::is_unfinished;
use crate::study::Plan;
use crate::study::plan::Overrides;
use crate::study::records::{RunTimes, Summary};
use crate::study::store::{CELLS, EXPERIMENT, RUN_TIMES, check_finished};

/// The folders of a finished run.
pub struct RunFolders {
    /// Its name: that of both folders.
    pub name: String,
    /// Its data.
    pub data: PathBuf,
    /// Its figures.
    pub plots: PathBuf,
}

/// A finished run.
pub(super) struct Run {
    /// What it was asked for.
    pub plan: Plan,
    /// That, as the text that was kept with it.
    pub text: String,
    /// What it found.
    pub summary: Summary,
    /// Where and how long it was measured.
    pub times: RunTimes,
}

impl Run {
    /// Its name.
    pub fn name(&self) -> &str {
        &self.plan.name
    }

    /// Read it.
    pub fn read(folders: &RunFolders) -> Result<Self, ArchiveError> {
        let data = &folders.data;
        check_finished(data)?;
        let remedy = "expected the folder of a finished run such as data/validate";
        let summary = json(data, "summary.json", remedy)?;
        let (plan, text) = plan(folders)?;
        let times = json(
            data,
            RUN_TIMES,
            "run it again, which measures anew only what is missing",
        )?;
        Ok(Self {
            plan,
            text,
            summary,
            times,
        })
    }
}

fn missing(folder: &Path, file: &str, remedy: &str) -> ArchiveError {
    unfit(folder, &format!("no {file}; {remedy}"))
}

/// What a file of a run says.
fn json<T: DeserializeOwned>(folder: &Path, file: &str, remedy: &str) -> Result<T, ArchiveError> {
    let path = folder.join(file);
    if !path.is_file() {
        return Err(missing(folder, file, remedy));
    }
    let text = fs::read(&path).map_err(|source| unreadable(&path, source))?;
    let told = serde_json::from_slice(&text);
    told.map_err(|error| unfit(&path, &format!("not as this program writes it: {error}")))
}

/// What a run was asked for, and that as text.
fn plan(run: &RunFolders) -> Result<(Plan, String), ArchiveError> {
    let path = run.data.join(EXPERIMENT);
    if !path.is_file() {
        let remedy = "what `validate scene` or an older program has made cannot be repeated from its files; write it as an \
                      experiment and run that";
        return Err(missing(&run.data, EXPERIMENT, remedy));
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

/// Where the bytes of a file in the archive come from.
pub(super) enum Source {
    Memory(Vec<u8>),
    Disk(PathBuf),
}

/// Files by their path below the folder of the payload.
pub(super) type Sources = BTreeMap<String, Source>;

impl Source {
    pub fn open(&self) -> Result<Box<dyn Read + '_>, ArchiveError> {
        Ok(match self {
            Self::Memory(bytes) => Box::new(Cursor::new(bytes)),
            Self::Disk(path) => {
                let file = File::open(path).map_err(|source| unreadable(path, source))?;
                Box::new(BufReader::new(file))
            }
        })
    }

    pub fn facts(&self, path: &str) -> Result<Facts, ArchiveError> {
        let facts = Digesting::new(self.open()?).finish();
        facts.map_err(|source| unreadable(&self.place(path), source))
    }

    /// How to name it in a message.
    pub fn place(&self, path: &str) -> PathBuf {
        match self {
            Self::Memory(_) => path.into(),
            Self::Disk(place) => place.clone(),
        }
    }
}

/// The data of a run but its finished cells, which are only there to resume a stopped run, and its figures.
pub(super) fn files_of(run: &RunFolders, sources: &mut Sources) -> Result<(), ArchiveError> {
    let RunFolders { name, data, plots } = run;
    gather(data, &format!("data/{name}"), Some(CELLS), sources)?;
    if !plots.is_dir() {
        let what = "no such folder; `validate plots` draws the figures of a run";
        return Err(unfit(plots, what));
    }
    gather(plots, &format!("plots/{name}"), None, sources)
}

/// All files below a folder but those in `without`, as `prefix/...`.
fn gather(
    folder: &Path,
    prefix: &str,
    without: Option<&str>,
    sources: &mut Sources,
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
            let what = format!(
                "the name of a file must be one on every system: UTF-8 without {NOT_PLAIN}, no device such as 'con', and no \
                 space or dot at its end"
            );
            unfit(&place, &what)
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

fn unreadable(path: &Path, source: io::Error) -> ArchiveError {
    ArchiveError::Read {
        path: path.into(),
        source,
    }
}

pub(super) fn unfit(path: &Path, what: &str) -> ArchiveError {
    ArchiveError::Unfit {
        path: path.into(),
        what: what.into(),
    }
}
