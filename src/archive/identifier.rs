//! Files named by relative references of RFC 3986: what is no plain ASCII in a path is written as `%XX`.

use std::fmt::Write;

/// The reference that names a path.
pub(super) fn identifier(path: &str) -> String {
    let mut text = String::new();
    for byte in path.bytes() {
        if byte.is_ascii_alphanumeric() || b"-._~/".contains(&byte) {
            text.push(byte.into());
        } else {
            write!(text, "%{byte:02X}").expect("in memory");
        }
    }
    text
}

/// The path that a reference names, if it is one.
pub(super) fn path_of(identifier: &str) -> Option<String> {
    let mut parts = identifier.split('%');
    let mut bytes = parts.next()?.as_bytes().to_vec();
    for part in parts {
        let (digits, rest) = part.split_at_checked(2)?;
        bytes.push(u8::from_str_radix(digits, 16).ok()?);
        bytes.extend(rest.bytes());
    }
    String::from_utf8(bytes).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_are_named_and_found_again() {
        assert_eq!(identifier("data/a b/ä#.csv"), "data/a%20b/%C3%A4%23.csv");
        for path in ["", "data/e/x-y_z.csv", "a b", "ä/ö.md", "#?&"] {
            assert_eq!(path_of(&identifier(path)).as_deref(), Some(path));
        }
        for wrong in ["%", "%2", "a%zz", "%ff", "%2ä"] {
            assert_eq!(path_of(wrong), None, "{wrong}");
        }
    }
}
