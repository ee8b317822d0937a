//! The report of kind `strategies` as a whole: hand-checked numbers, no seconds where none may be, nothing off the page.

use crate::report::number::percent_above;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use super::fixture::{STOPS, run, strategies, summary};
use super::part::{Measure, Part};
use super::{Strategies, averages, dots, findings, greedy, tables};
use crate::report::table::{Cell, Table};
use crate::report::tests::assert_on_page;
use crate::report::{screen, write_plots, write_tables};

fn row<'t>(table: &'t Table, names: &[&str]) -> &'t [Cell] {
    let named = |row: &&Vec<Cell>| {
        row.iter()
            .zip(names)
            .all(|(cell, name)| *cell == Cell::Text((*name).to_owned()))
    };
    &table.rows.iter().find(named).unwrap()[names.len()..]
}

/// The numbers of differences, rounded to whole per cent.
fn numbers(cells: &[Cell]) -> Vec<Option<f64>> {
    let number = |cell: &Cell| match cell {
        Cell::Change(value, _) => Some(value.round()),
        _ => None,
    };
    cells.iter().map(number).collect()
}

#[test]
fn havrans_table_stands_beside_ours() {
    let run = strategies();
    let table = tables::havran(&Part::new(&run, STOPS[0]));
    // 2, 4, 32: mean 38/3, geometric mean the cube root of 256, median 4.
    let ours = [1167.0, 535.0, 300.0, 100.0, 3100.0, 535.0, 535.0, 535.0];
    let expected: Vec<_> = [1804.0, 25.0, 36604.0]
        .into_iter()
        .chain(ours)
        .map(Some)
        .collect();
    assert_eq!(numbers(row(&table, &["1 spatial-median"])), expected);
    assert!(table.caption.contains("3 scenes, stop objects:2:16"));
}

#[test]
fn averages_name_their_scenes() {
    let run = strategies();
    let table = tables::averages(&Part::new(&run, STOPS[1]), &Measure::COSTS);
    assert_eq!(table.rows.len(), 5 * 4, "three costs and Havran's row each");
    let between = row(&table, &["4 sah-between-medians", "C counted"]);
    assert_eq!(between[0], Cell::Count(3));
    assert_eq!(between[7], Cell::Text("spd:tree:11".to_owned()));
    assert_eq!(numbers(&between[6..7]), [Some(-10.0)]);
    let his = row(&table, &["4 sah-between-medians", "Havran's total time"]);
    assert_eq!(
        numbers(&[his[1].clone(), his[6].clone(), his[8].clone()]),
        [-3.0, -12.0, 5.0].map(Some)
    );
}

#[test]
fn rays_are_set_against_havrans() {
    let mut run = strategies();
    let table = tables::ray_counts(&run.rays);
    let gears = row(&table, &["spd:gears:4"]);
    assert_eq!(gears[0], Cell::Count(263_169));
    assert_eq!(gears[6], Cell::Change(3.0, 0));
    assert_eq!(numbers(&gears[7..]), [0.0; 4].map(Some));
    let balls = row(&table, &["spd:balls:4"]);
    assert_eq!(
        numbers(&balls[6..]),
        [Some(-17834.0), None, None, None, None]
    );
    // A smaller picture is set against nothing.
    run.rays.iter_mut().for_each(|row| row.rays /= 4);
    let table = tables::ray_counts(&run.rays);
    assert_eq!(numbers(&row(&table, &["spd:gears:4"])[6..]), [None; 5]);
}

#[test]
fn the_greedy_choice_can_lose() {
    let run = strategies();
    let part = Part::new(&run, STOPS[0]);
    let better = greedy::better(&part);
    let [one] = &better[..] else {
        panic!("{}", better.len())
    };
    assert_eq!(
        (one.scene, one.strategy),
        ("spd:tree:11", "sah-between-medians")
    );
    assert!(
        one.percent
            .iter()
            .all(|percent| (percent.unwrap() + 10.0).abs() < 1e-6)
    );
    let text = findings::by_cost(&part);
    assert!(
        text.contains("By C counted some tree is better than sah's on 1 of 3 scenes"),
        "{text}"
    );
}

