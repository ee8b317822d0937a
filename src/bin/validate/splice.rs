//! Marks in a page of text, and what the published files put between them. No number in a page is typed by hand.
//!
//! - `<!-- BEGIN FILE -->` ... `<!-- END -->`: the file as it is.
//! - `<!-- BEGIN FILE :: COLUMN :: COLUMN -->` ... `<!-- END -->`: only these columns of its tables.
//! - `<!-- = FILE :: ROW :: COLUMN -->` ... `<!-- / -->`, inside a line: one cell of a table of the file. ROW is the first cell of the row, or
//!   its first cells, divided by `::`; the title of the group of rows it stands in may go before them. (A `|` would end a cell of
//!   a table in which such a mark stands.)

use std::fs;
use std::io::ErrorKind;
use std::path::Path;

use anyhow::{Context, Result, bail, ensure};

const BLOCK: &str = "<!-- BEGIN ";
const BLOCK_END: &str = "<!-- END -->";
const CELL: &str = "<!-- = ";
const CELL_END: &str = "<!-- / -->";
const CLOSE: &str = " -->";

/// A page with what belongs between its marks.
#[derive(Debug, Default, PartialEq)]
pub struct Spliced {
    /// The page.
    pub text: String,
    /// How many marks it has.
    pub marks: usize,
    /// The marks, as they name themselves, where something else stood.
    pub stale: Vec<String>,
    /// Those whose file is not there; what stands in them is kept.
    pub absent: Vec<String>,
}

/// Put into each mark of a page what it names; files are relative to `root`.
///
/// # Errors
/// If a mark is not closed, or names a row or column that its file has not, or has more than once.
pub fn splice(page: &str, root: &Path) -> Result<Spliced> {
    let mut spliced = Spliced::default();
    let mut rest = page;
    while let Some((begin, open, end)) = next_mark(rest) {
        let name = begin + open.len();
        let close = rest[name..]
            .find(CLOSE)
            .with_context(|| format!("'{open}' is not closed by{CLOSE}"))?;
        let mark = &rest[name..name + close];
        let body = name + close + CLOSE.len();
        let length = rest[body..]
            .find(end)
            .with_context(|| format!("no {end} after '{open}{mark}'"))?;
        let old = &rest[body..body + length];
        spliced.text += &rest[..body];
        spliced.marks += 1;
        let mut words = mark.split(" :: ").map(str::trim);
        let file = words.next().unwrap_or_default();
        let words: Vec<&str> = words.collect();
        let new = match fs::read_to_string(root.join(file)) {
            Ok(text) if open == CELL => {
                // Such a line would be HTML, and its Markdown be shown as it stands.
                let before = &spliced.text[..spliced.text.len() - (body - begin)];
                let first = before.is_empty() || before.ends_with('\n');
                ensure!(!first, "{mark}: begins a line; put a word before it");
                cell(&text, &words).with_context(|| mark.to_string())?
            }
            Ok(text) => {
                let text = columns(&text, &words).with_context(|| mark.to_string())?;
                format!("\n{}\n", text.trim_end())
            }
            Err(error) if error.kind() == ErrorKind::NotFound => {
                spliced.absent.push(mark.into());
                old.into()
            }
            Err(error) => return Err(error).with_context(|| format!("{file}: cannot read")),
        };
        if new != old {
            spliced.stale.push(mark.into());
        }
        spliced.text += &new;
        spliced.text += end;
        rest = &rest[body + length + end.len()..];
    }
    spliced.text += rest;
    Ok(spliced)
}

/// Where the next mark begins, how, and how it ends.
fn next_mark(text: &str) -> Option<(usize, &'static str, &'static str)> {
    let marks = [(BLOCK, BLOCK_END), (CELL, CELL_END)];
    let found = marks.map(|(open, end)| text.find(open).map(|at| (at, open, end)));
    found.into_iter().flatten().min()
}

/// The cells of a line of a Markdown table, if it is one. `\|` is no border.
fn cells(line: &str) -> Option<Vec<&str>> {
    let inner = line.strip_prefix('|')?.strip_suffix('|')?;
    let borders = inner.match_indices('|').map(|(at, _)| at);
    let borders = borders.filter(|&at| !inner[..at].ends_with('\\'));
    let mut begin = 0;
    let cells = borders.chain([inner.len()]).map(|end| {
        let cell = &inner[begin..end];
        begin = end + 1;
        cell.trim()
    });
    Some(cells.collect())
}

/// Only the named columns of the tables in a text, or all of it if none is named.
fn columns(text: &str, names: &[&str]) -> Result<String> {
    if names.is_empty() {
        return Ok(text.into());
    }
    let mut out = String::new();
    let mut kept: Option<Vec<usize>> = None;
    for line in text.lines() {
        let Some(row) = cells(line) else {
            kept = None;
            out += &format!("{line}\n");
            continue;
        };
        let here = match kept.take() {
            Some(here) => here,
            None => chosen(&row, names)?,
        };
        let row = here.iter().map(|&column| row.get(column).copied());
        let row = row.collect::<Option<Vec<_>>>();
        let row = row.with_context(|| format!("a row with too few cells: {line}"))?;
        out += &format!("| {} |\n", row.join(" | "));
        kept = Some(here);
    }
    Ok(out)
}

