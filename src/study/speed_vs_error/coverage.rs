//! Not yet.

use super::asked::{Coverage, SpeedVsError};
use super::{Found, Piece};
use crate::study::Watcher;
use crate::study::records::Verdict;

/// Units of progress of a scene.
pub fn units(_asked: &Coverage) -> u64 {
    0
}

/// Measure a scene.
pub fn measure(
    _asked: &Coverage,
    _piece: &Piece<'_>,
    _watcher: &impl Watcher,
) -> Result<Found, String> {
    Ok(Found::default())
}

/// What came of the expectations.
pub fn verdicts(_asked: &SpeedVsError, _found: &[Found]) -> Vec<Verdict> {
    Vec::new()
}
