//! Experiments: from a file to cells, from cells to records, from records to verdicts.

pub mod cell;
pub mod findings;
pub mod hits_vs_area;
pub mod plan;
pub mod records;
pub mod samplers;
pub mod scores;
pub mod spread;
pub mod store;
pub mod verdicts;

pub use plan::{LineRule, Plan, PlanError};

use sha2::{Digest, Sha256};

/// The first 16 hexadecimal digits of the SHA-256: names a cell, a scene's content, a file.
fn digest(bytes: &[u8]) -> String {
    let hash = Sha256::digest(bytes);
    hash.iter().take(8).map(|b| format!("{b:02x}")).collect()
}
