//! The experiment `stability`: named hard cases with their exact outcome, by every strategy and kernel; random cases held against
//! exact integers; trees and lines transformed together.

pub mod asked;
pub mod case;
pub mod files;
pub mod statistics;

use super::records::{CaseRecord, MetamorphicRecord, RandomRecord, Summary, TieRecord};
use super::store::Store;
use super::{Plan, RunError, Watcher};
use crate::scene::Scene;

pub use asked::Stability;

/// Measure what is not finished and write the files of the run.
pub(super) fn run(
    plan: &Plan,
    asked: &Stability,
    _scenes: &[Scene],
    store: &Store,
    _watcher: &impl Watcher,
) -> Result<(), RunError> {
    store.write_rows::<CaseRecord>("cases.csv", [])?;
    store.write_rows::<RandomRecord>("random.csv", [])?;
    store.write_rows::<TieRecord>("ties.csv", [])?;
    store.write_rows::<MetamorphicRecord>("metamorphic.csv", [])?;
    store.write_summary(&Summary {
        stop: Some(asked.stop.to_string()),
        ..plan.summary()
    })?;
    Ok(())
}

/// The cases of a dry run, a line each.
pub(super) fn describe(plan: &Plan, asked: &Stability, _scenes: &[Scene]) -> String {
    format!("stop {}, seed {}\n", asked.stop, plan.seed)
}
