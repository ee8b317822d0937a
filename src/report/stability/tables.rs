//! Tables of a run of this kind.

use statrs::distribution::{ContinuousCDF, Gamma};

use super::Stability;
use super::outcomes::{Outcome, Tally, kernel_words};
use crate::report::axis::extent;
use crate::report::series::distinct;
use crate::report::shown::{known, ratio, text};
use crate::report::table::{Cell, Column, Table};
use crate::study::records::{CaseRecord, MetamorphicRecord, RandomRecord, TieRecord};

/// Kernels of the cases.
pub fn kernels(run: &Stability) -> Vec<&str> {
    distinct(run.cases.iter().map(|row| row.kernel.as_str()))
}

/// Every case: what is right, what came out, and how often by each kernel.
pub fn cases(run: &Stability) -> Table {
    let kernels = kernels(run);
    let mut columns = vec![
        Column::left("case", "case"),
        Column::left("group", "group"),
        Column::sentences("stresses", "stresses"),
        Column::sentences("expected", "expected"),
        Column::sentences("measured (f64)", "measured"),
    ];
    for kernel in &kernels {
        let words = kernel_words(kernel);
        let key = words.replace('-', "_");
        let count = |outcome: Outcome| {
            let name = outcome.name();
            Column::right(&format!("{words} {name}"), &format!("{key}_{name}"))
        };
        columns.extend(Outcome::ALL.map(count));
        columns.push(Column::right(
            &format!("{words} worst off"),
            &format!("{key}_off"),
        ));
    }
    columns.push(Column::sentences("message of a refusal", "message"));
    let row = |own: Vec<&CaseRecord>| {
        let first = own.first()?;
        let shown = shown(&own);
        let mut row = vec![text(&first.case), text(&first.group), text(&first.stresses)];
        row.extend([text(&shown.expected), text(&shown.measured)]);
        for kernel in &kernels {
            let by_kernel = own.iter().copied().filter(|row| row.kernel == *kernel);
            let tally = Tally::of(by_kernel);
            let count = |n: u64| match tally.is_empty() {
                true => Cell::Missing,
                false => Cell::Count(n),
            };
            row.extend(tally.counts.map(count));
            row.push(known(tally.worst, ratio));
        }
        let refused = own.iter().find(|row| Outcome::of(row) == Outcome::Refused);
        row.push(known(refused, |row| text(&row.measured)));
        Some(row)
    };
    let names = distinct(run.cases.iter().map(|row| row.case.as_str()));
    let rows = names.into_iter().filter_map(|name| {
        let own = run.cases.iter().filter(|row| row.case == name);
        row(own.collect())
    });
    Table {
        caption: "Named hard cases: what is exactly right, what came out by f64 numbers (where strategies differ, the first that does not \
                  pass), and how often each kernel passed, was off, refused or failed over the strategies' trees, or once where there is \
                  no tree. Worst off: in units in the last place of the kernel's numbers, or as the case says."
            .to_owned(),
        columns,
        keys: 2,
        rows: rows.collect(),
    }
}

/// The row of a case that its table tells of: of f64 if there is one, the first that does not pass if there is one.
fn shown<'r>(own: &[&'r CaseRecord]) -> &'r CaseRecord {
    let of_f64: Vec<&'r CaseRecord> = own.iter().copied().filter(|r| r.kernel == "f64").collect();
    let of = if of_f64.is_empty() { own } else { &of_f64 };
    let wrong = of.iter().find(|row| Outcome::of(row) != Outcome::Pass);
    wrong.unwrap_or(&of[0])
}

/// Pairs of a line and a box or triangle judged by exact arithmetic, added up.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Judged {
    /// Pairs.
    pub cases: u64,
    /// Of them, hits.
    pub hits: u64,
    /// Taken for hit wrongly.
    pub wrong: u64,
    /// Taken for missed wrongly.
    pub missed: u64,
    /// Nearer than 8 ulp to a tie.
    pub ties: u64,
    /// Of them, judged wrongly.
    pub tied_wrong: u64,
    /// Of those, hits taken for missed.
    pub tied_missed: u64,
}

