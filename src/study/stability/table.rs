//! Reads tables of hard cases: a case a line below a heading, cells between bars.

use glam::DVec3;

/// Why reading cannot fail.
const FIXED: &str = "tables of hard cases are part of the program";

/// The rows of a table, so many cells each.
pub fn rows<const N: usize>(text: &'static str) -> impl Iterator<Item = [&'static str; N]> {
    let row = |line: &'static str| {
        let cells: Vec<&str> = line.split('|').map(str::trim).collect();
        cells.try_into().expect(FIXED)
    };
    text.lines().skip(1).map(row)
}

/// Whether a cell says that line and object meet.
pub fn meet(cell: &str) -> bool {
    match cell {
        "hit" => true,
        "miss" => false,
        _ => panic!("{FIXED}: {cell}"),
    }
}

/// A point or a direction: x, y and z, or one number for all three.
pub fn vector(cell: &str) -> DVec3 {
    let parts: Vec<f64> = cell.split(' ').map(number).collect();
    match parts[..] {
        [all] => DVec3::splat(all),
        [x, y, z] => DVec3::new(x, y, z),
        _ => panic!("{FIXED}: {cell}"),
    }
}

/// A sum of decimals and powers of two, rounded after each: `-0`, `1e6+1`, `1-2^-24`, `inf`.
pub fn number(text: &str) -> f64 {
    let within = |i: usize| i > 0 && !text[..i].ends_with(['^', 'e']);
    let signs = text.match_indices(['+', '-']).map(|(i, _)| i);
    let mut starts: Vec<usize> = signs.filter(|&i| within(i)).collect();
    starts.insert(0, 0);
    let ends = starts.iter().skip(1).copied().chain([text.len()]);
    let terms = starts
        .iter()
        .zip(ends)
        .map(|(&start, end)| term(&text[start..end]));
    // Not from 0 on: 0 + -0 is 0.
    terms.reduce(|sum, term| sum + term).expect(FIXED)
}

/// A decimal or a power of two, with its sign.
fn term(text: &str) -> f64 {
    match text.split_once("2^") {
        Some((sign, k)) => {
            let power = libm::ldexp(1.0, k.parse().expect(FIXED));
            match sign {
                "" | "+" => power,
                "-" => -power,
                _ => panic!("{FIXED}: {text}"),
            }
        }
        None => text.parse().expect(FIXED),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_exact() {
        let exact = [
            ("-0", -0.0),
            ("1e6+1", 1_000_001.0),
            ("1e6+1-2^-20", 1_000_001.0 - f64::EPSILON * 4_294_967_296.0),
            ("-1-2^-50", -1.0 - 4.0 * f64::EPSILON),
            ("-2^-1074", -f64::from_bits(1)),
            (
                "2^100-2^77",
                f64::from((1 << 23) - 1) * libm::ldexp(1.0, 77),
            ),
            ("-1e-20", -1e-20),
            ("1.7976931348623157e308", f64::MAX),
        ];
        for (text, right) in exact {
            assert_eq!(number(text).to_bits(), right.to_bits(), "{text}");
        }
        assert_eq!(vector("2^-3"), DVec3::splat(0.125));
        assert_eq!(vector("0 1 -2"), DVec3::new(0.0, 1.0, -2.0));
    }

    #[test]
    #[should_panic(expected = "12^3")]
    fn no_other_power_is_taken() {
        number("12^3");
    }

    #[test]
    fn rows_come_in_cells() {
        let table = "name | meet\na    | hit\nb    | miss";
        let rows: Vec<[&str; 2]> = rows(table).collect();
        assert_eq!(rows.clone(), [["a", "hit"], ["b", "miss"]]);
        assert!(meet(rows[0][1]) && !meet(rows[1][1]));
    }
}
