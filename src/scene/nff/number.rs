//! Numbers as C's `%g` writes them.

/// `x` with that many significant digits (at least one), without trailing zeros; as a power of ten where that is below -4
/// or not below the number of digits. 17 digits read back to the same bits. `x` must be finite.
pub(super) fn significant(x: f64, digits: usize) -> String {
    let digits = digits.max(1);
    let scientific = format!("{:.*e}", digits - 1, x);
    let (mantissa, exponent) = scientific
        .split_once('e')
        .expect("the scientific form of a finite number has an exponent");
    // Known after rounding: 9.9999996 has the exponent 1 with six digits.
    let exponent: i32 = exponent.parse().expect("an exponent is a whole number");
    match usize::try_from(exponent) {
        Ok(whole) if whole < digits => trimmed(&format!("{x:.*}", digits - 1 - whole)).into(),
        Err(_) if exponent >= -4 => {
            let places = digits - 1 + exponent.unsigned_abs() as usize;
            trimmed(&format!("{x:.places$}")).into()
        }
        _ => {
            let sign = if exponent < 0 { '-' } else { '+' };
            format!("{}e{sign}{:02}", trimmed(mantissa), exponent.unsigned_abs())
        }
    }
}

/// Without the zeros that end a fraction.
fn trimmed(text: &str) -> &str {
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.')
    } else {
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn as_printf_writes_them() {
        for (x, digits, text) in [
            (0.0, 6, "0"),
            (-0.0, 6, "-0"),
            (1.0, 6, "1"),
            (-0.5, 6, "-0.5"),
            (100.0, 6, "100"),
            (100_000.0, 6, "100000"),
            (1e6, 6, "1e+06"),
            (123_456_789.0, 6, "1.23457e+08"),
            (999_999.5, 6, "1e+06"),
            (9.999_999_6, 6, "10"),
            (0.000_1, 6, "0.0001"),
            (0.000_099_999_99, 6, "0.0001"),
            (0.000_012_345_67, 6, "1.23457e-05"),
            (2.0 / 3.0, 6, "0.666667"),
            (2.0 / 3.0, 17, "0.66666666666666663"),
            (0.1, 17, "0.10000000000000001"),
            (1e16, 17, "10000000000000000"),
            (1e17, 17, "1e+17"),
            (5e-324, 17, "4.9406564584124654e-324"),
            (f64::MAX, 17, "1.7976931348623157e+308"),
            (2.5, 1, "2"),
            (35.0, 1, "4e+01"),
            (0.96, 1, "1"),
        ] {
            assert_eq!(significant(x, digits), text, "{x} with {digits} digits");
        }
    }

    #[test]
    fn seventeen_digits_keep_every_bit() {
        let mut bits = 1_u64;
        for _ in 0..20_000 {
            bits = bits.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            let x = f64::from_bits(bits);
            if x.is_finite() {
                let back: f64 = significant(x, 17).parse().expect("a number");
                assert_eq!(back.to_bits(), bits, "{x:e}");
            }
        }
    }
}
