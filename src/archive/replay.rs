//! Did a repeated run come out as the archived one? The archived files are compared where they are, never unpacked.

use std::collections::BTreeSet;
use std::fmt;
use std::fs::{self, File};
use std::io::{self, BufReader};
use std::path::Path;

use super::alike::{self, Alike};
use super::walk::walk;
use super::{ArchiveError, Files, PAYLOAD, TOLERANCE, Verified, holds_times, run_of_data};
use crate::study::records::RunTimes;
use crate::study::store::{CELLS, EXPERIMENT, RUN_TIMES};

/// A file of data that did not come out as archived, by its path in the archive's `data/`.
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

/// Hold the runs repeated into `root` against a verified archive: all files of data but those that hold times, and each
/// run's `experiment.toml` (which tells the revision of the program that ran it) against the text it was repeated from.
///
/// # Errors
/// If the archive cannot be read any more, or is no longer the one that was verified.
pub fn compare(path: &Path, verified: &Verified, root: &Path) -> Result<Compared, ArchiveError> {
    let mut result = Compared::default();
    let mut compared = BTreeSet::new();
    let mut files = Files::new();
    walk(path, &mut files, |below, archived| {
        let Some(below) = below.strip_prefix(PAYLOAD) else {
            return Ok(());
        };
        let Some((run, file)) = run_of_data(below).filter(|(_, file)| !holds_times(file)) else {
            return Ok(());
        };
        compared.insert(below.to_string());
        if file == EXPERIMENT {
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
        let again = match File::open(root.join(below)) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                result.differences.push(Difference::Gone(below.into()));
                return Ok(());
            }
            again => again?,
        };
        match alike::compare(file, BufReader::new(archived), BufReader::new(again))? {
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
    for run in verified.experiments.keys() {
        let data = root.join("data").join(run);
        let mut written = Vec::new();
        list(&data, &format!("data/{run}"), &mut written)?;
        let new = written.into_iter().filter(|file| {
            let name = run_of_data(file).map_or("", |(_, name)| name);
            let resumes = name.split_once('/').is_some_and(|(top, _)| top == CELLS);
            !resumes && !holds_times(name) && !compared.contains(file)
        });
        result.differences.extend(new.map(Difference::New));
        if let Some(archived) = verified.seconds.get(run)
            && let Ok(text) = fs::read(data.join(RUN_TIMES))
            && let Ok(times) = serde_json::from_slice::<RunTimes>(&text)
        {
            result
                .seconds
                .push((run.clone(), [*archived, times.seconds]));
        }
    }
    Ok(result)
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
