//! How near samplers of lines come to the truth, and in what time.

use super::super::SpeedVsError;
use super::super::times::Of;
use crate::report::shown::{known, ratio, text};
use crate::report::table::{Cell, Column, Table};
use crate::study::records::{EnoughRecord, ErrorRecord};

/// Each estimate by the most lines that the sampler drew for it.
pub fn at_most(run: &SpeedVsError) -> Vec<&ErrorRecord> {
    let same = |a: &ErrorRecord, b: &ErrorRecord| {
        (&a.cell, &a.sampler, &a.rays, &a.quantity) == (&b.cell, &b.sampler, &b.rays, &b.quantity)
    };
    let largest = |row: &&ErrorRecord| {
        let mut own = run.errors.iter().filter(|other| same(row, other));
        own.all(|other| other.lines <= row.lines)
    };
    run.errors.iter().filter(largest).collect()
}

/// 1/(MSE · seconds) over that of random lines, from as many lines as the row has or the most that both have; `None` where one
/// of both was not timed.
pub fn efficiency(run: &SpeedVsError, row: &ErrorRecord) -> Option<f64> {
    let random = |other: &&&ErrorRecord| {
        other.sampler == "random"
            && (&other.cell, &other.rays, &other.quantity) == (&row.cell, &row.rays, &row.quantity)
    };
    let of = |r: &ErrorRecord| Some(1.0 / (r.rmse * r.rmse * run.replicate_seconds(r)?));
    let most = at_most(run);
    let random = most.iter().find(random)?;
    Some(of(row)? / of(random)?).filter(|ratio| ratio.is_finite())
}

/// Root mean square errors below this are of rounding alone: the estimate is exact.
const EXACT: f64 = 1e-12;

/// Whether an estimate is exact, so that a gain would be of rounding errors.
pub fn is_exact(row: &ErrorRecord) -> bool {
    row.rmse < EXACT
}

/// What a row gains over random lines.
fn gain(row: &ErrorRecord, value: Option<f64>) -> Cell {
    if is_exact(row) {
        text("exact")
    } else {
        known(value, ratio)
    }
}

/// Errors at the most lines, and how they fall with their number.
pub fn samplers(run: &SpeedVsError) -> Table {
    let columns = vec![
        Column::left("scene", "scene"),
        Column::left("lines ask", "rays"),
        Column::left("quantity", "quantity"),
        Column::left("sampler", "sampler"),
        Column::right("lines", "lines"),
        Column::right("replicates", "replicates"),
        Column::right("RMSE, %", "rmse_pct"),
        Column::right("RMSE·√N", "scaled_rmse"),
        Column::right("gain", "gain"),
        Column::right("least", "gain_lo"),
        Column::right("most", "gain_hi"),
        Column::right("exponent", "exponent"),
        Column::right("least", "exponent_lo"),
        Column::right("most", "exponent_hi"),
    ];
    let row = |r: &ErrorRecord| {
        let fit = run.exponents.iter().find(|e| {
            (&e.scene, &e.sampler, &e.rays, &e.quantity)
                == (&r.scene, &r.sampler, &r.rays, &r.quantity)
        });
        let exponent = |value: Option<f64>| known(value, |v| Cell::Value(v, 3));
        vec![
            text(&r.scene),
            text(&r.rays),
            text(&r.quantity),
            text(&r.sampler),
            Cell::Count(r.lines),
            Cell::Count(r.replicates),
            ratio(100.0 * r.rmse),
            ratio(r.rmse * (r.lines as f64).sqrt()),
            gain(r, r.gain),
            gain(r, r.gain_lo),
            gain(r, r.gain_hi),
            exponent(fit.map(|e| e.exponent)),
            exponent(fit.map(|e| e.exponent_lo)),
            exponent(fit.map(|e| e.exponent_hi)),
        ]
    };
    Table {
        caption: "Relative root mean square error of estimates from the most lines of each sampler, over independent replicates. RMSE·√N \
                  does not fall for independent lines; of nodes it is 1 for them. Gain: how many times fewer lines do than random ones, \
                  by mean square errors; exact: RMSE below 10⁻¹². Exponent of 1/N fitted to all numbers of lines. Least, most: 95 % intervals."
            .to_owned(),
        columns,
        keys: 4,
        rows: at_most(run).into_iter().map(row).collect(),
    }
}

