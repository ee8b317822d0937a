//! The files of a run under `data/NAME/`: finished cells are found again, so that a stopped run resumes.
//!
//! `cells/ID.json` holds a finished cell, `cells/ID.times.json` the seconds of a finished piece of the run (a cell, or cells
//! measured together) and where it was measured; the other files are put together from them at the end, and beside them goes
//! `experiment.toml`, what was asked for. `README.md` says what all of them hold.

use std::fs::{self, File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::value::{RawValue, to_raw_value};
use thiserror::Error;

use crate::files::{make_folder, remove_unfinished, write_atomic, write_atomic_with};

use super::identity::digest;
use super::pieces::PieceTimes;
use super::records::Summary;
use super::share::Share;

/// A folder cannot be written.
#[derive(Debug, Error)]
pub enum StoreError {
    /// The system refuses.
    #[error("{path}: cannot write", path = path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// Another process writes there.
    #[error(
        "{path}: another process is at work in this folder; wait for it to end, or take another folder",
        path = path.display()
    )]
    Busy {
        /// The folder.
        path: PathBuf,
    },
}

/// A folder that is no finished run, though it may hold the files of one: some are of this run and some of the one before.
#[derive(Debug, Error)]
#[error(
    "{folder}: a run is writing here, or was stopped before its end; run it again, which goes on where it was",
    folder = .0.display()
)]
pub struct Unfinished(pub PathBuf);

/// The data folder of one experiment.
pub struct Store {
    folder: PathBuf,
    cells: Cells,
    share: Option<Share>,
}

/// What becomes of the cells that are there.
#[derive(Clone, Copy, PartialEq)]
enum Cells {
    /// They are found again, and others are measured.
    Resumed,
    /// They are measured again.
    Forgotten,
    /// They are all there is: nothing is measured.
    All,
}

/// A folder that no other process writes while this is held; the system lets go of it when the process ends, however it ends.
pub struct Claim {
    _lock: File,
}

/// What the files of a run hold: goes beside them.
const DICTIONARY: &str = include_str!("../../data/README.md");

/// The file of seconds. It and those whose names begin with `times-` are the only ones that are not reproducible.
pub const TIMINGS: &str = "timings.csv";

/// The file that tells where and how long the run was measured.
pub const RUN_TIMES: &str = "times-run.json";

/// The folder of finished cells.
pub const CELLS: &str = "cells";

/// The file in it by which processes are kept apart.
const LOCK: &str = ".lock";

/// The folder of pictures that a run keeps as data.
pub const PICTURES: &str = "pictures";

/// The file that has the experiment's text and how it was run.
pub const EXPERIMENT: &str = "experiment.toml";

/// The file that is there while the others of a run are written, and stays when that is stopped.
pub const UNFINISHED: &str = "UNFINISHED";

/// What it says to whoever finds it.
const UNFINISHED_TEXT: &str = "\
A run is writing here, or was stopped before its end: some files may be of another run. The same command finishes it.
";

/// What is kept of a finished piece, with the program that made it and a digest of its text: what another program has made, or
/// what is not as it was written, is made anew.
#[derive(Serialize, Deserialize)]
struct Kept {
    revision: String,
    id: String,
    sha256: String,
    content: Box<RawValue>,
}

impl Kept {
    fn new<T: Serialize>(id: &str, content: &T) -> Self {
        let content = to_raw_value(content).expect("records are plain data");
        Self {
            revision: crate::REVISION.into(),
            id: id.into(),
            sha256: digest(content.get().as_bytes()),
            content,
        }
    }

    /// What was kept, if it is this, by this very program.
    fn content<T: DeserializeOwned>(&self, id: &str) -> Option<T> {
        let text = self.content.get();
        let own = self.revision == crate::REVISION && self.id == id;
        let whole = own && self.sha256 == digest(text.as_bytes());
        whole.then(|| serde_json::from_str(text).ok())?
    }
}

impl Store {
    /// The store in this folder, which may not exist yet.
    pub fn open(folder: &Path) -> Self {
        Self {
            folder: folder.into(),
            cells: Cells::Resumed,
            share: None,
        }
    }

    /// The same, finding nothing that an earlier run has finished.
    pub fn forgetful(self) -> Self {
        Self {
            cells: Cells::Forgotten,
            ..self
        }
    }

