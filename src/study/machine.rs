//! The machine that measures, and the program that does.

use super::records::Machine;

/// This program on this machine, with the threads of the current pool.
pub fn machine() -> Machine {
    Machine {
        version: env!("CARGO_PKG_VERSION").into(),
        revision: crate::REVISION.into(),
        rustc: env!("SAHLAB_RUSTC").into(),
        target: env!("SAHLAB_TARGET").into(),
        os: std::env::consts::OS.into(),
        processor: processor(),
        threads: rayon::current_num_threads() as u64,
    }
}

/// The processor's name where the system tells it.
pub fn processor() -> Option<String> {
    let text = std::fs::read_to_string("/proc/cpuinfo").ok()?;
    let line = text
        .lines()
        .find_map(|l| l.strip_prefix("model name")?.split_once(": "));
    line.map(|(_, name)| name.trim().into())
}
