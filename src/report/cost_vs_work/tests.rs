//! The report of this kind as a whole: hand-checked numbers, no seconds where none may be, nothing off the page.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use super::fixture::{run, trees};
use super::times::{self, Key};
use super::{CostVsWork, figures, findings, work};
use crate::report::table::{Cell, Table};
use crate::report::tests::assert_on_page;
use crate::report::{screen, write_plots, write_tables};
use crate::study::records::{ModelRecord, ShareRecord, WorkRecord};

fn row<'t>(table: &'t Table, names: &[&str]) -> &'t [Cell] {
    let named = |row: &&Vec<Cell>| {
        row.iter()
            .zip(names)
            .all(|(cell, name)| *cell == Cell::Text((*name).to_owned()))
    };
    &table.rows.iter().find(named).unwrap()[names.len()..]
}

/// The numbers of cells, to six decimals.
fn numbers(cells: &[Cell]) -> Vec<Option<f64>> {
    let number = |cell: &Cell| match cell {
        Cell::Value(value, _) | Cell::Change(value, _) => Some((1e6 * value).round() / 1e6),
        Cell::Count(count) => Some(*count as f64),
        _ => None,
    };
    cells.iter().map(number).collect()
}

#[test]
fn work_by_hand() {
    let run = trees();
    let table = work::by_set(&run);
    assert_eq!(table.rows.len(), 2 * 4);
    // Six trees: ratios 2, 2, 2, 2, 8, 8 of n_K; n_t has nothing to be set against.
    let n_k = numbers(row(&table, &["primary", "n_K"]));
    let geometric = (1e6 * 2f64.powf(10.0 / 6.0)).round() / 1e6;
    assert_eq!(n_k[..4], [Some(6.0), Some(geometric), Some(2.0), Some(8.0)]);
    assert_eq!(n_k[4..], [None; 5]);
    let cost = row(&table, &["primary", "C"]);
    // Of three scenes tau is 1, 1 and -1; 2 of 3 pairs; regrets 0, 0 and 30 %.
    let ordered = [0.333_333, 66.666_667, 10.0, 30.0].map(Some);
    assert_eq!(numbers(&cost[4..8]), ordered);
    assert_eq!(cost[8], Cell::Text("spd:b:1".into()));
    // Of lines areas take the right tree everywhere, so no scene is the worst.
    assert_eq!(row(&table, &["lines", "C"])[8], Cell::Missing);
    assert!(
        table.caption.contains("6 trees over 3 scenes"),
        "{}",
        table.caption
    );
    assert!(
        table.caption.contains("c_K:c_B:c_t = 1:1:2"),
        "{}",
        table.caption
    );
    let short = work::summary(&run);
    let median = numbers(row(&short, &["primary"]));
    assert_eq!(median[..3], [Some(6.0), Some(geometric), Some(2.0)]);
}

#[test]
fn every_scene_has_its_row() {
    let table = work::traced(&trees()).unwrap();
    assert_eq!(table.columns.len(), 2 + 3, "no set but primary was traced");
    // sah's tree: 8 times, tau -1, and the cheapest predicted is not the cheapest.
    let b = numbers(row(&table, &["spd:b:1"]));
    assert_eq!(b, [1000.0, 8.0, -1.0, 30.0].map(Some));
    let a = numbers(row(&table, &["spd:a:2"]));
    assert_eq!(a, [1000.0, 2.0, 1.0, 0.0].map(Some));
    let mut lines = trees();
    lines.work.retain(|row| row.rays == "lines");
    assert!(work::traced(&lines).is_none());
}

#[test]
fn constants_have_the_digits_of_their_intervals() {
    let run = trees();
    let text = times::constants(&run, |_| true).to_markdown("x");
    for row in [
        "| n_K, n_t      | inner node (c_K)    | 16.9 | 13.8 | 20.0 |       4.8 |",
        "| n_K, n_B, n_t | leaf (c_B)          |    6 |    0 |   23 |      17.4 |",
        "| chosen terms  | mispredicted branch |   16 |    – |    – |         – |",
    ] {
        assert!(text.contains(row), "{row}\n{text}");
    }
    assert!(text.contains(
        "Not separately identified, with a variance inflation above 10, are of the model n_K, n_B, n_t: inner node (c_K) 18.3; leaf \
         (c_B) 17.4; and of the model chosen terms: inner node (c_K) 17.5; mispredicted branch without end."
    ));
    let mut apart = run.clone();
    for constant in &mut apart.constants {
        constant.inflation = Some(9.0);
    }
    assert!(times::unidentified(&apart).is_none());
}