    /// The same, finding all that it needs or refusing the run.
    pub fn complete(self) -> Self {
        Self {
            cells: Cells::All,
            ..self
        }
    }

    /// The same for a share of the run's pieces.
    pub fn sharing(self, share: Option<Share>) -> Self {
        Self { share, ..self }
    }

    /// The share of the run's pieces that it is for, if not all.
    pub fn share(&self) -> Option<Share> {
        self.share
    }

    /// Whether nothing may be measured.
    pub fn takes_only_what_is_there(&self) -> bool {
        self.cells == Cells::All
    }

    /// Make the folder, with the description of its files, and keep others from writing there: tells whether it can be written.
    pub fn prepare(&self) -> Result<Claim, StoreError> {
        let claim = self.claim()?;
        for below in ["", CELLS, PICTURES, "tables"] {
            let folder = self.folder.join(below);
            remove_unfinished(&folder).map_err(|source| self.wrong(below, source))?;
        }
        self.write("README.md", DICTIONARY.as_bytes())?;
        Ok(claim)
    }

    /// Say that the folder holds no finished run, until [`finish`](Self::finish): goes before all that a run writes.
    pub fn begin(&self) -> Result<(), StoreError> {
        self.write(UNFINISHED, UNFINISHED_TEXT.as_bytes())
    }

    /// Say that the folder holds a finished run: goes after all that is written of it, figures and tables too.
    pub fn finish(&self) -> Result<(), StoreError> {
        self.remove(UNFINISHED)
    }

    fn claim(&self) -> Result<Claim, StoreError> {
        let name = format!("{CELLS}/{LOCK}");
        let path = self.folder.join(&name);
        let wrong = |source| self.wrong(&name, source);
        make_folder(&self.folder.join(CELLS)).map_err(wrong)?;
        let lock = File::create(path).map_err(wrong)?;
        let locked = lock.try_lock();
        claimed(&self.folder, lock, locked)
    }

    fn wrong(&self, name: &str, source: io::Error) -> StoreError {
        StoreError::Write {
            path: self.folder.join(name),
            source,
        }
    }

    /// A finished cell of this very program; `None` if it must be measured.
    pub fn finished<T: DeserializeOwned>(&self, id: &str) -> Option<T> {
        self.kept(&cell_file(id), id)
    }

    /// The times of a finished piece, by this very program.
    pub fn times<T: DeserializeOwned>(&self, id: &str) -> Option<PieceTimes<T>> {
        self.kept(&times_file(id), id)
    }

    /// Keep the times of a piece: the last of it that is written.
    pub fn keep_times<T: Serialize>(
        &self,
        id: &str,
        times: &PieceTimes<T>,
    ) -> Result<(), StoreError> {
        self.keep(&times_file(id), id, times)
    }

    /// What an earlier run has kept in a file, if it may be taken.
    fn kept<T: DeserializeOwned>(&self, name: &str, id: &str) -> Option<T> {
        if self.cells == Cells::Forgotten {
            return None;
        }
        let kept: Kept = serde_json::from_slice(&self.read(name)?).ok()?;
        kept.content(id)
    }

    fn keep<T: Serialize>(&self, name: &str, id: &str, content: &T) -> Result<(), StoreError> {
        let json = serde_json::to_vec(&Kept::new(id, content)).expect("records are plain data");
        self.write(name, &json)
    }

    /// What is in a file; nothing in what is no file, such as a pipe, on which reading would wait.
    fn read(&self, name: &str) -> Option<Vec<u8>> {
        let path = self.folder.join(name);
        path.is_file().then(|| fs::read(path).ok())?
    }

    /// Keep a finished cell.
    pub fn save<T: Serialize>(&self, id: &str, result: &T) -> Result<(), StoreError> {
        self.keep(&cell_file(id), id, result)
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
        self.write_digested(name, &bytes)
    }

    /// The rows of a file, if it can be read; with a digest given, only those it was made of.
    pub fn read_rows<T: DeserializeOwned>(
        &self,
        name: &str,
        wanted: Option<&str>,
    ) -> Option<Vec<T>> {
        let bytes = self.read(name)?;
        if wanted.is_some_and(|wanted| wanted != digest(&bytes)) {
            return None;
        }
        let mut reader = csv::Reader::from_reader(&bytes[..]);
        reader.deserialize().collect::<Result<_, _>>().ok()
    }

