//! Means, variances and covariances of what each line counted or scored.
//!
//! The idea: keep sums of values and of products, and divide once at the end. For counts the sums are integers and
//! exact; for scores they carry 32 digits. So the textbook formula "mean of squares minus square of the mean", which
//! loses everything in plain doubles, is safe here, and merging two parts is adding their sums. Integer results do not
//! depend on how the lines were divided or ordered; score results depend on it at most in the last bit.
//! Source of the danger, and of the data that test it: NIST Statistical Reference Datasets, univariate summaries.
//!
//! The invariant: variances are sample variances (divisor n - 1) per observation and never negative; with fewer
//! observations than a quantity needs it is `None`.

use serde::{Deserialize, Serialize};

use super::double_double::DoubleDouble;

/// The exact sums of one integer count per observation.
///
/// The sum of squares must stay below 2^128: counts below 2^52 are safe for 2^24 observations, counts below 2^32 for
/// any number.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct IntegerMoments {
    /// The number of observations.
    pub n: u64,
    /// The sum of the counts.
    pub sum: u128,
    /// The sum of their squares.
    pub sum_sq: u128,
}

impl IntegerMoments {
    /// Adds one observation.
    ///
    /// # Panics
    /// If the sum of squares leaves its range.
    pub fn push(&mut self, count: u64) {
        let count = u128::from(count);
        self.merge(&Self {
            n: 1,
            sum: count,
            sum_sq: count * count,
        });
    }

    /// Adds the observations of another part.
    ///
    /// # Panics
    /// If the sum of squares leaves its range.
    pub fn merge(&mut self, other: &Self) {
        self.n += other.n;
        self.sum += other.sum;
        let Some(sum_sq) = self.sum_sq.checked_add(other.sum_sq) else {
            panic!("sum of squares above 2^128 after {} observations", self.n);
        };
        self.sum_sq = sum_sq;
    }

    /// The mean, rounded once or twice; needs one observation.
    pub fn mean(&self) -> Option<f64> {
        (self.n > 0).then(|| self.sum as f64 / self.n as f64)
    }

    /// The sample variance, exact but for the final roundings; needs two observations.
    pub fn variance(&self) -> Option<f64> {
        (self.n > 1)
            .then(|| centred_product(self.n, self.sum_sq, self.sum, self.sum) / (self.n - 1) as f64)
    }
}

/// The exact sums of a vector of small integer counts per observation, and of their products.
///
/// With counts of 32 bits the sums cannot overflow before 2^64 observations.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct IntegerCovariance {
    n: u64,
    sums: Vec<u128>,
    /// The q x q sums of products, by rows.
    products: Vec<u128>,
}

impl IntegerCovariance {
    /// No observations of `q` counts each.
    pub fn new(q: usize) -> Self {
        Self {
            n: 0,
            sums: vec![0; q],
            products: vec![0; q * q],
        }
    }

    /// Adds one observation.
    ///
    /// # Panics
    /// If the number of counts is not the one given to `new`.
    pub fn push(&mut self, counts: &[u32]) {
        let q = self.sums.len();
        assert_eq!(counts.len(), q, "counts of one observation");
        self.n += 1;
        for (j, &a) in counts.iter().enumerate() {
            self.sums[j] += u128::from(a);
            for (k, &b) in counts.iter().enumerate() {
                self.products[j * q + k] += u128::from(u64::from(a) * u64::from(b));
            }
        }
    }

    /// Adds the observations of another part.
    ///
    /// # Panics
    /// If the other part has another number of counts.
    pub fn merge(&mut self, other: &Self) {
        assert_eq!(
            self.sums.len(),
            other.sums.len(),
            "counts of one observation"
        );
        self.n += other.n;
        self.sums
            .iter_mut()
            .zip(&other.sums)
            .for_each(|(a, b)| *a += b);
        self.products
            .iter_mut()
            .zip(&other.products)
            .for_each(|(a, b)| *a += b);
    }

    /// The number of observations.
    pub fn n(&self) -> u64 {
        self.n
    }

