//! Tables of a run of this kind.

mod memory;
mod steps;
mod times;

pub use memory::{memory, memory_summary};
pub use steps::{steps, steps_summary};
pub use times::{times, times_links, times_summary};

use crate::report::shown::ratio;
use crate::report::strategies::averages::Averages;
use crate::report::table::{Cell, Column};

/// Columns of the averages of a ratio.
fn ratio_columns(of: &str, key: &str) -> Vec<Column> {
    vec![
        Column::right(of, &format!("{key}_geometric")),
        Column::right("least", &format!("{key}_least")),
        Column::right("most", &format!("{key}_most")),
    ]
}

/// Geometric mean, least and most.
fn ratio_cells(averages: Option<&Averages>) -> Vec<Cell> {
    match averages {
        None => vec![Cell::Missing; 3],
        Some(all) => [all.geometric, all.best.1, all.worst.1].map(ratio).into(),
    }
}