#[test]
fn findings_are_made_from_the_numbers() {
    let mut run = strategies();
    let text = findings::by_time(&Part::new(&run, STOPS[0]));
    for sentence in [
        "- Cost-driven strategies (3, 4, 5) beat both medians (1, 2).\n  - By total time: **undecided**; all three beat both on \
         3 of 3 scenes; against sah, spatial-median takes +535 % (",
        "and object-median +200 % (+200 to +200).\n",
        "differ little.\n  - By total time: **undecided**; against sah, sah-between-medians takes −3.5 % (",
        "from −10 % on spd:tree:11 to 0.0 % on spd:gears:4 and sah-cyclic +1.6 % (",
        "against object-median, spatial-median takes +112 % (",
        "median +33 %, and more on 2 of 3 scenes; by the arithmetic mean against sah, as he took it, spatial-median takes +1167 % \
         and object-median +200 %.\n",
        // 31 of 35 = 31 + 3 + 1 hundred per cent.
        "- Arithmetic mean of spatial-median, +1167 % by total time: spd:tree:11 makes 89 %; without spd:tree:11 and \
         spd:gears:4 it is +100 %.\n",
        "- The tree of least C predicted is the fastest to trace, or within 1 % of it, on 3 of 3 scenes; taking it costs 0.0 % of",
        "- Of 15 trees timed, 0 had a time whose even and odd rounds are more than 3 % apart; of 0 only",
    ] {
        assert!(text.contains(sentence), "{sentence}\n{text}");
    }
    // Every scene alike: intervals of no width.
    let first = run.cells[0].scene.clone();
    run.cells.iter_mut().for_each(|cell| {
        cell.c_counted = if cell.scene == first {
            cell.c_counted
        } else {
            0.0
        }
    });
    let timings = run.timings.as_mut().unwrap();
    for timing in timings.iter_mut() {
        timing.seconds = match timing.strategy.as_str() {
            "spatial-median" => 2.0,
            "object-median" => 3.0,
            _ => 1.0,
        };
        timing.disturbed = timing.what == "build" && timing.strategy == "sah";
        timing.timed_units /= 2;
    }
    let text = findings::by_time(&Part::new(&run, STOPS[0]));
    for sentence in [
        "beat both medians (1, 2).\n  - By total time: **holds**",
        "differ little.\n  - By total time: **holds**",
        "calls its equal.\n  - By total time: **does not hold**",
        "- Of 15 trees timed, 3 had a time whose even and odd rounds are more than 3 % apart (total furthest apart: 1.0 % for sah",
        "of 15 only a random sample",
    ] {
        assert!(text.contains(sentence), "{sentence}\n{text}");
    }
    // A single scene tells nothing beyond itself.
    let part = Part::new(&run, STOPS[0]);
    let one = findings::judged(&part, Measure::Counted);
    assert!(
        one.iter()
            .all(|finding| finding.judgement == findings::Judgement::Undecided)
    );
}

/// Every file of the report, by its name.
fn files(strategies: Strategies) -> BTreeMap<String, Vec<u8>> {
    let dir = tempfile::tempdir().unwrap();
    let run = run(strategies);
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
    let before = files(strategies());
    let mut other = strategies();
    for (i, timing) in other.timings.iter_mut().flatten().enumerate() {
        timing.seconds *= 1.0 + (i % 7) as f64;
        timing.half_a_s *= 3.0;
        timing.disturbed = true;
        timing.load_average = Some(9.0);
    }
    let after = files(other);
    assert!(before.keys().eq(after.keys()));
    for (name, bytes) in &before {
        assert_eq!(name.starts_with("times-"), *bytes != after[name], "{name}");
    }
    // Without any times the others are the same.
    let without = files(Strategies {
        timings: None,
        ..strategies()
    });
    for (name, bytes) in without
        .iter()
        .filter(|(name, _)| !name.starts_with("times-"))
    {
        assert_eq!(*bytes, before[name], "{name}");
    }
    assert!(
        without
            .keys()
            .all(|name| !name.starts_with("times-strategies")),
        "nothing to draw"
    );
}

