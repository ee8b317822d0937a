//! Sums carried to about 32 digits.
//!
//! The idea: a running sum is kept as the unevaluated sum of two doubles, and every rounding error is added to the
//! lower one. Sources: Dekker, "A floating-point technique for extending the available precision" (Numer. Math. 18,
//! 1971); Ogita, Rump, Oishi, "Accurate sum and dot product" (SIAM J. Sci. Comput. 26(6), 2005).
//!
//! The invariant: `|low|` is at most half a unit in the last place of `high`. Here, and nowhere else in the project, a
//! fused multiply-add is used: it gives the rounding error of a product exactly, on every processor alike.

/// A sum of doubles and of products of doubles, accurate to about 2^-104 of the sum of magnitudes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct DoubleDouble {
    high: f64,
    low: f64,
}

impl DoubleDouble {
    /// Adds one number.
    pub fn add(&mut self, x: f64) {
        let (sum, error) = two_sum(self.high, x);
        (self.high, self.low) = two_sum(sum, error + self.low);
    }

    /// Adds the product of two numbers, its rounding error included.
    pub fn add_product(&mut self, a: f64, b: f64) {
        let product = a * b;
        let error = a.mul_add(b, -product);
        self.add(product);
        self.add(error);
    }

    /// Adds another such sum.
    pub fn merge(&mut self, other: Self) {
        self.add(other.high);
        self.add(other.low);
    }

    /// Adds the product of another such sum with a number.
    pub fn add_scaled(&mut self, other: Self, factor: f64) {
        self.add_product(other.high, factor);
        self.add_product(other.low, factor);
    }

    /// The sum, rounded to one double.
    pub fn value(self) -> f64 {
        self.high + self.low
    }
}

/// The rounded sum of two numbers and its rounding error (Knuth's TwoSum).
fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let b_part = sum - a;
    (sum, (a - (sum - b_part)) + (b - b_part))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_cancels_in_f64_survives() {
        let mut sum = DoubleDouble::default();
        for x in [1.0, 1e16, 1.0, -1e16, 1e-14] {
            sum.add(x);
        }
        assert_eq!(sum.value(), 2.0 + 1e-14);
    }

    #[test]
    fn products_keep_their_rounding_error() {
        // (1 + e)(1 - e) = 1 - e^2, which rounds to 1 as a product.
        let e = 2f64.powi(-30);
        let mut sum = DoubleDouble::default();
        sum.add_product(1.0 + e, 1.0 - e);
        sum.add(-1.0);
        assert_eq!(sum.value(), -e * e);
    }

    #[test]
    fn scaled_sums_and_merged_sums() {
        let mut third = DoubleDouble::default();
        third.add(1.0 / 3.0);
        third.add(1e-20);
        let mut total = DoubleDouble::default();
        total.add_scaled(third, 3.0);
        total.add_scaled(third, -3.0);
        assert!(total.value().abs() < 1e-31);
        total.merge(third);
        total.add(-1.0 / 3.0);
        assert!((total.value() - 1e-20).abs() < 1e-31);
    }
}
