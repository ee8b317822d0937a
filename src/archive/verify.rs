//! Is an archive what its manifests and its metadata say?

use std::collections::BTreeMap;
use std::fmt;
use std::io::Read;
use std::path::Path;

use super::walk::walk;
use super::{
    ArchiveError, BAG_INFO, BAGIT, Files, MANIFEST, METADATA, MOST_KEPT, PAYLOAD, REPLAY,
    TAG_MANIFEST, TAGS, bag, manifest, metadata, reproduced, run_of_experiment,
};
use crate::study::records::RunTimes;
use crate::study::store::RUN_TIMES;

/// A file that is not as the others say; its path is below the archive's folder.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Fault {
    /// Its digest is another.
    Differs(String),
    /// It is listed and not there.
    Missing(String),
    /// It is there and not listed.
    Unlisted(String),
    /// What it says of others is not so.
    Contradicts(String, String),
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Differs(path) => write!(f, "{path}: differs from the manifest"),
            Self::Missing(path) => write!(f, "{path}: missing"),
            Self::Unlisted(path) => write!(f, "{path}: not in the manifest"),
            Self::Contradicts(path, what) => write!(f, "{path}: {what}"),
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
    /// Where and how long each run was measured, where that is told.
    pub(super) times: BTreeMap<String, RunTimes>,
    pub(super) files: Files,
}

impl Verified {
    /// How many files it has, those left out that only tell of the others, and their bytes.
    pub fn size(&self) -> (usize, u64) {
        let files = || self.files.iter().filter(|(path, _)| is_payload(path));
        (files().count(), files().map(|(_, facts)| facts.size).sum())
    }
}

fn is_payload(path: &str) -> bool {
    path.starts_with(PAYLOAD)
}

/// Whether what a file says matters here.
fn is_read(path: &str) -> bool {
    let below = path.strip_prefix(PAYLOAD).unwrap_or_default();
    TAGS.contains(&path)
        || [METADATA, REPLAY].contains(&path)
        || run_of_experiment(below).is_some()
        || run_of_times(below).is_some()
}

/// The run of which a file tells the times.
fn run_of_times(below: &str) -> Option<&str> {
    let (run, file) = below.strip_prefix("data/")?.split_once('/')?;
    (file == RUN_TIMES).then_some(run)
}

/// Check every file of an archive, or of its unpacked folder, against its manifests, its sizes and what else tells of it. Nothing is
/// written.
///
/// # Errors
/// If it cannot be read, or not trusted: entries that are no regular files, paths that lead elsewhere, files there twice,
/// sizes beyond all use, a damaged or missing manifest, another version of BagIt, anything behind the end. The message names the
/// file at which that is seen, and the first one before it that is not as it was packed.
pub fn verify(path: &Path) -> Result<Verified, ArchiveError> {
    let mut texts = BTreeMap::new();
    let mut files = Files::new();
    let mut room = MOST_KEPT;
    let walked = walk(path, &mut files, |below, reader| {
        if is_read(below) {
            let mut bytes = Vec::new();
            // What is cut off here cannot be read below, and is not run.
            room -= reader.take(room).read_to_end(&mut bytes)? as u64;
            texts.insert(below.to_string(), bytes);
        }
        Ok(())
    });
    let refused = |what: String| ArchiveError::Refused {
        path: path.into(),
        what,
    };
    let name = match walked {
        Ok(name) => name,
        Err(ArchiveError::Refused { what, .. }) => {
            let listed = listed(&texts).unwrap_or_default();
            let first = listed
                .into_iter()
                .find(|(file, sha256)| files.get(file).is_some_and(|f| f.sha256 != *sha256));
            return Err(refused(match first {
                Some((file, _)) => format!("{}; {what}", Fault::Differs(file)),
                None => what,
            }));
        }
        Err(error) => return Err(error),
    };
    let listed = listed(&texts).map_err(refused)?;
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
        .filter(|file| *file != TAG_MANIFEST && !listed.contains_key(*file));
    faults.extend(unlisted.cloned().map(Fault::Unlisted));
    // What is not as it was packed tells nothing of the others.
    if faults.is_empty() {
        if texts[BAGIT] != bag::DECLARATION.as_bytes() {
            return Err(refused(format!(
                "{BAGIT} does not say BagIt-Version: 1.0 and UTF-8"
            )));
        }
        faults = contradictions(&texts, &files);
        for (file, bytes) in &texts {
            let below = file.strip_prefix(PAYLOAD).unwrap_or_default();
            if run_of_experiment(below).is_some() && std::str::from_utf8(bytes).is_err() {
                let what = "no text, so no experiment".into();
                faults.push(Fault::Contradicts(file.clone(), what));
            }
        }
    }
    let mut experiments = BTreeMap::new();
    let mut told = BTreeMap::new();
    for (file, bytes) in texts {
        let below = file.strip_prefix(PAYLOAD).unwrap_or_default();
        if let Some(run) = run_of_experiment(below)
            && let Ok(text) = String::from_utf8(bytes.clone())
        {
            experiments.insert(run.to_string(), text);
        }
        if let Some(run) = run_of_times(below)
            && let Ok(times) = serde_json::from_slice::<RunTimes>(&bytes)
        {
            told.insert(run.to_string(), times);
        }
    }
    Ok(Verified {
        name,
        faults,
        experiments,
        times: told,
        files,
    })
}

/// Path and digest of every file that the two manifests list; the message says which line of which is wrong.
fn listed(texts: &BTreeMap<String, Vec<u8>>) -> Result<BTreeMap<String, [u8; 32]>, String> {
    let mut all = BTreeMap::new();
    for (name, of_payload) in [(MANIFEST, true), (TAG_MANIFEST, false)] {
        let bytes = texts.get(name).ok_or_else(|| format!("it has no {name}"))?;
        let listed = manifest::read(bytes).map_err(|what| format!("{name}, {what}"))?;
        if let Some(path) = listed.keys().find(|path| is_payload(path) != of_payload) {
            return Err(format!("{name}: {path:?} belongs in the other manifest"));
        }
        all.extend(listed);
    }
    // Each of these is there for what it tells.
    for path in [BAGIT, BAG_INFO, MANIFEST, METADATA, REPLAY] {
        if !all.contains_key(path) {
            return Err(format!("its manifests do not list {path}"));
        }
    }
    Ok(all)
}

/// Where sound files contradict each other.
fn contradictions(texts: &BTreeMap<String, Vec<u8>>, files: &Files) -> Vec<Fault> {
    let mut faults = Vec::new();
    let (stated, found) = (bag::stated_oxum(&texts[BAG_INFO]), bag::oxum(files));
    if stated != Some(&found) {
        let stated = stated.unwrap_or("nothing");
        let what = format!("Payload-Oxum is {stated:?}, the payload's bytes and files are {found}");
        faults.push(Fault::Contradicts(BAG_INFO.into(), what));
    }
    for (path, checked) in [
        (METADATA, metadata::check(&texts[METADATA], files)),
        (REPLAY, reproduced::check(&texts[REPLAY], files)),
    ] {
        if let Err(what) = checked {
            let what = what.replace(char::is_control, " ");
            faults.push(Fault::Contradicts(path.into(), what));
        }
    }
    faults
}
