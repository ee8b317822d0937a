//! How numbers read in the tables of several kinds.

use crate::report::number::{counted, digits_for, grouped};
use crate::report::table::Cell;
use crate::study::records::PassTiming;

/// A name.
pub fn text(text: &str) -> Cell {
    Cell::Text(text.to_owned())
}

/// A number if it is known.
pub fn known<T>(value: Option<T>, show: impl Fn(T) -> Cell) -> Cell {
    value.map_or(Cell::Missing, show)
}

/// A ratio, to three digits.
pub fn ratio(value: f64) -> Cell {
    Cell::Value(value, digits_for(value, 3))
}

/// Kendall's tau.
pub fn tau(value: f64) -> Cell {
    Cell::Value(value, 3)
}

/// A share, in per cent.
pub fn percent(share: f64) -> Cell {
    let percent = 100.0 * share;
    Cell::Value(percent, decimals(percent))
}

/// A ratio - 1, in per cent and with its sign.
pub fn change(share: f64) -> Cell {
    let percent = 100.0 * share;
    Cell::Change(percent, decimals(percent))
}

/// One decimal; two digits of what is less than 1.
fn decimals(percent: f64) -> usize {
    if percent.abs() < 1.0 {
        digits_for(percent, 2)
    } else {
        1
    }
}

/// How many of these times were disturbed, for captions; nothing of none.
pub fn disturbed(times: &[&PassTiming], noun: &str) -> String {
    if times.is_empty() {
        return String::new();
    }
    let disturbed = times.iter().filter(|time| time.disturbed).count();
    format!(
        " Disturbed, halves over 3 % apart: {} of {}.",
        grouped(disturbed as u64),
        counted(times.len() as u64, noun)
    )
}
