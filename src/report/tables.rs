//! The tables of a run.

use super::cost::Pair;
use super::number::{Z99, decimals_for, signed};
use super::series::Series;
use super::table::{Cell, Column, Table};
use crate::study::records::{CellRecord, SamplerRecord, Summary};

/// The strategy others are measured against.
const REFERENCE: &str = "sah";

/// Every cell: slope, counts and cost predicted and counted, p-values of the gate.
pub fn cells(cells: &[CellRecord]) -> Table {
    let mut columns = vec![
        Column::left("scene", "scene"),
        Column::left("strategy", "strategy"),
        Column::right("nodes", "nodes"),
        Column::right("lines", "lines"),
        Column::right("slope − 1, %", "slope_minus_1_pct"),
    ];
    for name in ["n_K", "n_B", "n_t", "C"] {
        let key = name.to_lowercase();
        columns.push(Column::right(
            &format!("{name} predicted"),
            &format!("{key}_predicted"),
        ));
        columns.push(Column::right(
            &format!("{name} counted"),
            &format!("{key}_counted"),
        ));
    }
    columns.extend([
        Column::right("C difference, %", "c_difference_pct"),
        Column::right("p slope", "p_slope"),
        Column::right("p tails", "p_tails"),
        Column::right("p contrasts", "p_contrasts"),
    ]);
    let caption = "Slope of hits against N p; inner nodes (n_K), leaves (n_B) and object tests (n_t) per line; tree cost C. \
                   ± is half of the 99 % interval; p-values: slope is 1, smallest binomial tail, Hotelling over contrasts.";
    Table {
        caption: caption.to_owned(),
        columns,
        keys: 2,
        rows: cells.iter().map(cell_row).collect(),
    }
}

fn cell_row(cell: &CellRecord) -> Vec<Cell> {
    let mut row = vec![
        Cell::Text(cell.scene.clone()),
        Cell::Text(cell.strategy.clone()),
        Cell::Count(cell.inner_nodes + cell.leaves),
        Cell::Count(cell.lines),
        match (cell.slope, cell.slope_se) {
            (Some(slope), Some(se)) => Cell::Estimate(100.0 * (slope - 1.0), 100.0 * Z99 * se),
            _ => Cell::Missing,
        },
    ];
    let pairs = Pair::all(cell);
    for pair in pairs {
        let decimals = decimals_for(Z99 * pair.se);
        row.extend([
            Cell::Value(pair.predicted, decimals),
            Cell::Value(pair.counted, decimals),
        ]);
    }
    let [.., cost] = pairs;
    row.push(cost.deviation().map_or(Cell::Missing, |(percent, half)| {
        Cell::Estimate(percent, half)
    }));
    let p_values = [cell.slope_p, cell.tail_p, cell.hotelling_p];
    row.extend(p_values.map(|p| p.map_or(Cell::Missing, Cell::PValue)));
    row
}

/// Every scene: the cost of the reference, and by how many per cent every other strategy costs more.
pub fn strategies(cells: &[CellRecord]) -> Table {
    let Series { scenes, strategies } = Series::of(cells);
    let others: Vec<&str> = strategies
        .into_iter()
        .filter(|&strategy| strategy != REFERENCE)
        .collect();
    let mut columns = vec![
        Column::left("scene", "scene"),
        Column::left("cost", "cost"),
        Column::right(&format!("C of {REFERENCE}"), "c_reference"),
    ];
    columns.extend(
        others
            .iter()
            .map(|&strategy| Column::right(strategy, strategy)),
    );
    let mut rows = Vec::new();
    for scene in scenes {
        let find = |strategy: &str| {
            cells
                .iter()
                .find(|cell| cell.scene == scene && cell.strategy == strategy)
        };
        let reference = find(REFERENCE);
        for (name, cost) in [
            (
                "predicted",
                (|cell| cell.c_predicted) as fn(&CellRecord) -> f64,
            ),
            ("counted", |cell| cell.c_counted),
        ] {
            let mut row = vec![Cell::Text(scene.to_owned()), Cell::Text(name.to_owned())];
            row.push(reference.map_or(Cell::Missing, |cell| {
                Cell::Value(cost(cell), decimals_for(Z99 * cell.c_se))
            }));
            row.extend(
                others
                    .iter()
                    .map(|&strategy| match (find(strategy), reference) {
                        (Some(cell), Some(reference)) if cost(reference) > 0.0 => Cell::Change(
                            100.0 * (cost(cell) / cost(reference) - 1.0),
                            change_decimals(cell, reference),
                        ),
                        _ => Cell::Missing,
                    }),
            );
            rows.push(row);
        }
    }
    let caption = format!(
        "Tree cost C of {REFERENCE}, and of every other strategy in per cent above (+) or below (−) it, predicted from \
         areas and counted on lines."
    );
    Table {
        caption,
        columns,
        keys: 2,
        rows,
    }
}

