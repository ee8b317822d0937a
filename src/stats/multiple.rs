//! Several tests, one error rate.
//!
//! The idea: Holm's step-down correction keeps the chance of any false rejection below the family level whatever the
//! dependence between the tests. Source: Holm, "A simple sequentially rejective multiple test procedure" (Scand. J.
//! Statist. 6, 1979). The invariant: the adjusted p-values keep the order of the given ones and lie in [0, 1].

/// The p-values adjusted by Holm's method, in the order given.
///
/// A hypothesis is rejected at family level L where its adjusted p-value is at most L: the k-th smallest of m becomes
/// the largest of (m - j + 1) p_j over j = 1..k, capped at 1.
///
/// # Panics
/// If a p-value is not in [0, 1].
///
/// ```
/// use sahlab::stats::holm;
///
/// // One small p-value of three is not small enough, if any would have done.
/// assert_eq!(holm(&[0.5, 0.03125, 0.75]), [1.0, 0.09375, 1.0]);
/// ```
pub fn holm(p: &[f64]) -> Vec<f64> {
    for value in p {
        assert!(
            (0.0..=1.0).contains(value),
            "p-value {value} is not in [0, 1]"
        );
    }
    let mut order: Vec<usize> = (0..p.len()).collect();
    order.sort_by(|&i, &j| p[i].total_cmp(&p[j]));

    let mut adjusted = vec![0.0; p.len()];
    let mut largest = 0.0_f64;
    for (rank, &i) in order.iter().enumerate() {
        largest = largest.max(((p.len() - rank) as f64 * p[i]).min(1.0));
        adjusted[i] = largest;
    }
    adjusted
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn by_hand() {
        // Sorted: 0.01 * 4, 0.02 * 3, 0.03 * 2, 0.3 * 1; none falls below its predecessor.
        assert_eq!(holm(&[0.03, 0.01, 0.3, 0.02]), [0.06, 0.04, 0.3, 0.06]);
        // 0.02 * 3 = 0.06, then 0.025 * 2 = 0.05 is lifted to 0.06, and 0.9 stays.
        assert_eq!(holm(&[0.02, 0.025, 0.9]), [0.06, 0.06, 0.9]);
        assert_eq!(holm(&[0.5, 0.6]), [1.0, 1.0]);
        assert_eq!(holm(&[0.04]), [0.04]);
        assert_eq!(holm(&[0.0, 1.0]), [0.0, 1.0]);
        assert!(holm(&[]).is_empty());
    }

    #[test]
    fn every_order_gives_the_same() {
        let p = [0.001, 0.2, 0.04, 0.04, 0.011];
        let adjusted = holm(&p);
        let mut order = [0, 1, 2, 3, 4];
        // All rotations of all reversals of prefixes: 50 orders.
        for turn in 0..5 {
            for prefix in 1..=5 {
                order[..prefix].reverse();
                order.rotate_left(turn);
                let given: Vec<f64> = order.iter().map(|&i| p[i]).collect();
                let expected: Vec<f64> = order.iter().map(|&i| adjusted[i]).collect();
                assert_eq!(holm(&given), expected);
            }
        }
    }

    #[test]
    #[should_panic(expected = "p-value NaN is not in [0, 1]")]
    fn nan_is_refused() {
        holm(&[0.5, f64::NAN]);
    }
}