/// Where these columns are in the head of a table. A name that is there twice may be named twice.
fn chosen(head: &[&str], names: &[&str]) -> Result<Vec<usize>> {
    let place = |(i, name): (usize, &&str)| {
        let before = names[..i].iter().filter(|other| *other == name).count();
        let mut places = (0..head.len()).filter(|&column| head[column] == *name);
        places
            .nth(before)
            .with_context(|| format!("no column '{name}'; there are: {}", head.join(", ")))
    };
    names.iter().enumerate().map(place).collect()
}

/// The one cell that the first cells of its row and the head of its column name.
fn cell(text: &str, words: &[&str]) -> Result<String> {
    let Some((column, row)) = words.split_last().filter(|(_, row)| !row.is_empty()) else {
        bail!("expected FILE :: ROW :: COLUMN");
    };
    let mut found = Vec::new();
    let mut head: Option<Vec<&str>> = None;
    let mut group = "";
    for line in text.lines() {
        let Some(here) = cells(line) else {
            head = None;
            continue;
        };
        let Some(names) = &head else {
            head = Some(here);
            group = "";
            continue;
        };
        if here[1..].iter().all(|cell| cell.is_empty()) {
            group = here[0];
        }
        let grouped = row[0] == group && here.starts_with(&row[1..]) && row.len() > 1;
        let at = names.iter().position(|name| name == column);
        if let Some(at) = at.filter(|_| here.starts_with(row) || grouped) {
            found.extend(here.get(at).copied());
        }
    }
    match found[..] {
        [one] => Ok(one.into()),
        _ => bail!("{} such cells, expected one", found.len()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TABLE: &str = "A caption.\n\n| a | b | c |\n|:--|--:|:--|\n| **g** |  |  |\n| x | 1 | u |\n| **h** | | |\n| x | 2 | v |\n| y | 3 | w |\n";

    fn page(text: &str) -> Result<Spliced> {
        let folder = tempfile::tempdir().expect("a temporary folder");
        fs::write(folder.path().join("t.md"), TABLE).expect("written");
        splice(text, folder.path())
    }

    fn text(of: &str) -> String {
        page(of).expect("spliced").text
    }

    #[test]
    fn blocks_are_replaced_and_nothing_else() {
        let wanted = format!("x\n<!-- BEGIN t.md -->\n{TABLE}<!-- END -->\ny");
        let spliced = page("x\n<!-- BEGIN t.md -->\nold\n<!-- END -->\ny").expect("spliced");
        assert_eq!(
            (spliced.text, spliced.stale),
            (wanted.clone(), vec!["t.md".into()])
        );
        let again = page(&wanted).expect("spliced");
        assert_eq!(
            (again.text, again.stale, again.marks),
            (wanted.clone(), vec![], 1)
        );
        let kept = format!("{wanted}<!-- BEGIN none.md -->\nold\n<!-- END -->");
        let spliced = page(&kept).expect("spliced");
        assert_eq!(
            (spliced.text, spliced.absent),
            (kept, vec!["none.md".into()])
        );
    }

    #[test]
    fn columns_are_chosen_by_name() {
        let chosen = text("<!-- BEGIN t.md :: c :: a -->\n<!-- END -->");
        assert!(chosen.contains("caption.\n\n| c | a |\n| :-- | :-- |\n|  | **g** |\n| u | x |\n"));
        let error = page("<!-- BEGIN t.md :: d -->\n<!-- END -->").expect_err("no such column");
        assert!(format!("{error:#}").contains("no column 'd'; there are: a, b, c"));
    }

    #[test]
    fn escaped_bars_are_no_borders() {
        assert_eq!(cells(r"| max \|z\| | b |"), Some(vec![r"max \|z\|", "b"]));
        assert_eq!(cells("no table"), None);
    }

    #[test]
    fn a_name_that_two_columns_have_is_taken_in_turn() {
        let head = ["a", "b", "b"];
        assert_eq!(chosen(&head, &["b", "a", "b"]).expect("chosen"), [1, 0, 2]);
        assert!(chosen(&head, &["a", "a"]).is_err());
    }

    #[test]
    fn cells_are_found_by_row_and_column() {
        for (row, cell) in [
            ("y", "3"),
            ("x :: 1", "1"),
            ("**h** :: x", "2"),
            ("y :: 3", "3"),
        ] {
            let wanted = format!("It is <!-- = t.md :: {row} :: b -->{cell}<!-- / -->.");
            assert_eq!(text(&wanted.replace(&format!(">{cell}<"), ">9<")), wanted);
        }
        for wrong in ["x :: b", "z :: b", "y :: d", "b", ""] {
            let wrong = format!("It is <!-- = t.md :: {wrong} -->3<!-- / -->.");
            assert!(page(&wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn marks_must_be_closed_and_cells_not_begin_a_line() {
        for wrong in [
            "<!-- BEGIN t.md",
            "<!-- BEGIN t.md -->",
            "a <!-- = t.md :: y :: b -->3",
            "<!-- = t.md :: y :: b -->3<!-- / -->",
            "a\n<!-- = t.md :: y :: b -->3<!-- / -->",
        ] {
            assert!(page(wrong).is_err(), "{wrong}");
        }
    }
}
