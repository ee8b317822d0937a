//! Numbers as text. Rounding happens here and nowhere else: as many digits as the error leaves.

/// Normal quantile of a two-sided 99 % interval.
pub const Z99: f64 = 2.575_829_303_548_901;

/// Most decimals ever shown.
const MOST_DECIMALS: i32 = 12;

/// Decimals that show `error` with two significant digits.
pub fn decimals_for(error: f64) -> usize {
    if error.is_finite() && error > 0.0 {
        (1 - magnitude(error, 2)).clamp(0, MOST_DECIMALS) as usize
    } else {
        4
    }
}

/// Decimals that show `value` with this many significant digits, as far as digits after the point can.
pub fn digits_for(value: f64, digits: usize) -> usize {
    if value == 0.0 || !value.is_finite() {
        return 0;
    }
    let decimals = digits as i32 - 1 - magnitude(value.abs(), digits);
    decimals.clamp(0, MOST_DECIMALS) as usize
}

/// Decimal exponent of a positive number once rounded to this many digits.
fn magnitude(value: f64, digits: usize) -> i32 {
    let text = format!("{:.*e}", digits.saturating_sub(1), value);
    let exponent = text
        .rsplit('e')
        .next()
        .and_then(|exponent| exponent.parse().ok());
    exponent.expect("the exponent format ends in an exponent")
}

/// A number with fixed decimals and a real minus sign; never "-0".
pub fn fixed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(rest) if rest.bytes().all(|byte| matches!(byte, b'0' | b'.')) => rest.to_owned(),
        Some(rest) => format!("−{rest}"),
        None => text,
    }
}

/// `fixed` with a sign on positive numbers too.
pub fn signed(value: f64, decimals: usize) -> String {
    let text = fixed(value, decimals);
    let zero = text.bytes().all(|byte| matches!(byte, b'0' | b'.'));
    if zero || text.starts_with('−') {
        text
    } else {
        format!("+{text}")
    }
}

/// A number with this many significant digits: plain between 0.001 and 10,000,000, else `4.3·10⁻⁷`.
pub fn significant(value: f64, digits: usize) -> String {
    if value == 0.0 || !value.is_finite() {
        return fixed(value, 0);
    }
    let exponent = magnitude(value.abs(), digits);
    if (-3..7).contains(&exponent) {
        return fixed(value, (digits as i32 - 1 - exponent).max(0) as usize);
    }
    let text = format!("{value:.*e}", digits.saturating_sub(1));
    let mantissa = text.split('e').next().unwrap_or(&text).replace('-', "−");
    format!("{mantissa}·{}", power_of_ten(exponent))
}

/// A p-value as R prints it: never 0.
pub fn p_value(p: f64) -> String {
    if p < 2.2e-16 {
        "< 2.2e-16".to_owned()
    } else if p < 1e-3 {
        format!("{p:.1e}")
    } else {
        format!("{p:.3}")
    }
}

/// `10⁻⁶`.
pub fn power_of_ten(exponent: i32) -> String {
    let raised = |character: char| match character.to_digit(10) {
        None => '⁻',
        Some(1) => '¹',
        Some(2) => '²',
        Some(3) => '³',
        // The others stand in a row from superscript zero on.
        Some(digit) => char::from_u32('⁰' as u32 + digit).unwrap_or(character),
    };
    format!(
        "10{}",
        exponent.to_string().chars().map(raised).collect::<String>()
    )
}

/// `4,194,304`.
pub fn grouped(count: u64) -> String {
    let digits = count.to_string();
    let mut out = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            out.push(',');
        }
        out.push(digit);
    }
    out
}

/// `3 nodes`, `1 node`.
pub fn counted(count: u64, noun: &str) -> String {
    format!(
        "{} {noun}{}",
        grouped(count),
        if count == 1 { "" } else { "s" }
    )
}

/// A ratio as per cent above 1.
pub fn percent_above(ratio: f64) -> f64 {
    100.0 * (ratio - 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_follow_the_error() {
        assert_eq!(decimals_for(0.0123), 3);
        assert_eq!(decimals_for(0.0996), 2, "rounds to 0.10");
        assert_eq!(decimals_for(37.0), 0);
        assert_eq!(decimals_for(f64::NAN), 4);
        assert_eq!(digits_for(-41.996, 4), 2);
        assert_eq!(digits_for(99.996, 4), 1, "rounds to 100.0");
        assert_eq!(digits_for(123_456.0, 4), 0);
        assert_eq!(digits_for(0.0, 4), 0);
        assert_eq!(fixed(-0.0004, 2), "0.00");
        assert_eq!(fixed(-1.25, 1), "−1.2");
        assert_eq!(signed(0.5, 1), "+0.5");
        assert_eq!(signed(-0.04, 1), "0.0");
    }

    #[test]
    fn small_and_large_numbers_get_a_power_of_ten() {
        assert_eq!(significant(4.34e-7, 2), "4.3·10⁻⁷");
        assert_eq!(significant(-9.96e12, 2), "−1.0·10¹³");
        assert_eq!(significant(1234.5, 3), "1234");
        assert_eq!(significant(0.012_34, 2), "0.012");
        assert_eq!(significant(0.0, 2), "0");
        assert_eq!(power_of_ten(-1234567890), "10⁻¹²³⁴⁵⁶⁷⁸⁹⁰");
    }

    #[test]
    fn a_p_value_is_never_zero() {
        assert_eq!(p_value(0.0), "< 2.2e-16");
        assert_eq!(p_value(3.2e-9), "3.2e-9");
        assert_eq!(p_value(0.5), "0.500");
    }

    #[test]
    fn counts_are_grouped() {
        assert_eq!(grouped(4_194_304), "4,194,304");
        assert_eq!(grouped(12), "12");
        assert_eq!(counted(1, "node"), "1 node");
        assert_eq!(counted(1000, "node"), "1,000 nodes");
    }
}
