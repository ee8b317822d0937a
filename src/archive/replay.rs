//! Did a repeated run come out as the archived one? The archived files are compared where they are, never unpacked.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::fs::{self, File};
use std::io::{self, BufRead, BufReader};
use std::path::Path;

use super::alike::{self, Alike};
use super::claims;
use super::gather::Run;
use super::walk::walk;
use super::{
    ArchiveError, Files, PARTS, PAYLOAD, RunFolders, TOLERANCE, Verified, holds_times, run_of,
};
use crate::study::Plan;
use crate::study::plan::Overrides;
use crate::study::records::RunTimes;
use crate::study::store::{CELLS, EXPERIMENT, RUN_TIMES};

/// A file that did not come out as archived, by its path in the archive's `data/`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Difference {
    /// They differ first in this line, as told.
    Line(String, u64, String),
    /// Archived, and not written again.
    Gone(String),
    /// Written, and not archived.
    New(String),
    /// The text the run was repeated from is not the one among the run's data.
    Experiment(String),
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line(path, line, what) => {
                write!(f, "{path}: differs, first in line {line}: {what}")
            }
            Self::Gone(path) => write!(f, "{path}: not written by the repeated run"),
            Self::New(path) => write!(f, "{path}: written by the repeated run only"),
            Self::Experiment(path) => write!(f, "{path}: differs from the experiment's text"),
        }
    }
}

/// What came of a comparison.
#[derive(Default)]
pub struct Compared {
    /// Files that are equal to the byte.
    pub equal: usize,
    /// Files that are equal but for figures, no counts, within [`TOLERANCE`].
    pub within: Vec<String>,
    /// The others.
    pub differences: Vec<Difference>,
    /// Wall seconds of each run, archived and repeated, where both are told.
    pub seconds: Vec<(String, [f64; 2])>,
}

impl fmt::Display for Compared {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (run, [archived, repeated]) in &self.seconds {
            writeln!(
                f,
                "{run}: {archived:.3} s archived, {repeated:.3} s repeated"
            )?;
        }
        for path in &self.within {
            writeln!(f, "{path}: equal within {TOLERANCE:e}")?;
        }
        for difference in &self.differences {
            writeln!(f, "{difference}")?;
        }
        Ok(())
    }
}

/// Hold the runs repeated into `root` against a verified archive: all data and figures but those that hold times; each run's
/// `experiment.toml` (which tells the revision of the program that ran it) against the text it was repeated from; and what the
/// archive tells of them beside their files, where this program is of the revision that packed it.
///
/// Figures are drawn on a grid of whole numbers far finer than eyes, so they have no last digits that could differ.
///
/// # Errors
/// If the archive cannot be read any more, or is no longer the one that was verified; if a repeated run cannot be read.
pub fn compare(path: &Path, verified: &Verified, root: &Path) -> Result<Compared, ArchiveError> {
    let told = told(verified, root)?;
    let mut result = Compared::default();
    let mut compared = BTreeSet::new();
    let mut files = Files::new();
    walk(path, &mut files, |below, archived| {
        let Some(below) = below.strip_prefix(PAYLOAD) else {
            return Ok(());
        };
        let of_run = run_of(below).filter(|(_, file)| !holds_times(file));
        if let Some((run, EXPERIMENT)) = of_run {
            compared.insert(below.to_string());
            let facts = |path: &str| verified.files.get(&format!("{PAYLOAD}{path}"));
            if facts(&format!("experiments/{run}.toml")) == facts(below) {
                result.equal += 1;
            } else {
                result
                    .differences
                    .push(Difference::Experiment(below.into()));
            }
            return Ok(());
        }
        let again: Box<dyn BufRead> = if let Some(text) = told.get(below) {
            Box::new(text.as_bytes())
        } else if of_run.is_some() {
            match File::open(root.join(below)) {
                Err(error) if error.kind() == io::ErrorKind::NotFound => {
                    result.differences.push(Difference::Gone(below.into()));
                    return Ok(());
                }
                again => Box::new(BufReader::new(again?)),
            }
        } else {
            return Ok(());
        };
        compared.insert(below.to_string());
        match alike::compare(below, BufReader::new(archived), again)? {
            Alike::Equal => result.equal += 1,
            Alike::Within => result.within.push(below.into()),
            Alike::Differs(line, what) => {
                let difference = Difference::Line(below.into(), line, what);
                result.differences.push(difference);
            }
        }
        Ok(())
    })?;
    if files != verified.files {
        return Err(ArchiveError::Refused {
            path: path.into(),
            what: "it changed while the runs were repeated".into(),
        });
    }
    let left_out = told.into_keys().filter(|path| !compared.contains(path));
    result.differences.extend(left_out.map(Difference::New));
    for run in verified.experiments.keys() {
        let mut written = Vec::new();
        for part in PARTS {
            list(
                &root.join(part).join(run),
                &format!("{part}/{run}"),
                &mut written,
            )?;
        }
        let new = written.into_iter().filter(|file| {
            let name = run_of(file).map_or("", |(_, name)| name);
            let resumes = name.split_once('/').is_some_and(|(top, _)| top == CELLS);
            !resumes && !holds_times(name) && !compared.contains(file)
        });
        result.differences.extend(new.map(Difference::New));
        let data = root.join("data").join(run);
        if let Some(archived) = verified.times.get(run)
            && let Ok(text) = fs::read(data.join(RUN_TIMES))
            && let Ok(times) = serde_json::from_slice::<RunTimes>(&text)
        {
            result
                .seconds
                .push((run.clone(), [archived.seconds, times.seconds]));
        }
    }
    Ok(result)
}

/// What an archive of the repeated runs would tell of them beside their files, if they had taken the archived times; nothing if
/// another revision has packed it, which may tell it otherwise.
fn told(verified: &Verified, root: &Path) -> Result<BTreeMap<String, String>, ArchiveError> {
    let mut runs = Vec::new();
    for (name, text) in &verified.experiments {
        let place = [PAYLOAD, "experiments/", name, ".toml"].concat();
        let archived = Plan::parse(text, &place, name, Overrides::default());
        let record = archived.ok().and_then(|plan| plan.record);
        let revision = record.and_then(|record| record.revision);
        let Some(times) = verified.times.get(name) else {
            return Ok(BTreeMap::new());
        };
        if revision.as_deref() != Some(crate::REVISION) {
            return Ok(BTreeMap::new());
        }
        let [data, plots] = PARTS.map(|part| root.join(part).join(name));
        let name = name.clone();
        let run = Run::read(&RunFolders { name, data, plots })?;
        let times = times.clone();
        runs.push(Run { times, ..run });
    }
    Ok(claims::texts(&runs))
}

/// The files below a folder of our own, as `prefix/...`.
fn list(folder: &Path, prefix: &str, files: &mut Vec<String>) -> Result<(), ArchiveError> {
    let unreadable = |source| ArchiveError::Read {
        path: folder.into(),
        source,
    };
    for entry in fs::read_dir(folder).map_err(unreadable)? {
        let entry = entry.map_err(unreadable)?;
        let path = format!("{prefix}/{}", entry.file_name().to_string_lossy());
        if entry.path().is_dir() {
            list(&entry.path(), &path, files)?;
        } else {
            files.push(path);
        }
    }
    files.sort();
    Ok(())
}
