//! How far the columns of a fit can be told apart.
//!
//! The idea: scaled to length 1, columns that are orthogonal have the identity as Gram matrix; what they share shows in
//! its inverse and in its eigenvalues. Sources: Marquardt, "Generalized inverses, ridge regression, biased linear
//! estimation, and nonlinear estimation" (Technometrics 12, 1970) for the variance inflation; Belsley, Kuh and Welsch,
//! "Regression Diagnostics" (1980), 3.2, for the condition number; Golub and Van Loan, "Matrix Computations", 8.5, for
//! Jacobi's rotations. Columns are not centred: a column of ones is one among others.

use super::cholesky::{Cholesky, DEPENDENT};
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

    /// The ratio of the largest to the least singular value of X with columns of length 1; from 30 on, collinearity harms
    /// a fit. `None` for no columns, and where one is zero or depends on others (ratios of about 1e5 and more).
    pub fn condition_number(&self) -> Option<f64> {
        let eigenvalues = eigenvalues(self.scaled().gram);
        let least = eigenvalues.iter().copied().reduce(f64::min)?;
        let largest = eigenvalues.iter().copied().reduce(f64::max)?;
        (least > DEPENDENT).then(|| (largest / least).sqrt())
    }
}

/// The eigenvalues of a symmetric matrix, in no order, by sweeps of rotations that each make one pair of entries zero.
fn eigenvalues(mut a: Vec<Vec<f64>>) -> Vec<f64> {
    let n = a.len();
    let beside = |a: &[Vec<f64>]| -> f64 {
        let rows = a.iter().enumerate();
        rows.map(|(i, row)| row[..i].iter().map(|v| v * v).sum::<f64>())
            .sum()
    };
    // Each sweep about squares what is left beside the diagonal, until rounding stops it.
    let mut left = beside(&a);
    while left > 0.0 {
        for p in 0..n {
            for q in p + 1..n {
                rotate(&mut a, p, q);
            }
        }
        let less = beside(&a);
        if less >= left {
            break;
        }
        left = less;
    }
    (0..n).map(|i| a[i][i]).collect()
}

/// Turns the plane of axes p and q so that the entries a_pq and a_qp become zero.
fn rotate(a: &mut [Vec<f64>], p: usize, q: usize) {
    if a[p][q] == 0.0 {
        return;
    }
    let cotangent = 0.5 * (a[q][q] - a[p][p]) / a[p][q];
    let tangent = cotangent.signum() / (cotangent.abs() + (1.0 + cotangent * cotangent).sqrt());
    let cosine = 1.0 / (1.0 + tangent * tangent).sqrt();
    let sine = tangent * cosine;
    let turn = |u: f64, v: f64| (cosine * u - sine * v, sine * u + cosine * v);
    for row in a.iter_mut() {
        (row[p], row[q]) = turn(row[p], row[q]);
    }
    let (above, below) = a.split_at_mut(q);
    for (u, v) in above[p].iter_mut().zip(&mut below[0]) {
        (*u, *v) = turn(*u, *v);
    }
    // What rounding leaves.
    (a[p][q], a[q][p]) = (0.0, 0.0);
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
        close(normal.condition_number(), 1.0);
    }

    #[test]
    fn two_columns_in_closed_form() {
        // Cosine c: inflation 1 / (1 - c^2), eigenvalues 1 + c and 1 - c.
        for (x, y) in [(0.6, 0.8), (-0.6, 0.8), (12.0 / 13.0, 5.0 / 13.0)] {
            let normal = of(&[&[1.0, 100.0 * x], &[0.0, 100.0 * y]]);
            for inflation in normal.variance_inflation() {
                close(inflation, 1.0 / (y * y));
            }
            let c = f64::abs(x);
            close(normal.condition_number(), ((1.0 + c) / (1.0 - c)).sqrt());
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
        // G = [2 1 0; 1 2 1; 0 1 2] has the inverse diagonal 3/4, 1, 3/4 and, halved, the eigenvalues 1, 1 +- 1/sqrt 2.
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
        close(normal.condition_number(), 1.0 + 2f64.sqrt());
    }

    #[test]
    fn equal_eigenvalues_are_found() {
        // G_ij = c + (1 - c) [i = j] of k columns: one eigenvalue 1 + (k - 1) c, the others 1 - c.
        let (k, c) = (24, 0.75);
        let gram = |i: usize| (0..k).map(|j| if i == j { 1.0 } else { c }).collect();
        let mut found = eigenvalues((0..k).map(gram).collect());
        found.sort_by(f64::total_cmp);
        for (i, found) in found.into_iter().enumerate() {
            let expected = if i == k - 1 { 18.25 } else { 0.25 };
            assert!((found - expected).abs() < 1e-13, "{i}: {found}");
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
        assert_eq!(normal.condition_number(), None);
        assert_eq!(Normal::new(0).condition_number(), None);
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
            assert_eq!(normal.condition_number(), None);
        }
    }
}
