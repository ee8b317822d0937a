//! Linear least squares to the accuracy of the data.
//!
//! The idea: a Householder factorisation X = QR of the design, its columns scaled by powers of two (which rounds
//! nothing), then one step of iterative refinement of the augmented system
//!
//! ```text
//! [ I   X ] [ r ]   [ y ]
//! [ X'  0 ] [ b ] = [ 0 ]
//! ```
//!
//! whose residuals are summed in double-double precision. The step matters where the residuals are large and the
//! design is ill conditioned: plain QR keeps 6 digits of NIST's Wampler5, the refined solution all of them.
//!
//! Sources: Golub and Van Loan, "Matrix Computations", 5.2 and 5.3.8; Björck, "Iterative refinement of linear least
//! squares solutions I" (BIT 7, 1967). The invariant: `r + X b = y` and `X' r = 0` hold together, to rounding, so
//! coefficients and residuals are accurate together. `tests/nist.rs` states the digits attained.
//!
//! The standard errors assume independent observations of equal variance (or of variance 1/weight). The hit counts of
//! the nodes of one tree are *not* independent: their intervals come from per-line scores, see [`super::moments`].

use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::double_double::DoubleDouble;
use super::qr::Qr;

/// The most columns a design may have.
pub const MAX_COLUMNS: usize = 16;

/// A fitted linear model.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Fit {
    /// One coefficient a column, in units of y over units of the column.
    pub coefficients: Vec<f64>,
    /// The standard error of each coefficient, for independent errors of equal variance.
    pub standard_errors: Vec<f64>,
    /// The square root of the residual sum of squares over its degrees of freedom, in units of y.
    pub residual_sd: f64,
    /// The sum of the (weighted) squared residuals.
    pub residual_sum_of_squares: f64,
    /// Rows minus columns.
    pub degrees_of_freedom: usize,
    /// 1 - SSE / sum w (y - mean)^2, with the weighted mean. `None` if y is constant. It may be negative for a model
    /// without an intercept.
    pub r_squared_centred: Option<f64>,
    /// 1 - SSE / sum w y^2, the form NIST certifies for models without an intercept. `None` if y is zero.
    pub r_squared_uncentred: Option<f64>,
}

/// Why a model cannot be fitted.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum RegressionError {
    /// There are no observations.
    #[error("no observations, but a fit needs more rows than columns")]
    Empty,
    /// The number of columns is zero or too large.
    #[error("{columns} columns, but a design has 1 to {MAX_COLUMNS}")]
    Columns {
        /// The number of columns given.
        columns: usize,
    },
    /// The lengths do not belong together.
    #[error(
        "{entries} design entries and {weights} weights do not make {rows} rows of {columns} columns"
    )]
    Shape {
        /// Length of the design.
        entries: usize,
        /// Length of the weights.
        weights: usize,
        /// Length of y.
        rows: usize,
        /// The number of columns given.
        columns: usize,
    },
    /// Nothing would be left to estimate the residual variance from.
    #[error(
        "{rows} rows for {columns} columns, but a fit with standard errors needs more rows than columns"
    )]
    TooFewRows {
        /// The number of observations.
        rows: usize,
        /// The number of columns.
        columns: usize,
    },
    /// A number is infinite or not a number.
    #[error("row {row}: a value is not finite")]
    NotFinite {
        /// The first row concerned, counted from 0.
        row: usize,
    },
    /// A weight is not a positive finite number.
    #[error("row {row}: weight {weight}, but a weight is positive and finite")]
    Weight {
        /// The row, counted from 0.
        row: usize,
        /// The weight given.
        weight: f64,
    },
    /// A column is zero or, to rounding, a combination of the columns before it.
    #[error("column {column} is a linear combination of the columns before it")]
    RankDeficient {
        /// The column, counted from 0.
        column: usize,
    },
}

/// Fits y = X b by least squares.
///
/// `design` is X by rows, `columns` numbers a row; an intercept is simply a column of ones.
///
/// # Errors
/// See [`RegressionError`]: shapes, non-finite values, not more rows than columns, dependent columns.
pub fn least_squares(design: &[f64], columns: usize, y: &[f64]) -> Result<Fit, RegressionError> {
    weighted_least_squares(design, columns, y, &vec![1.0; y.len()])
}

