//! A run that several machines share: each keeps its pieces in a folder of its own, with what it was asked for; together they
//! make the run, the same to the byte as if one machine had made it.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::scene::Scene;

use super::pieces::{Piece, own_share};
use super::share::Share;
use super::store::{CELLS, EXPERIMENT, PICTURES, Store, StoreError, Unfinished, check_finished};
use super::{Plan, REVISION, RunError, SCHEMA};

/// The file that says that a shard is finished, and what is in it.
pub const SHARD: &str = "shard.json";

/// What is in a shard.
#[derive(Serialize, Deserialize)]
struct Contents {
    schema: u32,
    revision: String,
    /// Its number, from 1.
    share: usize,
    of: usize,
    /// Identities of its pieces.
    pieces: Vec<String>,
}

/// Why shards cannot be put together.
#[derive(Debug, Error)]
pub enum MergeError {
    /// A file cannot be read.
    #[error("{path}: cannot read", path = path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// A shard that does not belong to the others, or is none.
    #[error("{path}: {what}", path = path.display())]
    Unfit {
        /// The folder or file.
        path: PathBuf,
        /// What is wrong, and what would be right.
        what: String,
    },
    /// A shard whose run is not at its end.
    #[error(transparent)]
    Unfinished(#[from] Unfinished),
    /// Some pieces are in none of the shards.
    #[error("{0}")]
    Gaps(String),
    /// The run's folder cannot be written.
    #[error(transparent)]
    Store(#[from] StoreError),
}

/// Say what is in a share of a run, which is finished but for its mark.
pub(super) fn write_contents<P>(
    store: &Store,
    share: Share,
    pieces: &[Piece<P>],
) -> Result<(), StoreError> {
    let (own, _) = own_share(store, pieces);
    let contents = Contents {
        schema: SCHEMA,
        revision: REVISION.into(),
        share: share.index(),
        of: share.of(),
        pieces: own.into_iter().map(|piece| piece.id.clone()).collect(),
    };
    store.write_json(SHARD, &contents)
}

/// Shards of one run by one program.
pub struct Shards {
    /// What the run was asked for: the text of their `experiment.toml`.
    pub experiment: String,
    folders: Vec<(PathBuf, Contents)>,
}

impl Shards {
    /// Read what these folders say of themselves.
    ///
    /// # Errors
    /// If one is no finished shard of this very program, or if they are of different runs.
    pub fn read(folders: &[PathBuf]) -> Result<Self, MergeError> {
        let mut experiment: Option<(&Path, String)> = None;
        let mut read = Vec::new();
        for folder in folders {
            check_finished(folder)?;
            let contents = contents(folder)?;
            let path = folder.join(EXPERIMENT);
            let text = fs::read_to_string(&path).map_err(|source| unreadable(&path, source))?;
            match &experiment {
                Some((first, wanted)) => same_run(first, wanted, folder, &text)?,
                None => experiment = Some((folder, text)),
            }
            read.push((folder.clone(), contents));
        }
        let (_, experiment) = experiment.ok_or_else(|| {
            let what = "expected the folders of shards such as shards/validate/1-of-6";
            unfit(Path::new("."), what.into())
        })?;
        Ok(Self {
            experiment,
            folders: read,
        })
    }

    /// Whether all pieces of the run are there, each as it was measured. Nothing is written.
    ///
    /// # Errors
    /// If a shard is not the share it says, if some of its pieces are missing or damaged, if two shards have different results
    /// of one piece, or if some pieces are in no shard: tells which, and which shares have them.
    pub fn check(&self, plan: &Plan, scenes: &[Scene]) -> Result<(), MergeError> {
        let pieces = super::pieces(plan, scenes);
        for (folder, contents) in &self.folders {
            contents.check(folder, &pieces)?;
            let share = contents.share(folder)?;
            let store = Store::open(folder).complete().sharing(Some(share));
            // There is nothing to measure: each piece is read, or missed.
            match super::measure(plan, scenes, &store, &()) {
                Ok(()) => {}
                Err(RunError::Store(error)) => return Err(error.into()),
                Err(error) => {
                    let what = format!(
                        "{error}, or not as they were written; run --shard {share} again, which keeps what is sound"
                    );
                    return Err(unfit(folder, what));
                }
            }
        }
        self.files()?;
        self.check_gaps(&pieces)
    }

    fn check_gaps<P>(&self, pieces: &[Piece<P>]) -> Result<(), MergeError> {
        let there = |id: &String| self.folders.iter().any(|(_, c)| c.pieces.contains(id));
        let missing = pieces.iter().enumerate();
        let missing: Vec<_> = missing.filter(|(_, piece)| !there(&piece.id)).collect();
        let Some((_, first)) = missing.first() else {
            return Ok(());
        };
        let of = self.folders.iter().map(|(_, c)| c.of).max().unwrap_or(1);
        let mut shares: Vec<_> = missing.iter().map(|(n, _)| n % of + 1).collect();
        shares.sort_unstable();
        shares.dedup();
        let shares: Vec<_> = shares.iter().map(|i| format!("{i}/{of}")).collect();
        Err(MergeError::Gaps(format!(
            "{} of {} pieces of the run are in none of these shards, the first {} ({}); run --shard {} first",
            missing.len(),
            pieces.len(),
            first.place,
            first.id,
            shares.join(", ")
        )))
    }

    /// Copy all finished pieces into the run's folder.
    ///
    /// # Errors
    /// If a file cannot be read or written.
    pub fn copy(&self, into: &Store) -> Result<(), MergeError> {
        let files = self.files()?;
        // Times last, as they say that a piece is finished.
        let (times, others): (Vec<_>, Vec<_>) =
            files.iter().partition(|(name, _)| name.ends_with(TIMES));
        for (name, path) in others.into_iter().chain(times) {
            into.write(name, &read(path)?)?;
        }
        Ok(())
    }

    /// The files of all results, by their name in a run's folder.
    ///
    /// # Errors
    /// If two shards have different results of one piece, or if a file cannot be read.
    fn files(&self) -> Result<BTreeMap<String, PathBuf>, MergeError> {
        let mut files: BTreeMap<String, PathBuf> = BTreeMap::new();
        for (folder, _) in &self.folders {
            for (name, path) in results(folder)? {
                let Some(other) = files.get(&name) else {
                    files.insert(name, path);
                    continue;
                };
                // Whichever was first tells its times.
                if !name.ends_with(TIMES) && read(other)? != read(&path)? {
                    let what = format!(
                        "differs from {}, which should hold the same result; remove the shard that is wrong and run it again",
                        other.display()
                    );
                    return Err(unfit(&path, what));
                }
            }
        }
        Ok(files)
    }
}

impl Contents {
    /// The share it says to be.
    fn share(&self, folder: &Path) -> Result<Share, MergeError> {
        let share = Share::new(self.share, self.of);
        share.map_err(|what| unfit(&folder.join(SHARD), what))
    }

    /// Whether its pieces are those of its share of the run.
    fn check<P>(&self, folder: &Path, pieces: &[Piece<P>]) -> Result<(), MergeError> {
        let share = self.share(folder)?;
        let own = pieces.iter().enumerate().filter(|(n, _)| share.has(*n));
        if own.map(|(_, piece)| &piece.id).eq(&self.pieces) {
            return Ok(());
        }
        let what = format!("its pieces are not those of share {share}; run that share again");
        Err(unfit(&folder.join(SHARD), what))
    }
}

/// What the names of files with times end in.
const TIMES: &str = ".times.json";

/// What a shard says of itself.
fn contents(folder: &Path) -> Result<Contents, MergeError> {
    let path = folder.join(SHARD);
    if !path.is_file() {
        let what = format!(
            "no {SHARD}, so no finished shard; `validate run EXPERIMENT.toml --shard I/N` makes shards/NAME/I-of-N"
        );
        return Err(unfit(folder, what));
    }
    let contents: Contents = serde_json::from_slice(&read(&path)?)
        .map_err(|error| unfit(&path, format!("not what a shard has there: {error}")))?;
    if (contents.schema, &*contents.revision) != (SCHEMA, REVISION) {
        let what = format!(
            "measured by revision {} of the program, this is {REVISION}; all shards must be of one revision, and put together \
             by it",
            contents.revision
        );
        return Err(unfit(folder, what));
    }
    Ok(contents)
}

/// Two shards of one run have the same experiment, options and scenes.
fn same_run(first: &Path, wanted: &str, folder: &Path, text: &str) -> Result<(), MergeError> {
    if wanted == text {
        return Ok(());
    }
    // One may have a line more than the other: named is what the one says and the other does not.
    let only = |text: &str, other: &str| {
        let mut lines = text.lines().enumerate();
        lines
            .find(|(_, line)| !other.lines().any(|l| l == *line))
            .map_or("nothing more".into(), |(number, line)| {
                format!("`{line}` (line {})", number + 1)
            })
    };
    let told = format!(
        "{} there and {} here",
        only(text, wanted),
        only(wanted, text)
    );
    Err(unfit(
        first,
        format!(
            "not of the same run as {}: in their {EXPERIMENT}, {told}; shards must have the same experiment, seed and options",
            folder.display()
        ),
    ))
}

/// The files of results in a shard, by their name in a run's folder.
fn results(shard: &Path) -> Result<Vec<(String, PathBuf)>, MergeError> {
    let mut files = Vec::new();
    for below in [CELLS, PICTURES] {
        let folder = shard.join(below);
        if !folder.is_dir() {
            continue;
        }
        let entries = fs::read_dir(&folder).map_err(|source| unreadable(&folder, source))?;
        for entry in entries {
            let entry = entry.map_err(|source| unreadable(&folder, source))?;
            let name = entry.file_name().to_string_lossy().into_owned();
            // Nothing else is of the program's making.
            if !name.starts_with('.') && entry.path().is_file() {
                files.push((format!("{below}/{name}"), entry.path()));
            }
        }
    }
    files.sort();
    Ok(files)
}

fn read(path: &Path) -> Result<Vec<u8>, MergeError> {
    fs::read(path).map_err(|source| unreadable(path, source))
}

fn unreadable(path: &Path, source: io::Error) -> MergeError {
    MergeError::Read {
        path: path.into(),
        source,
    }
}

fn unfit(path: &Path, what: String) -> MergeError {
    MergeError::Unfit {
        path: path.into(),
        what,
    }
}