    /// The mean of each count; needs one observation.
    pub fn mean(&self) -> Option<Vec<f64>> {
        let mean = |sum: &u128| *sum as f64 / self.n as f64;
        (self.n > 0).then(|| self.sums.iter().map(mean).collect())
    }

    /// The q x q sample covariance of one observation, by rows, exact but for the final roundings; needs two
    /// observations.
    pub fn covariance(&self) -> Option<Vec<f64>> {
        let q = self.sums.len();
        let entry = |(i, &product): (usize, &u128)| {
            centred_product(self.n, product, self.sums[i / q], self.sums[i % q])
                / (self.n - 1) as f64
        };
        (self.n > 1).then(|| self.products.iter().enumerate().map(entry).collect())
    }
}

/// The sum of (x - mean x)(y - mean y) from the sums of x y, x and y: the product minus s t / n, in integers.
///
/// Dividing s and t by n first keeps every term at most s t / n, which the sum of squares bounds: nothing overflows.
fn centred_product(n: u64, product: u128, s: u128, t: u128) -> f64 {
    let n_wide = u128::from(n);
    let (s, s_rest) = (s / n_wide, s % n_wide);
    let (t, t_rest) = (t / n_wide, t % n_wide);
    let rest = s_rest * t_rest;
    let whole = s * t * n_wide + s * t_rest + t * s_rest + rest / n_wide;
    let fraction = (rest % n_wide) as f64 / n as f64;
    if product >= whole {
        (product - whole) as f64 - fraction
    } else {
        -((whole - product) as f64) - fraction
    }
}

/// The sums of Q scores per observation, and of their products, to 32 digits.
///
/// One type serves a slope (Q = 1: its interval is mean and sd / sqrt(n) of the per-line scores) and an intercept with
/// a slope (Q = 2, whose covariance [`super::hotelling()`] takes).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScoreMoments<const Q: usize> {
    n: u64,
    sums: [DoubleDouble; Q],
    /// Sums of products j <= k; those below the diagonal stay zero.
    products: [[DoubleDouble; Q]; Q],
}

impl<const Q: usize> Default for ScoreMoments<Q> {
    fn default() -> Self {
        let zero = DoubleDouble::default();
        Self {
            n: 0,
            sums: [zero; Q],
            products: [[zero; Q]; Q],
        }
    }
}

impl<const Q: usize> ScoreMoments<Q> {
    /// Adds one observation.
    ///
    /// # Panics
    /// If a score is not finite.
    pub fn push(&mut self, scores: [f64; Q]) {
        self.n += 1;
        for (j, score) in scores.iter().enumerate() {
            assert!(
                score.is_finite(),
                "score {j} of observation {} is {score}",
                self.n
            );
            self.sums[j].add(*score);
            for (sum, other) in self.products[j][j..].iter_mut().zip(&scores[j..]) {
                sum.add_product(*score, *other);
            }
        }
    }

    /// Adds the observations of another part.
    pub fn merge(&mut self, other: &Self) {
        self.n += other.n;
        for j in 0..Q {
            self.sums[j].merge(other.sums[j]);
            for k in j..Q {
                self.products[j][k].merge(other.products[j][k]);
            }
        }
    }

    /// The number of observations.
    pub fn n(&self) -> u64 {
        self.n
    }

    /// The mean of each score; needs one observation.
    pub fn mean(&self) -> Option<[f64; Q]> {
        (self.n > 0).then(|| self.sums.map(|sum| sum.value() / self.n as f64))
    }

