//! The tables of counts: what areas predict against what rays of many kinds do.

use super::agreement::Agreement;
use super::spread::Spread;
use super::{CostVsWork, sets};
use crate::report::number::counted;
use crate::report::series::{constants, distinct};
use crate::report::shown::{known, percent, ratio, tau, text};
use crate::report::table::{Cell, Column, Table};
use crate::study::records::{TreeOrderRecord, WorkRecord};

/// Rows of trees of all stop rules together.
const ALL: &str = "all";

/// The strategy whose tree stands for a scene, where the run has it.
const REFERENCE: &str = "sah";

/// What is compared: its name, predicted and counted.
type Quantity = (&'static str, fn(&WorkRecord) -> [f64; 2]);

const QUANTITIES: [Quantity; 4] = [
    ("n_K", |r| [r.n_k_predicted, r.n_k_counted]),
    ("n_B", |r| [r.n_b_predicted, r.n_b_counted]),
    ("n_t", |r| [r.n_t_predicted, r.n_t_counted]),
    ("C", |r| [r.c_predicted, r.c_counted]),
];

/// Counted over predicted of some rows.
fn spread<'r>(
    rows: impl IntoIterator<Item = &'r WorkRecord>,
    of: fn(&WorkRecord) -> [f64; 2],
) -> Option<Spread> {
    Spread::of(rows.into_iter().map(|row| {
        let [predicted, counted] = of(row);
        counted / predicted
    }))
}

/// Counted over predicted C of some rows.
pub fn cost_ratios<'r>(rows: impl IntoIterator<Item = &'r WorkRecord>) -> Option<Spread> {
    spread(rows, QUANTITIES[3].1)
}

/// How well areas order the trees of each scene under a set of rays, all stop rules together.
pub fn agreement<'r>(run: &'r CostVsWork, rays: &str) -> Option<Agreement<'r>> {
    let wanted = |row: &&TreeOrderRecord| row.rays == rays && row.stop == ALL;
    Agreement::of(run.orders.iter().filter(wanted))
}

/// What the ordering columns hold.
const ORDER: &str = "tau: Kendall's tau-b between the C predicted and the C counted of a scene's trees, mean over scenes; pairs \
                     right: share of the pairs of a scene's trees that areas put into the right order; regret: C counted of the \
                     tree of least C predicted over the least C counted, minus 1.";

fn order_columns() -> Vec<Column> {
    vec![
        Column::right("tau", "tau"),
        Column::right("pairs right, %", "pairs_right_pct"),
        Column::right("regret, mean %", "regret_mean_pct"),
        Column::right("worst %", "regret_worst_pct"),
        Column::left("on", "regret_scene"),
    ]
}

fn order_cells(agreement: Option<&Agreement>) -> Vec<Cell> {
    let lost = agreement.filter(|a| a.regret_worst.0 > 0.0);
    let worst_scene = lost.map(|a| a.regret_worst.1);
    vec![
        known(agreement.and_then(|a| a.tau), tau),
        known(agreement.and_then(|a| a.pairs_right), percent),
        known(agreement.map(|a| a.regret_mean), percent),
        known(agreement.map(|a| a.regret_worst.0), percent),
        known(worst_scene, text),
    ]
}

/// Trees that a spread is of.
fn trees_of(spread: Option<&Spread>) -> Cell {
    Cell::Count(spread.map_or(0, |s| s.number as u64))
}

/// How C is put together, with the run's costs where all trees share them.
pub fn formula(run: &CostVsWork) -> String {
    let costs = constants(&run.cells).map_or(String::new(), |[k, b, t]| {
        format!(" (c_K:c_B:c_t = {k}:{b}:{t})")
    });
    format!("C = c_K n_K + c_B n_B + c_t n_t{costs}")
}

/// Trees and scenes of the run, in words.
pub fn trees(run: &CostVsWork) -> String {
    let scenes = distinct(run.cells.iter().map(|cell| cell.scene.as_str()));
    format!(
        "{} over {}",
        counted(run.cells.len() as u64, "tree"),
        counted(scenes.len() as u64, "scene")
    )
}

