//! What made an archive: facts of the program, the compiler and the machine that packs it, which need not be the one that ran;
//! no name of a host or a user, no path.

use std::thread::available_parallelism;

use serde::Serialize;

/// `environment.json`.
#[derive(Serialize)]
struct Environment {
    version: &'static str,
    revision: &'static str,
    rustc: &'static str,
    target: &'static str,
    os: &'static str,
    processor: Option<String>,
    /// That the packing machine runs at once; how many a run used is in its `timings.csv`.
    threads: Option<usize>,
}

/// The bytes of `environment.json`.
pub(super) fn json() -> Vec<u8> {
    let environment = Environment {
        version: env!("CARGO_PKG_VERSION"),
        revision: crate::REVISION,
        rustc: env!("SAHLAB_RUSTC"),
        target: env!("SAHLAB_TARGET"),
        os: std::env::consts::OS,
        processor: crate::study::machine::processor(),
        threads: available_parallelism().ok().map(usize::from),
    };
    let mut json = serde_json::to_vec_pretty(&environment).expect("plain data");
    json.push(b'\n');
    json
}
