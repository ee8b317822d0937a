//! Names of files that mean the same on every system, however an archive is unpacked.

use std::collections::BTreeMap;

use unicode_normalization::UnicodeNormalization;

/// What a name may not have in it, for the messages about those that have.
pub(super) const NOT_PLAIN: &str =
    "control or format characters, or '\\', ':', '%', '*', '?', '\"', '<', '>' and '|'";

/// Names that are devices on some systems, whatever follows a dot.
const DEVICES: [&str; 4] = ["CON", "PRN", "AUX", "NUL"];
/// The same, with a digit behind.
const PORTS: [&str; 2] = ["COM", "LPT"];

/// Whether a path below the archive's folder is plain: relative, no `.` or `..`, nothing that a terminal, a manifest (in which `%`
/// begins a code) or another system would read differently.
pub(super) fn is_plain(path: &str) -> bool {
    path.chars().all(is_plain_character) && path.split('/').all(is_plain_part)
}

fn is_plain_character(c: char) -> bool {
    match c {
        ' '..='~' => !"\\:%*?\"<>|".contains(c),
        // Letters and digits: nothing that cannot be seen, or that turns the direction of what follows.
        _ => c.is_alphanumeric(),
    }
}

fn is_plain_part(part: &str) -> bool {
    let stem = part.split('.').next().unwrap_or(part).trim_end();
    let stem = stem.to_ascii_uppercase();
    let port = |name: &str| {
        let number = stem.strip_prefix(name).unwrap_or_default();
        number.len() == 1 && number.chars().all(|c| c.is_ascii_digit())
    };
    let device = DEVICES.contains(&&*stem) || PORTS.iter().any(|name| port(name));
    !part.is_empty() && !part.ends_with(['.', ' ']) && !device
}

/// The names of the files and folders of an archive, as systems tell them apart that care least.
#[derive(Default)]
pub(super) struct Names {
    /// By how they are told apart: as they are spelled, and whether they are files.
    taken: BTreeMap<String, (String, bool)>,
}

impl Names {
    /// One more file.
    ///
    /// # Errors
    /// If it cannot lie beside those that are there: the message says which.
    pub fn take(&mut self, path: &str) -> Result<(), String> {
        let folders = path.match_indices('/').map(|(end, _)| &path[..end]);
        let all = folders.map(|folder| (folder, false)).chain([(path, true)]);
        for (name, is_file) in all {
            let new = (name.to_string(), is_file);
            let first = self.taken.entry(folded(name)).or_insert(new.clone());
            if first.0 != name || first.1 != is_file {
                return Err(format!(
                    "{path:?} and {:?} cannot be unpacked side by side on every system",
                    first.0
                ));
            }
        }
        Ok(())
    }
}

/// The same for names that differ in case, or in how an accent is written.
fn folded(name: &str) -> String {
    name.nfd().flat_map(char::to_lowercase).nfd().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_plain_paths() {
        for path in [
            "README.md",
            "data/e/tables/cells.md",
            "a b",
            "ä/..x",
            "console",
            "com",
            "COM10",
            "a.con",
        ] {
            assert!(is_plain(path), "{path}");
        }
        for path in [
            "",
            "/a",
            "a/",
            "a//b",
            ".",
            "a/./b",
            "../a",
            "a/..",
            "a\\b",
            "c:a",
            "a\nb",
            "a%2e",
            "a?",
            "a|b",
            "CON",
            "a/con.csv",
            "nul .txt",
            "com1",
            "lpt9.md",
            "a.",
            "a /b",
            // What turns the direction of the text, and what cannot be seen.
            "a\u{202e}gnp.svg",
            "a\u{200b}b",
            "\u{feff}a",
            "a\u{0301}",
        ] {
            assert!(!is_plain(path), "{path:?}");
        }
    }

    #[test]
    fn names_lie_side_by_side_or_not() {
        let mut names = Names::default();
        for path in ["a/b", "a/c", "ab", "d/e/f", "d/e.f", "Ä"] {
            names.take(path).expect(path);
        }
        for (path, other) in [
            ("A/x", "\"a\""),
            ("a/B", "\"a/b\""),
            // A file where a folder is, and the other way round.
            ("d/e", "\"d/e\""),
            ("ab/x", "\"ab\""),
            ("ä", "\"Ä\""),
        ] {
            let told = names.take(path).expect_err(path);
            assert!(told.contains(&format!("and {other} cannot")), "{told}");
        }
        // The sign of the unit and the letter.
        names.take("\u{212b}").expect("new");
        names.take("\u{c5}").expect_err("the same");
    }
}
