//! The manifest: a line `DIGEST  PATH` a file, in the order of the bytes of the path, as `sha256sum` writes and checks it.

use std::collections::BTreeMap;
use std::fmt::Write;

use super::Files;
use super::names::is_plain;

/// The manifest of these files.
pub(super) fn write(files: &Files) -> String {
    let mut text = String::new();
    for (path, facts) in files {
        writeln!(text, "{}  {path}", digits(&facts.sha256)).expect("writing to memory");
    }
    text
}

/// A digest as text.
pub(super) fn digits(sha256: &[u8; 32]) -> String {
    let mut text = String::with_capacity(64);
    for byte in sha256 {
        write!(text, "{byte:02x}").expect("writing to memory");
    }
    text
}

/// Path and digest of every file a manifest lists; the message says which line is wrong.
pub(super) fn read(bytes: &[u8]) -> Result<BTreeMap<String, [u8; 32]>, String> {
    let text = std::str::from_utf8(bytes).map_err(|_| "it is not UTF-8".to_string())?;
    let mut files = BTreeMap::new();
    for (i, line) in text.lines().enumerate() {
        let wrong = |what: &str| format!("line {}: {what}", i + 1);
        let (digits, path) = line
            .split_once("  ")
            .ok_or_else(|| wrong("expected a digest, two spaces and a path"))?;
        let digest =
            digest(digits).ok_or_else(|| wrong("expected a digest of 64 hexadecimal digits"))?;
        if !is_plain(path) {
            return Err(wrong(
                "the path is not a plain one below the archive's folder",
            ));
        }
        if files.insert(path.to_string(), digest).is_some() {
            return Err(wrong("the file is listed twice"));
        }
    }
    Ok(files)
}

/// The digest that a text says, in small letters.
pub(super) fn digest(digits: &str) -> Option<[u8; 32]> {
    let lower = |b: &u8| matches!(b, b'0'..=b'9' | b'a'..=b'f');
    if digits.len() != 64 || !digits.as_bytes().iter().all(lower) {
        return None;
    }
    let mut bytes = [0; 32];
    for (i, byte) in bytes.iter_mut().enumerate() {
        *byte = u8::from_str_radix(&digits[2 * i..2 * i + 2], 16).ok()?;
    }
    Some(bytes)
}

#[cfg(test)]
mod tests {
    use super::super::Facts;
    use super::*;

    #[test]
    fn what_is_written_is_read() {
        let facts = |b: u8| Facts {
            size: 1,
            sha256: std::array::from_fn(|i| b.wrapping_mul(i as u8)),
        };
        let files = Files::from([("b/x".into(), facts(7)), ("B".into(), facts(201))]);
        let text = write(&files);
        assert!(text.ends_with("  b/x\n") && text.contains("  B\n"));
        let read = read(text.as_bytes()).expect("read");
        let wanted: BTreeMap<_, _> = files.into_iter().map(|(p, f)| (p, f.sha256)).collect();
        assert_eq!(read, wanted);
    }

    #[test]
    fn wrong_lines_are_told() {
        let good = "0".repeat(64);
        for (text, part) in [
            (
                format!("{good}  a\n{good} b\n"),
                "line 2: expected a digest, two",
            ),
            (
                format!("{}  a\n", &good[1..]),
                "line 1: expected a digest of 64",
            ),
            (
                format!("{}Ä  a\n", &good[2..]),
                "line 1: expected a digest of 64",
            ),
            (format!("{good}  ../a\n"), "line 1: the path"),
            (
                format!("{good}  a\n{good}  a\n"),
                "line 2: the file is listed twice",
            ),
        ] {
            let wrong = read(text.as_bytes()).expect_err(&text);
            assert!(wrong.starts_with(part), "{wrong}");
        }
    }
}
