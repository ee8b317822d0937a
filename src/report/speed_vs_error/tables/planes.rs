//! What a plane search costs in tree cost, and what it saves in seconds.

use super::super::SpeedVsError;
use super::super::planes::{Timed, told};
use super::super::times::Of;
use crate::report::series::distinct;
use crate::report::shown::{change, known, ratio, text};
use crate::report::table::{Cell, Column, Table};
use crate::study::records::PlaneRecord;

/// Every search over every scene.
pub fn planes(run: &SpeedVsError) -> Table {
    let columns = vec![
        Column::left("scene", "scene"),
        Column::left("strategy", "strategy"),
        Column::left("objects", "clipped"),
        Column::right("C", "c"),
        Column::right("above exact, %", "above_pct"),
        Column::right("above exact unclipped, %", "above_unclipped_pct"),
        Column::right("depth", "depth"),
        Column::right("inner nodes", "inner_nodes"),
        Column::right("leaves", "leaves"),
        Column::right("references", "references"),
    ];
    let row = |r: &PlaneRecord| {
        vec![
            text(&r.scene),
            text(&r.strategy),
            text(told(r.clipped)),
            ratio(r.c),
            change(r.above),
            change(r.above_unclipped),
            Cell::Count(r.depth),
            Cell::Count(r.inner_nodes),
            Cell::Count(r.leaves),
            Cell::Count(r.references),
        ]
    };
    Table {
        caption: "Predicted cost C of the trees of plane searches, and by how much it lies above that of the exact search (sah), with \
                  the same clipping and without clipping."
            .to_owned(),
        columns,
        keys: 3,
        rows: run.planes.iter().map(row).collect(),
    }
}

/// The same beside the seconds of the builds; `None` where nothing was timed.
pub fn times_planes(run: &SpeedVsError) -> Option<Table> {
    let columns = vec![
        Column::left("scene", "scene"),
        Column::left("strategy", "strategy"),
        Column::left("objects", "clipped"),
        Column::right("above exact unclipped, %", "above_unclipped_pct"),
        Column::right("build, ms", "build_ms"),
        Column::right("over exact's", "over_exact"),
        Column::left("dominated by", "dominated_by"),
    ];
    let scenes = distinct(run.planes.iter().map(|row| row.scene.as_str()));
    let of_scene = |scene: &str| -> Vec<Vec<Cell>> {
        let all = Timed::all(run, scene);
        let exact = all
            .iter()
            .find(|one| one.row.strategy == "sah" && !one.row.clipped);
        let row = |one: &Timed| {
            let better = one.dominated_by(&all);
            let name = |row: &PlaneRecord| format!("{}, {}", row.strategy, told(row.clipped));
            vec![
                text(scene),
                text(&one.row.strategy),
                text(told(one.row.clipped)),
                change(one.row.above_unclipped),
                ratio(1e3 * one.seconds),
                known(exact, |exact| ratio(one.seconds / exact.seconds)),
                known(better, |row| text(&name(row))),
            ]
        };
        all.iter().map(row).collect()
    };
    let rows: Vec<_> = scenes.into_iter().flat_map(of_scene).collect();
    (!rows.is_empty()).then(|| Table {
        caption: format!(
            "Seconds of the builds, the least of several on one thread, beside the cost of the trees above that of the exact \
                  search without clipping. Dominated: another search of the scene is built no slower and gives a tree no dearer; of \
                  several the one with the cheapest tree is named.{}",
            run.disturbed(Of::Builds)
        ),
        columns,
        keys: 3,
        rows,
    })
}
