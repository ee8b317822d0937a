//! Tail probabilities and quantiles of the normal, Student and F distributions.
//!
//! The idea: every tail is computed as a tail, never as one minus a distribution function, so small p-values keep
//! their digits. Source of the functions: the crates `libm` (error function; the one of `statrs` 0.19 has only 10
//! digits) and `statrs` (its inverse, incomplete beta function); formulas: Abramowitz and Stegun, "Handbook of
//! Mathematical Functions", 26.5.27 and 26.6.2.
//!
//! The invariant: results are in [0, 1] and never NaN. Probabilities below 1e-308 come back as 0. The incomplete beta
//! function loses digits as the degrees of freedom grow: of the t tail about 1e-9 at a million, 2e-8 at 2^24.

use std::f64::consts::SQRT_2;

use statrs::function::beta::beta_reg;
use statrs::function::erf::erfc_inv;

/// The two-sided p-value of a standard normal z.
///
/// # Panics
/// If z is NaN. An infinite z has p = 0.
pub fn normal_p(z: f64) -> f64 {
    assert!(!z.is_nan(), "z is not a number");
    libm::erfc(z.abs() / SQRT_2)
}

/// The two-sided p-value of a Student t with the given degrees of freedom.
///
/// # Panics
/// If t is NaN or the degrees of freedom are not positive and finite. An infinite t has p = 0.
pub fn student_p(t: f64, degrees_of_freedom: f64) -> f64 {
    f_tail(t * t, 1.0, degrees_of_freedom)
}

/// The probability that an F variable with (d1, d2) degrees of freedom exceeds f.
///
/// # Panics
/// If f is negative or NaN, or a degree of freedom is not positive and finite. An infinite f has p = 0.
pub fn f_tail(f: f64, d1: f64, d2: f64) -> f64 {
    assert!(f >= 0.0, "F = {f} is not a non-negative number");
    for d in [d1, d2] {
        assert!(d > 0.0 && d.is_finite(), "{d} degrees of freedom");
    }
    // Written so that neither a tiny nor a huge f loses the small side of the ratio.
    beta_reg(d2 / 2.0, d1 / 2.0, 1.0 / (1.0 + d1 / d2 * f)).clamp(0.0, 1.0)
}

/// The half width, in standard errors, of a two-sided normal interval: 0.99 gives 2.5758.
///
/// # Panics
/// If the level is not strictly between 0 and 1.
pub fn normal_quantile(level: f64) -> f64 {
    simultaneous_quantile(level, 1)
}

