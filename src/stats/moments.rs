//! Means, variances and covariances of what each line counted or scored.
//!
//! The idea: keep sums of values and of products to 32 digits, and divide once at the end. So the textbook formula "mean
//! of squares minus square of the mean", which loses everything in plain doubles, is safe here, and merging two parts is
//! adding their sums. Results depend on how the lines were divided or ordered at most in the last bit.
//! Source of the danger, and of the data that test it: NIST Statistical Reference Datasets, univariate summaries.
//!
//! The invariant: variances are sample variances (divisor n - 1) per observation and never negative; with fewer
//! observations than a quantity needs it is `None`.

use super::double_double::DoubleDouble;

/// The sums of Q scores or counts per observation, and of their products, to 32 digits.
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

    #[test]
    fn integers_by_hand() {
        let of = |counts: &[u32]| {
            let mut moments = ScoreMoments::<1>::default();
            counts.iter().for_each(|&c| moments.push([f64::from(c)]));
            moments
        };
        let moments = of(&[2, 4, 4, 4, 5, 5, 7, 9]);
        assert_eq!(moments.n(), 8);
        assert_eq!(moments.mean(), Some([5.0]));
        assert_eq!(moments.covariance(), Some([[32.0 / 7.0]]));
        assert_eq!(of(&[]).mean(), None);
        assert_eq!(of(&[3]).covariance(), None);
        assert_eq!(of(&[3, 3, 3]).covariance(), Some([[0.0]]));
        let largest = of(&[u32::MAX - 2, u32::MAX - 1, u32::MAX]);
        assert_eq!(largest.covariance(), Some([[1.0]]));
    }

    #[test]
    fn covariances_by_hand_and_in_parts() {
        // x = 0, 1, 5 and y = 4, 2, 0: sums of products about the means 14, -10, 8.
        let rows = [[0.0, 4.0], [1.0, 2.0], [5.0, 0.0]];
        let mut whole = ScoreMoments::<2>::default();
        let mut parts = [ScoreMoments::<2>::default(); 2];
        for (i, row) in rows.into_iter().enumerate() {
            whole.push(row);
            parts[i % 2].push(row);
        }
        assert_eq!(whole.mean(), Some([2.0, 2.0]));
        assert_eq!(whole.covariance(), Some([[7.0, -5.0], [-5.0, 4.0]]));
        let [mut first, second] = parts;
        first.merge(&second);
        assert_eq!((first.n(), first), (3, whole));
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
