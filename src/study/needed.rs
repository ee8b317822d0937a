//! How many lines a wanted relative error of the tree cost C takes: the rule behind `--error`.
//!
//! Trial lines of their own are looked at after 1024, 2048, 4096, ... of them, until they tell the variance of C well enough
//! (Stein's two stages, the first of them sequential). Then so many lines are counted afresh. Their number is settled before
//! the first of them is drawn, so they are a sample of fixed size: every interval and test of a run holds as it stands, which
//! it would not around lines that had been stopped by what they showed.

use std::ops::Range;

use rayon::prelude::*;

use crate::kd::Stack;
use crate::stats::{ScoreMoments, normal_quantile};

use super::records::{CellRecord, Verdict, WorkRecord};

/// C is within the wanted error with this probability.
pub const CONFIDENCE: f64 = 0.95;

/// The first trial line: no run counts as many.
pub const TRIAL: u64 = 1 << 40;

/// Trial lines of the first look.
const FIRST: u64 = 1024;

/// Most trial lines.
const MOST: u64 = 1 << 24;

/// Standard errors by which the variance is taken larger, and the mean smaller, than the trial shows them.
const CAUTION: f64 = 3.3;

/// A variance known to this share, and a mean known to a quarter of it, end the trial: at most a third of the lines are then
/// more than needed.
const KNOWN: f64 = 0.2;

/// A trial of this share of the lines it asks for ends, too.
const SHARE: f64 = 0.25;

/// Lines that one thread takes at a time; sums are merged in the order of the lines.
const CHUNK: u64 = 1024;

/// Lines that bring the relative error of C's mean to `error` or below, with probability [`CONFIDENCE`]; not fewer than
/// `least` and not more than `most`. `cost` gives what line i costs, or `None` where it misses the root's box: of such lines
/// no cost is predicted, and more are drawn instead.
pub fn needed(
    error: f64,
    [least, most]: [u64; 2],
    cost: impl Fn(u64, &mut Stack) -> Option<f64> + Sync,
) -> u64 {
    let mut trial = ScoreMoments::default();
    let mut looked_at = 0;
    loop {
        let next = (2 * looked_at).max(FIRST);
        trial.merge(&moments(TRIAL + looked_at..TRIAL + next, &cost));
        looked_at = next;
        let asked = asked(error, &trial);
        // Of every line that hits the root's box so many are drawn.
        let drawn = looked_at as f64 / trial.n().max(1) as f64;
        let lines = asked.lines * drawn;
        if asked.known || looked_at as f64 >= SHARE * lines || looked_at >= MOST {
            return (lines.ceil() as u64).clamp(least, most);
        }
    }
}

/// Of C and C^2, line by line.
fn moments(
    lines: Range<u64>,
    cost: &(impl Fn(u64, &mut Stack) -> Option<f64> + Sync),
) -> ScoreMoments<2> {
    let starts: Vec<u64> = lines.clone().step_by(CHUNK as usize).collect();
    let chunk = |&start: &u64| {
        let mut own = ScoreMoments::default();
        let mut stack = Stack::default();
        for i in start..lines.end.min(start + CHUNK) {
            if let Some(c) = cost(i, &mut stack) {
                own.push([c, c * c]);
            }
        }
        own
    };
    let chunks: Vec<ScoreMoments<2>> = starts.par_iter().map(chunk).collect();
    let mut all = ScoreMoments::default();
    chunks.iter().for_each(|own| all.merge(own));
    all
}

/// What a trial asks for.
struct Asked {
    /// Lines, of those that hit the root's box.
    lines: f64,
    /// Whether the trial tells the variance well enough.
    known: bool,
}

/// N = (z s / (E C))^2, with s taken larger and C smaller than the trial shows them.
fn asked(error: f64, trial: &ScoreMoments<2>) -> Asked {
    let (Some([mean, _]), Some([[variance, with_square], [_, of_square]])) =
        (trial.mean(), trial.covariance())
    else {
        // No two lines that hit the root's box: nothing to be known, so all that may be drawn.
        return Asked {
            lines: f64::INFINITY,
            known: false,
        };
    };
    if variance <= 0.0 {
        return Asked {
            lines: 0.0,
            known: true,
        };
    }
    let n = trial.n() as f64;
    // Variance of (C - mean)^2, so that of the sample's variance.
    let of_variance = of_square - 4.0 * mean * with_square + 4.0 * mean * mean * variance;
    let uncertain = CAUTION * (of_variance.max(0.0) / n).sqrt();
    let off = CAUTION * (variance / n).sqrt();
    let least_mean = mean - off;
    let z = normal_quantile(CONFIDENCE);
    let lines = if least_mean > 0.0 {
        z * z * (variance + uncertain) / (error * error * least_mean * least_mean)
    } else {
        f64::INFINITY
    };
    Asked {
        lines,
        known: uncertain <= KNOWN * variance && off <= 0.25 * KNOWN * mean,
    }
}