impl Judged {
    /// All rows together.
    pub fn sum<'r>(rows: impl IntoIterator<Item = &'r RandomRecord>) -> Self {
        let add = |sum: Self, row: &RandomRecord| Judged {
            cases: sum.cases + row.cases,
            hits: sum.hits + row.hits,
            wrong: sum.wrong + row.wrong,
            missed: sum.missed + row.missed,
            ties: sum.ties + row.ties,
            tied_wrong: sum.tied_wrong + row.tied_wrong,
            tied_missed: sum.tied_missed + row.tied_missed,
        };
        rows.into_iter().fold(Self::default(), add)
    }

    /// One-sided 95 % upper bound of the pairs judged wrongly but for ties, per 10^9: the exact one of a Poisson mean, 3.0/n for
    /// none of n. `None` of no pairs.
    pub fn bound_per_1e9(&self) -> Option<f64> {
        let wrong = (self.wrong + self.missed) as f64;
        let law = Gamma::new(wrong + 1.0, 1.0).ok()?;
        (self.cases > 0).then(|| 1e9 * law.inverse_cdf(0.95) / self.cases as f64)
    }

    /// The cells of a row.
    pub fn cells(&self) -> Vec<Cell> {
        let Judged {
            cases,
            hits,
            wrong,
            missed,
            ties,
            tied_wrong,
            tied_missed,
        } = *self;
        let counts = [cases, hits, wrong, missed, ties, tied_wrong, tied_missed].map(Cell::Count);
        let bound = known(self.bound_per_1e9(), ratio);
        counts.into_iter().chain([bound]).collect()
    }

    /// Their columns.
    pub fn columns() -> Vec<Column> {
        vec![
            Column::right("judged", "cases"),
            Column::right("hits", "hits"),
            Column::right("wrong", "wrong"),
            Column::right("missed", "missed"),
            Column::right("ties", "ties"),
            Column::right("tied, wrong", "tied_wrong"),
            Column::right("of those missed", "tied_missed"),
            Column::right("at most per 10⁹", "bound_per_1e9"),
        ]
    }
}

/// What a row of random cases was of: kernel, box or triangle, random or aimed.
fn kind(row: &RandomRecord) -> [&str; 3] {
    [&row.kernel, &row.against, &row.family]
}

/// Each once, in the order of first appearance.
fn each_once<T: PartialEq>(all: impl Iterator<Item = T>) -> Vec<T> {
    let mut kept = Vec::new();
    for one in all {
        if !kept.contains(&one) {
            kept.push(one);
        }
    }
    kept
}

