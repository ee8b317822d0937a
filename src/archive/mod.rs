//! Archives of finished runs: one `.tar.gz` from which anyone can check the files and repeat the runs.
//!
//! [`pack`] writes one, the same bytes for the same runs; [`verify`] reads one without trusting it; [`compare`] holds a
//! repeated run against it. An archive is a bag (BagIt 1.0) whose payload is an RO-Crate (1.1, with Process Run Crate 0.5), laid
//! out as a folder in which `validate` has run. Under one folder `NAME/`:
//!
//! ```text
//! bagit.txt  bag-info.txt       that it is a bag; bytes and number of the files below data/
//! manifest-sha256.txt           digests of the files below data/, as `sha256sum -c` reads them
//! tagmanifest-sha256.txt        digests of the three above
//! data/ro-crate-metadata.json   every file and run, for machines
//! data/README.md  CLAIMS.md     what this is, how to check and how to repeat it; what was found
//! data/CITATION.cff  LICENSE-*  how to cite it, what may be done with it
//! data/environment.json         programs, compilers and machines that measured and that packed it
//! data/Cargo.lock               the dependencies
//! data/replay.json              digests of the files that a repeated run must reproduce
//! data/experiments/RUN.toml     what to run again
//! data/resolved/RUN.toml        the same with every default written out
//! data/data/RUN/  plots/RUN/    what came out
//! ```
//!
//! A run from its experiment to an archive, and what becomes of an archive that was damaged:
//!
//! ```
//! use sahlab::archive::{RunFolders, pack, verify};
//! use sahlab::study::{self, Plan, plan::Overrides, store::Store};
//! use sahlab::{report, scene::Scene};
//!
//! let few = Overrides { quick: true, lines: Some(4096), ..Overrides::default() };
//! let plan = Plan::read("experiments/validate.toml".as_ref(), few)?;
//! let scenes = plan.scenes.iter().map(|name| Scene::load(name)).collect::<Result<Vec<_>, _>>()?;
//! let folder = tempfile::tempdir()?;
//! let [data, plots] = ["data", "plots"].map(|part| folder.path().join(part).join(&plan.name));
//! let store = Store::open(&data);
//! study::run(&plan, &scenes, &store, &())?;
//! report::write_plots(&report::read_run(&data)?, &plots)?;
//! store.finish()?;
//!
//! let file = folder.path().join("run.tar.gz");
//! pack(&[RunFolders { name: plan.name, data, plots }], None)?.write(&file)?;
//! let verified = verify(&file)?;
//! assert!(verified.faults.is_empty() && verified.experiments.contains_key("validate-quick"));
//!
//! // Cut short, it is no archive.
//! let bytes = std::fs::read(&file)?;
//! std::fs::write(&file, &bytes[..bytes.len() / 2])?;
//! assert!(verify(&file).is_err());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod alike;
mod bag;
mod claims;
mod date;
mod environment;
mod gather;
mod gzip;
mod identifier;
mod manifest;
mod metadata;
mod names;
mod pack;
mod readme;
mod replay;
mod reproduced;
mod verify;
mod walk;

use std::collections::BTreeMap;
use std::fmt;
use std::io::{self, Read};
use std::path::PathBuf;

use sha2::{Digest, Sha256};

use crate::study::plan::is_folder_name;
use crate::study::store::{TIMINGS, Unfinished};

pub use gather::RunFolders;
pub use pack::{Packed, pack};
pub use replay::{Compared, Difference, compare};
pub use verify::{Fault, Verified, verify};

/// The page of a run, beside its figures: it tells where and how long the run was measured.
const PAGE: &str = "report.html";

/// Whether a file of a run, by its path below `data/RUN/` or `plots/RUN/`, holds times or shows them: the only files that differ
/// from run to run.
pub fn holds_times(path: &str) -> bool {
    let name = path.rsplit('/').next().unwrap_or(path);
    [TIMINGS, PAGE].contains(&name) || name.starts_with("times-") || name.ends_with(".times.json")
}

/// How much an archive may hold: no more is packed, and no more is read.
struct Limits {
    /// Files.
    files: usize,
    /// Bytes of one file.
    file: u64,
    /// Bytes of all.
    all: u64,
}

const LIMITS: Limits = Limits {
    files: 1 << 16,
    file: 2 << 30,
    all: 4 << 30,
};

impl Limits {
    /// Whether so many files, the largest and all of them so large, are too much.
    fn are_passed(&self, files: usize, file: u64, all: u64) -> bool {
        files > self.files || file > self.file || all > self.all
    }
}

impl fmt::Display for Limits {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { files, file, all } = self;
        write!(
            f,
            "at most {files} files, {file} bytes in one and {all} in all"
        )
    }
}

/// Most bytes that are kept in memory of what is read: of manifests, metadata and experiments together.
const MOST_KEPT: u64 = 64 << 20;

