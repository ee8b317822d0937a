//! The files of a run under `data/NAME/`: finished cells are found again, so that a stopped run resumes.
//!
//! `cells/ID.json` (and `cells/ID.nodes.csv`) hold a finished cell, `timings.csv` its seconds; `cells.csv`, `bins.csv`,
//! `nodes.csv` and `summary.json` are put together from them at the end. `README.md` says what all of them hold.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::files::write_atomic;

use super::cell::CellResult;
use super::digest;
use super::records::{SamplerRecord, Summary, TimingRecord};

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
    timings: BTreeMap<String, TimingRecord>,
}

/// What the files of a run hold: goes beside them.
const DICTIONARY: &str = include_str!("../../data/README.md");

/// A finished cell on disk, with the program that made it: another program's cells are made anew.
#[derive(Serialize, Deserialize)]
struct Finished {
    revision: String,
    /// Digest of the file of nodes written with it, if one was.
    nodes_sha256: Option<String>,
    #[serde(flatten)]
    result: CellResult,
}

impl Store {
    /// The store in this folder, which may not exist yet.
    pub fn open(folder: &Path) -> Self {
        let timings = csv::Reader::from_path(folder.join("timings.csv")).map(|mut reader| {
            let rows = reader.deserialize::<TimingRecord>().filter_map(Result::ok);
            rows.map(|t| (t.cell.clone(), t)).collect()
        });
        Self {
            folder: folder.into(),
            timings: timings.unwrap_or_default(),
        }
    }

    /// Make the folder, with the description of its files: tells whether it can be written.
    pub fn prepare(&self) -> Result<(), StoreError> {
        self.write(self.folder.join("README.md"), DICTIONARY.as_bytes())
    }

    fn cell_path(&self, id: &str, ending: &str) -> PathBuf {
        self.folder.join("cells").join(format!("{id}{ending}"))
    }

    /// A finished cell of this very program, with its nodes if they are needed; `None` if it must be measured.
    ///
    /// Taken only if the file is this cell's own and its nodes are those written with it.
    pub fn finished(&self, id: &str, nodes: bool) -> Option<CellResult> {
        let text = fs::read_to_string(self.cell_path(id, ".json")).ok()?;
        let Finished {
            revision,
            nodes_sha256,
            mut result,
        } = serde_json::from_str(&text).ok()?;
        if revision != crate::REVISION || result.record.cell != id {
            return None;
        }
        result.timing = self.timings.get(id).cloned();
        if nodes {
            let bytes = fs::read(self.cell_path(id, ".nodes.csv")).ok()?;
            if nodes_sha256? != digest(&bytes) {
                return None;
            }
            let mut reader = csv::Reader::from_reader(&bytes[..]);
            result.nodes = Some(reader.deserialize().collect::<Result<_, _>>().ok()?);
        }
        Some(result)
    }

    /// Keep a finished cell. Its nodes go first: a cell counts as finished when its JSON is there.
    pub fn save(&mut self, result: &CellResult) -> Result<(), StoreError> {
        let id = &result.record.cell;
        let mut nodes_sha256 = None;
        if let Some(nodes) = &result.nodes {
            let bytes = csv_bytes(nodes);
            nodes_sha256 = Some(digest(&bytes));
            self.write(self.cell_path(id, ".nodes.csv"), &bytes)?;
        }
        if let Some(timing) = &result.timing {
            self.timings.insert(id.clone(), timing.clone());
            let rows: Vec<_> = self.timings.values().collect();
            self.write(self.folder.join("timings.csv"), &csv_bytes(&rows))?;
        }
        let finished = Finished {
            revision: crate::REVISION.into(),
            nodes_sha256,
            result: CellResult {
                nodes: None,
                timing: None,
                ..result.clone()
            },
        };
        let json = serde_json::to_vec(&finished).expect("records are plain data");
        self.write(self.cell_path(id, ".json"), &json)
    }

    /// Put the run's files together. `timings.csv` stays as [`save`](Self::save) has left it, the description as
    /// [`prepare`](Self::prepare).
    pub fn write_run(
        &self,
        results: &[CellResult],
        samplers: &[SamplerRecord],
        summary: &Summary,
    ) -> Result<(), StoreError> {
        let rows: Vec<_> = results.iter().map(|r| &r.record).collect();
        self.write(self.folder.join("cells.csv"), &csv_bytes(&rows))?;
        let rows: Vec<_> = results.iter().flat_map(|r| &r.bins).collect();
        self.write(self.folder.join("bins.csv"), &csv_bytes(&rows))?;
        let rows: Vec<_> = results
            .iter()
            .filter_map(|r| r.nodes.as_ref())
            .flatten()
            .collect();
        self.write(self.folder.join("nodes.csv"), &csv_bytes(&rows))?;
        let timings = self.folder.join("timings.csv");
        if !timings.exists() {
            self.write(timings, TIMINGS_HEADER)?;
        }
        self.write(self.folder.join("samplers.csv"), &csv_bytes(samplers))?;
        let mut json = serde_json::to_vec_pretty(summary).expect("records are plain data");
        json.push(b'\n');
        self.write(self.folder.join("summary.json"), &json)
    }

    fn write(&self, path: PathBuf, bytes: &[u8]) -> Result<(), StoreError> {
        write_atomic(&path, bytes).map_err(|source| StoreError { path, source })
    }
}

/// `timings.csv` without a row.
const TIMINGS_HEADER: &[u8] = b"cell,scene,strategy,build_s,count_s,threads,visits\n";

fn csv_bytes<T: Serialize>(rows: &[T]) -> Vec<u8> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for row in rows {
        writer.serialize(row).expect("records are flat");
    }
    writer.into_inner().expect("writing to memory")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_header_is_that_of_a_row() {
        let row = TimingRecord {
            cell: "c".into(),
            scene: "s".into(),
            strategy: "sah".into(),
            build_s: 1.0,
            count_s: 2.0,
            threads: 3,
            visits: 4,
        };
        let written = csv_bytes(&[row]);
        assert!(written.starts_with(TIMINGS_HEADER));
    }

    #[test]
    fn the_dictionary_names_every_column_of_the_timings_and_every_file() {
        let header = String::from_utf8_lossy(TIMINGS_HEADER);
        for column in header.trim_end().split(',') {
            assert!(DICTIONARY.contains(&format!("`{column}`")), "{column}");
        }
        for file in [
            "cells.csv",
            "nodes.csv",
            "bins.csv",
            "samplers.csv",
            "timings.csv",
            "summary.json",
            "tables/",
            "cells/",
        ] {
            assert!(DICTIONARY.contains(file), "{file}");
        }
    }
}
