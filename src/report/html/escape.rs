//! Text from outside (names of scenes, paths, messages) as a page takes it.

use crate::report::glyphs::SUB;

/// The text as content or as a quoted attribute. Characters that HTML forbids become the sign for those that are unknown.
pub fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            '\n' | '\t' => out.push(character),
            _ if character.is_control() => out.push(char::REPLACEMENT_CHARACTER),
            _ => out.push(character),
        }
    }
    out
}

/// The words of a figure as content, subscripts set as such.
pub fn with_subscripts(text: &str) -> String {
    let mut pieces = text.split(SUB);
    let mut out = escape(pieces.next().unwrap_or_default());
    for piece in pieces {
        let letter = piece.chars().next().map_or(0, char::len_utf8);
        let (letter, rest) = piece.split_at(letter);
        out += &format!("<sub>{}</sub>{}", escape(letter), escape(rest));
    }
    out
}

/// The words of a figure as an attribute, `n_K` for a subscript.
pub fn without_subscripts(text: &str) -> String {
    escape(&text.replace(SUB, "_"))
}

/// What follows the kind of a thing in the name of its anchor: letters, digits and hyphens.
pub fn anchor(kind: &str, name: &str) -> String {
    let safe = |c: char| if c.is_ascii_alphanumeric() { c } else { '-' };
    format!("{kind}-{}", name.chars().map(safe).collect::<String>())
}

/// A relative path as an address (RFC 3986): all but unreserved characters and slashes as their bytes in hexadecimal.
pub fn address(path: &str) -> String {
    let mut out = String::new();
    for byte in path.bytes() {
        match byte {
            b'A'..=b'Z' | b'a'..=b'z' | b'0'..=b'9' | b'-' | b'.' | b'_' | b'~' | b'/' => {
                out.push(char::from(byte));
            }
            _ => out.push_str(&format!("%{byte:02X}")),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_of_a_text_is_markup() {
        let hostile = "<script>alert(\"1\" + '2') & more</script>\0";
        let safe =
            "&lt;script&gt;alert(&quot;1&quot; + &#39;2&#39;) &amp; more&lt;/script&gt;\u{fffd}";
        assert_eq!(escape(hostile), safe);
        assert_eq!(
            with_subscripts("c\u{e000}K<n\u{e000}<"),
            "c<sub>K</sub>&lt;n<sub>&lt;</sub>"
        );
        assert_eq!(without_subscripts("c\u{e000}K<"), "c_K&lt;");
        assert_eq!(anchor("table", "a b\"<é"), "table-a-b---");
        assert_eq!(address("a b/c#d?é.csv"), "a%20b/c%23d%3F%C3%A9.csv");
    }
}
