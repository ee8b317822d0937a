//! What measured, and what made the archive: facts of programs, compilers and machines; no name of a host or a user, no path.

use std::collections::BTreeMap;
use std::thread::available_parallelism;

use serde::Serialize;

use super::gather::Run;
use crate::study::machine::machine;
use crate::study::records::{Machine, MachineTimes};

/// `environment.json`.
#[derive(Serialize)]
struct Environment<'a> {
    /// What measured each run, and how long.
    measured: BTreeMap<&'a str, &'a [MachineTimes]>,
    /// What made the archive, with the threads this machine runs at once.
    packed: Machine,
}

/// The bytes of `environment.json`.
pub(super) fn json(runs: &[Run]) -> Vec<u8> {
    let measured = runs.iter().map(|run| (run.name(), &*run.times.machines));
    let machine = machine();
    let environment = Environment {
        measured: measured.collect(),
        packed: Machine {
            // Not those of `--threads`: packing takes one.
            threads: available_parallelism().map_or(machine.threads, |n| n.get() as u64),
            ..machine
        },
    };
    let mut json = serde_json::to_vec_pretty(&environment).expect("plain data");
    json.push(b'\n');
    json
}
