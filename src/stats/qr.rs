//! Householder factorisation of a tall, narrow matrix.
//!
//! The idea: one reflection a column, kept as a vector below the diagonal, so Q is never formed. Source: Golub and Van
//! Loan, "Matrix Computations", 5.1-5.2 and 5.3.8. The invariant: X = Q R with R upper triangular and every diagonal
//! entry of R well above the rounding of its column; a column that fails this is reported, never divided by.

/// A factorised matrix, by columns: R above the diagonal, the reflection vectors on and below it.
pub(super) struct Qr {
    rows: usize,
    columns: usize,
    entries: Vec<f64>,
    /// The diagonal of R.
    diagonal: Vec<f64>,
}

impl Qr {
    /// Factorises a matrix given by rows, or names the first column that depends on those before it.
    ///
    /// Column magnitudes should be near one: squares must neither overflow nor vanish.
    pub fn new(x: &[f64], columns: usize) -> Result<Self, usize> {
        let rows = x.len() / columns;
        // Rounding leaves this fraction of a column that is in the span of the others.
        let tolerance = f64::EPSILON * columns as f64 * (16.0 + (rows as f64).sqrt());

        let entries = (0..columns).flat_map(|j| x.iter().skip(j).step_by(columns).copied());
        let mut qr = Self {
            rows,
            columns,
            entries: entries.collect(),
            diagonal: vec![0.0; columns],
        };
        for k in 0..columns {
            let column = &mut qr.entries[k * rows..(k + 1) * rows];
            let remaining = norm(&column[k..]);
            if remaining <= tolerance * norm(column) {
                return Err(k);
            }
            // Reflect the rest of the column onto the axis, away from cancellation.
            let reflected = -remaining.copysign(column[k]);
            column[k] -= reflected;
            qr.diagonal[k] = reflected;

            let (done, rest) = qr.entries.split_at_mut((k + 1) * rows);
            let vector = &done[k * rows + k..];
            for column in rest.chunks_exact_mut(rows) {
                reflect(vector, reflected, &mut column[k..]);
            }
        }
        Ok(qr)
    }

    /// Solves `r + X b = upper`, `X' r = lower` for (r, b).
    pub fn solve_augmented(
        &self,
        mut upper: Vec<f64>,
        mut lower: Vec<f64>,
    ) -> (Vec<f64>, Vec<f64>) {
        let p = self.columns;
        for k in 0..p {
            reflect(self.vector(k), self.diagonal[k], &mut upper[k..]);
        }
        self.solve_transposed(&mut lower);
        let mut b: Vec<f64> = (upper.iter().zip(&lower)).map(|(u, l)| u - l).collect();
        self.solve(&mut b);
        upper[..p].copy_from_slice(&lower);
        for k in (0..p).rev() {
            reflect(self.vector(k), self.diagonal[k], &mut upper[k..]);
        }
        (upper, b)
    }

    /// The norm of each row of the inverse of R: the standard errors for a residual deviation of one.
    pub fn inverse_row_norms(&self) -> Vec<f64> {
        (0..self.columns)
            .map(|j| {
                let mut unit = vec![0.0; self.columns];
                unit[j] = 1.0;
                self.solve_transposed(&mut unit);
                norm(&unit)
            })
            .collect()
    }

    /// R b = b, from the bottom up.
    fn solve(&self, b: &mut [f64]) {
        for i in (0..self.columns).rev() {
            let known: f64 = (i + 1..self.columns).map(|j| self.r(i, j) * b[j]).sum();
            b[i] = (b[i] - known) / self.diagonal[i];
        }
    }

    /// R' b = b, from the top down.
    fn solve_transposed(&self, b: &mut [f64]) {
        for i in 0..self.columns {
            let known: f64 = (0..i).map(|j| self.r(j, i) * b[j]).sum();
            b[i] = (b[i] - known) / self.diagonal[i];
        }
    }

    fn r(&self, row: usize, column: usize) -> f64 {
        self.entries[column * self.rows + row]
    }

    fn vector(&self, k: usize) -> &[f64] {
        &self.entries[k * self.rows + k..(k + 1) * self.rows]
    }
}

/// Applies I - 2 v v' / v'v, where v'v / 2 = |reflected * v_0| by construction of v.
fn reflect(v: &[f64], reflected: f64, target: &mut [f64]) {
    let product: f64 = v.iter().zip(target.iter()).map(|(a, b)| a * b).sum();
    let factor = product / (reflected * v[0]).abs();
    target.iter_mut().zip(v).for_each(|(t, v)| *t -= factor * v);
}

fn norm(values: &[f64]) -> f64 {
    values.iter().map(|v| v * v).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_augmented_system_is_satisfied() {
        let x = [1.0, 2.0, -0.5, 1.5, 0.25, 1.0, 1.0, -1.0];
        let (upper, lower) = (vec![1.0, -2.0, 3.0, 0.5], vec![0.75, -1.25]);
        let qr = Qr::new(&x, 2).unwrap();
        let (r, b) = qr.solve_augmented(upper.clone(), lower.clone());
        for i in 0..4 {
            let sum = r[i] + x[2 * i] * b[0] + x[2 * i + 1] * b[1];
            assert!((sum - upper[i]).abs() < 1e-14, "row {i}: {sum}");
        }
        for j in 0..2 {
            let sum: f64 = (0..4).map(|i| x[2 * i + j] * r[i]).sum();
            assert!((sum - lower[j]).abs() < 1e-14, "column {j}: {sum}");
        }
    }

    #[test]
    fn row_norms_of_the_inverse_by_hand() {
        // X' X = [2 1; 1 2], whose inverse has 2/3 on the diagonal.
        let qr = Qr::new(&[1.0, 1.0, 1.0, 0.0, 0.0, 1.0], 2).unwrap();
        for norm in qr.inverse_row_norms() {
            assert!((norm - (2f64 / 3.0).sqrt()).abs() < 1e-15, "{norm}");
        }
    }

    #[test]
    fn columns_already_on_their_axes_do_not_cancel() {
        let qr = Qr::new(&[1.0, 0.0, 0.0, -1.0, 0.0, 0.0], 2).unwrap();
        let (r, b) = qr.solve_augmented(vec![2.0, 3.0, 5.0], vec![0.0; 2]);
        assert_eq!((r, b), (vec![0.0, 0.0, 5.0], vec![2.0, -3.0]));
    }

    #[test]
    fn a_repeated_column_is_named() {
        let x = [0.1, 0.7, 0.1, 0.3, 0.2, 0.3, 0.9, 0.4, 0.9];
        assert_eq!(Qr::new(&x, 3).err(), Some(2));
    }
}