/// Whether every C came out as well known as was wanted. A row: where, C, and its standard error; without one it is not known.
pub fn verdict(
    error: f64,
    rows: impl Iterator<Item = (String, f64, Option<f64>)>,
) -> Option<Verdict> {
    let z = normal_quantile(CONFIDENCE);
    let half = |(place, c, se): (String, f64, Option<f64>)| {
        let share = match se {
            Some(se) if se <= 0.0 => 0.0,
            Some(se) => z * se / c,
            None => f64::INFINITY,
        };
        (share, place)
    };
    let rows: Vec<(f64, String)> = rows.map(half).collect();
    let (known, unknown): (Vec<_>, Vec<_>) = rows.iter().partition(|row| row.0.is_finite());
    let (widest, place) = known.iter().max_by(|a, b| a.0.total_cmp(&b.0))?;
    let within = known.iter().filter(|row| row.0 <= error).count();
    let unknown = match unknown.len() {
        0 => String::new(),
        n => format!("; {n} not known: their variance hangs on events too rare for the pilot"),
    };
    Some(Verdict {
        name: "error".into(),
        held: within == rows.len(),
        message: format!(
            "95 % interval of C within ± {} % in {within} of {} cases; widest {:.3} % ({place}){unknown}",
            100.0 * error,
            rows.len(),
            100.0 * widest
        ),
    })
}

/// The same of cells and of the rays of sources through them, where an error was wanted.
pub fn of_records(
    error: Option<f64>,
    cells: &[CellRecord],
    work: &[&WorkRecord],
) -> Option<Verdict> {
    let cell = |r: &CellRecord| {
        let place = format!("{} on {}", r.strategy, r.scene);
        (place, r.c_counted, r.c_se)
    };
    let set = |r: &&WorkRecord| {
        let place = format!("{} of {} on {}", r.rays, r.strategy, r.scene);
        (place, r.c_counted, r.c_se)
    };
    let sampled = work.iter().filter(|r| !r.complete && r.entered > 0);
    verdict(error?, cells.iter().map(cell).chain(sampled.map(set)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Costs of known mean 1 and variance.
    fn two_valued(i: u64, rare: u64) -> Option<f64> {
        let r = rare as f64;
        // A hash, so that any stretch of lines is as good as random.
        let hash = i.wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(29);
        let hash = hash.wrapping_mul(0xbf58_476d_1ce4_e5b9) >> 32;
        Some(if hash.is_multiple_of(rare) { r } else { 0.0 })
    }

    #[test]
    fn the_number_follows_variance_and_error() {
        // Mean 1, variance rare - 1.
        for (rare, error) in [(2, 0.01), (2, 0.1), (10, 0.01), (50, 0.02)] {
            let exact = normal_quantile(CONFIDENCE).powi(2) * (rare - 1) as f64 / (error * error);
            let n = needed(error, [1, 1 << 30], |i, _| two_valued(i, rare)) as f64;
            let most = if exact < 4096.0 { 2.5 } else { 1.5 };
            assert!(exact < n && n < most * exact, "{n} for {exact}");
        }
    }

    #[test]
    fn lines_that_miss_are_made_up_for() {
        let all = needed(0.001, [1, 1 << 30], |i, _| two_valued(i, 2)) as f64;
        let half = needed(0.001, [1, 1 << 30], |i, _| {
            two_valued(i / 2, 2).filter(|_| i.is_multiple_of(2))
        });
        let ratio = half as f64 / all;
        assert!((1.8..2.2).contains(&ratio), "{ratio}");
    }

    #[test]
    fn bounds_hold_and_nothing_to_know_takes_what_there_is() {
        assert_eq!(needed(0.01, [100, 1000], |_, _| Some(7.0)), 100);
        assert_eq!(needed(0.01, [100, 1000], |_, _| Some(0.0)), 100);
        assert_eq!(needed(0.01, [100, 1000], |_, _| None), 1000);
        assert_eq!(needed(1e-6, [100, 1000], |i, _| Some((i % 2) as f64)), 1000);
    }

    #[test]
    fn the_number_does_not_depend_on_the_threads() {
        let one = rayon::ThreadPoolBuilder::new().num_threads(1).build();
        let one = one.expect("a pool");
        let cost = |i, _: &mut Stack| two_valued(i, 7).map(|c| c + 0.1);
        let alone = one.install(|| needed(0.003, [1, 1 << 30], cost));
        assert_eq!(needed(0.003, [1, 1 << 30], cost), alone);
    }
}
