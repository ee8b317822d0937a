//! Is an archive what its manifest says?

use std::collections::BTreeMap;
use std::fmt;
use std::io::Read;
use std::path::Path;

use super::walk::{Contents, walk};
use super::{ArchiveError, Files, MANIFEST, MOST_KEPT, manifest, run_of_experiment};

/// A file that is not as the manifest says; its path is below the archive's folder.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Fault {
    /// Its digest is another.
    Differs(String),
    /// It is listed and not there.
    Missing(String),
    /// It is there and not listed.
    Unlisted(String),
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Differs(path) => write!(f, "{path}: differs from the manifest"),
            Self::Missing(path) => write!(f, "{path}: missing"),
            Self::Unlisted(path) => write!(f, "{path}: not in the manifest"),
        }
    }
}

/// What was found in an archive.
pub struct Verified {
    /// Name of its folder.
    pub name: String,
    /// What is wrong with its files; nothing if they are as packed.
    pub faults: Vec<Fault>,
    /// Text of the experiment of each run, as far as it is text.
    pub experiments: BTreeMap<String, String>,
    pub(super) files: Files,
}

impl Verified {
    /// How many files it has, the manifest left out, and their bytes.
    pub fn size(&self) -> (usize, u64) {
        let files = || self.files.iter().filter(|(path, _)| *path != MANIFEST);
        (files().count(), files().map(|(_, facts)| facts.size).sum())
    }
}

/// Check every file of an archive against its manifest. Nothing is written.
///
/// # Errors
/// If it cannot be read, or not trusted: entries that are no regular files, paths that lead elsewhere, files there twice,
/// sizes beyond all use, a damaged or missing manifest, anything behind the end.
pub fn verify(path: &Path) -> Result<Verified, ArchiveError> {
    let refused = |what: String| ArchiveError::Refused {
        path: path.into(),
        what,
    };
    let mut listed = None;
    let mut experiments = BTreeMap::new();
    let mut room = MOST_KEPT;
    let Contents { name, files } = walk(path, |below, reader| {
        let run = run_of_experiment(below);
        if below == MANIFEST || run.is_some() {
            let mut bytes = Vec::new();
            // What is cut off here cannot be read below, and is not run.
            room -= reader.take(room).read_to_end(&mut bytes)? as u64;
            match run {
                None => listed = Some(bytes),
                Some(run) => {
                    if let Ok(text) = String::from_utf8(bytes) {
                        experiments.insert(run.to_string(), text);
                    }
                }
            }
        }
        Ok(())
    })?;
    let listed = listed.ok_or_else(|| refused(format!("it has no {MANIFEST}")))?;
    let listed = manifest::read(&listed).map_err(|what| refused(format!("{MANIFEST}, {what}")))?;
    let mut faults = Vec::new();
    for (file, sha256) in &listed {
        match files.get(file) {
            None => faults.push(Fault::Missing(file.clone())),
            Some(facts) if facts.sha256 != *sha256 => faults.push(Fault::Differs(file.clone())),
            Some(_) => {}
        }
    }
    let unlisted = files
        .keys()
        .filter(|file| *file != MANIFEST && !listed.contains_key(*file));
    faults.extend(unlisted.cloned().map(Fault::Unlisted));
    Ok(Verified {
        name,
        faults,
        experiments,
        files,
    })
}
