//! What trees cost, scene by scene.

use crate::report::cost::Pair;
use crate::report::number::{Z99, decimals_for, percent_above, signed};
use crate::report::series::{Series, constants};
use crate::report::table::{Cell, Column, Table};
use crate::study::records::CellRecord;

/// The strategy others are measured against.
pub const REFERENCE: &str = "sah";

/// Per cent of cost below which trees count as equal: a change that would be shown as 0.0.
pub const EQUAL: f64 = 0.05;

/// Every scene: the cost of every strategy, predicted and counted with half of its 99 % interval.
pub fn costs(cells: &[CellRecord]) -> Table {
    let Series { scenes, strategies } = Series::of(cells);
    let mut columns = vec![
        Column::left("scene", "scene"),
        Column::left("cost C", "cost"),
    ];
    columns.extend(strategies.iter().map(|name| Column::measured(name, name)));
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
            Cell::Value(cell.c_predicted, Pair::cost(cell).decimals())
        }));
        rows.push(row("counted", |cell| {
            Cell::Measured(cell.c_counted, Pair::cost(cell).half())
        }));
    }
    let unit = constants(cells).map_or(String::new(), |[k, b, t]| {
        format!(", in the units of c_K:c_B:c_t = {k}:{b}:{t}")
    });
    Table {
        caption: format!(
            "Tree cost C = c_K n_K + c_B n_B + c_t n_t per line{unit}: predicted from surface areas, counted on lines with \
             half of the 99 % interval (none where the pilot cannot tell it)."
        ),
        columns,
        keys: 2,
        rows,
    }
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
                Cell::Value(cost(cell), Pair::cost(cell).decimals())
            }));
            row.extend(
                others
                    .iter()
                    .map(|&strategy| match (find(strategy), reference) {
                        (Some(cell), Some(reference)) if cost(reference) > 0.0 => Cell::Change(
                            percent_above(cost(cell) / cost(reference)),
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

/// Decimals of a relative cost: one to three, from the errors as if independent (both trees met the same lines, which
/// makes the true error smaller); one where an error is unknown.
fn change_decimals(cell: &CellRecord, reference: &CellRecord) -> usize {
    let relative = |cell: &CellRecord| cell.c_se.map(|se| se / cell.c_counted);
    match (relative(cell), relative(reference)) {
        (Some(a), Some(b)) => decimals_for(100.0 * Z99 * a.hypot(b)).clamp(1, 3),
        _ => 1,
    }
}

/// Every scene: the cost of the reference strategy, and the strategies that cost least and most.
pub fn extremes(cells: &[CellRecord]) -> Table {
    let columns = vec![
        Column::left("scene", "scene"),
        Column::right("predicted", "c_predicted"),
        Column::measured("counted", "c_counted"),
        Column::left("least", "least"),
        Column::left("most", "most"),
    ];
    let mut rows = Vec::new();
    for scene in Series::of(cells).scenes {
        let of_scene = || cells.iter().filter(|cell| cell.scene == scene);
        let reference = of_scene().find(|cell| cell.strategy == REFERENCE);
        let mut row = vec![Cell::Text(scene.to_owned())];
        row.extend(reference.map_or([Cell::Missing, Cell::Missing], |cell| {
            let cost = Pair::cost(cell);
            [
                Cell::Value(cost.predicted, cost.decimals()),
                Cell::Measured(cost.counted, cost.half()),
            ]
        }));
        let by_cost = |a: &&CellRecord, b: &&CellRecord| a.c_counted.total_cmp(&b.c_counted);
        let ends = of_scene().min_by(by_cost).zip(of_scene().max_by(by_cost));
        row.extend(
            ends.map_or([Cell::Missing, Cell::Missing], |(least, most)| {
                least_and_most(least, most, reference).map(Cell::Text)
            }),
        );
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

/// The strategies of least and most cost, with what they cost relative to the reference. The reference is preferred to
/// one that is better by next to nothing.
fn least_and_most(
    least: &CellRecord,
    most: &CellRecord,
    reference: Option<&CellRecord>,
) -> [String; 2] {
    let equal = |cell: &CellRecord| {
        let percent = percent_above(cell.c_counted / least.c_counted);
        percent.is_nan() || percent <= EQUAL
    };
    if equal(most) {
        return [(); 2].map(|()| "all equal".to_owned());
    }
    let least = reference.filter(|cell| equal(cell)).unwrap_or(least);
    [least, most].map(|cell| match reference {
        Some(reference) if cell.strategy != reference.strategy => {
            let change = percent_above(cell.c_counted / reference.c_counted);
            format!("{} {} %", cell.strategy, signed(change, 1))
        }
        _ => cell.strategy.clone(),
    })
}
