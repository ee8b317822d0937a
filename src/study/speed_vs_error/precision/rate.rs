//! Errors per 10^9 visits or tests.

use crate::stats::clustered_interval;
use crate::study::incidence::Tally;

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
    /// Of the errors among so many; `None` where there are none.
    pub fn of(tally: &Tally, among: u64) -> Option<Self> {
        let scale = 1e9 / among as f64;
        let errors = tally.errors();
        let [lo, hi] = clustered_interval(errors, tally.squares, LEVEL).map(|m| scale * m);
        (among > 0).then_some(Self {
            rate: scale * errors as f64,
            lo,
            hi,
        })
    }
}
