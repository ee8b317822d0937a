//! Tails, quantiles and tests at their ends, against values known exactly.

use super::case;
use crate::stats::{
    ScoreMoments, binomial_tail, holm, hotelling, kendall_tau_b, normal_p, simultaneous_quantile,
};
use crate::study::stability::case::{Case, Finding};

/// The cases of tails and tests.
pub(super) fn cases() -> Vec<Case> {
    vec![
        case("tail-by-hand", "sums of a few terms", || {
            // 2 (1 + 4)/16; 2/1024.
            digits(
                [binomial_tail(1, 4, 0.5), binomial_tail(10, 10, 0.5)],
                [0.625, 0.001953125],
                11,
            )
        }),
        case("tail-of-all-hits", "underflow", || {
            // 2 * 2^-1000, and 2 * 2^-2000, which f64 does not have.
            let tails = [1000, 2000].map(|n| binomial_tail(n, n, 0.5));
            digits(tails, [libm::ldexp(1.0, -999), 0.0], 11)
        }),
        case("tail-of-no-hits", "p near 0", || {
            // The mean is far below one: no hit is no surprise, one is one of about n p = 1e-290.
            let tails = [0, 1].map(|hits| binomial_tail(hits, 1 << 20, 1e-300));
            digits(tails, [1.0, 2.0 * 1_048_576.0 * 1e-300], 11)
        }),
        case("tail-near-certainty", "p near 1", || {
            // One miss of n at q = 2^-53: 2 (1 - (1 - q)^n) = 2 n q, but for (n q)^2.
            let p = 1.0 - f64::EPSILON / 2.0;
            digits([binomial_tail(1023, 1024, p)], [1024.0 * f64::EPSILON], 11)
        }),
        case("tail-at-the-mean", "no deviation", || {
            digits([binomial_tail(1 << 39, 1 << 40, 0.5)], [1.0], 15)
        }),
        case("normal-tails-at-their-ends", "overflow", || {
            let p = [0.0, f64::INFINITY, -f64::INFINITY, 1e300].map(normal_p);
            digits(p, [1.0, 0.0, 0.0, 0.0], 15)
        }),
        case("a-million-intervals", "1 - level cancels", || {
            // 2 Q(x) = 0.01/10^6 at x = 5.7307... (mpmath, 30 digits).
            digits(
                [simultaneous_quantile(0.99, 1_000_000)],
                [5.730_728_868_235_926],
                12,
            )
        }),
        case("holm-of-zeros-and-ones", "ends", || {
            digits(holm(&[0.0, 1.0, 0.0, 1e-300]), [0.0, 1.0, 0.0, 2e-300], 15)
        }),
        case("a-contrast-twice", "singular covariance", || {
            let once = hotelling(&[0.1], &[1.0], 1000, 1000);
            let twice = hotelling(&[0.1; 2], &[1.0; 4], 1000, 1000);
            digits([twice.t2, twice.p], [once.t2, once.p], 12)
        }),
        case("a-contrast-without-variance", "singular covariance", || {
            let certain =
                [0.0, 1e-3].map(|deviation| hotelling(&[deviation], &[0.0], 1000, 1000).p);
            digits(certain, [1.0, 0.0], 15)
        }),
        case("order-of-equals", "ties", || {
            let tau = kendall_tau_b(&[1.0; 1000], &(0..1000).map(f64::from).collect::<Vec<_>>());
            Finding::of("None", format!("{tau:?}"))
        }),
        case("variance-beside-a-large-mean", "cancellation", || {
            // NIST NumAcc4: 10000000.2, then 10000000.1 and 10000000.3 in turn. Mean and deviation as certified.
            let mut moments = ScoreMoments::<1>::default();
            for i in 0..=1000 {
                moments.push([if i == 0 {
                    10_000_000.2
                } else {
                    10_000_000.1 + 0.2 * f64::from(1 - i % 2)
                }]);
            }
            let mean = moments.mean().map_or(f64::NAN, |mean| mean[0]);
            let variance = moments.covariance().map_or(f64::NAN, |c| c[0][0]);
            digits([mean, variance.sqrt()], [10_000_000.2, 0.1], 7)
        }),
        case("one-observation", "no variance", || {
            let mut moments = ScoreMoments::<1>::default();
            moments.push([1.0]);
            Finding::of(
                "Some([1.0]), None",
                format!("{:?}, {:?}", moments.mean(), moments.covariance()),
            )
        }),
    ]
}

/// Whether numbers agree with exact ones to so many digits.
fn digits(found: impl AsRef<[f64]>, exact: impl AsRef<[f64]>, digits: i32) -> Finding {
    let (found, exact) = (found.as_ref(), exact.as_ref());
    let tolerance = libm::pow(10.0, -f64::from(digits));
    let close = |(a, b): (&f64, &f64)| a == b || (a - b).abs() <= tolerance * b.abs();
    let right = found.len() == exact.len() && found.iter().zip(exact).all(close);
    Finding::judged(
        format!("{exact:?} to {digits} digits"),
        format!("{found:?}"),
        right,
    )
}
