//! A table as a terminal shows it.

use super::{Cell, Table};

/// Longer names of rows are shortened, so that no path makes a table wider than its terminal.
const LONGEST_NAME: usize = 28;

/// What a terminal shows of a table.
struct Texts {
    /// Headings in two lines, the upper one empty where none is folded.
    headings: [Vec<String>; 2],
    /// Rows, long names shortened.
    rows: Vec<Vec<String>>,
    /// Width of each column.
    widths: Vec<usize>,
}

impl Table {
    /// For a terminal of this many characters: where the columns do not fit, long headings are folded; what does not fit even
    /// so follows below, beside the same row names.
    pub fn to_text(&self, width: usize) -> String {
        let Texts {
            headings,
            rows,
            widths,
        } = self.texts(width);
        let mut out = format!("{}\n", fold(&self.caption, width));
        for block in self.blocks(&widths, width) {
            out.push('\n');
            let rules: Vec<String> = widths.iter().map(|&width| "─".repeat(width)).collect();
            let folded = headings[0].iter().any(|text| !text.is_empty());
            let headings = headings[usize::from(!folded)..].iter();
            for row in headings.chain([&rules]).chain(&rows) {
                let cells = block.iter().map(|&i| self.pad(i, &row[i], widths[i]));
                let line = cells.collect::<Vec<_>>().join("  ");
                out.push_str(line.trim_end());
                out.push('\n');
            }
        }
        out
    }

    /// Whether text of this width holds all columns side by side.
    pub fn fits(&self, width: usize) -> bool {
        self.blocks(&self.texts(width).widths, width).len() == 1
    }

    /// What a terminal of this width shows: headings in one line if all columns fit so, else folded where a heading is wider than its cells.
    fn texts(&self, width: usize) -> Texts {
        let show = |row: &Vec<Cell>| {
            let cells = row.iter().enumerate();
            cells
                .map(|(i, cell)| match cell {
                    Cell::Text(text) if i < self.keys => shorten(text),
                    _ => cell.show().replace(" ± ", "±"),
                })
                .collect()
        };
        let rows: Vec<Vec<String>> = self.rows.iter().map(show).collect();
        let widest = |i: usize| rows.iter().map(|row| length(&row[i])).max();
        let cells: Vec<usize> = (0..self.columns.len())
            .map(|i| widest(i).unwrap_or(0))
            .collect();
        let headings = self.headings(&cells, width);
        let wide = |(i, cells): (usize, usize)| {
            let [above, below] = headings.each_ref().map(|line| length(&line[i]));
            above.max(below).max(cells)
        };
        Texts {
            widths: cells.into_iter().enumerate().map(wide).collect(),
            headings,
            rows,
        }
    }

    /// Headings in two lines, above cells of these widths.
    fn headings(&self, cells: &[usize], width: usize) -> [Vec<String>; 2] {
        let titles = || self.columns.iter().map(|column| column.title.as_str());
        let whole = titles().zip(cells).map(|(t, &cells)| length(t).max(cells));
        let all_fit = self.blocks(&whole.collect::<Vec<_>>(), width).len() == 1;
        let folded = titles().zip(cells).map(|(title, &cells)| {
            if all_fit || length(title) <= cells {
                [String::new(), title.to_owned()]
            } else {
                fold_heading(title)
            }
        });
        let (above, below) = folded.map(|[above, below]| (above, below)).unzip();
        [above, below]
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
    if length(name) <= LONGEST_NAME {
        return name.to_owned();
    }
    let end = name.chars().skip(length(name) + 1 - LONGEST_NAME);
    ['…'].into_iter().chain(end).collect()
}

/// A heading in two lines, split at a space or behind a hyphen where the halves are most even; the upper one empty if it has neither.
fn fold_heading(title: &str) -> [String; 2] {
    let gaps = title.match_indices([' ', '-']);
    let halves = gaps.map(|(i, gap)| {
        let above = if gap == " " {
            &title[..i]
        } else {
            &title[..=i]
        };
        [above, &title[i + 1..]]
    });
    let halves = halves.min_by_key(|[above, below]| length(above).max(length(below)));
    halves.unwrap_or(["", title]).map(str::to_owned)
}

/// Characters of a text.
fn length(text: &str) -> usize {
    text.chars().count()
}

/// Breaks a sentence into lines of at most this many characters.
pub(in crate::report) fn fold(text: &str, width: usize) -> String {
    let mut out = String::new();
    let mut used = 0;
    for word in text.split(' ') {
        let (gap, start) = if used == 0 {
            ("", 0)
        } else if used + 1 + length(word) > width {
            ("\n", 0)
        } else {
            (" ", used + 1)
        };
        out.push_str(gap);
        out.push_str(word);
        used = start + length(word);
    }
    out
}
