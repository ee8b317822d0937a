//! Hotelling's T^2: several correlated means against their expectations, in one p-value.
//!
//! The idea: T^2 = N d' S^-1 d weighs the deviations d of the means by their own covariance, so contrasts that say the
//! same thing count once. Source: Hotelling, "The generalization of Student's ratio" (Ann. Math. Statist. 2, 1931);
//! pivoted Cholesky for the semidefinite case: Higham, "Accuracy and Stability of Numerical Algorithms", 10.3.
//!
//! The invariant: adding a contrast that is a combination of the others changes nothing. A contrast without variance
//! is certain: it agrees with its expectation, or the hypothesis is false and p is 0.

use serde::Serialize;

use super::tails::f_tail;

/// Pivots below this fraction of a contrast's variance count as a combination of the others. Far above rounding: what is
/// left of a contrast after the others would hang on a few observations, and its variance with it.
const COLLINEAR: f64 = 1e-3;
/// Deviations and standard deviations below this, relative to the larger of one and the largest standard deviation,
/// are what rounding leaves of zero. (Contrasts are counts or scores per line, so one is their natural unit.)
const ROUNDING: f64 = 1e-12;

/// The outcome of Hotelling's test.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Hotelling {
    /// T^2 = N d' S^-1 d over the independent contrasts; infinite if a certain contrast deviates.
    pub t2: f64,
    /// The F statistic, with (contrasts, n - contrasts) degrees of freedom; infinite with `t2`.
    pub f: f64,
    /// The number of independent contrasts used, the rank of S.
    pub contrasts: usize,
    /// The p-value; 1 if there is nothing to test.
    pub p: f64,
}

/// Tests that the expectation of a vector of q contrasts is what it should be.
///
/// - `deviation`: mean minus expectation, q numbers;
/// - `covariance`: the q x q sample covariance of one observation, by rows;
/// - `observations_mean`: N, how many observations the mean is over;
/// - `observations_covariance`: n, how many the covariance is from (it may be a part of N).
///
/// F = T^2 (n - q) / (q (n - 1)), exact for normal observations and an independent covariance, asymptotic otherwise.
///
/// # Panics
/// If the lengths disagree, a number is not finite, a variance is negative, N is 0, or n is not above the rank of the
/// covariance (which that of a sample covariance always is).
pub fn hotelling(
    deviation: &[f64],
    covariance: &[f64],
    observations_mean: u64,
    observations_covariance: u64,
) -> Hotelling {
    let q = deviation.len();
    assert_eq!(covariance.len(), q * q, "covariance of {q} contrasts");
    assert!(observations_mean > 0, "no observations behind the mean");
    for value in deviation.iter().chain(covariance) {
        assert!(value.is_finite(), "{value} in a deviation or covariance");
    }

    // A contrast without variance must not deviate.
    let variances = || (0..q).map(|i| covariance[i * q + i]);
    let largest = variances().fold(1.0_f64, f64::max).sqrt();
    let rounding = ROUNDING * largest;
    for (i, variance) in variances().enumerate() {
        assert!(variance >= 0.0, "variance {variance} of contrast {i}");
    }
    let varying: Vec<usize> = (0..q)
        .filter(|&i| covariance[i * q + i].sqrt() > rounding)
        .collect();
    let certain = |i: &usize| !varying.contains(i);
    let contradiction = (0..q)
        .filter(certain)
        .any(|i| deviation[i].abs() > rounding);

    // Scale to unit variances.
    let sd = |i: usize| covariance[i * q + i].sqrt();
    let scaled: Vec<f64> = varying.iter().map(|&i| deviation[i] / sd(i)).collect();
    let correlation: Vec<Vec<f64>> = (varying.iter())
        .map(|&i| {
            (varying.iter())
                .map(|&j| covariance[i * q + j] / (sd(i) * sd(j)))
                .collect()
        })
        .collect();

    let (distance, contrasts) = mahalanobis(scaled, correlation);
    let (t2, f, p) = if contradiction {
        (f64::INFINITY, f64::INFINITY, 0.0)
    } else if contrasts == 0 {
        (0.0, 0.0, 1.0)
    } else {
        let n = observations_covariance as f64;
        let rank = contrasts as f64;
        assert!(
            n > rank,
            "rank {contrasts} from {observations_covariance} observations"
        );
        let t2 = observations_mean as f64 * distance;
        let f = t2 * (n - rank) / (rank * (n - 1.0));
        (t2, f, f_tail(f, rank, n - rank))
    };
    Hotelling {
        t2,
        f,
        contrasts,
        p,
    }
}

