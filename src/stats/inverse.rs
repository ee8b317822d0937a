//! Quantiles of the chi-square and F distributions, for intervals of mean squares and of their ratios.
//!
//! The idea: the tails are known to many digits, so a quantile is found by halving an interval of its logarithm. Source of
//! the incomplete gamma function: the crate `statrs`.

use statrs::function::gamma::gamma_lr;

use super::tails::f_tail;

/// The value that a chi-square variable of so many degrees of freedom is below with probability p.
///
/// # Panics
/// If p is not strictly between 0 and 1, or there are no degrees of freedom.
pub fn chi_square_quantile(p: f64, degrees_of_freedom: f64) -> f64 {
    assert!(degrees_of_freedom > 0.0, "no degrees of freedom");
    inverse(p, |x| gamma_lr(0.5 * degrees_of_freedom, 0.5 * x))
}

/// The value that an F variable with (d1, d2) degrees of freedom is below with probability p.
///
/// # Panics
/// As [`chi_square_quantile`].
pub fn f_quantile(p: f64, d1: f64, d2: f64) -> f64 {
    inverse(p, |x| 1.0 - f_tail(x, d1, d2))
}

/// Where a distribution function of a positive variable passes p.
fn inverse(p: f64, below: impl Fn(f64) -> f64) -> f64 {
    assert!(p > 0.0 && p < 1.0, "probability {p} is not in (0, 1)");
    let (mut low, mut high) = (f64::MIN_POSITIVE, 1e300_f64);
    // The logarithm's width halves: 80 steps leave less than an ulp.
    for _ in 0..80 {
        let middle = low.sqrt() * high.sqrt();
        if below(middle) < p {
            low = middle;
        } else {
            high = middle;
        }
    }
    low.sqrt() * high.sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn published_values() {
        // NIST/SEMATECH e-Handbook, 1.3.6.7.4 and 1.3.6.7.3.
        for (p, degrees, value) in [
            (0.95, 1.0, 3.841),
            (0.025, 10.0, 3.247),
            (0.975, 10.0, 20.483),
            (0.025, 32.0, 18.291),
            (0.975, 32.0, 49.480),
            (0.999, 100.0, 149.449),
        ] {
            let found = chi_square_quantile(p, degrees);
            assert!((found - value).abs() < 6e-4, "{found} for {value}");
        }
        for (d1, d2, value) in [(1.0, 1.0, 161.448), (10.0, 10.0, 2.978), (5.0, 60.0, 2.368)] {
            let found = f_quantile(0.95, d1, d2);
            assert!((found - value).abs() < 6e-4, "{found} for {value}");
            let other = 1.0 / f_quantile(0.05, d2, d1);
            assert!((found / other - 1.0).abs() < 1e-9, "{found} {other}");
        }
    }
}
