//! The exact interval of a Poisson mean, for rates of rare events.

use statrs::function::gamma::gamma_lr;

/// Both ends of the exact (Garwood 1936, Biometrika 28:437) interval of the mean of a Poisson count: each tail has half of what
/// `level` leaves.
///
/// # Panics
/// If the level is not strictly between 0 and 1.
pub fn poisson_interval(count: u64, level: f64) -> [f64; 2] {
    assert!(level > 0.0 && level < 1.0, "level {level} is not in (0, 1)");
    let k = count as f64;
    let tail = 0.5 * (1.0 - level);
    // P(X >= k) of mean x is the regularised lower incomplete gamma function P(k, x).
    let lower = if count == 0 { 0.0 } else { mean_with(k, tail) };
    [lower, mean_with(k + 1.0, 1.0 - tail)]
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

    /// Tables of Garwood's interval; for 0 the upper end is -ln 0.025; large counts are nearly normal.
    #[test]
    fn known_intervals() {
        for (count, [lo, hi]) in [
            (0, [0.0, 3.688_879_454_113_936]),
            (1, [0.025_317_807_984_289_897, 5.571_643_390_938_898]),
            (10, [4.795_389, 18.390_356]),
        ] {
            let [a, b] = poisson_interval(count, 0.95);
            assert!(
                (a - lo).abs() < 1e-5 && (b - hi).abs() < 1e-5,
                "{count}: {a} {b}"
            );
        }
        let [lo, hi] = poisson_interval(100_000_000, 0.95);
        assert!(
            (lo - 1e8 + 19_600.0).abs() < 10.0 && (hi - 1e8 - 19_600.0).abs() < 10.0,
            "{lo} {hi}"
        );
    }
}
