//! Least squares through designs that leave few digits, after NIST's Statistical Reference Datasets; solutions known exactly.

use super::case;
use crate::stats::{RegressionError, least_squares, weighted_least_squares};
use crate::study::stability::case::{Case, Finding};

/// The cases of fits.
pub(super) fn cases() -> Vec<Case> {
    vec![
        case("powers-up-to-the-fifth", "condition 1e7", || {
            // NIST Wampler1: y = 1 + x + ... + x^5 for x = 0 to 20, all of them whole numbers.
            right_digits(&powers(5, 0.0), 1.0, 9.0)
        }),
        case("powers-with-large-residuals", "cancellation", || {
            // After NIST Wampler5: residuals of 1e8, orthogonal to every power up to the fifth.
            right_digits(&powers(5, 0.0), 1e8, 6.0)
        }),
        case("a-line-far-from-zero", "condition 1e7", || {
            right_digits(&powers(1, 1e8), 1.0, 4.0)
        }),
        case("hilbert-columns", "condition 1e10", || {
            let hilbert = |i: usize| (0..8).map(|j| 1.0 / (i + j + 1) as f64).collect();
            right_digits(&(0..12).map(hilbert).collect::<Vec<_>>(), 0.0, 4.0)
        }),
        case("weights-over-hundreds-of-decades", "scaling", || {
            let x: Vec<f64> = (1..=10).map(f64::from).collect();
            let weights: Vec<f64> = (0..10)
                .map(|i| libm::pow(10.0, f64::from(50 * i - 225)))
                .collect();
            let fit = weighted_least_squares(&x, 1, &x, &weights);
            Finding::of(
                "Ok([1.0])",
                format!("{:?}", fit.map(|fit| fit.coefficients)),
            )
        }),
        case("a-column-twice", "dependent columns", || {
            let design: Vec<f64> = (0..20).flat_map(|i| [f64::from(i); 2]).collect();
            refused(&design, 2, RegressionError::RankDeficient { column: 1 })
        }),
        case("a-column-nearly-twice", "dependent columns", || {
            let design: Vec<f64> = (0..20)
                .flat_map(|i| [f64::from(i), f64::from(i) * (1.0 + f64::EPSILON)])
                .collect();
            refused(&design, 2, RegressionError::RankDeficient { column: 1 })
        }),
        case("as-many-rows-as-columns", "no residual", || {
            refused(
                &[1.0, 0.0, 0.0, 1.0],
                2,
                RegressionError::TooFewRows {
                    rows: 2,
                    columns: 2,
                },
            )
        }),
        case("a-row-that-is-not-finite", "NaN", || {
            refused(
                &[1.0, f64::NAN, 1.0],
                1,
                RegressionError::NotFinite { row: 1 },
            )
        }),
    ]
}

/// Rows of the powers 0 to `degree` of 0 to 20, moved by `offset`.
fn powers(degree: i32, offset: f64) -> Vec<Vec<f64>> {
    let row = |x: f64| {
        (0..=degree).scan(1.0, move |power, _| {
            Some(std::mem::replace(power, *power * x))
        })
    };
    (0..=20)
        .map(|x| row(f64::from(x) + offset).collect())
        .collect()
}

/// Whether a fit finds coefficients of 1 to so many digits (the log relative error of McCullough 1998). Every row stands
/// twice, with `residual` added to y and taken from it: such residuals are orthogonal to every column.
fn right_digits(rows: &[Vec<f64>], residual: f64, demanded: f64) -> Finding {
    let (mut design, mut y) = (Vec::new(), Vec::new());
    for row in rows {
        let sum: f64 = row.iter().sum();
        design.extend([&row[..], row].concat());
        y.extend([sum + residual, sum - residual]);
    }
    let expected = format!("at least {demanded} digits");
    match least_squares(&design, rows[0].len(), &y) {
        Ok(fit) => {
            let error = |b: &f64| {
                if b.is_nan() {
                    f64::INFINITY
                } else {
                    (b - 1.0).abs()
                }
            };
            // No error is told as one in the last place.
            let errors = fit.coefficients.iter().map(error);
            let worst = errors.fold(f64::EPSILON, f64::max);
            let digits = -libm::log10(worst);
            Finding::judged(expected, format!("{digits:.1} digits"), digits >= demanded)
        }
        Err(error) => Finding::judged(expected, error, false),
    }
}

/// A design that must be refused in so many words.
fn refused(design: &[f64], columns: usize, expected: RegressionError) -> Finding {
    let y = vec![1.0; design.len() / columns];
    let measured = match least_squares(design, columns, &y) {
        Ok(fit) => format!("{:?}", fit.coefficients),
        Err(error) => error.to_string(),
    };
    Finding::of(expected, measured)
}
