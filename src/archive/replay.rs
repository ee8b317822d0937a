//! Did a repeated run come out as the archived one? The archived files are compared where they are, never unpacked.

use std::collections::BTreeSet;
use std::fmt;
use std::fs::{self, File};
use std::io::{self, BufRead, BufReader};
use std::path::Path;

use super::walk::walk;
use super::{ArchiveError, EXPERIMENT, Verified, holds_times, run_of_data};

/// A file of data that did not come out as archived; its path is below the archive's folder.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Difference {
    /// The bytes differ, first in this line.
    Line(String, u64),
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
            Self::Line(path, line) => write!(f, "{path}: differs, first in line {line}"),
            Self::Gone(path) => write!(f, "{path}: not written by the repeated run"),
            Self::New(path) => write!(f, "{path}: written by the repeated run only"),
            Self::Experiment(path) => write!(f, "{path}: differs from the experiment's text"),
        }
    }
}

/// What came of a comparison.
pub struct Compared {
    /// Files that are equal.
    pub equal: usize,
    /// The others.
    pub differences: Vec<Difference>,
}

/// Hold the runs repeated into `root` against a verified archive: all files of data but those that hold times, and each
/// run's `experiment.toml` (which tells the revision of the program that ran it) against the text it was repeated from.
///
/// # Errors
/// If the archive cannot be read any more, or is no longer the one that was verified.
pub fn compare(path: &Path, verified: &Verified, root: &Path) -> Result<Compared, ArchiveError> {
    let mut differences = Vec::new();
    let mut compared = BTreeSet::new();
    let contents = walk(path, |below, archived| {
        let Some((run, file)) = run_of_data(below).filter(|(_, file)| !holds_times(file)) else {
            return Ok(());
        };
        compared.insert(below.to_string());
        if file == EXPERIMENT {
            let source = verified.files.get(&format!("experiments/{run}.toml"));
            if source != verified.files.get(below) {
                differences.push(Difference::Experiment(below.into()));
            }
            return Ok(());
        }
        match File::open(root.join(below)) {
            Ok(again) => {
                let line = first_difference(BufReader::new(archived), BufReader::new(again))?;
                differences.extend(line.map(|line| Difference::Line(below.into(), line)));
            }
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                differences.push(Difference::Gone(below.into()));
            }
            Err(error) => return Err(error),
        }
        Ok(())
    })?;
    if contents.files != verified.files {
        return Err(ArchiveError::Refused {
            path: path.into(),
            what: "it changed while the runs were repeated".into(),
        });
    }
    let equal = compared.len() - differences.len();
    for run in verified.experiments.keys() {
        let mut written = Vec::new();
        list(
            &root.join("data").join(run),
            &format!("data/{run}"),
            &mut written,
        )?;
        let new = written.into_iter().filter(|file| {
            let name = run_of_data(file).map_or("", |(_, name)| name);
            !name.starts_with("cells/") && !holds_times(name) && !compared.contains(file)
        });
        differences.extend(new.map(Difference::New));
    }
    Ok(Compared { equal, differences })
}

/// The line, from 1, in which two texts first differ.
fn first_difference(mut a: impl BufRead, mut b: impl BufRead) -> io::Result<Option<u64>> {
    let mut line = 1;
    loop {
        let (left, right) = (a.fill_buf()?, b.fill_buf()?);
        let n = left.len().min(right.len());
        if n == 0 {
            let both_end = left.len() == right.len();
            return Ok((!both_end).then_some(line));
        }
        let same = left.iter().zip(right).take_while(|(x, y)| x == y).count();
        line += left[..same].iter().filter(|&&byte| byte == b'\n').count() as u64;
        if same < n {
            return Ok(Some(line));
        }
        a.consume(n);
        b.consume(n);
    }
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_line_that_differs() {
        // Small buffers, so that lines and ends lie across them.
        let first = |a: &str, b: &str| {
            let a = BufReader::with_capacity(3, a.as_bytes());
            let b = BufReader::with_capacity(5, b.as_bytes());
            first_difference(a, b).expect("in memory")
        };
        assert_eq!(first("", ""), None);
        assert_eq!(first("one\ntwo\nthree\n", "one\ntwo\nthree\n"), None);
        assert_eq!(first("one\ntwo\nthree\n", "one\ntwo\nthrae\n"), Some(3));
        assert_eq!(first("one\ntwo\n", "one\ntwo"), Some(2));
        assert_eq!(first("one\ntwo\n", "one\ntwo\nthree\n"), Some(3));
        assert_eq!(first("x", ""), Some(1));
    }
}