#[test]
fn steps_tell_the_best_and_the_next() {
    let table = times::choice(&trees());
    let told: Vec<_> = table.rows.iter().map(|row| row[1..3].to_vec()).collect();
    let pair = |name: &str, taken: &str| vec![Cell::Text(name.into()), Cell::Text(taken.into())];
    assert_eq!(told[0], pair("leaves", "yes"));
    assert_eq!(told[1], pair("size of the tree", "no"));
    assert_eq!(told[2], pair("constant per ray", "no"));
    assert_eq!(told.len(), 4);
    assert_eq!(
        numbers(&table.rows[0][3..]),
        [30.0, 20.0, 10.0, 2.0].map(Some)
    );
}

#[test]
fn groups_of_one_scene_are_not_told() {
    let mut run = trees();
    let groups = run.models.clone();
    run.models
        .extend(groups.into_iter().map(|model| ModelRecord {
            left_out: ModelRecord::GROUP.into(),
            ..model
        }));
    assert_eq!(times::models(&run, |_| true).rows.len(), 2);
    run.models[3].error_max += 0.1;
    assert_eq!(times::models(&run, |_| true).rows.len(), 4);
}

#[test]
fn residuals_by_hand() {
    let run = trees();
    // spd:b:1: chosen terms 10 % too much, twice, and 20 % too little, twice; n_K and n_t twice too much.
    let scenes = times::residuals(&run, Key::Scene);
    let b = row(&scenes, &["spd:b:1"]);
    let wanted = [4.0, -5.0, 15.0, -20.0, 100.0, 100.0, 100.0].map(Some);
    assert_eq!(numbers(&b[..7]), wanted);
    assert_eq!(
        b[7..],
        [Cell::Text("sah".into()), Cell::Text("primary".into())]
    );
    let strategies = times::residuals(&run, Key::Strategy);
    assert_eq!(strategies.rows.len(), 2);
}

#[test]
fn findings_are_made_from_the_numbers() {
    let mut run = trees();
    let text = findings::findings(&run);
    for sentence in [
        "6 trees over 3 scenes, 12 times of a set of rays in a tree; 1 of them had even",
        "an inner node takes 16.9 ns (13.8 to 20.0) and an object test 4.4 ns (2.0 to 14.9): c_K:c_t is 0.93 to 10:1",
        "15:20 (Wald and Havran 2006) lies below, 1:80 (pbrt) lies below, 1.2:1 (Aila 2013) lies within.",
        "(ends of both intervals, so 90 %)",
        "no price of an inner node is given: it cannot be told apart from the mispredicted branches (variance inflation 17.5). \
         A branch that the simulated predictor gets wrong takes 16 ns, what comes with it included; these branches make 57 % of \
         the time.",
        "- Error 9.5 %, at most 0.1 wanted: **held**. By n_K and n_t alone: median relative error 28.3 %",
        "- By chosen terms: Kendall's tau between predicted and measured times of a scene's trees 0.900",
        "Areas, 1:1:2: tau 0.800, regret 4.0 % in the mean and 33.0 % at worst (spd:b:1).",
        "for scene spd:b:1 (15.0 %)",
        "furthest off is sah on spd:b:1, stop objects:2:16, primary: −20 % of 200 ns.",
    ] {
        assert!(text.contains(sentence), "{sentence}\n{text}");
    }
    run.constants[5].inflation = Some(2.0);
    let text = findings::findings(&run);
    let sentence = "an inner node whose branches are predicted takes 0.26 ns (0.00 to 1.46); a branch that the simulated \
                    predictor gets wrong adds 16 ns, and these branches make 57 % of the time.";
    assert!(text.contains(sentence), "{text}");
    // An interval that begins at nothing bounds the ratio on one side only.
    run.constants[1].lo = Some(0.0);
    let text = findings::findings(&run);
    assert!(
        text.contains("at least 0.93:1, without an upper bound"),
        "{text}"
    );
    // Without two trees of a scene there is no order.
    for model in &mut run.models {
        (model.tau, model.pairs_right) = (None, None);
    }
    assert!(!findings::findings(&run).contains("Kendall's tau between predicted and measured"));
    let table = times::models(&run, |_| true);
    assert_eq!(table.rows[0][7..9], [Cell::Missing, Cell::Missing]);
    run.models.clear();
    let none = findings::findings(&run);
    assert!(none.starts_with("No constants were fitted"), "{none}");
}