/// Every set of rays: how far n_K, n_B, n_t and C are from what areas predict, over all trees.
pub fn by_set(run: &CostVsWork) -> Table {
    let mut columns = vec![
        Column::left("rays", "rays"),
        Column::left("of", "quantity"),
        Column::right("trees", "trees"),
        Column::right("counted/predicted", "ratio_geometric"),
        Column::right("least", "ratio_least"),
        Column::right("largest", "ratio_largest"),
    ];
    columns.extend(order_columns());
    let mut rows = Vec::new();
    for rays in sets::of(run) {
        let agreement = agreement(run, rays);
        for (name, of) in QUANTITIES {
            let found = spread(run.work.iter().filter(|row| row.rays == rays), of);
            let mut row = vec![
                text(rays),
                text(name),
                trees_of(found.as_ref()),
                known(found.as_ref().map(|s| s.geometric), ratio),
                known(found.as_ref().map(|s| s.least), ratio),
                known(found.as_ref().map(|s| s.largest), ratio),
            ];
            // Trees are ordered by C alone.
            let ordered = agreement.as_ref().filter(|_| name == "C");
            row.extend(order_cells(ordered));
            rows.push(row);
        }
    }
    Table {
        caption: format!(
            "What rays do in a tree over what surface areas predict of it: inner nodes n_K, leaves n_B and object tests n_t per \
             ray, and {}. {}; geometric mean, least and largest ratio of the trees where both are above 0. The prediction is that \
             of lines and the same for all sets. {ORDER} {}",
            formula(run),
            trees(run),
            sets::NAMES
        ),
        columns,
        keys: 2,
        rows,
    }
}

/// The same of C alone, with the range of most trees: short.
pub fn summary(run: &CostVsWork) -> Table {
    let mut columns = vec![
        Column::left("rays", "rays"),
        Column::right("trees", "trees"),
        Column::right("C counted/predicted", "ratio_geometric"),
        Column::right("median", "ratio_median"),
        Column::right("5 %", "ratio_q05"),
        Column::right("95 %", "ratio_q95"),
    ];
    columns.extend(order_columns());
    let row = |rays: &&str| {
        let found = cost_ratios(run.work.iter().filter(|row| row.rays == *rays));
        let mut row = vec![
            text(rays),
            trees_of(found.as_ref()),
            known(found.as_ref().map(|s| s.geometric), ratio),
            known(found.as_ref().map(|s| s.median), ratio),
            known(found.as_ref().map(|s| s.low), ratio),
            known(found.as_ref().map(|s| s.high), ratio),
        ];
        row.extend(order_cells(agreement(run, rays).as_ref()));
        row
    };
    Table {
        caption: format!(
            "Tree cost {} counted on rays over the one predicted from surface areas: geometric mean, median, 5 and 95 % quantile \
             of {}. {ORDER} {}",
            formula(run),
            trees(run),
            sets::NAMES
        ),
        columns,
        keys: 1,
        rows: sets::of(run).iter().map(row).collect(),
    }
}

/// Every scene: how far the cost of its picture's rays is from what areas predict. `None` where no such rays were traced.
pub fn traced(run: &CostVsWork) -> Option<Table> {
    let present = sets::of(run);
    let own = sets::TRACED.into_iter().filter(|set| present.contains(set));
    let own: Vec<&str> = own.collect();
    let first = run.cells.first().filter(|_| !own.is_empty())?;
    let stop = first.stop.as_str();
    let by_reference = run.cells.iter().find(|cell| cell.strategy == REFERENCE);
    let strategy = by_reference.unwrap_or(first).strategy.as_str();
    let mut columns = vec![
        Column::left("scene", "scene"),
        Column::right("objects", "objects"),
    ];
    for set in &own {
        columns.extend([
            Column::right(
                &format!("{set}: counted/predicted"),
                &format!("{set}_ratio"),
            ),
            Column::right(&format!("{set}: tau"), &format!("{set}_tau")),
            Column::right(&format!("{set}: regret, %"), &format!("{set}_regret_pct")),
        ]);
    }
    let row = |scene: &&str| {
        let tree =
            |row: &&WorkRecord| row.scene == *scene && row.strategy == strategy && row.stop == stop;
        let of_tree: Vec<&WorkRecord> = run.work.iter().filter(tree).collect();
        let objects = run.cells.iter().find(|cell| cell.scene == *scene);
        let mut row = vec![
            text(scene),
            known(objects.map(|cell| cell.objects), Cell::Count),
        ];
        for set in &own {
            let work = of_tree.iter().copied().filter(|row| row.rays == *set);
            let order = run
                .orders
                .iter()
                .find(|row| row.scene == *scene && row.rays == *set && row.stop == stop);
            row.extend([
                known(cost_ratios(work).map(|s| s.geometric), ratio),
                known(order.and_then(|order| order.tau), tau),
                known(order.and_then(|order| order.regret), percent),
            ]);
        }
        row
    };
    let scenes = distinct(run.cells.iter().map(|cell| cell.scene.as_str()));
    Some(Table {
        caption: format!(
            "The rays of every scene's picture against what surface areas predict, stop {stop}. Counted over predicted tree cost \
             {} of the tree of strategy {strategy}; tau: Kendall's tau-b between the C predicted and the C counted of the trees of \
             all strategies; regret: C counted of the tree of least C predicted over the least C counted, minus 1: 0 where the \
             cheapest predicted is the cheapest counted.",
            formula(run)
        ),
        columns,
        keys: 1,
        rows: scenes.iter().map(row).collect(),
    })
}