/// How far a repeated figure that is no count may be off, over the larger of the two: sums of floats keep this many digits whatever
/// the machine, and nothing that is wrong by a count does.
pub const TOLERANCE: f64 = 1e-9;

const BAGIT: &str = "bagit.txt";
const BAG_INFO: &str = "bag-info.txt";
const MANIFEST: &str = "manifest-sha256.txt";
const TAG_MANIFEST: &str = "tagmanifest-sha256.txt";

/// The files of a bag that are not payload. They come first: with them, what follows is checked as it is read.
const TAGS: [&str; 4] = [BAGIT, BAG_INFO, MANIFEST, TAG_MANIFEST];

/// The folder of the payload.
const PAYLOAD: &str = "data/";

const METADATA: &str = "data/ro-crate-metadata.json";
const REPLAY: &str = "data/replay.json";

/// Why an archive cannot be written or read.
#[derive(Debug, thiserror::Error)]
pub enum ArchiveError {
    /// A file cannot be read.
    #[error("{path}: cannot read", path = path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// The archive cannot be written.
    #[error("{path}: cannot write", path = path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// Something that cannot be packed.
    #[error("{path}: {what}", path = path.display())]
    Unfit {
        /// The file or folder.
        path: PathBuf,
        /// What is wrong, and what would be right.
        what: String,
    },
    /// A run that is not at its end.
    #[error(transparent)]
    Unfinished(#[from] Unfinished),
    /// The variable `SOURCE_DATE_EPOCH` makes no sense.
    #[error("SOURCE_DATE_EPOCH is '{0}', expected whole seconds since 1970, below 2^32")]
    Epoch(String),
    /// A file that is not an archive, or not one that may be trusted.
    #[error("{path}: no archive of runs: {what}", path = path.display())]
    Refused {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        what: String,
    },
}

/// Size and digest of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Facts {
    size: u64,
    sha256: [u8; 32],
}

/// Files by their path below the archive's folder, in the order of the bytes of the path.
type Files = BTreeMap<String, Facts>;

/// A reader that knows size and digest of what has been read through it.
struct Digesting<R> {
    inner: R,
    size: u64,
    hash: Sha256,
}

impl<R: Read> Digesting<R> {
    fn new(inner: R) -> Self {
        Self {
            inner,
            size: 0,
            hash: Sha256::new(),
        }
    }

    /// Reads what is left and gives the facts of all.
    fn finish(mut self) -> io::Result<Facts> {
        io::copy(&mut self, &mut io::sink())?;
        Ok(Facts {
            size: self.size,
            sha256: self.hash.finalize().into(),
        })
    }
}

impl<R: Read> Read for Digesting<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let n = self.inner.read(buffer)?;
        self.size += n as u64;
        self.hash.update(&buffer[..n]);
        Ok(n)
    }
}

/// The header of a file in an archive, if its path has room there: nothing in it tells who packed it, or when.
fn header(folder: &str, path: &str, size: u64, mtime: u32) -> Option<tar::Header> {
    let mut header = tar::Header::new_ustar();
    header.set_entry_type(tar::EntryType::Regular);
    header.set_mode(0o644);
    header.set_uid(0);
    header.set_gid(0);
    header.set_mtime(mtime.into());
    header.set_size(size);
    header.set_path(format!("{folder}/{path}")).ok()?;
    header.set_cksum();
    Some(header)
}

/// The run of which a file is the experiment's text.
fn run_of_experiment(path: &str) -> Option<&str> {
    let run = path.strip_prefix("experiments/")?.strip_suffix(".toml")?;
    is_folder_name(run).then_some(run)
}

/// The folders of a run's files, each with one of its name in it.
const PARTS: [&str; 2] = ["data", "plots"];

/// The run of which a file is data or a figure, and its path below the run's folder.
fn run_of(path: &str) -> Option<(&str, &str)> {
    let (part, below) = path.split_once('/')?;
    below.split_once('/').filter(|_| PARTS.contains(&part))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_told_by_their_name() {
        for path in [
            "timings.csv",
            "times-x.csv",
            "tables/times-y.md",
            "cells/0.times.json",
            "report.html",
        ] {
            assert!(holds_times(path), "{path}");
        }
        for path in [
            "cells.csv",
            "sometimes-x.csv",
            "times-x/cells.csv",
            "timings.csv.md",
        ] {
            assert!(!holds_times(path), "{path}");
        }
    }

    #[test]
    fn runs_are_told_by_the_path() {
        assert_eq!(run_of_experiment("experiments/a.b.toml"), Some("a.b"));
        for path in [
            "experiments/a",
            "experiments/x/a.toml",
            "experiments/.toml",
            "a.toml",
        ] {
            assert_eq!(run_of_experiment(path), None, "{path}");
        }
        assert_eq!(run_of("data/e/tables/x"), Some(("e", "tables/x")));
        assert_eq!(run_of("plots/e/x.svg"), Some(("e", "x.svg")));
        assert_eq!(run_of("data/e"), None);
        assert_eq!(run_of("resolved/e/x"), None);
    }
}