/// Every file of the report, by its name.
fn files(trees: CostVsWork) -> BTreeMap<String, Vec<u8>> {
    let dir = tempfile::tempdir().unwrap();
    let run = run(trees);
    let mut written = write_tables(&run, dir.path()).unwrap();
    written.extend(write_plots(&run, dir.path()).unwrap());
    let name = |path: &Path| path.file_name().unwrap().to_str().unwrap().to_owned();
    let all: BTreeMap<_, _> = written
        .iter()
        .map(|path| (name(path), fs::read(path).unwrap()))
        .collect();
    assert_eq!(all.len(), written.len(), "no file is written twice");
    all
}

#[test]
fn seconds_are_only_where_names_say_so() {
    let before = files(trees());
    let mut other = trees();
    for model in &mut other.models {
        model.error_median *= 2.0;
    }
    for constant in &mut other.constants {
        constant.ns *= 2.0;
    }
    for choice in &mut other.choices {
        choice.error_before *= 2.0;
    }
    for prediction in &mut other.predictions {
        prediction.measured_ns *= 2.0;
    }
    for order in &mut other.times_order {
        order.tau -= 0.5;
    }
    for share in &mut other.shares {
        share.share = 1.0 - share.share;
    }
    for verdict in &mut other.time_verdicts.verdicts {
        verdict.held = !verdict.held;
    }
    let after = files(other);
    assert!(before.keys().eq(after.keys()));
    for (name, bytes) in &before {
        assert_eq!(name.starts_with("times-"), *bytes != after[name], "{name}");
    }
    // Without anything fitted the others are the same, and one file says why.
    let mut without = trees();
    without.models.clear();
    without.predictions.clear();
    without.shares.clear();
    for (name, bytes) in files(without) {
        assert_eq!(
            name == "times-findings.md",
            bytes != before[&name],
            "{name}"
        );
    }
}

#[test]
fn figures_stay_on_the_page() {
    let summary = super::fixture::summary();
    let mut odd = trees();
    odd.work[0].scene = format!("{}/dragon.ply", "a-long-name".repeat(20));
    odd.work[1].c_counted = 0.0;
    odd.work[2].c_counted = f64::NAN;
    odd.work[3].c_predicted = 1e9;
    for i in 0..12 {
        odd.work.push(WorkRecord {
            rays: format!("a-set-of-rays-with-a-long-name:{i}"),
            ..odd.work[4].clone()
        });
    }
    odd.predictions[0].group = "g".repeat(200);
    odd.predictions[1].chosen_ns = 0.0;
    odd.predictions[2].two_ns = 1e7;
    for i in 0..20 {
        odd.shares.push(ShareRecord {
            term: format!("a term of many more than fit a line, number {i}"),
            ..odd.shares[0].clone()
        });
    }
    let terms = odd.shares.len() as f64;
    odd.shares
        .iter_mut()
        .for_each(|row| row.share = 1.0 / terms);
    for (run, pages) in [(trees(), 1), (odd, 2)] {
        let counted = figures::counted(&run, &summary);
        assert_eq!(counted.len(), pages);
        counted
            .iter()
            .for_each(|(_, figure)| assert_on_page(figure));
        let all = [figures::predicted, figures::residuals, figures::shares];
        for draw in all {
            assert_on_page(&draw(&run, &summary).unwrap());
        }
    }
}

#[test]
fn a_run_fits_one_screen() {
    let text = screen::study(&run(trees()));
    assert!(
        text.lines().all(|line| line.chars().count() <= 100),
        "{text}"
    );
    for part in [
        "primary",
        "chosen terms",
        "mispredicted branch",
        "counts-cover",
        "time-error",
    ] {
        assert!(text.contains(part), "{part}\n{text}");
    }
    let mut without = trees();
    without.models.clear();
    assert!(screen::study(&run(without)).contains("No constants were fitted"));
}
