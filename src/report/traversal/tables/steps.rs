//! What rays do along the ways.

use super::{INTERVAL, ratio_cells, ratio_columns};
use crate::report::shown::{known, percent, ratio, text};
use crate::report::strategies::averages::Averages;
use crate::report::table::{Cell, Column, Table};
use crate::report::traversal::Traversal;
use crate::report::traversal::against::{Against, PRECISIONS, STACK, WAYS, averages};
use crate::report::traversal::figures::left_out;
use crate::study::records::TraversalRecord;

/// Every tree, set of rays and precision: leaves, tests and inner nodes of a ray along each way, and how many fell back.
pub fn steps(run: &Traversal) -> Table {
    let mut columns = vec![
        Column::left("scene", "scene"),
        Column::left("rays", "rays"),
        Column::left("precision", "precision"),
        Column::right("rays that enter", "entered"),
        Column::right("leaves", "leaves"),
        Column::right("tests", "tests"),
    ];
    let ways = || [STACK].into_iter().chain(WAYS);
    let inner = |way: &str| format!("inner_{}", way.replace('-', "_"));
    columns.extend(ways().map(|way| Column::right(&format!("inner, {way}"), &inner(way))));
    let fell = |way: &str| format!("fall_backs_{}", way.replace('-', "_"));
    columns.extend(WAYS.map(|way| Column::right(&format!("fell back, {way}"), &fell(way))));
    let row = |stack: &TraversalRecord| {
        let of = |count: u64| (stack.entered > 0).then(|| count as f64 / stack.entered as f64);
        let mut row = vec![
            text(&stack.scene),
            text(&stack.rays),
            text(&stack.precision),
            Cell::Count(stack.entered),
            known(of(stack.leaf_visits), ratio),
            known(stack.object_tests.and_then(of), ratio),
        ];
        let beside = |way: &str| run.beside(stack, way);
        row.extend(ways().map(|way| known(beside(way).and_then(|r| of(r.inner_visits)), ratio)));
        row.extend(WAYS.map(|way| known(beside(way), |r| Cell::Count(r.fall_backs))));
        row
    };
    let stacks = run.walks.iter().filter(|row| row.way == STACK);
    Table {
        caption: format!(
            "Leaves visited, objects tested and inner nodes visited per ray that meets the root's box, along each way; leaves and tests are \
             the same for all but the rays that fell back: whose next leaf was not certain, as planes tie, and that were finished with a \
             stack.{}",
            left_out(run)
        ),
        columns,
        keys: 3,
        rows: stacks.map(row).collect(),
    }
}

/// Every set of rays, precision and way over all scenes.
pub fn steps_summary(run: &Traversal) -> Table {
    let mut columns = vec![
        Column::left("rays", "rays"),
        Column::left("precision", "precision"),
        Column::left("way", "way"),
        Column::right("scenes", "scenes"),
        Column::right("leaves of a ray", "leaves"),
    ];
    columns.extend(ratio_columns("inner nodes over the stack's", "inner"));
    columns.extend([
        Column::right("links to a leaf straight, %", "straight_pct"),
        Column::right("fell back", "fall_backs"),
        Column::right("in thin leaves", "thin_fall_backs"),
        Column::right("of rays", "cast"),
        Column::right("most on a scene, %", "fall_backs_most_pct"),
    ]);
    let row = |rays: &str, precision: &str, way: &str| {
        let rows = run.of(rays, precision, way);
        let inner = averages(&rows, Against::inner)?;
        let leaves = averages(&rows, |row| {
            let leaves = row.own.leaf_visits as f64 / row.own.entered as f64;
            (leaves.is_finite() && leaves > 0.0).then_some(leaves)
        });
        let sum = |of: fn(&TraversalRecord) -> u64| rows.iter().map(|row| of(row.own)).sum();
        let shares = rows.iter().map(|row| row.own);
        let most = shares.map(|own| own.fall_backs as f64 / own.cast.max(1) as f64);
        let mut row = vec![
            text(rays),
            text(precision),
            text(way),
            Cell::Count(inner.scenes as u64),
            known(leaves, |all: Averages| ratio(all.geometric)),
        ];
        row.extend(ratio_cells(Some(&inner)));
        row.push(known(straight(run, precision, way), percent));
        row.extend([
            Cell::Count(sum(|r| r.fall_backs)),
            Cell::Count(sum(|r| r.thin_fall_backs)),
            Cell::Count(sum(|r| r.cast)),
        ]);
        row.push(known(most.reduce(f64::max), percent));
        Some(row)
    };
    let mut rows = Vec::new();
    for rays in run.sets() {
        for precision in PRECISIONS {
            rows.extend(WAYS.iter().filter_map(|way| row(rays, precision, way)));
        }
    }
    Table {
        caption: format!(
            "Inner nodes that the rays of a set visit over those with a stack: geometric mean over scenes, least and most; {INTERVAL}. Leaves of a \
             ray: geometric mean. Links to a leaf straight: share of all links within the root's box that lead to a leaf and not to a node \
             that covers the face. Fell back: rays whose next leaf was not certain, as planes tie, and that were finished with a \
             stack; in thin leaves: those of them that meet a leaf thinner than 12 ulp of the root's longest side.{}",
            left_out(run)
        ),
        columns,
        keys: 3,
        rows,
    }
}

/// Share of the links that lead straight to a leaf, over all trees.
fn straight(run: &Traversal, precision: &str, way: &str) -> Option<f64> {
    let own = run.links.iter().filter(|row| row.precision == precision);
    let sums = own.fold((0, 0), |(leaves, inner), row| {
        (leaves + row.links_to_leaves, inner + row.links_to_inner)
    });
    let all = sums.0 + sums.1;
    (way != "restart" && all > 0).then(|| sums.0 as f64 / all as f64)
}
