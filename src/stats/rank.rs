//! How far two quantities put the same things into the same order.
//!
//! The idea: count the pairs of things that both quantities order alike and those they order oppositely ([`Pairs`]);
//! Kendall's tau-b is their difference on a scale from -1 to 1, Spearman's rho the correlation of the ranks. Sources:
//! Kendall, "The treatment of ties in ranking problems" (Biometrika 33, 1945); Spearman, "The proof and measurement of
//! association between two things" (American Journal of Psychology 15, 1904).
//!
//! The invariant: only the order of the values matters, so a strictly increasing function of either side changes
//! nothing; exchanging the sides changes nothing; reversing one side changes the sign only.

/// Pairs of things by how two quantities order them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Pairs {
    /// Pairs that both order the same way: concordant.
    pub right: u64,
    /// Pairs that they order oppositely: discordant.
    pub wrong: u64,
    /// Pairs that at least one of them does not order.
    pub tied: u64,
}

/// Compares all pairs, in time proportional to their number.
///
/// # Panics
/// If the lengths differ or a value is NaN.
pub fn concordant(a: &[f64], b: &[f64]) -> Pairs {
    compare(a, b).0
}

/// Kendall's tau-b: (right - wrong) / sqrt(pairs not tied in a * pairs not tied in b). `None` where one side is
/// constant, so also for less than two things. Takes time proportional to the number of pairs.
///
/// # Panics
/// If the lengths differ or a value is NaN.
///
/// ```
/// use sahlab::stats::kendall_tau_b;
///
/// // Three trees' costs, predicted and counted: of the three pairs, one is the other way round.
/// assert_eq!(kendall_tau_b(&[1.0, 2.0, 3.0], &[10.0, 30.0, 20.0]), Some(1.0 / 3.0));
/// ```
pub fn kendall_tau_b(a: &[f64], b: &[f64]) -> Option<f64> {
    let (Pairs { right, wrong, .. }, [ordered_a, ordered_b]) = compare(a, b);
    // The root of a square is exact: perfect agreement is 1, not nearly 1.
    let scale = (ordered_a as f64 * ordered_b as f64).sqrt();
    (scale > 0.0).then(|| (right as f64 - wrong as f64) / scale)
}

/// Which thing one takes who goes by a prediction, and what it costs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Taken {
    /// Number of the thing of the least predicted cost; of several the first.
    pub taken: usize,
    /// Number of the cheapest thing; of several the first.
    pub cheapest: usize,
    /// By what share the thing taken costs more than the cheapest: 0 where it costs the same; `None` where the cheapest costs
    /// nothing and it something.
    pub regret: Option<f64>,
}

/// Take the thing of the least predicted cost; `None` without things. No cost is negative.
///
/// # Panics
/// If the lengths differ or a value is NaN.
pub fn take_least(predicted: &[f64], cost: &[f64]) -> Option<Taken> {
    check(predicted, cost);
    let least = |of: &[f64]| (0..of.len()).min_by(|&i, &j| of[i].total_cmp(&of[j]));
    let (taken, cheapest) = (least(predicted)?, least(cost)?);
    let regret = if cost[taken] == cost[cheapest] {
        0.0
    } else {
        cost[taken] / cost[cheapest] - 1.0
    };
    Some(Taken {
        taken,
        cheapest,
        regret: regret.is_finite().then_some(regret),
    })
}

/// Spearman's rho: the correlation of the ranks, tied values sharing the mean of theirs. `None` where one side is
/// constant, so also for less than two things.
///
/// # Panics
/// If the lengths differ or a value is NaN.
pub fn spearman_rho(a: &[f64], b: &[f64]) -> Option<f64> {
    check(a, b);
    let (a, b) = (centred_ranks(a), centred_ranks(b));
    let product = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| x * y).sum::<f64>();
    let scale = (product(&a, &a) * product(&b, &b)).sqrt();
    (scale > 0.0).then(|| (product(&a, &b) / scale).clamp(-1.0, 1.0))
}

