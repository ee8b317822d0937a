//! A run of this kind on one screen.

use super::Traversal;
use super::against::{Against, PRECISIONS, WAYS, averages, outcomes};
use super::tables;
use crate::report::shown::{known, ratio, text};
use crate::report::strategies::averages::Averages;
use crate::report::table::{Cell, Column, Table};

/// Every set of rays beside the stack, and the memory.
pub fn tables(run: &Traversal, width: usize) -> String {
    let memory = tables::memory_summary(run).to_text(width);
    format!("{}\n{memory}", ways(run).to_text(width))
}

/// A row a set of rays and way; both precisions side by side.
fn ways(run: &Traversal) -> Table {
    let mut columns = vec![Column::left("rays", "rays"), Column::left("way", "way")];
    for precision in PRECISIONS {
        let title = |what: &str| format!("{precision} {what}");
        columns.extend([
            Column::right(&title("inner"), &title("inner")),
            Column::right("time", &title("seconds")),
            Column::right("least–most", &title("ends")),
            Column::right("+ / − / ?", &title("outcomes")),
        ]);
    }
    let row = |rays: &str, way: &str| {
        let mut row = vec![text(rays), text(way)];
        for precision in PRECISIONS {
            let rows = run.of(rays, precision, way);
            let inner = averages(&rows, Against::inner);
            let seconds = averages(&rows, Against::seconds);
            let mean = |all: &Averages| ratio(all.geometric);
            row.push(known(inner.as_ref(), mean));
            row.push(known(seconds.as_ref(), mean));
            row.push(known(seconds.as_ref(), |all: &Averages| {
                text(&format!("{:.2}–{:.2}", all.best.1, all.worst.1))
            }));
            row.push(match seconds {
                None => Cell::Missing,
                Some(_) => text(&outcomes(&rows).map(|n| n.to_string()).join(" / ")),
            });
        }
        row
    };
    let sets = run.sets();
    let rows = sets
        .iter()
        .flat_map(|rays| WAYS.iter().map(move |way| row(rays, way)));
    Table {
        caption: "Each way beside the stack: inner nodes and seconds over its own (geometric means over scenes), least and most seconds, and \
                  on how many scenes it is faster (+), slower (−) or the seconds cannot tell (?)."
            .to_owned(),
        columns,
        keys: 2,
        rows: rows.collect(),
    }
}
