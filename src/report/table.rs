//! One table, printed as plain text, Markdown, CSV and LaTeX.
//!
//! Cells keep what they are (a count, an estimate with its error, a p-value); how they read follows from that. CSV is
//! for machines: numbers unrounded, an estimate in two columns, unknown empty.

use std::fmt::Write;

use super::number::{decimals_for, fixed, grouped, p_value, signed};

/// One cell of a table.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    /// A name.
    Text(String),
    /// A whole number.
    Count(u64),
    /// A number shown to this many decimals.
    Value(f64, usize),
    /// A difference shown with its sign and this many decimals.
    Change(f64, usize),
    /// A difference and half of its interval, to the digits the interval leaves.
    Estimate(f64, f64),
    /// A number and half of its interval, to the digits the interval leaves.
    Measured(f64, f64),
    /// A p-value.
    PValue(f64),
    /// Unknown.
    Missing,
}

/// Where the texts of a column stand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Align {
    /// Names.
    Left,
    /// Numbers.
    Right,
}

/// A column: its heading for readers, its name for machines.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// Heading.
    pub title: String,
    /// Name in CSV.
    pub key: String,
    /// Alignment.
    pub align: Align,
}

impl Column {
    /// A column of names.
    pub fn left(title: &str, key: &str) -> Self {
        Column {
            title: title.to_owned(),
            key: key.to_owned(),
            align: Align::Left,
        }
    }

    /// A column of numbers.
    pub fn right(title: &str, key: &str) -> Self {
        Column {
            align: Align::Right,
            ..Column::left(title, key)
        }
    }
}

/// A table. The first `keys` columns name the row.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// What it shows, in a sentence.
    pub caption: String,
    /// Its columns.
    pub columns: Vec<Column>,
    /// How many of them name the row.
    pub keys: usize,
    /// Its rows, each as long as `columns`.
    pub rows: Vec<Vec<Cell>>,
}

impl Cell {
    /// False for a number that is none.
    fn is_known(&self) -> bool {
        match self {
            Cell::Value(value, _) | Cell::Change(value, _) | Cell::PValue(value) => {
                value.is_finite()
            }
            Cell::Estimate(value, half) | Cell::Measured(value, half) => {
                value.is_finite() && half.is_finite()
            }
            Cell::Text(_) | Cell::Count(_) => true,
            Cell::Missing => false,
        }
    }

    fn show(&self) -> String {
        match self {
            _ if !self.is_known() => "–".to_owned(),
            Cell::Text(text) => text.clone(),
            Cell::Count(count) => grouped(*count),
            Cell::Value(value, decimals) => fixed(*value, *decimals),
            Cell::Change(value, decimals) => signed(*value, *decimals),
            Cell::Estimate(value, half) => {
                let decimals = decimals_for(*half);
                format!("{} ± {}", signed(*value, decimals), fixed(*half, decimals))
            }
            Cell::Measured(value, half) => {
                let decimals = decimals_for(*half);
                format!("{} ± {}", fixed(*value, decimals), fixed(*half, decimals))
            }
            Cell::PValue(p) => p_value(*p),
            Cell::Missing => "–".to_owned(),
        }
    }

