//! The figures of this kind.

mod counted;
mod predicted;
mod residuals;
mod shares;

use super::{CostVsWork, sets};
use crate::report::legend::Key;
use crate::report::number::{counted as numbered, grouped};

pub use counted::counted;
pub use predicted::predicted;
pub use residuals::residuals;
pub use shares::shares;

/// The sets of rays of a run, for a legend.
fn keys(run: &CostVsWork) -> Vec<(Key, String)> {
    let sets = sets::of(run);
    let key = |rays: &&str| (Key::Mark(sets::look(&sets, rays)), (*rays).to_owned());
    sets.iter().map(key).collect()
}

/// What times share, for a caption.
fn provenance(run: &CostVsWork, seed: u64) -> String {
    let trees = super::work::trees(run);
    let disturbed = run.predictions.iter().filter(|row| row.disturbed);
    format!(
        "{trees}, {} ({} of them disturbed: halves of the rounds more than 3 % apart), seed {seed}.",
        numbered(run.predictions.len() as u64, "time"),
        grouped(disturbed.count() as u64)
    )
}
