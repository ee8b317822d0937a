//! One table, printed as plain text, Markdown, CSV and LaTeX.
//!
//! Cells keep what they are (a count, an estimate with its error, a p-value); how they read follows from that. CSV is
//! for machines: numbers unrounded, a column of estimates followed by one of half intervals, unknown empty.

mod latex;
mod terminal;

use std::fmt::Write;

use super::number::{decimals_for, digits_for, fixed, grouped, p_value, signed, significant};

pub(in crate::report) use terminal::fold;

/// Digits of a number, and of a difference, whose error is unknown.
const DIGITS: [usize; 2] = [4, 2];

/// One cell of a table.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    /// A name.
    Text(String),
    /// A whole number.
    Count(u64),
    /// A number shown to this many decimals.
    Value(f64, usize),
    /// A number shown to so many significant digits.
    Rounded(f64, usize),
    /// A difference shown with its sign and this many decimals.
    Change(f64, usize),
    /// A difference and half of its interval, to the digits the interval leaves; to two digits where it has none.
    Estimate(f64, Option<f64>),
    /// A number and half of its interval, to the digits the interval leaves; to four digits where it has none.
    Measured(f64, Option<f64>),
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
    /// Sentences: left, and broken into lines in print.
    Paragraph,
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
    /// Whether a column of half intervals (99 %) follows in CSV, be they known or not.
    pub half: bool,
}

impl Column {
    /// A column of names.
    pub fn left(title: &str, key: &str) -> Self {
        Column {
            title: title.to_owned(),
            key: key.to_owned(),
            align: Align::Left,
            half: false,
        }
    }

    /// A column of sentences.
    pub fn sentences(title: &str, key: &str) -> Self {
        Column {
            align: Align::Paragraph,
            ..Column::left(title, key)
        }
    }

    /// A column of numbers.
    pub fn right(title: &str, key: &str) -> Self {
        Column {
            align: Align::Right,
            ..Column::left(title, key)
        }
    }

    /// A column of numbers with half of their intervals: [`Cell::Estimate`] and [`Cell::Measured`].
    pub fn measured(title: &str, key: &str) -> Self {
        Column {
            half: true,
            ..Column::right(title, key)
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
            Cell::Value(value, _)
            | Cell::Rounded(value, _)
            | Cell::Change(value, _)
            | Cell::Estimate(value, _)
            | Cell::Measured(value, _)
            | Cell::PValue(value) => value.is_finite(),
            Cell::Text(_) | Cell::Count(_) => true,
            Cell::Missing => false,
        }
    }

    pub(in crate::report) fn show(&self) -> String {
        match self {
            _ if !self.is_known() => "–".to_owned(),
            Cell::Text(text) => text.clone(),
            Cell::Count(count) => grouped(*count),
            Cell::Value(value, decimals) => fixed(*value, *decimals),
            Cell::Rounded(value, digits) => significant(*value, *digits),
            Cell::Change(value, decimals) => signed(*value, *decimals),
            Cell::Estimate(value, _) => self.with_half(signed, *value, DIGITS[1]),
            Cell::Measured(value, _) => self.with_half(fixed, *value, DIGITS[0]),
            Cell::PValue(p) => p_value(*p),
            Cell::Missing => "–".to_owned(),
        }
    }

    /// Half of the interval, where there is one.
    fn half(&self) -> Option<f64> {
        match self {
            Cell::Estimate(_, half) | Cell::Measured(_, half) => half.filter(|h| h.is_finite()),
            _ => None,
        }
    }

    fn with_half(&self, show: fn(f64, usize) -> String, value: f64, digits: usize) -> String {
        match self.half() {
            Some(half) => {
                let decimals = decimals_for(half);
                format!("{} ± {}", show(value, decimals), fixed(half, decimals))
            }
            None => show(value, digits_for(value, digits)),
        }
    }

    pub(in crate::report) fn raw(&self) -> String {
        match self {
            _ if !self.is_known() => String::new(),
            Cell::Text(text) => text.clone(),
            Cell::Count(count) => count.to_string(),
            Cell::Value(value, _)
            | Cell::Rounded(value, _)
            | Cell::Change(value, _)
            | Cell::Estimate(value, _)
            | Cell::Measured(value, _)
            | Cell::PValue(value) => value.to_string(),
            Cell::Missing => String::new(),
        }
    }
}

impl Table {
    /// Markdown, with `command` as what generated it.
    pub fn to_markdown(&self, command: &str) -> String {
        let safe = |text: &str| text.replace('|', "\\|").replace('\n', " ");
        let titles: Vec<String> = self.columns.iter().map(|c| safe(&c.title)).collect();
        let shown: Vec<Vec<String>> = self
            .rows
            .iter()
            .map(|row| row.iter().map(|cell| safe(&cell.show())).collect())
            .collect();
        let widest = |i: usize| {
            let texts = shown.iter().chain([&titles]).map(|row| &row[i]);
            texts.map(|text| text.chars().count()).max().unwrap_or(0)
        };
        let widths: Vec<usize> = (0..self.columns.len()).map(widest).collect();
        let mut out = format!("<!-- {} -->\n\n{}\n\n", generated_by(command), self.caption);
        let rules: Vec<String> = self
            .columns
            .iter()
            .zip(&widths)
            .map(|(column, &width)| match column.align {
                Align::Left | Align::Paragraph => format!(":{}", "-".repeat(width.max(2) - 1)),
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

    /// CSV, full precision. Which columns there are depends on [`columns`](Self::columns) alone, never on the rows.
    pub fn to_csv(&self) -> String {
        let mut writer = csv::Writer::from_writer(Vec::new());
        let mut record = |row: Vec<(String, String)>| {
            let fields = row
                .into_iter()
                .zip(&self.columns)
                .flat_map(|((value, half), column)| {
                    [Some(value), column.half.then_some(half)]
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
            let half = |cell: &Cell| {
                let half = cell.half().filter(|_| cell.is_known());
                half.map_or(String::new(), |half| half.to_string())
            };
            record(row.iter().map(|cell| (cell.raw(), half(cell))).collect());
        }
        let bytes = writer.into_inner().expect("memory takes every byte");
        String::from_utf8(bytes).expect("made of strings")
    }

    fn pad(&self, column: usize, text: &str, width: usize) -> String {
        match self.columns[column].align {
            Align::Left | Align::Paragraph => format!("{text:<width$}"),
            Align::Right => format!("{text:>width$}"),
        }
    }
}

/// What the first line of a generated file says.
pub(in crate::report) fn generated_by(command: &str) -> String {
    let command = command.replace('\n', " ");
    format!("generated by `{command}`, do not edit")
}