#[test]
fn figures_stay_on_the_page() {
    let mut odd = strategies();
    odd.cells[0].scene = format!("{}/dragon.ply", "a-long-name".repeat(20));
    odd.cells[1].c_counted = f64::NAN;
    odd.cells[2].c_counted = 0.0;
    odd.cells[6].c_counted = 1e9;
    for measure in [Measure::Counted, Measure::Traced, Measure::Total] {
        for run in [strategies(), odd.clone()] {
            assert_on_page(&dots::figure(&Part::new(&run, STOPS[0]), measure, true).unwrap());
        }
    }
    // One kind of strategy makes one panel; the reference alone makes none.
    let only = |names: &[&str]| {
        let mut run = strategies();
        run.cells
            .retain(|cell| names.contains(&cell.strategy.as_str()));
        dots::figure(&Part::new(&run, STOPS[0]), Measure::Counted, false)
    };
    assert_on_page(&only(&["sah", "sah-cyclic"]).unwrap());
    assert!(only(&["sah"]).is_none());
    assert!(only(&["spatial-median"]).is_none());
}

#[test]
fn a_run_fits_one_screen() {
    let mut long = run(strategies());
    long.summary.question = "Is a question longer than a line folded? ".repeat(4);
    let text = screen::study(&long);
    assert!(
        text.lines().all(|line| line.chars().count() <= 100),
        "{text}"
    );
    assert!(text.lines().count() < 40, "{text}");
    assert!(
        text.contains("30 trees over 3 scenes, stop objects:2:16 and automatic, seed 7"),
        "{text}"
    );
    assert!(
        text.contains("beat both medians (1, 2): by total time undecided, by C undecided"),
        "{text}"
    );
}

#[test]
fn pictures_become_figures() {
    let dir = tempfile::tempdir().unwrap();
    let mut run = strategies();
    run.pictures = dir.path().to_owned();
    let names = |run: &Strategies| {
        let figures = run.figures(&summary()).unwrap();
        figures
            .iter()
            .for_each(|(_, figure)| assert_on_page(figure));
        let of_pictures = figures.into_iter().map(|(name, _)| name);
        of_pictures
            .filter(|name| name == "gallery" || name.starts_with("render-"))
            .collect::<Vec<_>>()
    };
    assert!(names(&run).is_empty());
    let pixels = [b"P6\n2 2\n255\n".as_slice(), &[100; 12]].concat();
    fs::write(dir.path().join("spd-balls-4.ppm"), &pixels).unwrap();
    fs::write(dir.path().join("spd-tree-11.ppm"), &pixels).unwrap();
    let costs: Vec<u8> = (0..9u8).flat_map(|i| f32::from(i).to_le_bytes()).collect();
    fs::write(
        dir.path().join("spd-tree-11-objects-2-16.pfm"),
        [b"Pf\n3 3\n-1.0\n".as_slice(), &costs].concat(),
    )
    .unwrap();
    assert_eq!(names(&run), ["gallery", "render-spd-tree-11"]);
    let flat = dir.path().join("spd-balls-4-objects-2-16.pfm");
    fs::write(&flat, b"Pf\n1 0\n-1.0\n").unwrap();
    let error = run.figures(&summary()).unwrap_err().to_string();
    assert_eq!(
        error,
        format!(
            "{}: 1 by 0 pixels, expected 1 to 32768 each way",
            flat.display()
        )
    );
    fs::write(&flat, [b"Pf\n1 2\n-1.0\n".as_slice(), &costs[..8]].concat()).unwrap();
    let error = run.figures(&summary()).unwrap_err().to_string();
    assert!(
        error.ends_with("1 by 2 numbers, expected as many rows as columns"),
        "{error}"
    );
}

#[test]
fn half_a_run_is_reported() {
    // No reference over one scene, no rays of another, one time missing.
    let mut run = strategies();
    run.cells
        .retain(|cell| cell.scene != "spd:balls:4" || cell.strategy != "sah");
    run.rays.retain(|row| row.scene != "spd:gears:4");
    run.timings
        .as_mut()
        .unwrap()
        .retain(|row| row.what != "shadow" || row.scene != "spd:tree:11");
    let part = Part::new(&run, STOPS[0]);
    let scenes = |measure| part.ratios(measure, "spatial-median", "sah");
    assert_eq!(scenes(Measure::Counted).len(), 2);
    assert_eq!(scenes(Measure::Traced), [("spd:tree:11", 32.0)]);
    assert_eq!(scenes(Measure::Total), [("spd:gears:4", 4.0)]);
    let averages = averages::Averages::of(&scenes(Measure::Total)).unwrap();
    assert_eq!(
        (percent_above(averages.mean), averages.interval),
        (300.0, None)
    );
    files(run);
}
