//! Not yet.

use super::asked::{Samplers, SpeedVsError};
use super::{Found, Piece};
use crate::study::Watcher;
use crate::study::records::Verdict;

/// Units of progress of a scene.
pub fn units(_asked: &Samplers) -> u64 {
    0
}

/// Measure a scene.
pub fn measure(
    _asked: &Samplers,
    _piece: &Piece<'_>,
    _watcher: &impl Watcher,
) -> Result<Found, String> {
    Ok(Found::default())
}

/// What came of the expectations.
pub fn verdicts(_asked: &SpeedVsError, _found: &[Found]) -> Vec<Verdict> {
    Vec::new()
}