/// Fits y = X b with weights proportional to 1 / variance of the observations, by scaling the rows with sqrt(weight).
///
/// Residual variance and sums of squares are those of the scaled rows. The scaling rounds each row once.
///
/// # Errors
/// Those of [`least_squares`], and a weight that is not positive and finite.
///
/// ```
/// use sahlab::stats::weighted_least_squares;
///
/// // Hits of three nodes against N p, through the origin; weights 1/(p (1 - p)).
/// let (p, hits) = ([0.5, 0.1, 0.01], [505.0, 98.0, 11.0]);
/// let expected = p.map(|p| 1000.0 * p);
/// let fit = weighted_least_squares(&expected, 1, &hits, &p.map(|p| 1.0 / (p * (1.0 - p))))?;
/// assert!((fit.coefficients[0] - 1.0).abs() < 3.0 * fit.standard_errors[0]);
/// // A column twice tells nothing new.
/// assert!(weighted_least_squares(&[1.0, 1.0, 2.0, 2.0, 3.0, 3.0], 2, &[1.0, 2.0, 4.0], &[1.0; 3]).is_err());
/// # Ok::<(), sahlab::stats::RegressionError>(())
/// ```
pub fn weighted_least_squares(
    design: &[f64],
    columns: usize,
    y: &[f64],
    weights: &[f64],
) -> Result<Fit, RegressionError> {
    check(design, columns, y, weights)?;
    let rows = y.len();

    // Scale the rows by the weights, then every column and y by a power of two.
    let row_scales: Vec<f64> = weights.iter().map(|w| w.sqrt()).collect();
    let mut x: Vec<f64> = (design.iter().enumerate())
        .map(|(i, value)| value * row_scales[i / columns])
        .collect();
    let mut y: Vec<f64> = y.iter().zip(&row_scales).map(|(v, s)| v * s).collect();
    if let Some(i) = x.iter().position(|v| !v.is_finite()) {
        return Err(RegressionError::NotFinite { row: i / columns });
    }
    if let Some(row) = y.iter().position(|v| !v.is_finite()) {
        return Err(RegressionError::NotFinite { row });
    }
    let mut column_scales = vec![0.0; columns];
    for (j, scale) in column_scales.iter_mut().enumerate() {
        let column = x.iter().skip(j).step_by(columns);
        *scale = binary_scale(column).ok_or(RegressionError::RankDeficient { column: j })?;
        x.iter_mut()
            .skip(j)
            .step_by(columns)
            .for_each(|v| *v *= *scale);
    }
    let y_scale = binary_scale(y.iter()).unwrap_or(1.0);
    y.iter_mut().for_each(|v| *v *= y_scale);

    // Solve, then correct the solution once by the equations it leaves unsatisfied.
    let qr = Qr::new(&x, columns).map_err(|column| RegressionError::RankDeficient { column })?;
    let (mut residuals, mut b) = qr.solve_augmented(y.clone(), vec![0.0; columns]);
    let (upper, lower) = unsatisfied(&x, &y, &residuals, &b);
    let (residual_corrections, b_corrections) = qr.solve_augmented(upper, lower);
    (residuals.iter_mut().zip(residual_corrections)).for_each(|(r, dr)| *r += dr);
    b.iter_mut().zip(b_corrections).for_each(|(b, db)| *b += db);

    // Sums of squares, of the residuals and of y about zero and about its mean.
    let mut weighted_y = DoubleDouble::default();
    let mut weight_sum = DoubleDouble::default();
    for (y, s) in y.iter().zip(&row_scales) {
        weighted_y.add_product(*y, *s);
        weight_sum.add_product(*s, *s);
    }
    let mean = weighted_y.value() / weight_sum.value();
    let sse = sum_of_squares(residuals.iter().copied());
    let about_zero = sum_of_squares(y.iter().copied());
    let about_mean = sum_of_squares(y.iter().zip(&row_scales).map(|(y, s)| y - s * mean));

    let degrees_of_freedom = rows - columns;
    let residual_sd = (sse.value() / degrees_of_freedom as f64).sqrt();
    Ok(Fit {
        coefficients: (b.iter().zip(&column_scales))
            .map(|(b, scale)| b * scale / y_scale)
            .collect(),
        standard_errors: (qr.inverse_row_norms().iter().zip(&column_scales))
            .map(|(norm, scale)| norm * residual_sd * scale / y_scale)
            .collect(),
        residual_sd: residual_sd / y_scale,
        residual_sum_of_squares: sse.value() / y_scale / y_scale,
        degrees_of_freedom,
        r_squared_centred: r_squared(sse, about_mean, about_zero),
        r_squared_uncentred: r_squared(sse, about_zero, about_zero),
    })
}

