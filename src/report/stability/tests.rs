//! The report of this kind as a whole: hand-checked counts and bounds, nothing off the page.

use super::fixture::{KERNELS, parts, run, summary};
use super::outcomes::Tally;
use super::tables::{self, Judged};
use crate::report::table::Cell;
use crate::report::tests::assert_on_page;
use crate::report::{screen, write_plots, write_tables};

fn named(text: &str) -> Cell {
    Cell::Text(text.to_owned())
}

#[test]
fn outcomes_are_counted_by_kernel() {
    let run = parts();
    let own = |case: &str, kernel: &str| {
        let rows = run.cases.iter();
        Tally::of(rows.filter(|row| row.case == case && row.kernel == kernel))
    };
    assert_eq!(own("trees-corner-touch-4", "f64").counts, [10, 0, 0, 1]);
    let off = own("trees-corner-touch-2", "f32");
    assert_eq!((off.counts, off.worst), ([0, 11, 0, 0], Some(2e7)));
    assert!(own("trees-corner-touch-9", "f32-padded").is_empty());

    let table = tables::cases(&run);
    let row = |case: &str| {
        let mut rows = table.rows.iter();
        rows.find(|row| row[0] == named(case)).unwrap()
    };
    // The strategy that fails is told of, not the first.
    let fails = row("trees-corner-touch-4");
    assert_eq!(fails[4], named("miss"));
    assert_eq!(
        fails[5..10],
        [10, 0, 0, 1]
            .map(Cell::Count)
            .into_iter()
            .chain([Cell::Missing])
            .collect::<Vec<_>>()
    );
    let message = row("trees-corner-touch-7").last().unwrap();
    assert_eq!(*message, named("coordinates too coarse for f32 numbers"));
    // A kernel that a case is not for has no counts.
    assert_eq!(row("files-corner-touch-0")[10], Cell::Missing);
    // What no row of files names is wrong.
    let mut odd = run.cases[0].clone();
    odd.outcome = "unheard of".into();
    assert_eq!(Tally::of([&odd]).counts, [0, 0, 0, 1]);
}

#[test]
fn bounds_of_rare_events() {
    let of = |wrong, cases| {
        let judged = Judged {
            cases,
            wrong,
            ..Judged::default()
        };
        judged.bound_per_1e9()
    };
    // -ln 0.05; upper limits of 1 and 10 events from tables of the Poisson law.
    for (wrong, wanted) in [(0, 2.9957), (1, 4.7439), (10, 16.9622)] {
        let bound = of(wrong, 1_000_000_000).unwrap();
        assert!((bound / wanted - 1.0).abs() < 1e-4, "{wrong}: {bound}");
    }
    assert!((of(0, 1000).unwrap() / 2.9957e6 - 1.0).abs() < 1e-4);
    assert_eq!(of(0, 0), None);
    // Many events: close to the normal law.
    let many = of(1_000_000, 1_000_000_000).unwrap();
    assert!((many / (1e6 + 1.645e3) - 1.0).abs() < 1e-5, "{many}");
}

#[test]
fn random_cases_are_added_up() {
    let run = parts();
    let table = tables::random(&run);
    // Three kernels, two shapes, two families; in a table of their own, of each of two scenes.
    assert_eq!(table.rows.len(), 12);
    assert_eq!(tables::random_by_scene(&run).rows.len(), 12 * 2);
    let aimed = &table.rows[5];
    assert_eq!(aimed[..3], ["f32", "box", "aimed"].map(named));
    let counts = [2_000_000, 1_000_000, 12, 0, 4000, 1600, 600].map(Cell::Count);
    assert_eq!(aimed[3..10], counts);
    let ties = tables::ties(&run);
    assert_eq!(ties.rows.len(), 1);
    assert_eq!(ties.rows[0][3..5], [2, 1].map(Cell::Count));
    let metamorphic = tables::metamorphic(&run);
    let differing: Vec<_> = metamorphic.rows.iter().map(|row| row[5].clone()).collect();
    assert_eq!(differing, [0, 0, 0, 0, 2, 2].map(Cell::Count));
}

#[test]
fn pages_hold_all_cases_and_stay_within_their_edges() {
    let figures = |parts: &super::Stability| {
        let all = parts.figures(&summary());
        all.iter().for_each(|(_, figure)| assert_on_page(figure));
        all.into_iter().map(|(name, _)| name).collect::<Vec<_>>()
    };
    assert_eq!(figures(&parts()), ["stability", "stability-2"]);
    let mut lone = parts();
    lone.cases
        .retain(|row| row.kernel == "f64" && row.strategy.is_empty());
    assert_eq!(figures(&lone), ["stability"]);
    lone.cases.truncate(1);
    assert_eq!(figures(&lone), ["stability"]);
    lone.cases.clear();
    assert!(figures(&lone).is_empty());
    let mut odd = parts();
    let first = odd.cases[0].clone();
    for i in 0..90 {
        let mut row = first.clone();
        row.case = format!("{}-{i}", "a-case-of-a-long-name".repeat(i % 9));
        row.strategy = "a-strategy-of-a-long-name".repeat(1 + i % 9);
        row.kernel = KERNELS[i % 3].to_owned();
        row.off = Some(f64::INFINITY);
        row.outcome = "off".to_owned();
        odd.cases.push(row);
    }
    assert_eq!(figures(&odd).len(), 4);
}

#[test]
fn a_run_fits_one_screen() {
    let text = screen::study(&run(parts()));
    assert!(
        text.lines().all(|line| line.chars().count() <= 100),
        "{text}"
    );
    assert!(text.lines().count() <= 40, "{text}");
    // Sentences are folded.
    let flat = text.replace('\n', " ");
    for part in [
        "131 / 0 / 0 / 1",
        "Of 161 outcomes demanded 1 not right: trees-corner-touch-4 (f64).",
        "aimed",
        "by axes yzx.",
    ] {
        assert!(flat.contains(part), "{part}\n{text}");
    }
    let mut right = parts();
    right.cases.retain(|row| row.outcome == "pass");
    (right.random, right.metamorphic) = (Vec::new(), Vec::new());
    let text = screen::study(&run(right));
    assert!(
        text.contains("All 160 outcomes demanded are right."),
        "{text}"
    );
    let mut none = parts();
    none.cases.clear();
    assert!(screen::study(&run(none)).contains("aimed"));
}

#[test]
fn files_are_those_of_the_parts() {
    let dir = tempfile::tempdir().unwrap();
    let parts = parts();
    assert_eq!(
        write_plots(&run(parts.clone()), dir.path()).unwrap().len(),
        4
    );
    let tables = write_tables(&run(parts), &dir.path().join("tables")).unwrap();
    assert_eq!(tables.len(), 6 * 3);
}
