//! Rows of a figure, a set of rays each: its name in words, and dots under the assumptions that it breaks.

use plotters::style::text_anchor::{HPos, VPos};

use super::Assumptions;
use super::names::{BROKEN, Broken, words};
use crate::report::figure::{LEFT, Pen};
use crate::report::palette::{BLUE, GRID, INK, MUTED};
use crate::report::text::{MEDIUM, SMALL, fit, text_width};

/// Height of a row.
pub const ROW: f64 = 11.6;
/// Width of a column of dots.
const COLUMN: f64 = 11.0;
/// Between the columns and what follows.
const GAP: f64 = 4.0;
/// Room of the columns' headings, which read upwards.
pub const HEADINGS: f64 = 50.0;
/// Longer names are shortened.
const WIDEST: f64 = 132.0;

/// The rows of a figure.
pub struct Rows<'r> {
    /// Sets of rays.
    pub sets: Vec<&'r str>,
    /// Top of the first row.
    pub top: f64,
    /// Right edge of what names the rows.
    pub right: f64,
    names: Vec<String>,
    broken: Vec<Broken>,
}

impl<'r> Rows<'r> {
    /// A row for every set of a run.
    pub fn of(run: &'r Assumptions, top: f64) -> Self {
        let sets = run.sets();
        let names: Vec<String> = sets
            .iter()
            .map(|set| fit(&words(set), MEDIUM, WIDEST))
            .collect();
        let widest = names.iter().map(|name| text_width(name, MEDIUM));
        Rows {
            top,
            right: LEFT + widest.fold(0.0, f64::max) + 5.0 + 3.0 * COLUMN + GAP,
            names,
            broken: sets.iter().map(|set| Broken::of(&run.bias, set)).collect(),
            sets,
        }
    }

    /// Middle of a row.
    pub fn middle(&self, row: usize) -> f64 {
        self.top + ROW * (row as f64 + 0.5)
    }

    /// Bottom of the last row.
    pub fn bottom(&self) -> f64 {
        self.top + ROW * self.sets.len() as f64
    }

    /// Names and dots; thin lines from row to row as far as `end`.
    pub fn draw(&self, pen: &Pen, end: f64) {
        let first = self.right - GAP - 2.5 * COLUMN;
        for (i, (name, broken)) in self.names.iter().zip(&self.broken).enumerate() {
            let y = self.middle(i);
            let below = self.top + ROW * (i + 1) as f64;
            pen.line(&[(LEFT, below), (end, below)], GRID, 0.4);
            let at = (self.right - GAP - 3.0 * COLUMN - 5.0, y);
            pen.text(name, at, MEDIUM, INK, (HPos::Right, VPos::Center));
            for (c, is) in broken.marks().into_iter().enumerate() {
                let at = (first + COLUMN * c as f64, y);
                if is {
                    pen.disc(at, 2.4, BLUE);
                } else {
                    pen.disc(at, 0.8, GRID);
                }
            }
        }
        for (c, name) in BROKEN.iter().enumerate() {
            let at = (first + COLUMN * c as f64 + 2.5, self.top - 4.0);
            pen.upright(name, at, SMALL, MUTED, (HPos::Left, VPos::Bottom));
        }
    }
}