/// Time of a line, and what an estimate's error costs in time; `None` where nothing was timed.
pub fn times_samplers(run: &SpeedVsError) -> Option<Table> {
    let columns = vec![
        Column::left("scene", "scene"),
        Column::left("lines ask", "rays"),
        Column::left("quantity", "quantity"),
        Column::left("sampler", "sampler"),
        Column::right("lines", "lines"),
        Column::right("RMSE, %", "rmse_pct"),
        Column::right("ns a line", "line_ns"),
        Column::right("ms a replicate", "replicate_ms"),
        Column::right("efficiency", "efficiency"),
    ];
    let row = |r: &ErrorRecord| {
        let seconds = run.replicate_seconds(r)?;
        Some(vec![
            text(&r.scene),
            text(&r.rays),
            text(&r.quantity),
            text(&r.sampler),
            Cell::Count(r.lines),
            ratio(100.0 * r.rmse),
            ratio(1e9 * seconds / r.lines as f64),
            ratio(1e3 * seconds),
            gain(r, efficiency(run, r)),
        ])
    };
    let rows: Vec<_> = at_most(run).into_iter().filter_map(row).collect();
    (!rows.is_empty()).then(|| Table {
        caption: format!(
            "Time of the most lines of each sampler on one thread, their generation included. Efficiency: 1/(MSE · time) over that of \
             random lines: how many times sooner the same error is reached; exact: RMSE below 10⁻¹².{}",
            run.disturbed(Of::Samplers)
        ),
        columns,
        keys: 4,
        rows,
    })
}

const ENOUGH: &str =
    "Lines that a wanted relative error of the tree cost C takes, by the fitted curve";

/// Lines of a wanted error.
pub fn enough(run: &SpeedVsError) -> Table {
    let row = |r: &EnoughRecord| {
        let mut row = wanted(r);
        row.push(text(if r.extrapolated { "yes" } else { "no" }));
        row
    };
    Table {
        caption: format!("{ENOUGH}. Extrapolated: beyond the lines that the curve was fitted to."),
        columns: columns_of_enough(Column::left("extrapolated", "extrapolated")),
        keys: 4,
        rows: run.enough.iter().map(row).collect(),
    }
}

/// Seconds of a wanted error; `None` where nothing was timed.
pub fn times_enough(run: &SpeedVsError) -> Option<Table> {
    let row = |r: &EnoughRecord| {
        let mut row = wanted(r);
        row.push(ratio(run.enough_seconds(r)?));
        Some(row)
    };
    let rows: Vec<_> = run.enough.iter().filter_map(row).collect();
    (!rows.is_empty()).then(|| Table {
        caption: format!(
            "{ENOUGH}, and their seconds on one thread.{}",
            run.disturbed(Of::Samplers)
        ),
        columns: columns_of_enough(Column::right("seconds", "seconds")),
        keys: 4,
        rows,
    })
}

fn columns_of_enough(last: Column) -> Vec<Column> {
    vec![
        Column::left("scene", "scene"),
        Column::left("lines ask", "rays"),
        Column::left("sampler", "sampler"),
        Column::right("error wanted, %", "wanted_pct"),
        Column::right("lines", "lines"),
        last,
    ]
}

fn wanted(row: &EnoughRecord) -> Vec<Cell> {
    vec![
        text(&row.scene),
        text(&row.rays),
        text(&row.sampler),
        ratio(100.0 * row.wanted),
        Cell::Count(row.lines),
    ]
}
