//! Kolmogorov's test, whether numbers look uniform in 0 to 1: for p-values of many runs.
//!
//! Stephens (1970, JRSS B 32): with D the largest distance between the empirical and the true distribution function,
//! (sqrt(n) + 0.12 + 0.11/sqrt(n)) D follows Kolmogorov's limit closely for any n.

/// The p-value of uniformity; `None` for no numbers.
///
/// # Panics
/// If a number is NaN or not in 0 to 1.
pub fn uniform_p(numbers: &[f64]) -> Option<f64> {
    let mut sorted = numbers.to_vec();
    assert!(
        sorted.iter().all(|x| (0.0..=1.0).contains(x)),
        "not in 0 to 1"
    );
    sorted.sort_by(f64::total_cmp);
    let n = sorted.len() as f64;
    let apart = |(i, x): (usize, &f64)| (x - i as f64 / n).max((i + 1) as f64 / n - x);
    let distance = sorted.iter().enumerate().map(apart).reduce(f64::max)?;
    let root = n.sqrt();
    Some(kolmogorov((root + 0.12 + 0.11 / root) * distance))
}

/// The probability that Kolmogorov's limit exceeds x: 2 sum (-1)^(k-1) exp(-2 k^2 x^2).
fn kolmogorov(x: f64) -> f64 {
    // Below, the series alternates between numbers near 1 and the probability is 1 to 12 digits.
    if x < 0.18 {
        return 1.0;
    }
    let term = |k: i32| {
        let sign = if k % 2 == 1 { 2.0 } else { -2.0 };
        sign * libm::exp(-2.0 * f64::from(k * k) * x * x)
    };
    (1..=100).map(term).sum::<f64>().clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_limit_against_published_values() {
        // Smirnov (1948): quantiles 0.90, 0.95 and 0.99.
        for (x, p) in [(1.22385, 0.10), (1.35810, 0.05), (1.62762, 0.01)] {
            assert!((kolmogorov(x) - p).abs() < 1e-5);
        }
        assert!((kolmogorov(0.2) - 1.0).abs() < 1e-9);
    }

    #[test]
    fn even_numbers_pass_and_crowded_ones_do_not() {
        let even: Vec<f64> = (0..1000).map(|i| (f64::from(i) + 0.5) / 1000.0).collect();
        assert!(uniform_p(&even).expect("numbers") > 0.999);
        let crowded: Vec<f64> = even.iter().map(|x| x * x).collect();
        assert!(uniform_p(&crowded).expect("numbers") < 1e-12);
        // Off by 0.05 of 1000: x = 1.59.
        let shifted: Vec<f64> = even.iter().map(|x| (x + 0.05).min(1.0)).collect();
        let p = uniform_p(&shifted).expect("numbers");
        assert!((0.005..0.03).contains(&p), "{p}");
        assert_eq!(uniform_p(&[]), None);
    }
}