    fn raw(&self) -> String {
        match self {
            _ if !self.is_known() => String::new(),
            Cell::Text(text) => text.clone(),
            Cell::Count(count) => count.to_string(),
            Cell::Value(value, _)
            | Cell::Change(value, _)
            | Cell::Estimate(value, _)
            | Cell::Measured(value, _)
            | Cell::PValue(value) => value.to_string(),
            Cell::Missing => String::new(),
        }
    }
}

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

    /// Headings in two lines, and the rows, as a terminal shows them.
    fn texts(&self) -> ([Vec<String>; 2], Vec<Vec<String>>) {
        let show = |row: &Vec<Cell>| row.iter().map(|c| c.show().replace(" ± ", "±")).collect();
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

    /// Markdown, with `command` as what generated it.
    pub fn to_markdown(&self, command: &str) -> String {
        let shown: Vec<Vec<String>> = self
            .rows
            .iter()
            .map(|row| {
                row.iter()
                    .map(|cell| cell.show().replace('|', "\\|"))
                    .collect()
            })
            .collect();
        let widths = self.widths(&shown);
        let mut out = format!(
            "<!-- generated by {command}, do not edit -->\n\n{}\n\n",
            self.caption
        );
        let titles: Vec<String> = self
            .columns
            .iter()
            .map(|column| column.title.clone())
            .collect();
        let rules: Vec<String> = self
            .columns
            .iter()
            .zip(&widths)
            .map(|(column, &width)| match column.align {
                Align::Left => format!(":{}", "-".repeat(width.max(2) - 1)),
                Align::Right => format!("{}:", "-".repeat(width.max(2) - 1)),
            })
            .collect();
        for row in [&titles, &rules].into_iter().chain(&shown) {
            let cells: Vec<_> = row
                .iter()
                .enumerate()
                .map(|(i, text)| self.pad(i, text, widths[i]))
                .collect();
            let _ = writeln!(out, "| {} |", cells.join(" | "));
        }
        out
    }

    /// CSV, full precision.
    pub fn to_csv(&self) -> String {
        let is_estimate = |i: usize| {
            self.rows
                .iter()
                .any(|row| matches!(row[i], Cell::Estimate(..) | Cell::Measured(..)))
        };
        let estimates: Vec<bool> = (0..self.columns.len()).map(is_estimate).collect();
        let mut writer = csv::Writer::from_writer(Vec::new());
        let mut record = |row: Vec<(String, String)>| {
            let fields = row
                .into_iter()
                .zip(&estimates)
                .flat_map(|((value, half), &estimate)| {
                    [Some(value), estimate.then_some(half)]
                        .into_iter()
                        .flatten()
                });
            writer
                .write_record(fields)
                .expect("every row has as many fields, and memory takes them");
        };
        record(
            self.columns
                .iter()
                .map(|c| (c.key.clone(), format!("{}_half99", c.key)))
                .collect(),
        );
        for row in &self.rows {
            let half = |cell: &Cell| match cell {
                Cell::Estimate(_, half) | Cell::Measured(_, half) if cell.is_known() => {
                    half.to_string()
                }
                _ => String::new(),
            };
            record(row.iter().map(|cell| (cell.raw(), half(cell))).collect());
        }
        let bytes = writer.into_inner().expect("memory takes every byte");
        String::from_utf8(bytes).expect("made of strings")
    }

    /// A LaTeX tabular with booktabs rules, with `command` as what generated it.
    pub fn to_latex(&self, command: &str) -> String {
        let align: String = self
            .columns
            .iter()
            .map(|c| if c.align == Align::Left { 'l' } else { 'r' })
            .collect();
        let line = |texts: Vec<String>| format!("{} \\\\\n", texts.join(" & "));
        let mut out =
            format!("% generated by {command}, do not edit; needs \\usepackage{{booktabs}}\n");
        let _ = writeln!(out, "% {}", self.caption);
        let _ = write!(out, "\\begin{{tabular}}{{{align}}}\n\\toprule\n");
        out.push_str(&line(
            self.columns
                .iter()
                .map(|column| heading(&column.title))
                .collect(),
        ));
        out.push_str("\\midrule\n");
        for row in &self.rows {
            out.push_str(&line(row.iter().map(|cell| latex(&cell.show())).collect()));
        }
        out.push_str("\\bottomrule\n\\end{tabular}\n");
        out
    }

    fn widths(&self, shown: &[Vec<String>]) -> Vec<usize> {
        let of = |text: &str| text.chars().count();
        let widest = |(i, column): (usize, &Column)| {
            shown
                .iter()
                .map(|row| of(&row[i]))
                .fold(of(&column.title), usize::max)
        };
        self.columns.iter().enumerate().map(widest).collect()
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

    fn pad(&self, column: usize, text: &str, width: usize) -> String {
        match self.columns[column].align {
            Align::Left => format!("{text:<width$}"),
            Align::Right => format!("{text:>width$}"),
        }
    }
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
pub(super) fn fold(text: &str, width: usize) -> String {
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

/// Text made safe for LaTeX, in any encoding it is read with.
fn latex(text: &str) -> String {
    let mut out = String::new();
    for character in text.chars() {
        match character {
            '&' | '%' | '$' | '#' | '_' | '{' | '}' => out.extend(['\\', character]),
            '\\' => out.push_str("\\textbackslash{}"),
            '~' => out.push_str("\\textasciitilde{}"),
            '^' => out.push_str("\\textasciicircum{}"),
            '<' => out.push_str("$<$"),
            '>' => out.push_str("$>$"),
            '−' => out.push_str("$-$"),
            '±' => out.push_str("$\\pm$"),
            '–' => out.push_str("--"),
            other => out.push(other),
        }
    }
    out
}

/// A heading: the three counts as the formulas they are.
fn heading(title: &str) -> String {
    let formula = |text: String, of: &str| text.replace(&format!("n\\_{of}"), &format!("$n_{of}$"));
    ["K", "B", "t"].into_iter().fold(latex(title), formula)
}
