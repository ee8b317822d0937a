//! Percentile intervals from a bootstrap of clusters.
//!
//! The idea: observations of one cluster (the cells of one scene) depend on each other in ways nobody knows, so whole
//! clusters are drawn with replacement and the estimate is repeated on each draw; the middle of its values is the
//! interval. Source: Davison and Hinkley, "Bootstrap Methods and their Application" (1997), 3.8 and 5.3. With few
//! clusters such intervals are too short: of a mean by about the factor sqrt(1 - 1/clusters), before the tails of
//! Student's t are counted.
//!
//! The invariant: the draws depend on the seed and the number of clusters only, so estimates made with the same seed are
//! paired.

use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};

use super::quantile::quantile_of_sorted;

/// The two-sided interval of the given level of each quantity that `estimate` makes of drawn cluster numbers
/// (`clusters` of them, in 0..clusters).
///
/// A draw from which a quantity cannot be had (`None`, or a value that is not finite) is taken to lie beyond whichever
/// end of its interval is asked for. So missing draws never make an interval shorter, and a quantity has none where more
/// are missing than lie outside. Empty if no draw has an estimate.
///
/// # Panics
/// If there are no clusters, the level is not strictly between 0 and 1, or two estimates differ in length.
///
/// ```
/// use sahlab::stats::cluster_bootstrap;
///
/// // The mean of six scenes' ratios, with its 95 % interval.
/// let ratios = [1.1, 0.9, 1.3, 1.0, 1.2, 1.1];
/// let mean = |scenes: &[usize]| {
///     let sum: f64 = scenes.iter().map(|&scene| ratios[scene]).sum();
///     Some(vec![sum / scenes.len() as f64])
/// };
/// let interval = cluster_bootstrap(ratios.len(), 2000, 1, 0.95, mean)[0];
/// assert!(matches!(interval, Some((from, to)) if 0.95 < from && from < 1.1 && 1.1 < to && to < 1.25));
/// ```
pub fn cluster_bootstrap(
    clusters: usize,
    draws: usize,
    seed: u64,
    level: f64,
    estimate: impl Fn(&[usize]) -> Option<Vec<f64>>,
) -> Vec<Option<(f64, f64)>> {
    assert!(clusters > 0, "no clusters to draw from");
    assert!(level > 0.0 && level < 1.0, "level {level} is not in (0, 1)");
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut drawn = vec![0; clusters];
    let estimates: Vec<Vec<f64>> = (0..draws)
        .filter_map(|_| {
            drawn.fill_with(|| random.random_range(0..clusters));
            estimate(&drawn)
        })
        .collect();
    let quantities = estimates.first().map_or(0, Vec::len);
    for values in &estimates {
        let found = values.len();
        assert!(found == quantities, "{found} estimates, not {quantities}");
    }
    (0..quantities)
        .map(|q| {
            let values = estimates.iter().map(|values| values[q]);
            percentiles(values.filter(|v| v.is_finite()).collect(), draws, level)
        })
        .collect()
}

