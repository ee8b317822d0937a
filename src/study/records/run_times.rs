//! Where and how long a run was measured: `times-run.json`.

use serde::{Deserialize, Serialize};

/// Where and how long a run was measured. The content of `times-run.json`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RunTimes {
    /// Wall seconds of all pieces together; what was measured on several machines at once took less.
    pub seconds: f64,
    /// Each machine and program that measured, in the order of the run's first piece there.
    pub machines: Vec<MachineTimes>,
}

/// What one machine measured of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MachineTimes {
    /// The machine and the program.
    #[serde(flatten)]
    pub machine: Machine,
    /// Pieces of the run it measured, each on its own: cells, scenes or parts of them, as the kind of the run has it.
    pub pieces: u64,
    /// Wall seconds of these.
    pub seconds: f64,
}

/// A machine, and the program on it. No name of a host or a user, no path.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Machine {
    /// Version of the program.
    pub version: String,
    /// Stands for its sources and locked dependencies.
    pub revision: String,
    /// The compiler.
    pub rustc: String,
    /// What it was compiled for.
    pub target: String,
    /// Operating system.
    pub os: String,
    /// The processor's name where the system tells it.
    pub processor: Option<String>,
    /// Threads that counted.
    pub threads: u64,
}
