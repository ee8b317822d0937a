//! The files of a run under `data/NAME/`: finished cells are found again, so that a stopped run resumes.
//!
//! `cells/ID.json` (and `cells/ID.nodes.csv`) hold a finished cell, `timings.csv` its seconds; `cells.csv`, `bins.csv`,
//! `nodes.csv` and `summary.json` are put together from them at the end.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::files::write_atomic;

use super::cell::CellResult;
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

/// A finished cell on disk, with the program that made it: another program's cells are made anew.
#[derive(Serialize, Deserialize)]
struct Finished {
    revision: String,
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

    fn cell_path(&self, id: &str, ending: &str) -> PathBuf {
        self.folder.join("cells").join(format!("{id}{ending}"))
    }

    /// A finished cell of this very program, with its nodes if they are needed; `None` if it must be measured.
    pub fn finished(&self, id: &str, nodes: bool) -> Option<CellResult> {
        let text = fs::read_to_string(self.cell_path(id, ".json")).ok()?;
        let Finished {
            revision,
            mut result,
        } = serde_json::from_str(&text).ok()?;
        if revision != crate::REVISION {
            return None;
        }
        result.timing = self.timings.get(id).cloned();
        if nodes {
            let mut reader = csv::Reader::from_path(self.cell_path(id, ".nodes.csv")).ok()?;
            result.nodes = Some(reader.deserialize().collect::<Result<_, _>>().ok()?);
        }
        Some(result)
    }

    /// Keep a finished cell. Its nodes go first: a cell counts as finished when its JSON is there.
    pub fn save(&mut self, result: &CellResult) -> Result<(), StoreError> {
        let id = &result.record.cell;
        if let Some(nodes) = &result.nodes {
            self.write(self.cell_path(id, ".nodes.csv"), &csv_bytes(nodes))?;
        }
        if let Some(timing) = &result.timing {
            self.timings.insert(id.clone(), timing.clone());
            let rows: Vec<_> = self.timings.values().collect();
            self.write(self.folder.join("timings.csv"), &csv_bytes(&rows))?;
        }
        let finished = Finished {
            revision: crate::REVISION.into(),
            result: CellResult {
                nodes: None,
                timing: None,
                ..result.clone()
            },
        };
        let json = serde_json::to_vec(&finished).expect("records are plain data");
        self.write(self.cell_path(id, ".json"), &json)
    }

    /// Put the run's files together.
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
        let rows: Vec<_> = results.iter().filter_map(|r| r.timing.as_ref()).collect();
        self.write(self.folder.join("timings.csv"), &csv_bytes(&rows))?;
        self.write(self.folder.join("samplers.csv"), &csv_bytes(samplers))?;
        let mut json = serde_json::to_vec_pretty(summary).expect("records are plain data");
        json.push(b'\n');
        self.write(self.folder.join("summary.json"), &json)
    }

    fn write(&self, path: PathBuf, bytes: &[u8]) -> Result<(), StoreError> {
        write_atomic(&path, bytes).map_err(|source| StoreError { path, source })
    }
}

fn csv_bytes<T: Serialize>(rows: &[T]) -> Vec<u8> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for row in rows {
        writer.serialize(row).expect("records are flat");
    }
    writer.into_inner().expect("writing to memory")
}
