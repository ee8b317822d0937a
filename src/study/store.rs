//! The files of a run under `data/NAME/`: finished cells are found again, so that a stopped run resumes.
//!
//! `cells/ID.json` holds a finished cell, `timings.csv` the seconds; the other files are put together from them at the
//! end, and beside them goes `experiment.toml`, what was asked for. `README.md` says what all of them hold.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::files::{write_atomic, write_atomic_with};

use super::identity::digest;
use super::records::Summary;

/// A folder cannot be written.
#[derive(Debug, Error)]
#[error("{path}: cannot write", path = path.display())]
pub struct StoreError {
    path: PathBuf,
    source: io::Error,
}

/// The data folder of one experiment.
pub struct Store {
    folder: PathBuf,
    /// Whether finished cells are found again.
    resumes: bool,
}

/// What the files of a run hold: goes beside them.
const DICTIONARY: &str = include_str!("../../data/README.md");

/// The file of seconds, the only one that is not reproducible.
pub const TIMINGS: &str = "timings.csv";

/// The file that has the experiment's text and how it was run.
pub const EXPERIMENT: &str = "experiment.toml";

/// A finished cell on disk, with the program that made it: another program's cells are made anew.
#[derive(Serialize, Deserialize)]
struct Finished<T> {
    revision: String,
    id: String,
    result: T,
}

impl Store {
    /// The store in this folder, which may not exist yet.
    pub fn open(folder: &Path) -> Self {
        Self {
            folder: folder.into(),
            resumes: true,
        }
    }

    /// The same, finding nothing that an earlier run has finished.
    pub fn forgetful(self) -> Self {
        Self {
            resumes: false,
            ..self
        }
    }

    /// Make the folder, with the description of its files: tells whether it can be written.
    pub fn prepare(&self) -> Result<(), StoreError> {
        self.write("README.md", DICTIONARY.as_bytes())
    }

    /// A finished cell of this very program; `None` if it must be measured.
    pub fn finished<T: DeserializeOwned>(&self, id: &str) -> Option<T> {
        if !self.resumes {
            return None;
        }
        let text = fs::read_to_string(self.folder.join(cell_file(id))).ok()?;
        let found: Finished<T> = serde_json::from_str(&text).ok()?;
        (found.revision == crate::REVISION && found.id == id).then_some(found.result)
    }

    /// Keep a finished cell.
    pub fn save<T: Serialize>(&self, id: &str, result: &T) -> Result<(), StoreError> {
        let finished = Finished {
            revision: crate::REVISION.into(),
            id: id.into(),
            result,
        };
        let json = serde_json::to_vec(&finished).expect("records are plain data");
        self.write(&cell_file(id), &json)
    }

    /// Write a file of rows; gives its digest.
    pub fn write_rows<T: Serialize>(
        &self,
        name: &str,
        rows: impl IntoIterator<Item = T>,
    ) -> Result<String, StoreError> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        for row in rows {
            writer.serialize(row).expect("records are flat");
        }
        let bytes = writer.into_inner().expect("writing to memory");
        self.write(name, &bytes)?;
        Ok(digest(&bytes))
    }

    /// The rows of a file, if it can be read; with a digest given, only those it was made of.
    pub fn read_rows<T: DeserializeOwned>(
        &self,
        name: &str,
        wanted: Option<&str>,
    ) -> Option<Vec<T>> {
        let bytes = fs::read(self.folder.join(name)).ok()?;
        if wanted.is_some_and(|wanted| wanted != digest(&bytes)) {
            return None;
        }
        let mut reader = csv::Reader::from_reader(&bytes[..]);
        reader.deserialize().collect::<Result<_, _>>().ok()
    }

    /// Whether a file of the run is there.
    pub fn has(&self, name: &str) -> bool {
        self.folder.join(name).is_file()
    }

    /// Write the summary.
    pub fn write_summary(&self, summary: &Summary) -> Result<(), StoreError> {
        let mut json = serde_json::to_vec_pretty(summary).expect("records are plain data");
        json.push(b'\n');
        self.write("summary.json", &json)
    }

    /// As [`write`](Self::write), for what is too large to be held at once.
    pub fn write_with(
        &self,
        name: &str,
        write: impl FnOnce(&mut fs::File) -> io::Result<()>,
    ) -> Result<(), StoreError> {
        let path = self.folder.join(name);
        write_atomic_with(&path, write).map_err(|source| StoreError { path, source })
    }

    /// Remove a file that an earlier run may have left and this one has not.
    pub fn remove(&self, name: &str) -> Result<(), StoreError> {
        let path = self.folder.join(name);
        match fs::remove_file(&path) {
            Err(source) if source.kind() != io::ErrorKind::NotFound => {
                Err(StoreError { path, source })
            }
            _ => Ok(()),
        }
    }

    /// Write a file of the run.
    pub fn write(&self, name: &str, bytes: &[u8]) -> Result<(), StoreError> {
        let path = self.folder.join(name);
        write_atomic(&path, bytes).map_err(|source| StoreError { path, source })
    }
}

fn cell_file(id: &str) -> String {
    format!("cells/{id}.json")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_dictionary_names_every_file() {
        for file in [
            "cells.csv",
            "nodes.csv",
            "bins.csv",
            "samplers.csv",
            "work.csv",
            "choices.csv",
            "hits.csv",
            "trace.json",
            "bias.csv",
            "nodes-by.csv",
            "visits.csv",
            "order.csv",
            "metrics.csv",
            "exact.csv",
            "steps.csv",
            "tree-order.csv",
            "times-models.csv",
            "times-constants.csv",
            "times-choice.csv",
            "times-predictions.csv",
            "times-order.csv",
            "times-shares.csv",
            "times-verdicts.json",
            "errors.csv",
            "exponents.csv",
            "enough.csv",
            "precision.csv",
            "planes.csv",
            "coverage.csv",
            "cases.csv",
            "random.csv",
            "ties.csv",
            "metamorphic.csv",
            "traversal.csv",
            "link-memory.csv",
            TIMINGS,
            "summary.json",
            EXPERIMENT,
            "tables/",
            "cells/",
        ] {
            assert!(DICTIONARY.contains(file), "{file}");
        }
    }

    #[test]
    fn a_cell_is_found_again_by_its_own_program_only() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let store = Store::open(folder.path());
        store.save("a", &7).expect("written");
        assert_eq!(store.finished::<u32>("a"), Some(7));
        assert_eq!(store.finished::<u32>("b"), None);
        let path = folder.path().join("cells/a.json");
        let other = fs::read_to_string(&path).expect("read");
        fs::write(&path, other.replace(crate::REVISION, "another")).expect("written");
        assert_eq!(store.finished::<u32>("a"), None);
        store.save("a", &7).expect("written");
        assert_eq!(store.forgetful().finished::<u32>("a"), None);
    }
}