/// d' C^-1 d over the independent rows of a correlation matrix, and their number, by pivoted Cholesky elimination.
fn mahalanobis(mut d: Vec<f64>, mut c: Vec<Vec<f64>>) -> (f64, usize) {
    let mut left: Vec<usize> = (0..d.len()).collect();
    let (mut distance, mut rank) = (0.0, 0);
    while !left.is_empty() {
        // The contrast with the largest variance, given those already used; the first of equals.
        let best = (1..left.len()).fold(0, |a, b| {
            if c[left[b]][left[b]] > c[left[a]][left[a]] {
                b
            } else {
                a
            }
        });
        let pivot = left.remove(best);
        let variance = c[pivot][pivot];
        if variance < COLLINEAR {
            break;
        }
        distance += d[pivot] * d[pivot] / variance;
        rank += 1;
        // Take out of the others what this one explains.
        for &i in &left {
            let factor = c[i][pivot] / variance;
            d[i] -= factor * d[pivot];
            for &j in &left {
                c[i][j] -= factor * c[pivot][j];
            }
        }
    }
    (distance, rank)
}

#[cfg(test)]
mod tests {
    use super::super::{ScoreMoments, student_p};
    use super::*;

    fn assert_close(a: f64, b: f64) {
        assert!((a - b).abs() <= 1e-12 * b.abs(), "{a} against {b}");
    }

    #[test]
    fn one_contrast_is_a_t_test() {
        let test = hotelling(&[0.3], &[4.0], 50, 50);
        let t = 0.3 / (2.0 / 50_f64.sqrt());
        assert_close(test.t2, t * t);
        assert_close(test.f, t * t);
        assert_eq!(test.contrasts, 1);
        assert_close(test.p, student_p(t, 49.0));
    }

    #[test]
    fn two_contrasts_in_closed_form() {
        // d' S^-1 d = (d1^2 s22 - 2 d1 d2 s12 + d2^2 s11) / det; F(2, m) has the tail (1 + 2 F / m)^(-m/2).
        let (d, s) = ([0.2, -0.1], [3.0, 1.2, 1.2, 0.8]);
        let det = 3.0 * 0.8 - 1.44;
        let t2 = 40.0 * (0.04 * 0.8 + 2.0 * 0.02 * 1.2 + 0.01 * 3.0) / det;
        let f = t2 * 28.0 / (2.0 * 29.0);
        let test = hotelling(&d, &s, 40, 30);
        assert_close(test.t2, t2);
        assert_close(test.f, f);
        assert_close(test.p, (1.0 + 2.0 * f / 28.0).powi(-14));
        // Units do not matter.
        let scaled = hotelling(&[200.0, -0.1], &[3e6, 1200.0, 1200.0, 0.8], 40, 30);
        assert_close(scaled.t2, t2);
    }

    #[test]
    fn combinations_of_contrasts_change_nothing() {
        // Contrasts 0, 1, then 0 again, their sum, and a constant.
        let (d, s) = ([0.2, -0.1], [3.0, 1.2, 1.2, 0.8]);
        let maps = [[1.0, 0.0], [0.0, 1.0], [1.0, 0.0], [1.0, 1.0], [0.0, 0.0]];
        let deviation = maps.map(|m| m[0] * d[0] + m[1] * d[1]);
        let mut covariance = Vec::new();
        for a in maps {
            for b in maps {
                let row = [a[0] * s[0] + a[1] * s[2], a[0] * s[1] + a[1] * s[3]];
                covariance.push(row[0] * b[0] + row[1] * b[1]);
            }
        }
        let (few, many) = (
            hotelling(&d, &s, 40, 30),
            hotelling(&deviation, &covariance, 40, 30),
        );
        assert_eq!(many.contrasts, 2);
        assert_close(many.t2, few.t2);
        assert_close(many.p, few.p);
    }

