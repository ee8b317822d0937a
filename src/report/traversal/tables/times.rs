//! Seconds of the ways, and of building what they need.

use super::{INTERVAL, ratio_cells, ratio_columns};
use crate::report::shown::{known, ratio, text};
use crate::report::strategies::averages::Averages;
use crate::report::table::{Cell, Column, Table};
use crate::report::traversal::Traversal;
use crate::report::traversal::against::{
    Against, BUILD, PRECISIONS, STACK, WAYS, averages, outcomes,
};
use crate::report::traversal::figures::{BELIEF, disturbed, disturbed_builds, left_out, sample};
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
            Column::right("±, %", &format!("{key}_error_pct")),
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
            "Nanoseconds of a ray with a stack, and seconds along the other ways over those; ±: {BELIEF}. On one thread, of each chunk of \
             rays the least of all rounds.{}{}{}",
            sample(run),
            disturbed(run),
            left_out(run)
        ),
        columns,
        keys: 3,
        rows: stacks.filter_map(row).collect(),
    }
}

/// What is averaged of a set of rays: all scenes in each precision; where single precision has fewer, double on these alone too.
fn groups<'r>(run: &'r Traversal, rays: &str, way: &str) -> [(&'static str, Vec<Against<'r>>); 3] {
    let [wide, narrow] = PRECISIONS.map(|precision| run.of(rays, precision, way));
    let in_both = |row: &&Against| narrow.iter().any(|n| n.own.cell == row.own.cell);
    let mut same: Vec<_> = wide.iter().filter(in_both).copied().collect();
    if same.len() == wide.len() {
        same.clear();
    }
    [
        ("f64", wide),
        ("f64 of those in f32", same),
        ("f32", narrow),
    ]
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
        Column::right("faster", "faster"),
        Column::right("slower", "slower"),
        Column::right("undecided", "undecided"),
    ]);
    let row = |rays: &str, precision: &str, way: &str, rows: &[Against]| {
        let seconds = averages(rows, Against::seconds)?;
        let inner = averages(rows, Against::inner);
        let mut row = vec![
            text(rays),
            text(precision),
            text(way),
            Cell::Count(seconds.scenes as u64),
            known(inner, |all: Averages| ratio(all.geometric)),
        ];
        row.extend(ratio_cells(Some(&seconds)));
        row.extend(outcomes(rows).map(Cell::Count));
        Some(row)
    };
    let mut rows = Vec::new();
    for rays in run.sets() {
        let ways = WAYS.map(|way| (way, groups(run, rays, way)));
        for group in 0..3 {
            for (way, groups) in &ways {
                let (precision, own) = &groups[group];
                rows.extend(row(rays, precision, way, own));
            }
        }
    }
    Table {
        caption: format!(
            "Inner nodes and seconds over those with a stack in the same tree and precision: geometric means over scenes; of seconds the \
             least and the most too. {INTERVAL}. Faster, slower: scenes on which the ratio is further from 1 than it can be off: {BELIEF}.{}{}{}",
            sample(run),
            disturbed(run),
            left_out(run)
        ),
        columns,
        keys: 3,
        rows,
    }
}

/// Where a way is faster than a stack.
pub fn times_pays(run: &Traversal) -> Table {
    let columns = vec![
        Column::left("scene", "scene"),
        Column::left("rays", "rays"),
        Column::left("precision", "precision"),
        Column::left("way", "way"),
        Column::right("inner nodes", "inner"),
        Column::right("seconds", "seconds"),
        Column::right("±, %", "error_pct"),
    ];
    let faster = run.faster();
    let row = |row: &Against| {
        vec![
            text(&row.own.scene),
            text(&row.own.rays),
            text(&row.own.precision),
            text(&row.own.way),
            known(row.inner(), ratio),
            known(row.seconds(), ratio),
            known(row.error(), |error| Cell::Value(100.0 * error, 1)),
        ]
    };
    Table {
        caption: format!(
            "Where a way is faster than a stack: {} of {} ratios of seconds. Inner nodes and seconds over those with a stack; ±: \
             {BELIEF}.{}",
            faster.len(),
            run.ratios(),
            disturbed(run)
        ),
        columns,
        keys: 4,
        rows: faster.iter().map(row).collect(),
    }
}

/// Single precision over double, along each way.
pub fn times_precision(run: &Traversal) -> Table {
    let mut columns = vec![
        Column::left("rays", "rays"),
        Column::left("way", "way"),
        Column::right("scenes", "scenes"),
    ];
    columns.extend(ratio_columns("seconds", "seconds"));
    let mut rows = Vec::new();
    for rays in run.sets() {
        for way in [STACK].into_iter().chain(WAYS) {
            let averages = Averages::of(&run.narrow_over_wide(rays, way));
            let Some(averages) = averages else { continue };
            let mut row = vec![text(rays), text(way), Cell::Count(averages.scenes as u64)];
            row.extend(ratio_cells(Some(&averages)));
            rows.push(row);
        }
    }
    Table {
        caption: format!(
            "Seconds in f32 over those in f64, the same rays along the same way: geometric means over scenes, least and most. {INTERVAL}.{}{}{}",
            sample(run),
            disturbed(run),
            left_out(run)
        ),
        columns,
        keys: 2,
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
        let own = |what: &str| ms(&format!("{BUILD} {what} {}", row.precision));
        vec![
            text(&row.scene),
            text(&row.precision),
            Cell::Count(row.leaves),
            ms(BUILD),
            own("links"),
            own("face-trees"),
            known(run.building(row, "links"), ratio),
            known(run.building(row, "face-trees"), ratio),
        ]
    };
    Table {
        caption: format!(
            "Milliseconds of building the tree (in f64), its links, and the face trees from these: the least of all builds, on one \
             thread; seconds of links, and of both, over the tree's.{}",
            disturbed_builds(run)
        ),
        columns,
        keys: 2,
        rows: run.links.iter().map(row).collect(),
    }
}
