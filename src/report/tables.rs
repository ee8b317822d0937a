//! The tables of a run.

mod checks;
mod costs;

use super::cost::Pair;
use super::number::Z99;
use super::table::{Cell, Column, Table};
use crate::study::records::CellRecord;

pub use checks::{fits, judged, samplers, verdicts};
pub use costs::{EQUAL, REFERENCE, costs, extremes, strategies};

/// A p-value, where there is one.
fn p_value(p: Option<f64>) -> Cell {
    p.map_or(Cell::Missing, Cell::PValue)
}

/// `scale` times how far `value` is from `origin`, with half of its interval.
fn estimate(value: Option<f64>, se: Option<f64>, origin: f64, scale: f64) -> Cell {
    value.map_or(Cell::Missing, |value| {
        Cell::Estimate(scale * (value - origin), se.map(|se| scale * Z99 * se))
    })
}

/// Every cell: slope, counts and cost predicted and counted, p-values of the gate.
pub fn cells(cells: &[CellRecord]) -> Table {
    let mut columns = vec![
        Column::left("scene", "scene"),
        Column::left("strategy", "strategy"),
        Column::right("nodes", "nodes"),
        Column::right("lines", "lines"),
        Column::measured("slope − 1, %", "slope_minus_1_pct"),
    ];
    for name in ["n_K", "n_B", "n_K + n_B", "n_t", "C"] {
        let key = name.to_lowercase().replace(" + ", "_plus_");
        let columns_of = ["predicted", "counted"]
            .map(|what| Column::right(&format!("{name} {what}"), &format!("{key}_{what}")));
        columns.extend(columns_of);
    }
    columns.extend([
        Column::measured("C difference, %", "c_difference_pct"),
        Column::right("p slope", "p_slope"),
        Column::right("p tails", "p_tails"),
        Column::right("p contrasts", "p_contrasts"),
    ]);
    let caption = "Slope of hits against N p; inner nodes (n_K), leaves (n_B), all nodes (n_K + n_B) and object tests (n_t) per line; tree cost C. \
                   ± is half of the 99 % interval, left out where the pilot cannot tell it; p-values: slope is 1, \
                   smallest binomial tail, Hotelling over contrasts.";
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
        estimate(cell.slope, cell.slope_se, 1.0, 100.0),
    ];
    let [n_k, n_b, n_t, cost] = Pair::all(cell);
    for pair in [n_k, n_b, n_k.plus(n_b), n_t, cost] {
        let decimals = pair.decimals();
        row.extend([
            Cell::Value(pair.predicted, decimals),
            Cell::Value(pair.counted, decimals),
        ]);
    }
    row.push(cost.deviation().map_or(Cell::Missing, |deviation| {
        Cell::Estimate(deviation.percent, deviation.half)
    }));
    row.extend([cell.slope_p, cell.tail_p, cell.hotelling_p].map(p_value));
    row
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
        Column::right("bytes", "bytes"),
        Column::right("depth", "depth"),
    ];
    let row = |cell: &CellRecord| {
        let counts = [
            cell.objects,
            cell.inner_nodes,
            cell.leaves,
            cell.empty_leaves,
            cell.references,
            cell.bytes,
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
                  time), bytes that a traversal reads (nodes and references), depth of the deepest leaf."
            .to_owned(),
        columns,
        keys: 2,
        rows: cells.iter().map(row).collect(),
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
        Column::measured("C counted", "c_counted"),
    ];
    let row = |cell: &CellRecord| {
        let [n_k, n_b, n_t, cost] = Pair::all(cell);
        let counted = |pair: Pair| Cell::Value(pair.counted, pair.decimals().min(2));
        vec![
            Cell::Text(cell.strategy.clone()),
            Cell::Count(cell.inner_nodes + cell.leaves),
            Cell::Value(cell.references as f64 / cell.objects as f64, 2),
            Cell::Count(cell.depth),
            counted(n_k),
            counted(n_b),
            counted(n_t),
            Cell::Value(cost.predicted, cost.decimals()),
            Cell::Measured(cost.counted, cost.half()),
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
