//! Is a text the same as another, but for the last digits of figures that are no counts?

use std::io::{self, BufRead, Read};

use super::TOLERANCE;

/// How two files compare.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Alike {
    /// Byte for byte.
    Equal,
    /// But for figures within the tolerance.
    Within,
    /// They differ, first in this line (from 1), as told.
    Differs(u64, String),
}

/// Ends of the names of files that are text.
const TEXTS: [&str; 9] = [
    ".csv", ".json", ".md", ".tex", ".toml", ".txt", ".dat", ".svg", ".html",
];

/// Longest part of a line that is compared as one.
const LONGEST: u64 = 1 << 20;

/// Compare two files of this name, line by line.
pub(super) fn compare(
    name: &str,
    mut archived: impl BufRead,
    mut repeated: impl BufRead,
) -> io::Result<Alike> {
    let is_text = TEXTS.iter().any(|end| name.ends_with(end));
    let mut within = false;
    let mut line = 1;
    let (mut a, mut b) = (Vec::new(), Vec::new());
    loop {
        a.clear();
        b.clear();
        archived.by_ref().take(LONGEST).read_until(b'\n', &mut a)?;
        repeated.by_ref().take(LONGEST).read_until(b'\n', &mut b)?;
        if a != b {
            let wrong = if is_text {
                first_difference(&a, &b)
            } else {
                Some("other bytes".into())
            };
            match wrong {
                Some(what) => return Ok(Alike::Differs(line, what)),
                None => within = true,
            }
        } else if a.is_empty() {
            return Ok(if within { Alike::Within } else { Alike::Equal });
        }
        line += u64::from(a.ends_with(b"\n"));
    }
}

/// What differs first in two lines by more than the tolerance, if anything does.
fn first_difference(mut a: &[u8], mut b: &[u8]) -> Option<String> {
    let mut before = None;
    while !(a.is_empty() && b.is_empty()) {
        let ((x, rest_a), (y, rest_b)) = (token(a, before), token(b, before));
        if x != y && !are_near(x, y) {
            return Some(format!("{} archived, {} repeated", shown(x), shown(y)));
        }
        before = x.last().copied();
        (a, b) = (rest_a, rest_b);
    }
    None
}

/// Whether two tokens are figures, no counts, within the tolerance.
fn are_near(x: &[u8], y: &[u8]) -> bool {
    let figure = |token: &[u8]| {
        let is_figure = token.first()?.is_ascii_digit() && token.iter().any(|b| b".eE".contains(b));
        let text = std::str::from_utf8(token).ok().filter(|_| is_figure)?;
        text.parse().ok().filter(|x: &f64| x.is_finite())
    };
    match (figure(x), figure(y)) {
        (Some(x), Some(y)) => (x - y).abs() <= TOLERANCE * x.max(y),
        _ => false,
    }
}

/// The first token of a text that follows this byte, and the rest: a number without its sign, or what lies before the next one. Digits
/// behind a letter or a dot belong to a name or a version, and so do those before a letter unless a point is among them.
fn token(text: &[u8], before: Option<u8>) -> (&[u8], &[u8]) {
    let in_word = |b: u8| b.is_ascii_alphanumeric() || b"_.".contains(&b) || !b.is_ascii();
    let mut before = before;
    for at in 0..text.len() {
        if text[at].is_ascii_digit() && !before.is_some_and(in_word) {
            let n = match at {
                0 => number(text),
                _ => at,
            };
            return text.split_at(n);
        }
        before = Some(text[at]);
    }
    (text, &[])
}

