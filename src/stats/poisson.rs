//! Intervals of the rates of rare events, that come one by one or in clusters.

use statrs::function::gamma::gamma_lr;

/// Both ends of the interval of the mean of a sum of counts that come in clusters, from the sum of the clusters' counts and the
/// sum of their squares: the exact interval of n = sum^2 / squares clusters of squares / sum each, n being no whole number (the
/// scaled Poisson distribution of Bohm & Zech 2014, Nucl. Instrum. Methods A 748:1, section 2). Clusters of one count have Garwood's
/// interval; of none it is assumed that they would be of one count.
///
/// # Panics
/// If the level is not strictly between 0 and 1.
pub fn clustered_interval(sum: u64, squares: u64, level: f64) -> [f64; 2] {
    if sum == 0 {
        return poisson_interval(0.0, level);
    }
    let scale = squares as f64 / sum as f64;
    poisson_interval(sum as f64 / scale, level).map(|mean| scale * mean)
}

/// Both ends of the exact (Garwood 1936, Biometrika 28:437) interval of the mean of a Poisson count, continued to real counts by
/// its quantiles of chi-square with 2 count and 2 count + 2 degrees of freedom: each tail has half of what `level` leaves.
fn poisson_interval(count: f64, level: f64) -> [f64; 2] {
    assert!(level > 0.0 && level < 1.0, "level {level} is not in (0, 1)");
    let tail = 0.5 * (1.0 - level);
    // P(X >= k) of mean x is the regularised lower incomplete gamma function P(k, x).
    let lower = if count == 0.0 {
        0.0
    } else {
        mean_with(count, tail)
    };
    [lower, mean_with(count + 1.0, 1.0 - tail)]
}

/// The mean x with P(X >= k) = `tail`, by bisection: the probability grows with x.
fn mean_with(k: f64, tail: f64) -> f64 {
    let (mut below, mut above) = (0.0, k + 40.0 * (k + 1.0).sqrt() + 40.0);
    for _ in 0..200 {
        let middle = 0.5 * (below + above);
        if gamma_lr(k, middle) < tail {
            below = middle;
        } else {
            above = middle;
        }
    }
    above
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::rngs::ChaCha8Rng;
    use rand::{RngExt, SeedableRng};

    /// Tables of Garwood's interval; for 0 the upper end is -ln 0.025; large counts are nearly normal.
    #[test]
    fn known_intervals() {
        for (count, [lo, hi]) in [
            (0.0, [0.0, 3.688_879_454_113_936]),
            (1.0, [0.025_317_807_984_289_897, 5.571_643_390_938_898]),
            (10.0, [4.795_389, 18.390_356]),
        ] {
            let [a, b] = poisson_interval(count, 0.95);
            assert!(
                (a - lo).abs() < 1e-5 && (b - hi).abs() < 1e-5,
                "{count}: {a} {b}"
            );
        }
        let [lo, hi] = poisson_interval(1e8, 0.95);
        assert!(
            (lo - 1e8 + 19_600.0).abs() < 10.0 && (hi - 1e8 - 19_600.0).abs() < 10.0,
            "{lo} {hi}"
        );
    }

    /// Three clusters of 2: twice the interval of three; chi-square quantiles of 6 and 8 degrees of freedom, halved.
    #[test]
    fn clusters_scale_the_interval() {
        let [lo, hi] = clustered_interval(6, 12, 0.95);
        assert!((lo - 2.0 * 0.618_672).abs() < 1e-5 && (hi - 2.0 * 8.767_273).abs() < 1e-5);
        assert_eq!(clustered_interval(0, 0, 0.95), poisson_interval(0.0, 0.95));
    }

    /// Of 4,000 lines one in a hundred errs, in 1, 2, 3, ... nodes with probability 1/3, 2/9, 4/27, ...: a mean of 120 errors, with
    /// a variance five times as large. 400 runs at a level of 95 %: 380 intervals are expected to hold it, with a standard
    /// deviation of 4; the interval of so many independent errors holds it in far fewer.
    #[test]
    fn intervals_of_clustered_errors_cover() {
        let mut random = ChaCha8Rng::seed_from_u64(11);
        let mut covered = [0; 2];
        for _ in 0..400 {
            let (mut sum, mut squares) = (0u64, 0u64);
            for _ in 0..4_000 {
                if random.random_bool(0.01) {
                    let mut errors = 1u64;
                    while random.random_bool(2.0 / 3.0) {
                        errors += 1;
                    }
                    sum += errors;
                    squares += errors * errors;
                }
            }
            let both = [squares, sum].map(|squares| clustered_interval(sum, squares, 0.95));
            for (count, [lo, hi]) in covered.iter_mut().zip(both) {
                *count += u64::from(lo <= 120.0 && 120.0 <= hi);
            }
        }
        assert!(covered[0] >= 360 && covered[1] < 300, "{covered:?}");
    }
}