    /// Whether a file of the run has this digest.
    pub fn has(&self, name: &str, sha256: &str) -> bool {
        self.read(name)
            .is_some_and(|bytes| digest(&bytes) == sha256)
    }

    /// Write the summary.
    pub fn write_summary(&self, summary: &Summary) -> Result<(), StoreError> {
        self.write_json("summary.json", summary)
    }

    /// Write a file for reading, too.
    pub fn write_json<T: Serialize>(&self, name: &str, content: &T) -> Result<(), StoreError> {
        let mut json = serde_json::to_vec_pretty(content).expect("records are plain data");
        json.push(b'\n');
        self.write(name, &json)
    }

    /// As [`write`](Self::write), for what is too large to be held at once.
    pub fn write_with(
        &self,
        name: &str,
        write: impl FnOnce(&mut fs::File) -> io::Result<()>,
    ) -> Result<(), StoreError> {
        let path = self.folder.join(name);
        write_atomic_with(&path, write).map_err(|source| StoreError::Write { path, source })
    }

    /// Remove a file that an earlier run may have left and this one has not.
    pub fn remove(&self, name: &str) -> Result<(), StoreError> {
        let path = self.folder.join(name);
        match fs::remove_file(&path) {
            Err(source) if source.kind() != io::ErrorKind::NotFound => {
                Err(StoreError::Write { path, source })
            }
            _ => Ok(()),
        }
    }

    /// Write a file that goes with a cell; gives its digest.
    pub fn write_digested(&self, name: &str, bytes: &[u8]) -> Result<String, StoreError> {
        self.write(name, bytes)?;
        Ok(digest(bytes))
    }

    /// Write a file of the run.
    pub fn write(&self, name: &str, bytes: &[u8]) -> Result<(), StoreError> {
        let path = self.folder.join(name);
        write_atomic(&path, bytes).map_err(|source| StoreError::Write { path, source })
    }
}

/// Whether all files in a folder are of one run, which has come to its end.
///
/// # Errors
/// If a run is writing there, or was stopped.
pub fn check_finished(folder: &Path) -> Result<(), Unfinished> {
    match folder.join(UNFINISHED).exists() {
        true => Err(Unfinished(folder.into())),
        false => Ok(()),
    }
}

/// Keep runs from writing in a folder while it is read. `None` where none could resume: what is there is a copy.
pub fn hold(folder: &Path) -> Result<Option<Claim>, StoreError> {
    let Ok(lock) = File::open(folder.join(CELLS).join(LOCK)) else {
        return Ok(None);
    };
    let locked = lock.try_lock_shared();
    claimed(folder, lock, locked).map(Some)
}

fn claimed(
    folder: &Path,
    lock: File,
    locked: Result<(), TryLockError>,
) -> Result<Claim, StoreError> {
    match locked {
        Err(TryLockError::WouldBlock) => Err(StoreError::Busy {
            path: folder.into(),
        }),
        // Some file systems know no locks; there it is the user's to keep runs apart.
        Ok(()) | Err(TryLockError::Error(_)) => Ok(Claim { _lock: lock }),
    }
}

fn cell_file(id: &str) -> String {
    format!("{CELLS}/{id}.json")
}

fn times_file(id: &str) -> String {
    format!("{CELLS}/{id}.times.json")
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
            RUN_TIMES,
            "shard.json",
            UNFINISHED,
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
        let own = fs::read_to_string(&path).expect("read");
        let others = [
            own.replace(crate::REVISION, "another"),
            own.replace(r#""id":"a""#, r#""id":"b""#),
            // A result that nobody found.
            own.replace(":7}", ":8}"),
            own.replace(":7}", ":7 }"),
        ];
        for other in &others[..3] {
            assert_ne!(*other, own);
            fs::write(&path, other).expect("written");
            assert_eq!(store.finished::<u32>("a"), None, "{other}");
        }
        fs::write(&path, &others[3]).expect("written");
        assert_eq!(store.finished::<u32>("a"), Some(7));
        assert_eq!(store.forgetful().finished::<u32>("a"), None);
    }
}