/// Random cases of all scenes together, a row a kind.
pub fn random_totals(run: &Stability) -> Vec<([&str; 3], Judged)> {
    let kinds = each_once(run.random.iter().map(kind));
    let sum = |of: [&'_ str; 3]| Judged::sum(run.random.iter().filter(|row| kind(row) == of));
    kinds.into_iter().map(|kind| (kind, sum(kind))).collect()
}

const RANDOM: &str = "Lines against the boxes of trees' nodes and against triangles, held against exact integers: taken for hit though \
                      missed (wrong), for missed though hit (missed), and pairs nearer than 8 ulp to a tie. Random: isotropic lines; aimed: \
                      at edges and corners. At most: one-sided 95 % upper bound of wrong and missed together, per 10⁹ pairs; 3.0/n where \
                      none of n is.";

/// Random cases, all scenes and strategies together.
pub fn random(run: &Stability) -> Table {
    let row = |(of, total): ([&str; 3], Judged)| of.map(text).into_iter().chain(total.cells());
    random_table(&[], random_totals(run).into_iter().map(row))
}

/// Random cases of each scene, its strategies' trees together.
pub fn random_by_scene(run: &Stability) -> Table {
    let kinds = each_once(run.random.iter().map(kind));
    let scenes = distinct(run.random.iter().map(|row| row.scene.as_str()));
    let pairs = scenes
        .into_iter()
        .flat_map(|scene| kinds.iter().map(move |of| (scene, *of)));
    let rows = pairs.filter_map(|(scene, of)| {
        let own = run.random.iter();
        let own = own.filter(|row| kind(row) == of && row.scene == scene);
        let judged = Judged::sum(own);
        let names = [scene].into_iter().chain(of).map(text);
        (judged.cases > 0).then(|| names.chain(judged.cells()))
    });
    random_table(&[Column::left("scene", "scene")], rows)
}

fn random_table(first: &[Column], rows: impl Iterator<Item: Iterator<Item = Cell>>) -> Table {
    let mut columns = first.to_vec();
    columns.extend([
        Column::left("kernel", "kernel"),
        Column::left("against", "against"),
        Column::left("lines", "family"),
    ]);
    let keys = columns.len();
    columns.extend(Judged::columns());
    Table {
        caption: RANDOM.to_owned(),
        columns,
        keys,
        rows: rows.map(Iterator::collect).collect(),
    }
}

/// How many wrongly judged ties were kept, and how near they are.
pub fn ties(run: &Stability) -> Table {
    fn kind(row: &TieRecord) -> [&str; 3] {
        [&row.kernel, &row.against, &row.family]
    }
    let row = |of: [&str; 3]| {
        let own = || run.ties.iter().filter(|row| kind(row) == of);
        let (near, far) = extent(own().map(|row| row.ulps)).unwrap_or_default();
        let mut row: Vec<Cell> = of.into_iter().map(text).collect();
        let count = |exact: bool| own().filter(|row| row.exact == exact).count() as u64;
        row.extend([count(true), count(false)].map(Cell::Count));
        row.extend([near, far].map(ratio));
        row
    };
    Table {
        caption: "Pairs judged wrongly nearer than 8 ulp to a tie, of those kept: hits taken for missed, misses taken for hit, how near to \
                  the tie the nearest and the farthest lie."
            .to_owned(),
        columns: vec![
            Column::left("kernel", "kernel"),
            Column::left("against", "against"),
            Column::left("lines", "family"),
            Column::right("hits missed", "hits"),
            Column::right("misses hit", "misses"),
            Column::right("nearest, ulp", "nearest_ulps"),
            Column::right("farthest, ulp", "farthest_ulps"),
        ],
        keys: 3,
        rows: each_once(run.ties.iter().map(kind)).into_iter().map(row).collect(),
    }
}

/// Trees and lines transformed together: a row a transform.
pub fn metamorphic(run: &Stability) -> Table {
    fn kind(row: &MetamorphicRecord) -> [&str; 2] {
        [&row.transform, &row.rays]
    }
    let row = |of: [&str; 2]| {
        let own = || run.metamorphic.iter().filter(|row| kind(row) == of);
        let sum = |count: fn(&MetamorphicRecord) -> u64| Cell::Count(own().map(count).sum());
        let mut row: Vec<Cell> = of.into_iter().map(text).collect();
        row.push(Cell::Count(own().count() as u64));
        row.extend([
            sum(|r| r.lines),
            sum(|r| r.nodes),
            sum(|r| r.differing_nodes),
            sum(|r| r.differing_hits),
        ]);
        row
    };
    let kinds = each_once(run.metamorphic.iter().map(kind));
    Table {
        caption: "Trees and their lines transformed together, all scenes and strategies: nodes whose hits differ and lines whose nearest \
                  hit differs from before; right is none."
            .to_owned(),
        columns: vec![
            Column::left("transform", "transform"),
            Column::left("lines ask", "rays"),
            Column::right("trees", "trees"),
            Column::right("lines", "lines"),
            Column::right("nodes", "nodes"),
            Column::right("nodes that differ", "differing_nodes"),
            Column::right("hits that differ", "differing_hits"),
        ],
        keys: 2,
        rows: kinds.into_iter().map(row).collect(),
    }
}
