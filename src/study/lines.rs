//! How many lines a cell counts.

use serde::{Deserialize, Serialize};

use super::needed::TRIAL;
use super::plan::{Wrong, wrong_unless};

/// How many lines a cell counts.
///
/// ```
/// use sahlab::study::LineRule;
///
/// // Scores of standard deviation 0.5 and a wanted error of 1 %: (5.9 * 0.5 / 0.01)^2 lines, the next power of two times 1024.
/// let rule = LineRule::for_error(0.01, 1024, 1 << 20)?;
/// assert_eq!(rule.choose(0.5), 1 << 17);
/// assert!(LineRule::for_error(0.01, 1 << 20, 1024).is_err());
/// # Ok::<(), String>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LineRule {
    /// Wanted half-width of the slope's 99 % interval around 1, with room for chance: see [`choose`](Self::choose).
    slope_error: Option<f64>,
    /// Wanted relative error of the tree cost C instead: see [`needed`](super::needed).
    error: Option<f64>,
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
const MOST_LINES: u64 = TRIAL;
/// Most lines that a wanted error of C may ask for: some minutes' work.
const MOST_COUNTED: u64 = 1 << 34;
/// Least error of C that can be wanted.
const LEAST_ERROR: f64 = 1e-6;

/// Whether this can be a wanted relative error.
pub(super) fn check_error(error: f64) -> Result<(), String> {
    if (LEAST_ERROR..1.0).contains(&error) {
        return Ok(());
    }
    Err(format!(
        "a relative error of {error} is wanted, but it must be at least {LEAST_ERROR:e} and below 1"
    ))
}

impl LineRule {
    /// Exactly so many lines.
    pub fn exactly(lines: u64) -> Result<Self, String> {
        Self::for_error(1.0, lines, lines)
    }

    /// As many as a wanted error of the slope asks for, from `min` to `max`.
    pub fn for_error(slope_error: f64, min: u64, max: u64) -> Result<Self, String> {
        Self {
            slope_error: Some(slope_error),
            error: None,
            min,
            max,
        }
        .checked()
    }

    /// As many as a wanted relative error of the tree cost C asks for.
    pub fn for_cost_error(error: f64) -> Result<Self, String> {
        Self {
            slope_error: None,
            error: Some(error),
            min: FEWEST_LINES,
            max: MOST_COUNTED,
        }
        .checked()
    }

    fn checked(self) -> Result<Self, String> {
        self.check().map_err(|wrong| wrong.message)?;
        Ok(self)
    }

    /// The wanted relative error of C, if that is what decides.
    pub fn cost_error(&self) -> Option<f64> {
        self.error
    }

    /// The fewest and the most lines.
    pub fn bounds(&self) -> [u64; 2] {
        [self.min, self.max]
    }

    /// The smallest power of two times `min` for which 5.9 `sigma` / sqrt(N) is at most the wanted error, capped at the
    /// maximum. `sigma` is the standard deviation of the slope's per-line score.
    pub fn choose(&self, sigma: f64) -> u64 {
        let wanted = self.slope_error.map_or(0.0, |error| ROOM * sigma / error);
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
            error,
            min,
            max,
        } = *self;
        wrong_unless(slope_error.is_some() != error.is_some(), "lines", || {
            "lines needs either slope_error, the wanted error of slopes, or error, that of the tree cost C".into()
        })?;
        if let Some(slope_error) = slope_error {
            wrong_unless(
                slope_error > 0.0 && slope_error <= 1.0,
                "lines.slope_error",
                || {
                    format!(
                        "lines.slope_error = {slope_error}, but it must be above 0 and at most 1"
                    )
                },
            )?;
        }
        if let Some(error) = error {
            check_error(error).map_err(|message| Wrong {
                key: "lines.error",
                message,
            })?;
        }
        wrong_unless(min >= FEWEST_LINES, "lines.min", || {
            format!("{min} lines, but a cell needs at least {FEWEST_LINES} for its standard errors")
        })?;
        wrong_unless((min..=MOST_LINES).contains(&max), "lines.max", || {
            format!("lines.max = {max}, but it must be lines.min = {min} to {MOST_LINES}")
        })
    }
}