/// The half width, in standard errors, of each of several intervals that hold together with the given level
/// (Bonferroni): each has the level 1 - (1 - level) / intervals.
///
/// # Panics
/// If the level is not strictly between 0 and 1, or there are no intervals.
///
/// ```
/// use sahlab::stats::simultaneous_quantile;
///
/// // An interval at 99 % reaches 2.58 standard errors to each side, 132 that hold together 4.0.
/// assert!((simultaneous_quantile(0.99, 1) - 2.5758).abs() < 1e-4);
/// assert!((simultaneous_quantile(0.99, 132) - 3.96).abs() < 0.01);
/// ```
pub fn simultaneous_quantile(level: f64, intervals: usize) -> f64 {
    assert!(level > 0.0 && level < 1.0, "level {level} is not in (0, 1)");
    assert!(intervals > 0, "no intervals");
    SQRT_2 * erfc_inv((1.0 - level) / intervals as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_close(a: f64, b: f64, tolerance: f64) {
        assert!((a - b).abs() <= tolerance * b.abs(), "{a:e} against {b:e}");
    }

    #[test]
    fn normal_against_published_values() {
        assert_eq!(normal_p(0.0), 1.0);
        assert_close(normal_p(1.0), 0.317_310_507_862_914_1, 1e-14);
        assert_close(normal_p(-2.0), 0.045_500_263_896_358_42, 1e-14);
        assert_close(normal_p(5.0), 5.733_031_437_583_869e-7, 1e-13);
        assert_eq!(normal_p(f64::INFINITY), 0.0);
        assert_eq!(normal_p(40.0), 0.0);
    }

    #[test]
    fn student_against_closed_forms() {
        for t in [0.0, 0.01, 0.5, 1.0, -2.0, 7.0, -300.0, 1e6] {
            let a = f64::abs(t);
            // One degree of freedom: Cauchy. Two: 1 - a / sqrt(2 + a^2), without its cancellation.
            let cauchy = std::f64::consts::FRAC_2_PI * f64::atan2(1.0, a);
            assert_close(student_p(t, 1.0), cauchy, 1e-12);
            let root = (2.0 + a * a).sqrt();
            assert_close(student_p(t, 2.0), 2.0 / (root * (root + a)), 1e-12);
        }
        assert_eq!(student_p(f64::NEG_INFINITY, 5.0), 0.0);
        assert_eq!(student_p(1e200, 5.0), 0.0);
    }

    #[test]
    fn student_against_quadrature() {
        // Simpson's rule on the density, normalised by its own total, so no gamma function enters.
        for (v, tolerance) in [
            (30.0, 1e-10),
            (65_535.0, 2e-9),
            (1e6, 5e-9),
            (16_777_215.0, 1e-7),
        ] {
            let density = |x: f64| (-(v + 1.0) / 2.0 * f64::ln_1p(x * x / v)).exp();
            let integral = |from: f64| {
                let (intervals, to) = (20_000, 60.0);
                let step = (to - from) / f64::from(intervals);
                let weight = |i| {
                    if i % intervals == 0 {
                        1.0
                    } else {
                        f64::from(2 + i % 2 * 2)
                    }
                };
                let term = |i| weight(i) * density(from + f64::from(i) * step);
                step / 3.0 * (0..=intervals).map(term).sum::<f64>()
            };
            for t in [0.1, 1.0, 2.5, 6.0] {
                assert_close(student_p(t, v), integral(t) / integral(0.0), tolerance);
            }
        }
    }

    #[test]
    fn f_against_closed_forms() {
        for f in [0.0, 1e-9, 0.3, 1.0, 4.0, 60.0] {
            for d2 in [1.0, 7.0, 60.0, 65_534.0] {
                // d1 = 2: (1 + 2 f / d2)^(-d2 / 2). d1 = 4: the same kind of power times a linear term.
                let w = (-d2 / 2.0 * f64::ln_1p(2.0 * f / d2)).exp();
                assert_close(f_tail(f, 2.0, d2), w, 1e-9);
                let x = 1.0 / (1.0 + 4.0 * f / d2);
                let power = (d2 / 2.0 * f64::ln(x)).exp();
                let four = power * (1.0 + d2 / 2.0 * (1.0 - x));
                assert_close(f_tail(f, 4.0, d2), four, 1e-9);
            }
        }
        assert_eq!(f_tail(f64::INFINITY, 3.0, 10.0), 0.0);
        assert_eq!(f_tail(1e300, 3.0, 1000.0), 0.0);
    }

    #[test]
    fn quantiles_are_the_inverse_of_the_tail() {
        assert_close(normal_quantile(0.99), 2.575_829_303_548_901, 1e-14);
        assert_close(normal_quantile(0.95), 1.959_963_984_540_054, 1e-14);
        for intervals in [1, 2, 800, 1_000_000] {
            for level in [0.01, 0.5, 0.95, 0.99, 0.999_999] {
                let p = normal_p(simultaneous_quantile(level, intervals));
                assert_close(p, (1.0 - level) / intervals as f64, 1e-12);
            }
        }
    }

    #[test]
    fn nothing_is_nan() {
        for f in [0.0, f64::MIN_POSITIVE, 1e-200, 1.0, 1e200, f64::MAX] {
            for d1 in [1e-3, 1.0, 2.0, 16.0, 1e9] {
                for d2 in [1e-3, 1.0, 50.0, 1e9, 1e18] {
                    let p = f_tail(f, d1, d2);
                    assert!((0.0..=1.0).contains(&p), "F = {f}, ({d1}, {d2}): {p}");
                }
            }
        }
    }

    #[test]
    #[should_panic(expected = "z is not a number")]
    fn nan_is_refused() {
        normal_p(f64::NAN);
    }
}
