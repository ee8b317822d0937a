//! Cholesky's factor of a Gram matrix, grown column by column.
//!
//! The idea: with columns of length 1, the pivot of a new column is the square of its distance from the span of those
//! before it. One too close to that span is left out, so the factor never divides by rounding noise.
//! Source: Golub and Van Loan, "Matrix Computations", 4.2.

/// A column of length 1 whose squared distance from the span of others is less counts as dependent on them. Rounding of
/// the Gram matrix (about 1e-16 times the squared coefficients) stays below it unless coefficients exceed 1000.
pub(super) const DEPENDENT: f64 = 1e-10;

/// The factor L of the columns taken so far, G = L L' among them.
#[derive(Default)]
pub(super) struct Cholesky {
    /// The columns in the order taken.
    pub columns: Vec<usize>,
    /// Row i holds its i + 1 entries.
    rows: Vec<Vec<f64>>,
}

impl Cholesky {
    /// Takes column j of the Gram matrix (unit diagonal) and gives the square of its distance from the span of the
    /// columns before. `None`, and the column is left out, where it depends on them or is zero.
    pub fn take(&mut self, gram: &[Vec<f64>], j: usize) -> Option<f64> {
        let mut row = Vec::with_capacity(self.columns.len() + 1);
        for (above, &column) in self.rows.iter().zip(&self.columns) {
            let i = row.len();
            let rest = gram[j][column] - dot(&row, &above[..i]);
            row.push(rest / above[i]);
        }
        let pivot = gram[j][j] - dot(&row, &row);
        (pivot > DEPENDENT).then(|| {
            row.push(pivot.sqrt());
            self.rows.push(row);
            self.columns.push(j);
            pivot
        })
    }

    /// The solution of G x = c among the columns taken; 0 for all others.
    pub fn solve(&self, c: &[f64]) -> Vec<f64> {
        let mut x: Vec<f64> = self.columns.iter().map(|&j| c[j]).collect();
        for (i, row) in self.rows.iter().enumerate() {
            x[i] = (x[i] - dot(&row[..i], &x[..i])) / row[i];
        }
        for (i, row) in self.rows.iter().enumerate().rev() {
            x[i] /= row[i];
            let known = x[i];
            (x[..i].iter_mut().zip(row)).for_each(|(x, l)| *x -= l * known);
        }
        let mut all = vec![0.0; c.len()];
        self.columns.iter().zip(x).for_each(|(&j, x)| all[j] = x);
        all
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_and_solution_by_hand() {
        // Columns (1, 0), (3/5, 4/5) and (0, 1): the third depends on the first two, and a fourth is zero.
        let gram = [
            vec![1.0, 0.6, 0.0, 0.0],
            vec![0.6, 1.0, 0.8, 0.0],
            vec![0.0, 0.8, 1.0, 0.0],
            vec![0.0; 4],
        ];
        let mut factor = Cholesky::default();
        let distances = [0, 1, 2, 3].map(|j| factor.take(&gram, j));
        assert_eq!(distances[0], Some(1.0));
        assert!((distances[1].unwrap() - 0.64).abs() < 1e-15);
        assert_eq!((distances[2], distances[3]), (None, None));
        assert_eq!(factor.columns, [0, 1]);
        // 2 (1, 0) + 5 (3/5, 4/5) has the products 5 and 6.2 with them.
        let x = factor.solve(&[5.0, 6.2, 9.0, 9.0]);
        assert!((x[0] - 2.0).abs() + (x[1] - 5.0).abs() < 1e-14, "{x:?}");
        assert_eq!(x[2..], [0.0, 0.0]);
    }
}