/// Decimals of a relative cost: one to three, from the errors as if independent. (Both trees met the same lines, which
/// makes the true error smaller.)
fn change_decimals(cell: &CellRecord, reference: &CellRecord) -> usize {
    let relative = |cell: &CellRecord| cell.c_se / cell.c_counted;
    decimals_for(100.0 * Z99 * relative(cell).hypot(relative(reference))).clamp(1, 3)
}

/// Every scene: the cost of every strategy, predicted and counted with half of its 99 % interval.
pub fn costs(cells: &[CellRecord]) -> Table {
    let Series { scenes, strategies } = Series::of(cells);
    let mut columns = vec![
        Column::left("scene", "scene"),
        Column::left("cost C", "cost"),
    ];
    columns.extend(strategies.iter().map(|name| Column::right(name, name)));
    let mut rows = Vec::new();
    for scene in scenes {
        let find = |strategy: &&str| {
            cells
                .iter()
                .find(|cell| cell.scene == scene && cell.strategy == *strategy)
        };
        let row = |name: &str, show: fn(&CellRecord) -> Cell| {
            let mut row = vec![Cell::Text(scene.to_owned()), Cell::Text(name.to_owned())];
            row.extend(
                strategies
                    .iter()
                    .map(|s| find(s).map_or(Cell::Missing, show)),
            );
            row
        };
        rows.push(row("predicted", |cell| {
            Cell::Value(cell.c_predicted, decimals_for(Z99 * cell.c_se))
        }));
        rows.push(row("counted", |cell| {
            Cell::Measured(cell.c_counted, Z99 * cell.c_se)
        }));
    }
    Table {
        caption: "Tree cost C = c_K n_K + c_B n_B + c_t n_t of a line: predicted from surface areas, counted on lines with \
                  half of the 99 % interval."
            .to_owned(),
        columns,
        keys: 2,
        rows,
    }
}

/// Every tree: its size.
pub fn trees(cells: &[CellRecord]) -> Table {
    let columns = vec![
        Column::left("scene", "scene"),
        Column::left("strategy", "strategy"),
        Column::right("objects", "objects"),
        Column::right("inner nodes", "inner_nodes"),
        Column::right("leaves", "leaves"),
        Column::right("empty", "empty_leaves"),
        Column::right("references", "references"),
        Column::right("depth", "depth"),
    ];
    let row = |cell: &CellRecord| {
        let counts = [
            cell.objects,
            cell.inner_nodes,
            cell.leaves,
            cell.empty_leaves,
            cell.references,
            cell.depth,
        ];
        let mut row = vec![
            Cell::Text(cell.scene.clone()),
            Cell::Text(cell.strategy.clone()),
        ];
        row.extend(counts.map(Cell::Count));
        row
    };
    Table {
        caption: "Trees: inner nodes, leaves (empty ones among them), references (an object in several leaves counts each \
                  time), depth of the deepest leaf."
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
        let p = [
            r.boxes_p,
            r.mean_chord_p,
            r.fourth_chord_p,
            r.directions_p,
            r.triangles_p,
        ];
        row.extend(p.map(Cell::PValue));
        row
    };
    Table {
        caption: "p-values of five checks of laws of lines against integral geometry: an exact law passes, a wrong one fails \
                  at least one. Hits of boxes alone miss most wrong laws of directions."
            .to_owned(),
        columns,
        keys: 1,
        rows: records.iter().map(row).collect(),
    }
}

/// What was expected, and what came of it.
pub fn verdicts(summary: &Summary) -> Table {
    let row = |v: &crate::study::records::Verdict| {
        let held = if v.held { "held" } else { "MISSED" };
        vec![
            Cell::Text(v.name.clone()),
            Cell::Text(held.to_owned()),
            Cell::Text(v.message.clone()),
        ]
    };
    Table {
        caption: summary.question.clone(),
        columns: vec![
            Column::left("expectation", "name"),
            Column::left("verdict", "verdict"),
            Column::left("figures", "message"),
        ],
        keys: 1,
        rows: summary.verdicts.iter().map(row).collect(),
    }
}