fn check(a: &[f64], b: &[f64]) {
    let (left, right) = (a.len(), b.len());
    assert!(left == right, "{left} values against {right}");
    let known = |values: &[f64]| values.iter().all(|v| !v.is_nan());
    assert!(known(a) && known(b), "a value is not a number");
}

/// All pairs compared, and how many of them a and b order.
fn compare(a: &[f64], b: &[f64]) -> (Pairs, [u64; 2]) {
    check(a, b);
    let sign = |u: f64, v: f64| i8::from(u > v) - i8::from(u < v);
    let (mut pairs, mut ordered) = (Pairs::default(), [0; 2]);
    for (j, (&u, &v)) in a.iter().zip(b).enumerate() {
        for (&x, &y) in a[..j].iter().zip(&b[..j]) {
            let (in_a, in_b) = (sign(u, x), sign(v, y));
            let both = in_a * in_b;
            pairs.right += u64::from(both > 0);
            pairs.wrong += u64::from(both < 0);
            pairs.tied += u64::from(both == 0);
            ordered[0] += u64::from(in_a != 0);
            ordered[1] += u64::from(in_b != 0);
        }
    }
    (pairs, ordered)
}

/// Ranks less their mean, multiples of 1/2: their products add up without rounding for 10^5 values and fewer.
fn centred_ranks(values: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&i, &j| values[i].total_cmp(&values[j]));
    let mut ranks = vec![0.0; values.len()];
    let mut first = 0;
    for tied in order.chunk_by(|&i, &j| values[i] == values[j]) {
        // With ranks from 0, those of the tied have the mean (first + last) / 2, and all have (n - 1) / 2.
        let last = first + tied.len() - 1;
        let rank = 0.5 * ((first + last) as f64 - (values.len() - 1) as f64);
        tied.iter().for_each(|&i| ranks[i] = rank);
        first = last + 1;
    }
    ranks
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::rngs::ChaCha8Rng;
    use rand::{RngExt, SeedableRng};

    fn close(found: Option<f64>, expected: f64) {
        let found = found.unwrap();
        assert!((found - expected).abs() < 1e-15, "{found} not {expected}");
    }

    #[test]
    fn what_is_taken_and_what_it_costs() {
        let found = take_least(&[2.0, 1.0, 1.0], &[4.0, 5.0, 4.0]);
        let wanted = Taken {
            taken: 1,
            cheapest: 0,
            regret: Some(0.25),
        };
        assert_eq!(found, Some(wanted));
        assert_eq!(take_least(&[], &[]), None);
        let regret = |predicted: &[f64], cost: &[f64]| take_least(predicted, cost)?.regret;
        assert_eq!(regret(&[1.0, 2.0], &[0.0, 0.0]), Some(0.0));
        assert_eq!(regret(&[1.0, 2.0], &[3.0, 0.0]), None);
    }

    #[test]
    fn tuna_of_hollander_and_wolfe() {
        // Hollander & Wolfe, "Nonparametric Statistical Methods" (1973), p. 185; the example of R's cor.test: T = 26.
        let a = [44.4, 45.9, 41.9, 53.3, 44.7, 44.1, 50.7, 45.2, 60.1];
        let b = [2.6, 3.1, 2.5, 5.0, 3.6, 4.0, 5.2, 2.8, 3.8];
        let expected = Pairs {
            right: 26,
            wrong: 10,
            tied: 0,
        };
        assert_eq!(concordant(&a, &b), expected);
        close(kendall_tau_b(&a, &b), 16.0 / 36.0);
        close(spearman_rho(&a, &b), 0.6);
    }

    #[test]
    fn ties_of_kendall() {
        // Kendall & Gibbons, "Rank Correlation Methods", chapter 3: S = 33 of 45 pairs, 4 tied in a and 9 in b; tau-b 0.859.
        let a = [1.0, 2.5, 2.5, 4.5, 4.5, 6.5, 6.5, 8.0, 9.5, 9.5];
        let b = [1.0, 2.0, 4.5, 4.5, 4.5, 4.5, 8.0, 8.0, 8.0, 10.0];
        let Pairs { right, wrong, tied } = concordant(&a, &b);
        assert_eq!((right - wrong, right + wrong + tied), (33, 45));
        close(kendall_tau_b(&a, &b), 33.0 / (41.0 * 36.0_f64).sqrt());
        // Sums of squares 82.5 - 4 * 1/2 and 82.5 - 5 - 2; differences of rank 0, 1/2, 2, 0, 0, 2, 3/2, 0, 3/2, 1/2.
        let product = 0.5 * (80.5 + 75.5 - 13.0);
        close(spearman_rho(&a, &b), product / (80.5 * 75.5_f64).sqrt());
    }

    #[test]
    fn mixed_by_hand() {
        // Right are things 1 & 5 and 4 & 5; both sides tie 1 & 4, and a ties 2 & 5: 8 pairs ordered by a, 9 by b.
        let (a, b) = ([12.0, 2.0, 1.0, 12.0, 2.0], [1.0, 4.0, 7.0, 1.0, 0.0]);
        let expected = Pairs {
            right: 2,
            wrong: 6,
            tied: 2,
        };
        assert_eq!(concordant(&a, &b), expected);
        close(kendall_tau_b(&a, &b), -4.0 / 72.0_f64.sqrt());
    }

    #[test]
    fn only_the_order_matters() {
        let mut random = ChaCha8Rng::seed_from_u64(7);
        for n in [2, 3, 10, 57] {
            // Few different values, so that there are ties.
            let mut draw = || -> Vec<f64> {
                (0..n)
                    .map(|i| f64::from(random.random_range(0..9) - 4 + i / 20))
                    .collect()
            };
            let (a, b) = (draw(), draw());
            let cubes: Vec<f64> = b.iter().map(|v| v * v * v + 1.0).collect();
            let negated: Vec<f64> = b.iter().map(|v| -v).collect();
            let turned = |v: &[f64]| v.iter().rev().copied().collect::<Vec<f64>>();
            for measure in [kendall_tau_b, spearman_rho] {
                let value = measure(&a, &b);
                assert!(value.is_none_or(|v| (-1.0..=1.0).contains(&v)));
                assert_eq!(measure(&b, &a), value);
                assert_eq!(measure(&a, &cubes), value);
                assert_eq!(measure(&turned(&a), &turned(&b)), value);
                assert_eq!(measure(&a, &negated), value.map(|v| -v));
                assert_eq!(measure(&b, &cubes), value.and(Some(1.0)));
            }
            let (pairs, opposite) = (concordant(&a, &b), concordant(&a, &negated));
            assert_eq!((pairs.right, pairs.tied), (opposite.wrong, opposite.tied));
            let all = (n * (n - 1) / 2) as u64;
            assert_eq!(pairs.right + pairs.wrong + pairs.tied, all);
        }
    }

    #[test]
    fn what_has_no_order_has_no_correlation() {
        for measure in [kendall_tau_b, spearman_rho] {
            assert_eq!(measure(&[], &[]), None);
            assert_eq!(measure(&[1.0], &[2.0]), None);
            assert_eq!(measure(&[1.0, 2.0, 3.0], &[5.0; 3]), None);
            // The two zeros are one value.
            assert_eq!(measure(&[0.0, -0.0], &[1.0, 2.0]), None);
            let infinity = f64::INFINITY;
            let ends = [infinity, -infinity, 0.0];
            assert_eq!(measure(&ends, &[3.0, 1.0, 2.0]), Some(1.0));
        }
    }

    #[test]
    #[should_panic(expected = "2 values against 1")]
    fn lengths_must_agree() {
        concordant(&[1.0, 2.0], &[1.0]);
    }

    #[test]
    #[should_panic(expected = "a value is not a number")]
    fn nan_is_refused() {
        kendall_tau_b(&[1.0, f64::NAN], &[1.0, 2.0]);
    }
}
