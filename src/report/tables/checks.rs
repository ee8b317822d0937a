//! What the checks of a run found: fits, laws of lines, verdicts.

use super::{estimate, p_value};
use crate::report::table::{Cell, Column, Table};
use crate::study::records::{CellRecord, SamplerRecord, Summary, Verdict};

/// Every cell: the three regressions of hits against N p, and how much of the scatter chance explains.
pub fn fits(cells: &[CellRecord]) -> Table {
    let columns = vec![
        Column::left("scene", "scene"),
        Column::left("strategy", "strategy"),
        Column::measured("slope − 1, %, weighted", "slope_minus_1_pct"),
        Column::measured("slope − 1, %, ordinary", "slope_ols_minus_1_pct"),
        Column::measured("intercept of free line, 10⁻⁶", "free_intercept_ppm"),
        Column::measured("slope − 1, %, free line", "free_slope_minus_1_pct"),
        Column::right("p of free line", "free_p"),
        Column::right("1 − R² over its expectation", "unexplained_ratio"),
        Column::right("largest abs z, N p ≥ 10", "max_abs_z"),
    ];
    let value =
        |value: Option<f64>, decimals| value.map_or(Cell::Missing, |v| Cell::Value(v, decimals));
    let row = |cell: &CellRecord| {
        let ratio = cell
            .unexplained
            .zip(cell.unexplained_expected)
            .map(|(found, expected)| found / expected);
        vec![
            Cell::Text(cell.scene.clone()),
            Cell::Text(cell.strategy.clone()),
            estimate(cell.slope, cell.slope_se, 1.0, 100.0),
            estimate(cell.slope_ols, cell.slope_ols_se, 1.0, 100.0),
            estimate(cell.free_intercept, cell.free_intercept_se, 0.0, 1e6),
            estimate(cell.free_slope, cell.free_slope_se, 1.0, 100.0),
            p_value(cell.free_p),
            value(ratio, 2),
            value(cell.max_abs_z, 1),
        ]
    };
    Table {
        caption: "Regressions of a node's share of hits on p = SA(K)/SA(R): through the origin with weights 1/(p(1 − p)) and \
                  without, and the free line a + b p (weighted) with the p-value of a = 0, b = 1 together. ± is half of the \
                  99 % interval. 1 − R² (uncentred) is what chance leaves when its ratio is near 1; where a few large nodes \
                  dominate, that ratio scatters widely by itself (values of 0.4 to 2 are ordinary). Largest |z| over the \
                  nodes that at least 10 lines are expected to hit and 10 to miss."
            .to_owned(),
        columns,
        keys: 2,
        rows: cells.iter().map(row).collect(),
    }
}

/// Every law of lines that was checked: its p-values.
pub fn samplers(records: &[SamplerRecord]) -> Table {
    let columns = vec![
        Column::left("law", "law"),
        Column::left("exact", "exact"),
        Column::left("through", "scene"),
        Column::right("boxes", "boxes_p"),
        Column::right("mean chord", "mean_chord_p"),
        Column::right("fourth chord moment", "fourth_chord_p"),
        Column::right("directions", "directions_p"),
        Column::right("triangles", "triangles_p"),
    ];
    let row = |r: &SamplerRecord| {
        let mut row = vec![
            Cell::Text(r.law.clone()),
            Cell::Text(if r.exact { "yes" } else { "no" }.to_owned()),
            Cell::Text(r.scene.clone()),
        ];
        row.extend(r.p_values().map(p_value));
        row
    };
    Table {
        caption: "p-values of five checks of laws of lines against integral geometry: an exact law passes, a wrong one fails \
                  at least one. Hits of boxes alone miss most wrong laws of directions. A dash: too few lines for a p-value."
            .to_owned(),
        columns,
        keys: 1,
        rows: records.iter().map(row).collect(),
    }
}

/// What was expected of a run, and what came of it.
pub fn verdicts(summary: &Summary) -> Table {
    judged(&summary.question, &summary.verdicts)
}

/// Expectations under the question that they belong to.
pub fn judged(question: &str, verdicts: &[Verdict]) -> Table {
    let row = |v: &Verdict| {
        let held = if v.held { "held" } else { "MISSED" };
        vec![
            Cell::Text(v.name.clone()),
            Cell::Text(held.to_owned()),
            Cell::Text(v.message.clone()),
        ]
    };
    Table {
        caption: question.to_owned(),
        columns: vec![
            Column::left("expectation", "name"),
            Column::left("verdict", "verdict"),
            Column::sentences("figures", "message"),
        ],
        keys: 1,
        rows: verdicts.iter().map(row).collect(),
    }
}
