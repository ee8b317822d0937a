//! Tables of a run of this kind.

mod memory;
mod steps;
mod times;

pub use memory::{memory, memory_summary};
pub use steps::{steps, steps_summary};
pub use times::{times, times_links, times_pays, times_precision, times_summary};

use crate::report::shown::{known, ratio};
use crate::report::strategies::averages::Averages;
use crate::report::table::{Cell, Column};

/// Columns of the averages of a ratio.
fn ratio_columns(of: &str, key: &str) -> Vec<Column> {
    vec![
        Column::right(of, &format!("{key}_geometric")),
        Column::right("99 %, from", &format!("{key}_lo")),
        Column::right("to", &format!("{key}_hi")),
        Column::right("least", &format!("{key}_least")),
        Column::right("most", &format!("{key}_most")),
    ]
}

/// Geometric mean with its interval, least and most.
fn ratio_cells(averages: Option<&Averages>) -> Vec<Cell> {
    let Some(all) = averages else {
        return vec![Cell::Missing; 5];
    };
    let [lo, hi] = [0, 1].map(|end| known(all.interval, |ends| ratio(ends[end])));
    vec![
        ratio(all.geometric),
        lo,
        hi,
        ratio(all.best.1),
        ratio(all.worst.1),
    ]
}

/// What the interval is, for captions.
const INTERVAL: &str = "99 %: the interval of the geometric mean, of three kinds of scenes or more (Student's t of the logarithms, the sizes of one scene \
     together being one observation)";
