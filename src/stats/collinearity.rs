//! How far the columns of a fit can be told apart.
//!
//! The idea: scaled to length 1, columns that are orthogonal have the identity as Gram matrix; what they share shows in
//! its inverse. Source: Marquardt, "Generalized inverses, ridge regression, biased linear estimation, and nonlinear
//! estimation" (Technometrics 12, 1970). Columns are not centred: a column of ones is one among others.

use super::cholesky::Cholesky;
use super::normal_equations::Normal;

impl Normal {
    /// The variance inflation of each column: by how much the other columns enlarge the variance of its coefficient,
    /// 1 / (1 - R^2) of its fit by the others without centring, G_jj (G^-1)_jj. `None` for a column that is zero or
    /// depends on others.
    pub fn variance_inflation(&self) -> Vec<Option<f64>> {
        let gram = self.scaled().gram;
        (0..gram.len())
            .map(|j| {
                let mut factor = Cholesky::default();
                for other in (0..gram.len()).filter(|&other| other != j) {
                    factor.take(&gram, other);
                }
                factor.take(&gram, j).map(|distance| 1.0 / distance)
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(rows: &[&[f64]]) -> Normal {
        let mut normal = Normal::new(rows[0].len());
        rows.iter().for_each(|row| normal.push(row, 1.0));
        normal
    }

    fn close(found: Option<f64>, expected: f64) {
        let found = found.unwrap();
        let error = (found / expected - 1.0).abs();
        assert!(error < 1e-10, "{found} not {expected}");
    }

    #[test]
    fn orthogonal_columns_share_nothing() {
        let normal = of(&[&[3.0, 0.0], &[0.0, 1e-9], &[4.0, 0.0]]);
        for inflation in normal.variance_inflation() {
            close(inflation, 1.0);
        }
    }

    #[test]
    fn two_columns_in_closed_form() {
        // Cosine x: inflation 1 / (1 - x^2).
        for (x, y) in [(0.6, 0.8), (-0.6, 0.8), (12.0 / 13.0, 5.0 / 13.0)] {
            let normal = of(&[&[1.0, 100.0 * x], &[0.0, 100.0 * y]]);
            for inflation in normal.variance_inflation() {
                close(inflation, 1.0 / (y * y));
            }
        }
    }

    #[test]
    fn a_line_inflates_both_its_coefficients() {
        // Intercept and x = 9, 10, 11: uncentred inflation is mean square over variance, 302 / 2 for both.
        let normal = of(&[&[1.0, 9.0], &[1.0, 10.0], &[1.0, 11.0]]);
        for inflation in normal.variance_inflation() {
            close(inflation, 151.0);
        }
    }

    #[test]
    fn three_columns_by_hand() {
        // G = [2 1 0; 1 2 1; 0 1 2] has the inverse diagonal 3/4, 1, 3/4.
        let normal = of(&[
            &[1.0, 0.0, 0.0],
            &[1.0, 1.0, 0.0],
            &[0.0, 1.0, 1.0],
            &[0.0, 0.0, 1.0],
        ]);
        let found = normal.variance_inflation();
        for (found, expected) in found.into_iter().zip([1.5, 2.0, 1.5]) {
            close(found, expected);
        }
    }

    #[test]
    fn only_what_depends_has_no_inflation() {
        // The third column is twice the first, the last is zero; the second shares 1/2 with the first.
        let normal = of(&[
            &[1.0, 1.0, 2.0, 0.0],
            &[1.0, 0.0, 2.0, 0.0],
            &[0.0, 0.0, 0.0, 0.0],
        ]);
        let found = normal.variance_inflation();
        assert_eq!((found[0], found[2], found[3]), (None, None, None));
        close(found[1], 2.0);
    }
    #[test]
    fn sums_of_columns_depend_whatever_rounding_leaves() {
        for i in 1..40 {
            let rows: Vec<[f64; 3]> = (1..9)
                .map(|j| {
                    let (a, b) = (f64::from(i * j).sqrt(), 1.0 / f64::from(i + j * j));
                    [a, b, 0.3 * a + 0.7 * b]
                })
                .collect();
            let normal = of(&rows.iter().map(|row| &row[..]).collect::<Vec<_>>());
            assert_eq!(normal.variance_inflation(), [None; 3]);
        }
    }
}