fn check(
    design: &[f64],
    columns: usize,
    y: &[f64],
    weights: &[f64],
) -> Result<(), RegressionError> {
    let rows = y.len();
    if columns == 0 || columns > MAX_COLUMNS {
        return Err(RegressionError::Columns { columns });
    }
    if design.len() != rows * columns || weights.len() != rows {
        return Err(RegressionError::Shape {
            entries: design.len(),
            weights: weights.len(),
            rows,
            columns,
        });
    }
    if rows == 0 {
        return Err(RegressionError::Empty);
    }
    if rows <= columns {
        return Err(RegressionError::TooFewRows { rows, columns });
    }
    for (row, &weight) in weights.iter().enumerate() {
        if !(weight > 0.0 && weight.is_finite()) {
            return Err(RegressionError::Weight { row, weight });
        }
        let x = &design[row * columns..(row + 1) * columns];
        if !y[row].is_finite() || x.iter().any(|v| !v.is_finite()) {
            return Err(RegressionError::NotFinite { row });
        }
    }
    Ok(())
}

/// The power of two that brings the largest magnitude into [1, 2). `None` if every value is zero (or subnormal).
fn binary_scale<'a>(values: impl Iterator<Item = &'a f64>) -> Option<f64> {
    const EXPONENT: u64 = 0x7ff << 52;
    let largest = values.fold(0.0, |m: f64, v| m.max(v.abs()));
    let power = f64::from_bits(largest.to_bits() & EXPONENT);
    (power > 0.0).then(|| 1.0 / power)
}

fn sum_of_squares(values: impl Iterator<Item = f64>) -> DoubleDouble {
    let mut sum = DoubleDouble::default();
    values.for_each(|v| sum.add_product(v, v));
    sum
}

/// 1 - SSE / total, unless the total is no more than the rounding of a constant y can leave.
fn r_squared(sse: DoubleDouble, total: DoubleDouble, about_zero: DoubleDouble) -> Option<f64> {
    const ROUNDING: f64 = 16.0 * f64::EPSILON * f64::EPSILON;
    let mut explained = total;
    explained.add_scaled(sse, -1.0);
    (total.value() > ROUNDING * about_zero.value()).then(|| explained.value() / total.value())
}