    #[test]
    fn certain_contrasts() {
        let nothing = hotelling(&[], &[], 10, 10);
        assert_eq!((nothing.p, nothing.contrasts, nothing.t2), (1.0, 0, 0.0));
        assert_eq!(hotelling(&[1e-15], &[0.0], 10, 10), nothing);
        let wrong = hotelling(&[0.001], &[0.0], 10, 10);
        assert_eq!(
            (wrong.p, wrong.contrasts, wrong.t2),
            (0.0, 0, f64::INFINITY)
        );
        let agreeing = hotelling(&[0.3, 1e-14], &[4.0, 0.0, 0.0, 0.0], 50, 50);
        assert_eq!(agreeing, hotelling(&[0.3], &[4.0], 50, 50));
        let wrong = hotelling(&[0.3, 1e-9], &[4.0, 0.0, 0.0, 0.0], 50, 50);
        assert_eq!((wrong.p, wrong.contrasts), (0.0, 1));
    }

    /// A small generator with a fixed seed (Steele, Lea, Flood 2014).
    struct SplitMix(u64);

    impl SplitMix {
        fn bits(&mut self) -> u64 {
            self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let mut z = self.0;
            z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            z ^ (z >> 31)
        }

        fn uniform(&mut self) -> f64 {
            (self.bits() >> 11) as f64 / (1u64 << 53) as f64
        }
    }

    /// In 2,000 tests of true hypotheses the 99.9 % binomial bands of the rejections are 69 to 133 at 5 % and 7 to 36
    /// at 1 %.
    fn assert_calibrated(p: &[f64]) {
        assert_eq!(p.len(), 2_000);
        let rejections = |level: f64| p.iter().filter(|&&p| p <= level).count();
        let (five, one) = (rejections(0.05), rejections(0.01));
        println!("{five} rejections at 5 %, {one} at 1 %");
        assert!((69..=133).contains(&five), "{five} rejections at 5 %");
        assert!((7..=36).contains(&one), "{one} rejections at 1 %");
    }

    #[test]
    fn true_hypotheses_are_rejected_as_often_as_promised() {
        let mut generator = SplitMix(20_260_611);
        // Two correlated, nearly normal scores (sums of uniforms) in samples of 64.
        let mut scores = Vec::new();
        // Five counts of hits, the last the sum of the first two, in samples of 256.
        let mut counts = Vec::new();
        for _ in 0..2_000 {
            let mut sample = ScoreMoments::<2>::default();
            for _ in 0..64 {
                let mut normal = || (0..6).map(|_| generator.uniform()).sum::<f64>() - 3.0;
                let (a, b) = (normal(), normal());
                sample.push([1.0 + a, a + 0.5 * b]);
            }
            let mean = sample.mean().unwrap();
            let covariance = sample.covariance().unwrap();
            let test = hotelling(&[mean[0] - 1.0, mean[1]], covariance.as_flattened(), 64, 64);
            scores.push(test.p);

            let expected = [0.5, 0.375, 0.25, 0.5, 0.875];
            let mut sample = ScoreMoments::<5>::default();
            for _ in 0..256 {
                // Nested boxes on a line, so that hits are correlated, and one box apart.
                let (u, v) = (generator.uniform(), generator.uniform());
                let hits = [u < 0.5, u < 0.375, (0.25..0.5).contains(&u), v < 0.5]
                    .map(|hit| f64::from(u8::from(hit)));
                sample.push([hits[0], hits[1], hits[2], hits[3], hits[0] + hits[1]]);
            }
            let mean = sample.mean().unwrap();
            let deviation: Vec<f64> = mean.iter().zip(expected).map(|(m, e)| m - e).collect();
            let test = hotelling(
                &deviation,
                sample.covariance().unwrap().as_flattened(),
                256,
                256,
            );
            assert_eq!(test.contrasts, 4);
            counts.push(test.p);
        }
        assert_calibrated(&scores);
        assert_calibrated(&counts);
    }
}
