//! How many lines a cell counts.

use serde::Deserialize;

use super::plan::{Wrong, wrong_unless};

/// How many lines a cell counts.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LineRule {
    /// Wanted half-width of the slope's 99 % interval around 1, with room for chance: see [`choose`](Self::choose).
    slope_error: f64,
    /// At least so many.
    min: u64,
    /// At most so many.
    max: u64,
}

/// 2.58 standard errors for the interval and 3.3 for chance: the interval lies within the wanted bounds in all but one of
/// two thousand correct runs.
const ROOM: f64 = 5.9;

/// Fewest lines a cell may count: two make a variance, and the contrasts' covariance needs more.
pub(super) const FEWEST_LINES: u64 = 1024;
/// Most lines a cell may count: sums of squares of counts stay exact.
const MOST_LINES: u64 = 1 << 40;

impl LineRule {
    /// Exactly so many lines.
    pub fn exactly(lines: u64) -> Result<Self, String> {
        Self::for_error(1.0, lines, lines)
    }

    /// As many as a wanted error of the slope asks for, from `min` to `max`.
    pub fn for_error(slope_error: f64, min: u64, max: u64) -> Result<Self, String> {
        let rule = Self {
            slope_error,
            min,
            max,
        };
        rule.check().map_err(|wrong| wrong.message)?;
        Ok(rule)
    }

    /// The smallest power of two times `min` for which 5.9 `sigma` / sqrt(N) is at most the wanted error, capped at the
    /// maximum. `sigma` is the standard deviation of the slope's per-line score.
    pub fn choose(&self, sigma: f64) -> u64 {
        let wanted = ROOM * sigma / self.slope_error;
        let mut n = self.min;
        while n < self.max && (n as f64) < wanted * wanted {
            n *= 2;
        }
        n.min(self.max)
    }

    /// What a cell is guessed to take before its pilot.
    pub fn guess(&self) -> u64 {
        2 * self.min
    }

    /// The fewest lines it can give.
    pub fn at_least(&self) -> u64 {
        self.min
    }

    /// Whether the numbers make sense together.
    pub fn check(&self) -> Result<(), Wrong> {
        let Self {
            slope_error,
            min,
            max,
        } = *self;
        wrong_unless(
            slope_error > 0.0 && slope_error <= 1.0,
            "lines.slope_error",
            || format!("lines.slope_error = {slope_error}, but it must be above 0 and at most 1"),
        )?;
        wrong_unless(min >= FEWEST_LINES, "lines.min", || {
            format!("{min} lines, but a cell needs at least {FEWEST_LINES} for its standard errors")
        })?;
        wrong_unless((min..=MOST_LINES).contains(&max), "lines.max", || {
            format!("lines.max = {max}, but it must be lines.min = {min} to {MOST_LINES}")
        })
    }
}
