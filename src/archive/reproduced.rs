//! What a repeated run must reproduce: `replay.json`.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::manifest::{digest, digits};
use super::{Files, PAYLOAD, TOLERANCE, holds_times, run_of};

/// `replay.json`.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Reproduced {
    /// How far a figure that is no count may be off, over the larger of the two.
    relative_tolerance: f64,
    /// Files below the folder of the payload, and their SHA-256.
    sha256: BTreeMap<String, String>,
}

/// The data and figures but those that hold times.
fn files(files: &Files) -> BTreeMap<&str, [u8; 32]> {
    let below = files.iter().filter_map(|(path, facts)| {
        let path = path.strip_prefix(PAYLOAD)?;
        let (_, file) = run_of(path)?;
        (!holds_times(file)).then_some((path, facts.sha256))
    });
    below.collect()
}

/// The bytes of `replay.json` for the files of a bag.
pub(super) fn json(all: &Files) -> Vec<u8> {
    let reproduced = Reproduced {
        relative_tolerance: TOLERANCE,
        sha256: files(all)
            .into_iter()
            .map(|(path, sha256)| (path.into(), digits(&sha256)))
            .collect(),
    };
    let mut json = serde_json::to_vec_pretty(&reproduced).expect("plain data");
    json.push(b'\n');
    json
}

/// What is wrong with a `replay.json` beside these files of a bag.
pub(super) fn check(json: &[u8], all: &Files) -> Result<(), String> {
    let told: Reproduced = serde_json::from_slice(json).map_err(|error| error.to_string())?;
    let there = files(all);
    for (path, sha256) in &told.sha256 {
        match there.get(path.as_str()) {
            None => return Err(format!("{path:?} is no file of a run")),
            Some(found) if digest(sha256) != Some(*found) => {
                return Err(format!("the digest of {path:?} is another"));
            }
            Some(_) => {}
        }
    }
    match there.keys().find(|path| !told.sha256.contains_key(**path)) {
        Some(path) => Err(format!("{path:?} is not in it")),
        None => Ok(()),
    }
}
