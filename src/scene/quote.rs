//! What messages quote of a file.

/// Longest message that quotes a file, in bytes.
const LONGEST: usize = 1000;

/// A message that may quote a file, fit for one line of a terminal: control characters are escaped, and of a long one the
/// middle is left out.
pub(crate) fn quotable(message: &str) -> String {
    within(message, LONGEST)
}

/// As [`quotable`], in that many bytes and a few more.
pub(super) fn within(message: &str, longest: usize) -> String {
    let mut text = String::new();
    for c in message.chars() {
        if c.is_control() {
            text.extend(c.escape_default());
        } else {
            text.push(c);
        }
    }
    if text.len() > longest {
        // A place within a character moves to its end, of at most four bytes.
        let [mut head, mut tail] = [longest / 2, text.len() - longest / 2];
        while !text.is_char_boundary(head) {
            head += 1;
        }
        while !text.is_char_boundary(tail) {
            tail += 1;
        }
        text.replace_range(head..tail, " ... ");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_short_line() {
        assert_eq!(quotable("'caf\u{e9}' is"), "'caf\u{e9}' is");
        assert_eq!(quotable("'a\u{1b}[2J\n\0' is"), "'a\\u{1b}[2J\\n\\u{0}' is");
        let long = quotable(&format!("'{}' is not a number", "\u{20ac}".repeat(1000)));
        assert!(long.starts_with("'\u{20ac}") && long.ends_with("\u{20ac}' is not a number"));
        assert!(long.len() <= LONGEST + 10, "{}", long.len());
    }
}
