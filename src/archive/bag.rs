//! The bag around the files: BagIt 1.0 (RFC 8493), with SHA-256.

use std::fmt::Write;

use super::date::{Moment, day};
use super::{Files, PAYLOAD};

/// Declares a bag: the whole of `bagit.txt`.
pub(super) const DECLARATION: &str = "BagIt-Version: 1.0\nTag-File-Character-Encoding: UTF-8\n";

/// The label of bytes and number of the payload's files.
const OXUM: &str = "Payload-Oxum: ";

/// Bytes and number of the files of the payload, as `BYTES.FILES`.
pub(super) fn oxum(files: &Files) -> String {
    let payload = || files.iter().filter(|(path, _)| path.starts_with(PAYLOAD));
    let bytes: u64 = payload().map(|(_, facts)| facts.size).sum();
    format!("{bytes}.{}", payload().count())
}

/// The text of `bag-info.txt`.
pub(super) fn info(name: &str, files: &Files, time: Moment) -> String {
    let mut text = format!("Bag-Software-Agent: {}\n", agent());
    if let Some(seconds) = time {
        writeln!(text, "Bagging-Date: {}", day(seconds)).expect("in memory");
    }
    writeln!(
        text,
        "External-Description: {name}: runs of sahlab, with what is needed to check and to repeat them"
    )
    .expect("in memory");
    writeln!(text, "{OXUM}{}", oxum(files)).expect("in memory");
    text
}

/// The program, its version and revision.
pub(super) fn agent() -> String {
    let (version, revision) = (env!("CARGO_PKG_VERSION"), crate::REVISION);
    format!("sahlab {version}, revision {revision}")
}

/// What `bag-info.txt` says of bytes and number of files.
pub(super) fn stated_oxum(info: &[u8]) -> Option<&str> {
    let text = std::str::from_utf8(info).ok()?;
    text.lines().find_map(|line| line.strip_prefix(OXUM))
}

#[cfg(test)]
mod tests {
    use super::super::Facts;
    use super::*;

    #[test]
    fn the_payload_is_counted_and_told() {
        let facts = |size| Facts {
            size,
            sha256: [0; 32],
        };
        let files = [("bagit.txt", 55), ("data/a", 7), ("data/b/c", 20)];
        let files = files.map(|(path, size)| (path.to_string(), facts(size)));
        let info = info("x", &files.into(), Some(951_782_400));
        assert_eq!(stated_oxum(info.as_bytes()), Some("27.2"));
        assert!(info.contains("\nBagging-Date: 2000-02-29\n"), "{info}");
        assert_eq!(stated_oxum(b"Payload-Oxum 1.1\n"), None);
        assert_eq!(stated_oxum(b"\xff\nPayload-Oxum: 1.1\n"), None);
    }
}
