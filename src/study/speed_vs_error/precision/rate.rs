//! Errors per 10^9 visits or tests.

use crate::stats::clustered_interval;

use super::judge::Errors;

/// Level of the intervals of rates.
const LEVEL: f64 = 0.95;

/// Errors per 10^9, with an interval whose independent units are lines.
#[derive(Clone, Copy, Debug)]
pub struct Rate {
    /// Errors of all kinds per 10^9.
    pub rate: f64,
    /// Lower end.
    pub lo: f64,
    /// Upper end.
    pub hi: f64,
}

impl Rate {
    /// Of these errors; `None` where nothing was judged.
    pub fn of(errors: &Errors) -> Option<Self> {
        let scale = 1e9 / errors.judged as f64;
        let [lo, hi] = clustered_interval(errors.all(), errors.squares, LEVEL).map(|m| scale * m);
        (errors.judged > 0).then(|| Self {
            rate: scale * errors.all() as f64,
            lo,
            hi,
        })
    }
}
