//! Quantiles of a sample.
//!
//! The idea: the sorted values are the corners of a polygon over [0, 1], equally spaced, and a quantile is read off the
//! polygon. Source: definition 7 of Hyndman and Fan, "Sample quantiles in statistical packages" (American Statistician
//! 50, 1996), the default of R. The invariant: a quantile lies between two neighbours of the sorted values, or is one.

/// The value below which about this share of the values lies. `None` of nothing, and halfway from -infinity to infinity.
///
/// # Panics
/// If a value is NaN or the share is not in [0, 1].
pub fn quantile(values: &[f64], share: f64) -> Option<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    quantile_of_sorted(&sorted, share)
}

/// The middle value, or the mean of the two in the middle. `None` of nothing.
///
/// # Panics
/// If a value is NaN.
pub fn median(values: &[f64]) -> Option<f64> {
    quantile(values, 0.5)
}

/// [`quantile`] of values in ascending order, where several are wanted of the same.
///
/// # Panics
/// If the first or last value is NaN (as one is, if any, after [`f64::total_cmp`]), or the share is not in [0, 1].
pub fn quantile_of_sorted(sorted: &[f64], share: f64) -> Option<f64> {
    assert!(
        (0.0..=1.0).contains(&share),
        "share {share} is not in [0, 1]"
    );
    let (first, last) = sorted.first().zip(sorted.last())?;
    assert!(!first.is_nan() && !last.is_nan(), "a value is not a number");
    let position = share * (sorted.len() - 1) as f64;
    let below = position as usize;
    let (low, beyond) = (sorted[below], position - below as f64);
    // At a corner the next value, which may be infinite or missing, has no say.
    let high = if beyond > 0.0 { sorted[below + 1] } else { low };
    let value = if low == high || (low == f64::NEG_INFINITY && high.is_finite()) {
        low
    } else {
        // In this form, rounded or not, a larger share never gives a smaller value.
        (low + beyond * (high - low)).clamp(low, high)
    };
    (!value.is_nan()).then_some(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn by_hand() {
        // Sorted 1 1 2 3 4 5 6 9, positions 7 p: 0, 0.7, 1.75, 2.1, 3.5, 6.3, 7.
        let values = [3.0, 1.0, 4.0, 1.0, 5.0, 9.0, 2.0, 6.0];
        let expected = [
            (0.0, 1.0),
            (0.1, 1.0),
            (0.25, 1.75),
            (0.3, 2.1),
            (0.5, 3.5),
            (0.9, 6.9),
            (1.0, 9.0),
        ];
        for (share, expected) in expected {
            let found = quantile(&values, share).unwrap();
            assert!((found - expected).abs() < 1e-14, "{share}: {found}");
        }
        assert_eq!(median(&values), Some(3.5));
        assert_eq!(median(&[7.0, -1.0, 2.0]), Some(2.0));
    }

    #[test]
    fn few_values() {
        assert_eq!(median(&[]), None);
        for share in [0.0, 0.3, 1.0] {
            assert_eq!(quantile(&[4.0], share), Some(4.0));
            assert_eq!(quantile(&[0.1, 0.1, 0.1], share), Some(0.1));
        }
        assert_eq!(quantile(&[10.0, 20.0], 0.05), Some(10.5));
    }

    #[test]
    fn a_share_never_lowers_a_quantile() {
        let values = [0.3, 0.3 + f64::EPSILON, 0.7, -2.0, 1e300, -1e300, 0.3];
        let shares = (0..=1000).map(|i| f64::from(i) / 1000.0);
        let found: Vec<f64> = shares.map(|p| quantile(&values, p).unwrap()).collect();
        assert!(found.is_sorted());
        assert_eq!((found[0], found[1000]), (-1e300, 1e300));
    }

    #[test]
    fn infinite_values_are_ends() {
        let infinity = f64::INFINITY;
        let values = [infinity, -infinity, 1.0, 2.0];
        let found = [0.0, 0.2, 1.0 / 3.0, 0.5, 0.9].map(|p| quantile(&values, p).unwrap());
        assert_eq!(found, [-infinity, -infinity, 1.0, 1.5, infinity]);
        assert_eq!(median(&[-infinity, infinity]), None);
    }

    #[test]
    #[should_panic(expected = "a value is not a number")]
    fn nan_is_refused() {
        median(&[1.0, f64::NAN, 2.0]);
    }

    #[test]
    #[should_panic(expected = "share 1.5 is not in [0, 1]")]
    fn a_share_beyond_one_is_refused() {
        quantile(&[1.0], 1.5);
    }
}