/// The middle of `draws` values of which only these are known, the others beyond either end.
fn percentiles(mut known: Vec<f64>, draws: usize, level: f64) -> Option<(f64, f64)> {
    known.sort_by(f64::total_cmp);
    let missing = draws - known.len();
    let with_missing = |at: usize, value: f64| {
        let mut values = known.clone();
        values.splice(at..at, vec![value; missing]);
        values
    };
    let outside = 0.5 * (1.0 - level);
    let low = quantile_of_sorted(&with_missing(0, f64::NEG_INFINITY), outside)?;
    let high = quantile_of_sorted(&with_missing(known.len(), f64::INFINITY), 1.0 - outside)?;
    (low.is_finite() && high.is_finite()).then_some((low, high))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stats::normal_quantile;

    /// A sample of the size: sums of twelve uniforms, nearly normal with variance 1.
    fn bells(size: usize) -> Vec<f64> {
        let mut random = ChaCha8Rng::seed_from_u64(1990);
        let mut bell = || (0..12).map(|_| random.random::<f64>()).sum::<f64>() - 6.0;
        (0..size).map(|_| bell()).collect()
    }

    fn mean(values: &[f64], drawn: &[usize]) -> f64 {
        drawn.iter().map(|&i| values[i]).sum::<f64>() / drawn.len() as f64
    }

    #[test]
    fn a_mean_has_the_interval_of_normal_theory() {
        let values = bells(400);
        let all: Vec<usize> = (0..400).collect();
        let centre = mean(&values, &all);
        let squares: f64 = values.iter().map(|v| (v - centre).powi(2)).sum();
        let standard_error = (squares / 400.0).sqrt() / 20.0;
        for level in [0.5, 0.95, 0.99] {
            let found = cluster_bootstrap(400, 10_000, 1, level, |drawn| {
                Some(vec![mean(&values, drawn)])
            });
            let (low, high) = found[0].unwrap();
            // An end is a quantile of 10^4 draws: uncertain by sqrt(p (1 - p)) / (100 * density), 1.4 % to 4.9 % of a
            // standard error, and a width by 7 % at most. The bounds are three such deviations.
            let width = 2.0 * normal_quantile(level);
            let error = (high - low) / standard_error - width;
            assert!(error.abs() < 0.2, "{level}: {error}");
            let middle = (0.5 * (high + low) - centre) / standard_error;
            assert!(middle.abs() < 0.1, "{level}: {middle}");
        }
    }

    #[test]
    fn clusters_are_what_counts() {
        // 40 clusters of 10 equal observations: as uncertain as 40 observations, not as 400.
        let values = bells(40);
        let interval = |repeated: usize| {
            let found = cluster_bootstrap(40, 500, 3, 0.9, |drawn| {
                let rows: Vec<usize> = drawn.iter().flat_map(|&i| vec![i; repeated]).collect();
                Some(vec![mean(&values, &rows)])
            });
            found[0].unwrap()
        };
        let (one, ten) = (interval(1), interval(10));
        assert!((one.0 - ten.0).abs() + (one.1 - ten.1).abs() < 1e-12);
    }

    #[test]
    fn the_seed_decides() {
        let values = bells(30);
        let run = |seed, level| {
            cluster_bootstrap(30, 200, seed, level, |drawn| {
                let mean = mean(&values, drawn);
                Some(vec![mean, -mean])
            })
        };
        assert_eq!(run(5, 0.9), run(5, 0.9));
        assert_ne!(run(5, 0.9), run(6, 0.9));
        // The same draws give both quantities, and the wider interval holds the narrower.
        let [Some(plus), Some(minus)] = run(5, 0.9)[..] else {
            panic!("no intervals");
        };
        assert!((plus.0 + minus.1).abs() + (plus.1 + minus.0).abs() < 1e-15);
        let wide = run(5, 0.99)[0].unwrap();
        assert!(wide.0 < plus.0 && plus.1 < wide.1);
    }

    #[test]
    fn draws_hold_every_cluster_equally_often() {
        let counts = std::cell::RefCell::new([0_u32; 7]);
        let none = cluster_bootstrap(7, 10_000, 2, 0.95, |drawn| {
            assert_eq!(drawn.len(), 7);
            let mut counts = counts.borrow_mut();
            drawn.iter().for_each(|&i| counts[i] += 1);
            None
        });
        assert!(none.is_empty());
        // 70000 numbers: 10000 of each, standard deviation sqrt(70000 * 6) / 7 = 93.
        for count in counts.into_inner() {
            assert!(count.abs_diff(10_000) < 400, "{count}");
        }
    }

    #[test]
    fn missing_draws_lie_beyond_either_end() {
        // 101 draws: positions 5 and 95 of 0..100 at level 0.9.
        let values = |known: usize| (0..known).map(|i| i as f64).collect::<Vec<f64>>();
        let near = |found: Option<(f64, f64)>, low: f64, high: f64| {
            let (a, b) = found.unwrap();
            assert!((a - low).abs() + (b - high).abs() < 1e-9, "{a} {b}");
        };
        near(percentiles(values(101), 101, 0.9), 5.0, 95.0);
        near(percentiles(values(98), 101, 0.9), 2.0, 95.0);
        assert_eq!(percentiles(values(95), 101, 0.9), None);
        assert_eq!(percentiles(vec![], 101, 0.9), None);
        assert_eq!(percentiles(vec![], 0, 0.9), None);
        // A value that is not finite is missing too, for its own quantity only.
        let some = cluster_bootstrap(2, 50, 1, 0.9, |drawn| {
            let different = if drawn[0] == drawn[1] { f64::NAN } else { 1.0 };
            Some(vec![different, 2.0])
        });
        assert_eq!(some, [None, Some((2.0, 2.0))]);
    }

    #[test]
    #[should_panic(expected = "level 95 is not in (0, 1)")]
    fn a_level_in_percent_is_refused() {
        cluster_bootstrap(3, 10, 1, 95.0, |_| None);
    }
}