/// One scene: size and cost of every strategy's tree.
pub fn of_scene(cells: &[CellRecord]) -> Table {
    let columns = vec![
        Column::left("strategy", "strategy"),
        Column::right("nodes", "nodes"),
        Column::right("refs/object", "references_per_object"),
        Column::right("depth", "depth"),
        Column::right("n_K", "n_k_counted"),
        Column::right("n_B", "n_b_counted"),
        Column::right("n_t", "n_t_counted"),
        Column::right("C predicted", "c_predicted"),
        Column::right("C counted", "c_counted"),
    ];
    let row = |cell: &CellRecord| {
        let [n_k, n_b, n_t, cost] = Pair::all(cell);
        let counted = |pair: Pair| Cell::Value(pair.counted, decimals_for(Z99 * pair.se).min(2));
        vec![
            Cell::Text(cell.strategy.clone()),
            Cell::Count(cell.inner_nodes + cell.leaves),
            Cell::Value(cell.references as f64 / cell.objects as f64, 2),
            Cell::Count(cell.depth),
            counted(n_k),
            counted(n_b),
            counted(n_t),
            Cell::Value(cost.predicted, decimals_for(Z99 * cost.se)),
            Cell::Measured(cost.counted, Z99 * cost.se),
        ]
    };
    Table {
        caption: "Per line: inner nodes n_K, leaves n_B, object tests n_t, and the cost C with half of its 99 % interval."
            .to_owned(),
        columns,
        keys: 1,
        rows: cells.iter().map(row).collect(),
    }
}

/// Every scene: the cost of the reference strategy, and the strategies that cost least and most.
pub fn extremes(cells: &[CellRecord]) -> Table {
    let columns = vec![
        Column::left("scene", "scene"),
        Column::right("predicted", "c_predicted"),
        Column::right("counted", "c_counted"),
        Column::left("least", "least"),
        Column::left("most", "most"),
    ];
    let mut rows = Vec::new();
    for scene in Series::of(cells).scenes {
        let mut of_scene: Vec<&CellRecord> =
            cells.iter().filter(|cell| cell.scene == scene).collect();
        of_scene.sort_by(|a, b| a.c_counted.total_cmp(&b.c_counted));
        let (least, most) = (of_scene[0], of_scene[of_scene.len() - 1]);
        let reference = of_scene
            .iter()
            .copied()
            .find(|cell| cell.strategy == REFERENCE);
        let mut row = vec![Cell::Text(scene.to_owned())];
        row.extend(reference.map_or([Cell::Missing, Cell::Missing], |cell| {
            let half = Z99 * cell.c_se;
            [
                Cell::Value(cell.c_predicted, decimals_for(half)),
                Cell::Measured(cell.c_counted, half),
            ]
        }));
        row.extend([least, most].map(|cell| {
            let change = reference.map(|r| 100.0 * (cell.c_counted / r.c_counted - 1.0));
            let change = change.map_or(String::new(), |c| format!(" {} %", signed(c, 1)));
            Cell::Text(cell.strategy.clone() + &change)
        }));
        rows.push(row);
    }
    Table {
        caption: format!(
            "Tree cost C of {REFERENCE} with half of the 99 % interval, and the strategies of the least and the most C \
             counted, relative to it. All costs: tables/costs.md in the data folder."
        ),
        columns,
        keys: 1,
        rows,
    }
}

/// Every cell: the three regressions of hits against N p, and how much of the scatter chance explains.
pub fn fits(cells: &[CellRecord]) -> Table {
    let columns = vec![
        Column::left("scene", "scene"),
        Column::left("strategy", "strategy"),
        Column::right("slope − 1, %, weighted", "slope_minus_1_pct"),
        Column::right("slope − 1, %, ordinary", "slope_ols_minus_1_pct"),
        Column::right("free line: intercept, 10⁻⁶", "free_intercept_ppm"),
        Column::right("slope − 1, %", "free_slope_minus_1_pct"),
        Column::right("p", "free_p"),
        Column::right("1 − R² over its expectation", "unexplained_ratio"),
        Column::right("largest |z|", "max_abs_z"),
    ];
    let estimate = |value: Option<f64>, se: Option<f64>, less: f64, scale: f64| match (value, se) {
        (Some(value), Some(se)) => Cell::Estimate(scale * (value - less), scale * Z99 * se),
        _ => Cell::Missing,
    };
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
            cell.free_p.map_or(Cell::Missing, Cell::PValue),
            value(ratio, 2),
            value(cell.max_abs_z, 1),
        ]
    };
    Table {
        caption: "Regressions of a node's share of hits on p = SA(K)/SA(R): through the origin with weights 1/(p(1 − p)) and \
                  without, and the free line a + b p (weighted) with the p-value of a = 0, b = 1 together. ± is half of the \
                  99 % interval. 1 − R² (uncentred) is what chance leaves when its ratio is near 1."
            .to_owned(),
        columns,
        keys: 2,
        rows: cells.iter().map(row).collect(),
    }
}