/// What the augmented system still lacks: `y - r - X b` and `-X' r`, each summed in double-double and rounded once.
fn unsatisfied(x: &[f64], y: &[f64], residuals: &[f64], b: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let mut lower = vec![DoubleDouble::default(); b.len()];
    let upper = (x.chunks_exact(b.len()).zip(y).zip(residuals))
        .map(|((row, &y), &r)| {
            let mut sum = DoubleDouble::default();
            sum.add(y);
            sum.add(-r);
            for ((&x, &b), lower) in row.iter().zip(b).zip(&mut lower) {
                sum.add_product(-x, b);
                lower.add_product(-x, r);
            }
            sum.value()
        })
        .collect();
    (upper, lower.iter().map(|sum| sum.value()).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 1, x, for x = 0, 1, 2, 3.
    const LINE: [f64; 8] = [1.0, 0.0, 1.0, 1.0, 1.0, 2.0, 1.0, 3.0];

    fn assert_close(a: f64, b: f64) {
        assert!((a - b).abs() <= 1e-14 * b.abs().max(1.0), "{a} against {b}");
    }

    #[test]
    fn a_line_by_hand() {
        // y = 1, 2, 2, 4: slope 0.9, intercept 0.9, SSE 0.7, Sxx = 5, Syy = 4.75.
        let fit = least_squares(&LINE, 2, &[1.0, 2.0, 2.0, 4.0]).unwrap();
        assert_close(fit.coefficients[0], 0.9);
        assert_close(fit.coefficients[1], 0.9);
        assert_eq!(fit.degrees_of_freedom, 2);
        assert_close(fit.residual_sum_of_squares, 0.7);
        assert_close(fit.residual_sd, 0.35_f64.sqrt());
        assert_close(fit.standard_errors[1], (0.35_f64 / 5.0).sqrt());
        assert_close(
            fit.standard_errors[0],
            (0.35_f64 * (0.25 + 2.25 / 5.0)).sqrt(),
        );
        assert_close(fit.r_squared_centred.unwrap(), 1.0 - 0.7 / 4.75);
        assert_close(fit.r_squared_uncentred.unwrap(), 1.0 - 0.7 / 25.0);
    }

    #[test]
    fn a_weight_of_two_is_a_row_twice() {
        let y = [1.0, 2.0, 2.0, 4.0];
        let weighted = weighted_least_squares(&LINE, 2, &y, &[1.0, 1.0, 1.0, 2.0]).unwrap();
        let twice: Vec<f64> = LINE.iter().chain(&LINE[6..]).copied().collect();
        let repeated = least_squares(&twice, 2, &[1.0, 2.0, 2.0, 4.0, 4.0]).unwrap();
        for (a, b) in weighted.coefficients.iter().zip(&repeated.coefficients) {
            assert_close(*a, *b);
        }
        let (a, b) = (&weighted, &repeated);
        assert_close(a.residual_sum_of_squares, b.residual_sum_of_squares);
        assert_close(a.r_squared_centred.unwrap(), b.r_squared_centred.unwrap());
        assert_eq!((a.degrees_of_freedom, b.degrees_of_freedom), (2, 3));
    }

    #[test]
    fn powers_of_two_change_no_bit() {
        let y = [1.0, 2.1, 1.7, 4.3];
        let (up, down) = (2f64.powi(600), 2f64.powi(-600));
        let scaled: Vec<f64> = LINE.iter().map(|v| v * up).collect();
        let scaled_y: Vec<f64> = y.iter().map(|v| v * down).collect();
        let fit = least_squares(&LINE, 2, &y).unwrap();
        let tiny = least_squares(&LINE, 2, &scaled_y).unwrap();
        let huge = least_squares(&scaled, 2, &y).unwrap();
        for j in 0..2 {
            assert_eq!(tiny.coefficients[j], fit.coefficients[j] * down);
            assert_eq!(huge.coefficients[j], fit.coefficients[j] * down);
            assert_eq!(huge.standard_errors[j], fit.standard_errors[j] * down);
        }
        assert_eq!(huge.r_squared_centred, fit.r_squared_centred);
    }

    #[test]
    fn r_squared_of_a_constant_does_not_exist() {
        let fit = least_squares(&LINE, 2, &[0.1; 4]).unwrap();
        assert_eq!(fit.r_squared_centred, None);
        assert_close(fit.r_squared_uncentred.unwrap(), 1.0);
        let fit = least_squares(&LINE, 2, &[0.0; 4]).unwrap();
        assert_eq!(fit.r_squared_uncentred, None);
        assert_eq!(fit.residual_sd, 0.0);
    }

    #[test]
    fn every_bad_input_is_named() {
        let y = [1.0, 2.0, 3.0, 4.0];
        let message = |design: &[f64], columns, y: &[f64], weights: &[f64]| {
            let error = weighted_least_squares(design, columns, y, weights);
            error.unwrap_err().to_string()
        };
        let ones = [1.0; 4];
        let mut infinite = LINE;
        infinite[5] = f64::INFINITY;
        let zero_column = [1.0, 0.0, 2.0, 0.0, 3.0, 0.0, 4.0, 0.0];
        for (design, columns, y, weights, expected) in [
            (&[][..], 1, &[][..], &[][..], "no observations"),
            (&[], 0, &y, &ones, "0 columns, but a design has 1 to 16"),
            (&[0.0; 68], 17, &y, &ones, "17 columns"),
            (&LINE, 3, &y, &ones, "8 design entries and 4 weights"),
            (&LINE, 2, &y, &ones[1..], "8 design entries and 3 weights"),
            (&LINE[..4], 2, &y[..2], &ones[..2], "2 rows for 2 columns"),
            (
                &LINE,
                2,
                &[0.0, f64::NAN, 0.0, 0.0],
                &ones,
                "row 1: a value",
            ),
            (&infinite, 2, &y, &ones, "row 2: a value is not finite"),
            (&LINE, 2, &y, &[1.0, 1.0, 1.0, -1.0], "row 3: weight -1"),
            (&LINE, 2, &y, &[1.0, 0.0, 1.0, 1.0], "row 1: weight 0"),
            (&zero_column, 2, &y, &ones, "column 1 is a linear"),
        ] {
            let message = message(design, columns, y, weights);
            assert!(message.starts_with(expected), "{message}, not {expected}");
        }
    }

    #[test]
    fn dependent_columns_are_found_in_long_designs() {
        // The third column is 0.3 of the first plus 0.7 of the second, rounded.
        let rows = 20_000;
        let mut design = Vec::new();
        for i in 0..rows {
            let t = f64::from(i) / 7.0;
            design.extend([1.0, t, 0.3 + 0.7 * t]);
        }
        let y: Vec<f64> = (0..rows).map(f64::from).collect();
        let expected = Err(RegressionError::RankDeficient { column: 2 });
        assert_eq!(least_squares(&design, 3, &y), expected);
        // A tenth of a millionth of curvature makes it independent.
        design
            .iter_mut()
            .skip(2)
            .step_by(3)
            .for_each(|v| *v += 1e-10 * *v * *v);
        assert!(least_squares(&design, 3, &y).is_ok());
    }
}
