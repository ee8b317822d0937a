//! A run of this kind on one screen.

use super::Stability;
use super::outcomes::{Tally, kernel_words, missed};
use super::tables::{Judged, kernels, random_totals};
use crate::report::number::{counted, grouped};
use crate::report::series::distinct;
use crate::report::shown::{known, ratio, text};
use crate::report::table::{Cell, Column, Table, fold};

/// Cases named at most that are demanded and not right.
const NAMED: usize = 6;

/// Outcomes by group, what is demanded and not right, random cases, transformed ones: those that the run has.
pub fn tables(run: &Stability, width: usize) -> String {
    let mut parts = Vec::new();
    if !run.cases.is_empty() {
        let table = groups(run).to_text(width);
        parts.push(format!("{table}{}\n", fold(&wrong(run), width)));
    }
    if !run.random.is_empty() {
        parts.push(random(run).to_text(width));
    }
    if !run.metamorphic.is_empty() {
        parts.push(format!("{}\n", fold(&metamorphic(run), width)));
    }
    parts.join("\n")
}

fn groups(run: &Stability) -> Table {
    let kernels = kernels(run);
    let mut columns = vec![
        Column::left("group", "group"),
        Column::right("cases", "cases"),
    ];
    columns.extend(kernels.iter().map(|k| Column::right(kernel_words(k), k)));
    let row = |group: &str| {
        let own = || run.cases.iter().filter(|row| row.group == group);
        let cases = distinct(own().map(|row| row.case.as_str())).len();
        let mut row = vec![text(group), Cell::Count(cases as u64)];
        row.extend(kernels.iter().map(|kernel| {
            let tally = Tally::of(own().filter(|row| row.kernel == *kernel));
            if tally.is_empty() {
                return Cell::Missing;
            }
            let counts = tally.counts.map(|n| n.to_string());
            text(&counts.join(" / "))
        }));
        row
    };
    let groups = distinct(run.cases.iter().map(|row| row.group.as_str()));
    Table {
        caption: "Hard cases by each kernel, over the strategies: passed / off / refused / failed."
            .to_owned(),
        columns,
        keys: 1,
        rows: groups.into_iter().map(row).collect(),
    }
}

/// Which cases are demanded and not right.
fn wrong(run: &Stability) -> String {
    let own = run.cases.iter().filter(|row| missed(row));
    let all: Vec<_> = own.collect();
    let demanded = run.cases.iter().filter(|row| row.demanded).count() as u64;
    if all.is_empty() {
        let off = run
            .cases
            .iter()
            .filter(|row| row.demanded && row.off.is_some());
        let allowed = match off.count() as u64 {
            0 => String::new(),
            n => format!(", {} of them off by no more than is allowed", grouped(n)),
        };
        return format!(
            "All {} demanded are right{allowed}.",
            counted(demanded, "outcome")
        );
    }
    let names = distinct(all.iter().map(|row| row.case.as_str()));
    let told = names.iter().take(NAMED).map(|name| {
        let own = all.iter().filter(|row| row.case == *name);
        let kernels = distinct(own.map(|row| kernel_words(&row.kernel)));
        format!("{name} ({})", kernels.join(", "))
    });
    let told: Vec<String> = told.collect();
    let more = match names.len().saturating_sub(NAMED) {
        0 => String::new(),
        n => format!(" and {}", counted(n as u64, "more case")),
    };
    format!(
        "Of {} demanded {} not right: {}{more}.",
        counted(demanded, "outcome"),
        grouped(all.len() as u64),
        told.join(", ")
    )
}

/// A row a kernel and shape; random lines beside aimed ones.
fn random(run: &Stability) -> Table {
    let totals = random_totals(run);
    let wrong = |judged: &Judged| Cell::Count(judged.wrong + judged.missed);
    let bound = |judged: &Judged| known(judged.bound_per_1e9(), ratio);
    let mut rows: Vec<Vec<Cell>> = Vec::new();
    for ([kernel, against, _], _) in &totals {
        let names = vec![text(kernel), text(against)];
        if rows.iter().any(|row| row[..2] == names) {
            continue;
        }
        let of = |family: &str| {
            let own = totals
                .iter()
                .find(|(of, _)| *of == [*kernel, *against, family]);
            own.map(|(_, judged)| *judged).unwrap_or_default()
        };
        let [random, aimed] = [of("random"), of("aimed")];
        let mut row = names;
        row.extend([Cell::Count(random.cases), wrong(&random), bound(&random)]);
        row.extend([Cell::Count(aimed.cases), wrong(&aimed), bound(&aimed)]);
        row.push(Cell::Count(random.tied_wrong + aimed.tied_wrong));
        rows.push(row);
    }
    Table {
        caption: "Random lines, and lines aimed at edges and corners, against exact integers: pairs judged, wrong by more than 8 ulp, 95 % \
                  upper bound of that; tied: wrong by less."
            .to_owned(),
        columns: vec![
            Column::left("kernel", "kernel"),
            Column::left("against", "against"),
            Column::right("random", "random"),
            Column::right("wrong", "random_wrong"),
            Column::right("≤ per 10⁹", "random_bound"),
            Column::right("aimed", "aimed"),
            Column::right("wrong", "aimed_wrong"),
            Column::right("≤ per 10⁹", "aimed_bound"),
            Column::right("tied", "tied_wrong"),
        ],
        keys: 2,
        rows,
    }
}

fn metamorphic(run: &Stability) -> String {
    let transforms = distinct(run.metamorphic.iter().map(|row| row.transform.as_str()));
    let nodes: u64 = run.metamorphic.iter().map(|row| row.differing_nodes).sum();
    let hits: u64 = run.metamorphic.iter().map(|row| row.differing_hits).sum();
    let differing = run
        .metamorphic
        .iter()
        .filter(|row| row.differing_nodes + row.differing_hits > 0);
    let differing = distinct(differing.map(|row| row.transform.as_str()));
    let mut text = format!(
        "Trees and lines transformed together, {} of {}: {} and {} differ",
        counted(run.metamorphic.len() as u64, "check"),
        counted(transforms.len() as u64, "transform"),
        counted(nodes, "node"),
        counted(hits, "hit")
    );
    if !differing.is_empty() {
        text += &format!(", by {}", differing.join(", "));
    }
    text + "."
}
