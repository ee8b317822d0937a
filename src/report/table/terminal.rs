//! A table as a terminal shows it.

use super::{Cell, Table};

/// Longer names of rows are shortened, so that no path makes a table wider than its terminal.
const LONGEST_NAME: usize = 28;

impl Table {
    /// For a terminal of this many characters: columns that do not fit follow below, beside the same row names. Long
    /// headings are folded at a hyphen.
    pub fn to_text(&self, width: usize) -> String {
        let (headings, shown) = self.texts();
        let widths = self.text_widths();
        let mut out = format!("{}\n", fold(&self.caption, width));
        for block in self.blocks(&widths, width) {
            out.push('\n');
            let rules: Vec<String> = widths.iter().map(|&width| "─".repeat(width)).collect();
            let folded = headings[0].iter().any(|text| !text.is_empty());
            let headings = headings[usize::from(!folded)..].iter();
            for row in headings.chain([&rules]).chain(&shown) {
                let cells = block.iter().map(|&i| self.pad(i, &row[i], widths[i]));
                let line = cells.collect::<Vec<_>>().join("  ");
                out.push_str(line.trim_end());
                out.push('\n');
            }
        }
        out
    }

    /// Headings in two lines, and the rows (long names shortened), as a terminal shows them.
    fn texts(&self) -> ([Vec<String>; 2], Vec<Vec<String>>) {
        let show = |row: &Vec<Cell>| {
            let cells = row.iter().enumerate();
            cells
                .map(|(i, cell)| match cell {
                    Cell::Text(text) if i < self.keys => shorten(text),
                    _ => cell.show().replace(" ± ", "±"),
                })
                .collect()
        };
        let headings = self
            .columns
            .iter()
            .map(|column| fold_heading(&column.title));
        let (above, below) = headings.map(|[above, below]| (above, below)).unzip();
        ([above, below], self.rows.iter().map(show).collect())
    }

    /// Width of each column of [`texts`](Self::texts).
    fn text_widths(&self) -> Vec<usize> {
        let (headings, shown) = self.texts();
        let widest = |i: usize| {
            headings
                .iter()
                .chain(&shown)
                .map(|row| row[i].chars().count())
                .max()
        };
        (0..self.columns.len()).filter_map(widest).collect()
    }

    /// Whether text of this width holds all columns side by side.
    pub fn fits(&self, width: usize) -> bool {
        self.blocks(&self.text_widths(), width).len() == 1
    }

    /// Columns that stand beside each other in a text of this width, the row names first each time.
    fn blocks(&self, widths: &[usize], width: usize) -> Vec<Vec<usize>> {
        let keys: Vec<usize> = (0..self.keys).collect();
        let needs = |block: &[usize]| {
            block
                .iter()
                .map(|&i| widths[i] + 2)
                .sum::<usize>()
                .saturating_sub(2)
        };
        let mut blocks = vec![keys.clone()];
        for i in self.keys..self.columns.len() {
            let block = blocks.last_mut().expect("there is a first block");
            block.push(i);
            if needs(block) > width && block.len() > self.keys + 1 {
                block.pop();
                blocks.push(keys.iter().copied().chain([i]).collect());
            }
        }
        blocks
    }
}

/// The name, or its end behind an ellipsis where it is longer: the end of a path tells more.
fn shorten(name: &str) -> String {
    let length = name.chars().count();
    if length <= LONGEST_NAME {
        return name.to_owned();
    }
    let end = name.chars().skip(length + 1 - LONGEST_NAME);
    ['…'].into_iter().chain(end).collect()
}

/// A heading in two lines, the upper one empty if it is short or has no hyphen; split where the halves are most even.
fn fold_heading(title: &str) -> [String; 2] {
    const LONG: usize = 12;
    let hyphens = title.match_indices('-').map(|(i, _)| i + 1);
    match hyphens.min_by_key(|&i| i.abs_diff(title.len() - i)) {
        Some(i) if title.len() > LONG => [title[..i].to_owned(), title[i..].to_owned()],
        _ => [String::new(), title.to_owned()],
    }
}

/// Breaks a sentence into lines of at most this many characters.
pub(in crate::report) fn fold(text: &str, width: usize) -> String {
    let mut out = String::new();
    let mut used = 0;
    for word in text.split(' ') {
        let length = word.chars().count();
        let (gap, start) = if used == 0 {
            ("", 0)
        } else if used + 1 + length > width {
            ("\n", 0)
        } else {
            (" ", used + 1)
        };
        out.push_str(gap);
        out.push_str(word);
        used = start + length;
    }
    out
}