    /// The Q x Q sample covariance of one observation; needs two observations.
    pub fn covariance(&self) -> Option<[[f64; Q]; Q]> {
        let mean = self.mean().filter(|_| self.n > 1)?;
        let n = self.n as f64;
        // What the rounded means leave of each sum.
        let rests: [f64; Q] = std::array::from_fn(|j| {
            let mut rest = self.sums[j];
            rest.add_product(-mean[j], n);
            rest.value()
        });
        let mut covariance = [[0.0; Q]; Q];
        for j in 0..Q {
            for k in j..Q {
                // sum x y - s t / n, with t = n mean + rest; the product of two rests is beyond the last digit.
                let mut centred = self.products[j][k];
                centred.add_scaled(self.sums[j], -mean[k]);
                centred.add_product(mean[j], -rests[k]);
                let value = centred.value() / (n - 1.0);
                covariance[j][k] = if j == k { value.max(0.0) } else { value };
                covariance[k][j] = covariance[j][k];
            }
        }
        Some(covariance)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn integers(counts: &[u64]) -> IntegerMoments {
        let mut moments = IntegerMoments::default();
        counts.iter().for_each(|&count| moments.push(count));
        moments
    }

    #[test]
    fn integers_by_hand() {
        let moments = integers(&[2, 4, 4, 4, 5, 5, 7, 9]);
        assert_eq!((moments.n, moments.sum, moments.sum_sq), (8, 40, 232));
        assert_eq!(moments.mean(), Some(5.0));
        assert_eq!(moments.variance(), Some(32.0 / 7.0));
        assert_eq!(integers(&[]).mean(), None);
        assert_eq!(integers(&[3]).variance(), None);
        assert_eq!(integers(&[3, 3, 3]).variance(), Some(0.0));
    }

    #[test]
    fn large_integers_lose_nothing() {
        let offset = (1 << 63) - 7;
        assert_eq!(
            integers(&[offset, offset + 1, offset + 2]).variance(),
            Some(1.0)
        );
        // 2^60 observations of 2^33, and one of 2^33 + 1.
        let (n, c) = (1u64 << 60, 1u128 << 33);
        let mut many = IntegerMoments {
            n,
            sum: u128::from(n) * c,
            sum_sq: u128::from(n) * c * c,
        };
        assert_eq!(many.variance(), Some(0.0));
        many.push((1 << 33) + 1);
        assert_eq!(many.variance(), Some(1.0 / (n as f64 + 1.0)));
    }

    #[test]
    #[should_panic(expected = "sum of squares above 2^128 after 2 observations")]
    fn overflow_is_loud() {
        integers(&[u64::MAX, u64::MAX]);
    }

    #[test]
    fn covariances_by_hand_and_in_parts() {
        // x = 0, 1, 5 and y = 4, 2, 0: sums of products about the means 14, -10, 8.
        let rows = [[0, 4], [1, 2], [5, 0]];
        let mut whole = IntegerCovariance::new(2);
        let mut scores = ScoreMoments::<2>::default();
        let mut parts = [IntegerCovariance::new(2), IntegerCovariance::new(2)];
        let mut score_parts = [ScoreMoments::<2>::default(); 2];
        for (i, row) in rows.iter().enumerate() {
            whole.push(row);
            scores.push(row.map(f64::from));
            parts[i % 2].push(row);
            score_parts[i % 2].push(row.map(f64::from));
        }
        assert_eq!(whole.mean(), Some(vec![2.0, 2.0]));
        assert_eq!(whole.covariance(), Some(vec![7.0, -5.0, -5.0, 4.0]));
        assert_eq!(scores.mean(), Some([2.0, 2.0]));
        assert_eq!(scores.covariance(), Some([[7.0, -5.0], [-5.0, 4.0]]));

        let [mut first, second] = parts;
        first.merge(&second);
        assert_eq!((first.n(), first), (3, whole));
        let [mut first, second] = score_parts;
        first.merge(&second);
        assert_eq!((first.n(), first), (3, scores));
    }

    #[test]
    fn largest_counts_do_not_overflow() {
        let mut part = IntegerCovariance::new(2);
        part.push(&[u32::MAX, u32::MAX]);
        part.push(&[u32::MAX, 0]);
        for _ in 0..62 {
            part.merge(&part.clone());
        }
        let half = f64::from(u32::MAX) / 2.0;
        assert_eq!(part.covariance(), Some(vec![0.0, 0.0, 0.0, half * half]));
    }

    #[test]
    fn too_few_scores_are_none() {
        let mut scores = ScoreMoments::<1>::default();
        assert_eq!(scores.mean(), None);
        scores.push([0.1]);
        assert_eq!(scores.mean(), Some([0.1]));
        assert_eq!(scores.covariance(), None);
        scores.push([0.1]);
        assert_eq!(scores.covariance(), Some([[0.0]]));
    }
}
