//! Whether intervals cover and tests have their level, a row a check.

use super::super::SpeedVsError;
use super::super::coverage::{Family, kept};
use crate::report::shown::{percent, text};
use crate::report::table::{Cell, Column, Table};
use crate::study::records::CoverageRecord;

/// Every check.
pub fn coverage(run: &SpeedVsError) -> Table {
    let columns = vec![
        Column::left("check", "check"),
        Column::left("counts", "counts"),
        Column::left("scene", "scene"),
        Column::left("sampler", "sampler"),
        Column::right("lines", "lines"),
        Column::right("nominal, %", "nominal_pct"),
        Column::right("runs", "runs"),
        Column::right("counted", "counted"),
        Column::right("share, %", "share_pct"),
        Column::right("least", "least"),
        Column::right("most", "most"),
        Column::left("within", "within"),
    ];
    let row = |r: &CoverageRecord| {
        let share = match r.runs {
            0 => Cell::Missing,
            runs => percent(r.counted as f64 / runs as f64),
        };
        vec![
            text(&r.check),
            text(Family::of(&r.check).words()),
            text(&r.scene),
            text(&r.sampler),
            Cell::Count(r.lines),
            percent(r.nominal),
            Cell::Count(r.runs),
            Cell::Count(r.counted),
            share,
            Cell::Count(r.least),
            Cell::Count(r.most),
            text(if kept(r) { "yes" } else { "NO" }),
        ]
    };
    Table {
        caption: "Many independent runs of one small scene: in how many an interval holds the truth, a test rejects it, the stopping \
                  rule stays within the relative error of C that it was asked for (its nominal value; its lines are a mean); the \
                  fewest and the most that are expected of a correct program."
            .to_owned(),
        columns,
        keys: 4,
        rows: run.coverage.iter().map(row).collect(),
    }
}
