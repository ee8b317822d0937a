//! Seconds of the ways, and of building what they need.

use super::{ratio_cells, ratio_columns};
use crate::report::shown::{known, ratio, text};
use crate::report::strategies::averages::Averages;
use crate::report::table::{Cell, Column, Table};
use crate::report::traversal::Traversal;
use crate::report::traversal::against::{Against, PRECISIONS, STACK, WAYS, averages, outcomes};
use crate::report::traversal::figures::{disturbed, left_out};
use crate::study::records::{LinkRecord, TraversalRecord};

/// Every tree, set of rays and precision.
pub fn times(run: &Traversal) -> Table {
    let mut columns = vec![
        Column::left("scene", "scene"),
        Column::left("rays", "rays"),
        Column::left("precision", "precision"),
        Column::right("stack, ns a ray", "stack_ns"),
    ];
    for way in WAYS {
        let key = way.replace('-', "_");
        columns.extend([
            Column::right(&format!("{way} over it"), &key),
            Column::right("error, %", &format!("{key}_error_pct")),
        ]);
    }
    columns.push(Column::left("disturbed", "disturbed"));
    let row = |stack: &TraversalRecord| {
        let time = run.time_of(stack)?;
        let mut row = vec![
            text(&stack.scene),
            text(&stack.rays),
            text(&stack.precision),
            Cell::Value(1e9 * time.seconds / time.units as f64, 0),
        ];
        let others = WAYS.map(|way| run.beside(stack, way).and_then(|own| run.against(own)));
        for other in &others {
            let other = other.as_ref();
            row.push(known(other.and_then(Against::seconds), ratio));
            let error = other.and_then(Against::error);
            row.push(known(error, |error| Cell::Value(100.0 * error, 1)));
        }
        let any = others.iter().flatten().any(Against::disturbed);
        row.push(text(if any { "yes" } else { "no" }));
        Some(row)
    };
    let stacks = run.walks.iter().filter(|row| row.way == STACK);
    Table {
        caption: format!(
            "Nanoseconds of a ray with a stack, and seconds along the other ways over those; error: how far the ratio by even and by odd \
             rounds is apart, at least 1 %. On one thread, of each chunk of rays the least of all rounds.{}{}",
            disturbed(run),
            left_out(run)
        ),
        columns,
        keys: 3,
        rows: stacks.filter_map(row).collect(),
    }
}

/// Every set of rays, precision and way over all scenes.
pub fn times_summary(run: &Traversal) -> Table {
    let mut columns = vec![
        Column::left("rays", "rays"),
        Column::left("precision", "precision"),
        Column::left("way", "way"),
        Column::right("scenes", "scenes"),
        Column::right("inner nodes", "inner_geometric"),
    ];
    columns.extend(ratio_columns("seconds", "seconds"));
    columns.extend([
        Column::left("least on", "seconds_least_scene"),
        Column::left("most on", "seconds_most_scene"),
        Column::right("faster", "faster"),
        Column::right("slower", "slower"),
        Column::right("even", "even"),
    ]);
    let row = |rays: &str, precision: &str, way: &str| {
        let rows = run.of(rays, precision, way);
        let seconds = averages(&rows, Against::seconds)?;
        let inner = averages(&rows, Against::inner);
        let mut row = vec![
            text(rays),
            text(precision),
            text(way),
            Cell::Count(seconds.scenes as u64),
            known(inner, |all: Averages| ratio(all.geometric)),
        ];
        row.extend(ratio_cells(Some(&seconds)));
        row.extend([text(seconds.best.0), text(seconds.worst.0)]);
        row.extend(outcomes(&rows).map(Cell::Count));
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
            "Inner nodes and seconds over those with a stack in the same tree and precision: geometric means over scenes; of seconds the \
             least and the most too, and on which scene. Faster, slower: scenes on which that is certain, the ratio being further from 1 \
             than the ratios by even and by odd rounds from each other, and than 1 %; even: the others.{}",
            left_out(run)
        ),
        columns,
        keys: 3,
        rows,
    }
}

/// Every tree in each precision: seconds of building links and face trees.
pub fn times_links(run: &Traversal) -> Table {
    let columns = vec![
        Column::left("scene", "scene"),
        Column::left("precision", "precision"),
        Column::right("leaves", "leaves"),
        Column::right("tree, ms", "tree_ms"),
        Column::right("links, ms", "links_ms"),
        Column::right("face trees, ms", "face_trees_ms"),
        Column::right("links over the tree", "links_over_tree"),
        Column::right("both over the tree", "both_over_tree"),
    ];
    let row = |row: &LinkRecord| {
        let ms = |what: &str| {
            let time = run.timing(&row.cell, what);
            known(time, |time| ratio(1e3 * time.seconds))
        };
        let own = |what: &str| ms(&format!("build {what} {}", row.precision));
        vec![
            text(&row.scene),
            text(&row.precision),
            Cell::Count(row.leaves),
            ms("build"),
            own("links"),
            own("face-trees"),
            known(run.building(row, "links"), ratio),
            known(run.building(row, "face-trees"), ratio),
        ]
    };
    Table {
        caption: "Milliseconds of building the tree (in f64), its links, and the face trees from these: the least of all builds, on one \
                  thread; seconds of links, and of both, over the tree's."
            .to_owned(),
        columns,
        keys: 2,
        rows: run.links.iter().map(row).collect(),
    }
}
