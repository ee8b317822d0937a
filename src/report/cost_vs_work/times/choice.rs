//! The steps by which terms were chosen.

use super::super::CostVsWork;
use crate::report::shown::{change, percent, text};
use crate::report::table::{Cell, Column, Table};
use crate::study::records::ChoiceRecord;

/// Candidates that are told of each step: the best and the one after it.
const TOLD: usize = 2;

/// Of every step the best candidate and the next.
pub fn choice(run: &CostVsWork) -> Table {
    let last = run.choices.iter().map(|row| row.step).max().unwrap_or(0);
    let mut rows = Vec::new();
    for step in 1..=last {
        let told = |row: &&ChoiceRecord| row.step == step && changes(row);
        let own = run.choices.iter().filter(told);
        let mut own: Vec<&ChoiceRecord> = own.collect();
        own.sort_by(|a, b| b.gain.total_cmp(&a.gain));
        rows.extend(own.into_iter().take(TOLD).map(row));
    }
    Table {
        caption: "How terms were added to n_K and n_t, one step after the other: of each step the candidate of the largest gain \
                  and the next. Gain: by how much the mean relative error of scenes left out falls, in percentage \
                  points, mean over scenes and its standard error. The first is taken where its gain is above one standard error; \
                  at the step where it is not, the choice ends. Candidates that change \
                  nothing are not shown."
            .to_owned(),
        columns: vec![
            Column::right("step", "step"),
            Column::left("candidate", "candidate"),
            Column::left("taken", "taken"),
            Column::right("error before, %", "error_before_pct"),
            Column::right("with it, %", "error_after_pct"),
            Column::right("gain, points", "gain_points"),
            Column::right("± standard error", "gain_se_points"),
        ],
        keys: 2,
        rows,
    }
}

/// Gains up to this come from rounding.
const NOTHING: f64 = 1e-12;

/// Whether the candidate changes any prediction: else its constant is 0, and so are its gain and the error of that.
fn changes(c: &ChoiceRecord) -> bool {
    c.taken || c.gain.abs() > NOTHING || c.gain_se > NOTHING
}

fn row(c: &ChoiceRecord) -> Vec<Cell> {
    vec![
        Cell::Count(c.step),
        text(&c.candidate),
        text(if c.taken { "yes" } else { "no" }),
        percent(c.error_before),
        percent(c.error_after),
        change(c.gain),
        percent(c.gain_se),
    ]
}