/// Length of the number or the word that begins with a text's first byte, a digit.
fn number(text: &[u8]) -> usize {
    let run = |from: usize, is: fn(&u8) -> bool| {
        let rest = text.get(from..).unwrap_or_default();
        from + rest.iter().take_while(|b| is(b)).count()
    };
    let digits = |from| run(from, u8::is_ascii_digit);
    let mut end = digits(0);
    let mut point = false;
    if text.get(end) == Some(&b'.') && digits(end + 1) > end + 1 {
        end = digits(end + 1);
        point = true;
    }
    if matches!(text.get(end), Some(b'e' | b'E')) {
        let signed = matches!(text.get(end + 1), Some(b'+' | b'-'));
        let from = end + 1 + usize::from(signed);
        if digits(from) > from {
            end = digits(from);
        }
    }
    let word = run(end, u8::is_ascii_alphanumeric);
    if point { end } else { word }
}

/// A token as a message shows it.
fn shown(token: &[u8]) -> String {
    const MOST: usize = 40;
    let text = String::from_utf8_lossy(token);
    match text.chars().count() {
        0 => "nothing".into(),
        n if n > MOST => format!("{:?}...", text.chars().take(MOST).collect::<String>()),
        _ => format!("{text:?}"),
    }
}

#[cfg(test)]
mod tests {
    use std::io::BufReader;

    use super::*;

    /// Small buffers, so that lines and numbers lie across them.
    fn alike(name: &str, a: &str, b: &str) -> Alike {
        let a = BufReader::with_capacity(3, a.as_bytes());
        let b = BufReader::with_capacity(5, b.as_bytes());
        compare(name, a, b).expect("in memory")
    }

    #[test]
    fn figures_within_the_tolerance_pass() {
        for (a, b) in [
            ("x,1.00000000000,y\n", "x,1.00000000001,y\n"),
            ("-2.5e-300", "-2.5000000001e-300"),
            ("{\"a\": 1e-7}", "{\"a\": 1.0000000001e-7}"),
            ("9.999999999999", "10.0"),
            (
                "it takes 1.50000000000s, or 3",
                "it takes 1.50000000001s, or 3",
            ),
            ("1.5 1.5 7", "1.5000000000000002 1.4999999999999998 7"),
        ] {
            assert_eq!(alike("x.csv", a, b), Alike::Within, "{a}");
            assert_eq!(alike("x.csv", a, a), Alike::Equal, "{a}");
            assert!(matches!(alike("x.png", a, b), Alike::Differs(1, _)), "{a}");
        }
    }

    #[test]
    fn counts_words_and_figures_beyond_it_do_not() {
        for (a, b) in [
            ("17", "18"),
            ("1000000000000", "1000000000001"),
            ("1.0", "1"),
            ("1.0", "1.000000002"),
            ("1.0", "-1.0"),
            ("0.0", "1e-300"),
            ("1e400", "2e400"),
            ("v1.00000000000", "v1.00000000001"),
            ("cell 12e4567890123a", "cell 12e4567890124a"),
            ("cell 1e10a", "cell 1.0000000000001e10a"),
            ("0.1.0", "0.1.1"),
            ("a,b", "a,c"),
            ("a", "a "),
            ("a\n", "a"),
            ("", "x"),
            ("ä1.5", "ö1.5"),
            ("1.5,", "1.5"),
        ] {
            let differs = |a, b| matches!(alike("x.csv", a, b), Alike::Differs(..));
            assert!(differs(a, b) && differs(b, a), "{a} {b}");
        }
    }

    #[test]
    fn the_first_difference_is_told_with_its_line() {
        let told = |a, b| match alike("x.json", a, b) {
            Alike::Differs(line, what) => format!("{line}: {what}"),
            other => panic!("{other:?}"),
        };
        assert_eq!(
            told("one\n\"n\": 17,\n18\n", "one\n\"n\": 18,\n19\n"),
            "2: \"17\" archived, \"18\" repeated"
        );
        assert_eq!(
            told("a\nb\n", "a\n"),
            "2: \"b\\n\" archived, nothing repeated"
        );
        let long = "x".repeat(3_000_000);
        let told = told(&long, &(long.clone() + "y"));
        assert!(told.starts_with("1: ") && told.len() < 200, "{told}");
    }
}
