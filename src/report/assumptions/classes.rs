//! Where the metric errs, over all trees: by the size of nodes and by their place.

use super::Assumptions;
use super::tables::value;
use crate::report::means::geometric;
use crate::report::table::{Cell, Column, Table};
use crate::study::records::{BiasRecord, GroupRecord};

/// A class of nodes: its heading, its name for machines, and whether a group is in it.
type Class = (&'static str, &'static str, fn(&GroupRecord) -> bool);

/// Classes of nodes by size and by place. Groups begin and end at half decades of p and at tenths.
const CLASSES: [Class; 6] = [
    ("p > 0.1", "p_above_0_1", |g| g.by == "area" && g.lo > -1.2),
    ("p 0.01 to 0.1", "p_0_01_to_0_1", |g| {
        g.by == "area" && g.lo < -1.2 && g.lo > -2.2
    }),
    ("p < 0.01", "p_below_0_01", |g| {
        g.by == "area" && g.lo < -2.2
    }),
    ("at the centre", "distance_below_0_3", |g| {
        g.by == "distance" && g.lo < 0.25
    }),
    ("between", "distance_0_3_to_0_6", |g| {
        g.by == "distance" && g.lo > 0.25 && g.lo < 0.55
    }),
    ("far out", "distance_above_0_6", |g| {
        g.by == "distance" && g.lo > 0.55
    }),
];

/// Where the metric errs: by the size of nodes and by their place.
pub fn table(run: &Assumptions) -> Table {
    let mut columns = vec![Column::left("rays", "rays")];
    columns.extend(CLASSES.map(|(title, key, _)| Column::right(title, key)));
    let row = |set: &str| {
        let mut row = vec![Cell::Text(set.to_owned())];
        for (_, _, is_in) in CLASSES {
            let own = run.bias.iter().filter(|tree| tree.rays == set);
            let ratios: Vec<f64> = own
                .filter_map(|tree| ratio(run, tree, is_in))
                .filter(|ratio| *ratio > 0.0)
                .collect();
            row.push(value(geometric(&ratios), 3));
        }
        row
    };
    Table {
        caption: "Where the metric errs: visits counted over predicted of nodes by their predicted hit probability p, and by the \
                  distance of their centre from the root's, over half of the root's diagonal (at the centre: below 0.3; far out: above \
                  0.6). Geometric means over all trees."
            .to_owned(),
        columns,
        keys: 1,
        rows: run.sets().into_iter().map(row).collect(),
    }
}

/// Visits counted over predicted of the nodes of a class in one tree; `None` where none is predicted.
fn ratio(run: &Assumptions, tree: &BiasRecord, is_in: fn(&GroupRecord) -> bool) -> Option<f64> {
    let own = |g: &&GroupRecord| {
        (&g.scene, &g.strategy, &g.rays) == (&tree.scene, &tree.strategy, &tree.rays) && is_in(g)
    };
    let (mut hits, mut predicted) = (0.0, 0.0);
    for group in run.groups.iter().filter(own) {
        hits += group.hits as f64;
        predicted += group.entered as f64 * group.p_sum;
    }
    (predicted > 0.0).then(|| hits / predicted)
}
