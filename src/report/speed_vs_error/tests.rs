//! The report of this kind as a whole: hand-checked numbers, no seconds where none may be, nothing off the page.

use std::collections::BTreeMap;
use std::fs;

use super::fixture::{SCENES, parts, run, summary};
use super::planes::Timed;
use super::{SpeedVsError, tables};
use crate::report::table::Cell;
use crate::report::tests::assert_on_page;
use crate::report::{screen, write_plots, write_tables};

fn files(parts: SpeedVsError) -> BTreeMap<String, Vec<u8>> {
    let dir = tempfile::tempdir().unwrap();
    let written = write_tables(&run(parts), dir.path()).unwrap();
    let name = |path: &std::path::Path| path.file_name().unwrap().to_str().unwrap().to_owned();
    let read = |path: std::path::PathBuf| (name(&path), fs::read(&path).unwrap());
    written.into_iter().map(read).collect()
}

#[test]
fn efficiency_by_hand() {
    let run = parts();
    let most = tables::at_most(&run);
    assert_eq!(most.len(), 2 * (2 * 4 + 2 * 3));
    assert!(most.iter().all(|row| row.lines == 65_536));
    let of = |sampler: &str| {
        let row = most.iter().find(|r| {
            (&*r.scene, &*r.sampler, &*r.rays, &*r.quantity) == (SCENES[0], sampler, "lines", "C")
        });
        tables::efficiency(&run, row.unwrap()).unwrap()
    };
    assert_eq!(of("random"), 1.0);
    // RMSE 0.7 N^-0.65 in 530 ns a line, against 0.5 N^-0.5 in 500 ns: N^0.3 (0.5/0.7)^2 500/530.
    let wanted = 65_536f64.powf(0.3) * (0.5f64 / 0.7).powi(2) * 500.0 / 530.0;
    assert!((of("sobol") / wanted - 1.0).abs() < 1e-9);
}

#[test]
fn seconds_are_those_of_the_latest_run() {
    let mut run = parts();
    let row = run.enough[0].clone();
    let before = run.enough_seconds(&row).unwrap();
    assert!((before / (500e-9 * (1u64 << 18) as f64) - 1.0).abs() < 1e-9);
    let slower: Vec<_> = run.timings.clone();
    run.timings.extend(slower.into_iter().map(|mut t| {
        t.seconds *= 2.0;
        t
    }));
    assert!((run.enough_seconds(&row).unwrap() / before - 2.0).abs() < 1e-9);
}

#[test]
fn kernels_are_timed_by_visit_and_by_ray() {
    let run = parts();
    let table = tables::times_precision(&run).unwrap();
    assert_eq!(table.rows.len(), 2 * 5 * 3);
    let f32s = &table.rows[1];
    let number = |cell: &Cell| match cell {
        Cell::Value(value, _) => *value,
        other => panic!("{other:?}"),
    };
    let own: Vec<f64> = f32s[3..].iter().map(number).collect();
    for (found, wanted) in own.iter().zip([38.0, 38.0 / 40.0, 38.0, 38.0 / 40.0]) {
        assert!((found - wanted).abs() < 1e-9, "{own:?}");
    }
}

#[test]
fn dominated_searches_are_found() {
    let run = parts();
    let all = Timed::all(&run, SCENES[0]);
    let by = |strategy: &str, clipped| {
        let own = |one: &&Timed| one.row.strategy == strategy && one.row.clipped == clipped;
        let found = all.iter().find(own).unwrap().dominated_by(&all);
        found.map(|row| (row.strategy.as_str(), row.clipped))
    };
    assert_eq!(by("sah-bins:8", false), None);
    assert_eq!(by("sah-samples:1", false), Some(("sah-bins:8", false)));
    // Of those built no slower, the one with the cheapest tree.
    assert_eq!(by("sah-samples:8", false), Some(("sah-bins:8", true)));
    assert_eq!(by("sah", true), None);
}

#[test]
fn no_table_depends_on_seconds_but_those_named_so() {
    let before = files(parts());
    let mut other = parts();
    for (i, timing) in other.timings.iter_mut().enumerate() {
        timing.seconds *= 2.0 + i as f64;
    }
    let after = files(other);
    assert!(before.keys().eq(after.keys()));
    for (name, bytes) in &before {
        assert_eq!(name.starts_with("times-"), *bytes != after[name], "{name}");
    }
    let mut untimed = parts();
    untimed.timings.clear();
    let untimed = files(untimed);
    let kept = before
        .iter()
        .filter(|(name, _)| !name.starts_with("times-"));
    assert!(untimed.iter().eq(kept));
}

#[test]
fn each_part_may_be_absent() {
    let names = |parts: &SpeedVsError| -> Vec<String> {
        let all = parts.figures(&summary());
        all.iter().for_each(|(_, figure)| assert_on_page(figure));
        all.into_iter().map(|(name, _)| name).collect()
    };
    let all = [
        "times-speed-vs-error",
        "times-precision",
        "precision-offset",
        "times-plane-search",
        "coverage",
    ];
    assert_eq!(names(&parts()), all);
    let without = |remove: fn(&mut SpeedVsError)| {
        let mut parts = parts();
        remove(&mut parts);
        let text = screen::study(&run(parts.clone()));
        assert!(text.contains("sobol-gain"), "{text}");
        names(&parts)
    };
    assert_eq!(without(|p| p.errors.clear()), all[1..]);
    assert_eq!(without(|p| p.coverage.clear()), all[..4]);
    assert_eq!(
        without(|p| p.planes.clear()),
        [all[0], all[1], all[2], all[4]]
    );
    assert_eq!(without(|p| p.precision.clear()), [all[0], all[3], all[4]]);
    // Without times errors stand against lines, and what is about time alone is not drawn.
    assert_eq!(without(|p| p.timings.clear()), [all[0], all[2], all[4]]);
    // Scenes that were not moved have no figure of offsets.
    assert_eq!(
        without(|p| p.precision.retain(|r| r.offset == 0.0)),
        [all[0], all[1], all[3], all[4]]
    );
}

#[test]
fn strange_rows_stay_on_the_page() {
    let mut odd = parts();
    let long = format!("{}/dragon.ply", "a-long-name".repeat(20));
    odd.errors[0].rmse = 0.0;
    odd.errors[1].rmse_hi = f64::INFINITY;
    odd.errors
        .iter_mut()
        .filter(|r| r.sampler == "conditional")
        .for_each(|r| r.rmse *= 1e-9);
    for row in odd.errors.iter_mut().filter(|row| row.scene == SCENES[1]) {
        row.scene = long.clone();
    }
    odd.precision.retain(|row| row.kernel == "f64");
    odd.precision.iter_mut().for_each(|row| row.visits = 0);
    odd.precision[0].scene = long.clone();
    odd.precision[1].slope_error = Some(f64::NAN);
    odd.planes
        .iter_mut()
        .for_each(|row| row.scene = long.clone());
    odd.planes[0].above_unclipped = f64::NAN;
    odd.coverage[0].check = "a check of a long name ".repeat(9);
    odd.coverage[1].runs = 0;
    let figures = odd.figures(&summary());
    assert_eq!(figures.len(), 5);
    figures
        .iter()
        .for_each(|(_, figure)| assert_on_page(figure));
    let mut many = parts();
    for i in 0..4 {
        let more: Vec<_> = many
            .errors
            .iter()
            .filter(|r| r.scene == SCENES[0])
            .cloned()
            .collect();
        many.errors.extend(more.into_iter().map(|mut row| {
            row.scene = format!("another:{i}");
            row
        }));
    }
    let names: Vec<_> = many
        .figures(&summary())
        .into_iter()
        .map(|(name, _)| name)
        .collect();
    assert_eq!(
        names[..3],
        [
            "times-speed-vs-error",
            "times-speed-vs-error-2",
            "times-speed-vs-error-3"
        ]
    );
}

#[test]
fn a_run_fits_one_screen() {
    let text = screen::study(&run(parts()));
    assert!(
        text.lines().all(|line| line.chars().count() <= 100),
        "{text}"
    );
    assert!(text.lines().count() <= 40, "{text}");
    // No table goes on below.
    for first in ["sampler  ", "kernel  ", "search  "] {
        let blocks = text.lines().filter(|line| line.starts_with(first)).count();
        assert_eq!(blocks, 1, "{first}\n{text}");
    }
    // Sentences are folded.
    let flat = text.replace('\n', " ");
    for part in [
        "sobol",
        "nearest:",
        "f32-padded",
        "sah-bins:8",
        "slope, random: 940 of 1,000",
    ] {
        assert!(flat.contains(part), "{part}\n{text}");
    }
}

#[test]
fn a_share_of_no_runs_is_unknown() {
    let mut odd = parts();
    odd.coverage[0].runs = 0;
    assert_eq!(tables::coverage(&odd).rows[0][8], Cell::Missing);
}

#[test]
fn pictures_of_the_fixture_are_written() {
    let dir = tempfile::tempdir().unwrap();
    let files = write_plots(&run(parts()), dir.path()).unwrap();
    assert_eq!(files.len(), 2 * 5);
}

#[test]
fn captions_tell_disturbed_times_and_exact_estimates_are_called_so() {
    let mut odd = parts();
    odd.timings
        .iter_mut()
        .filter(|timing| timing.what.starts_with("f32 ray"))
        .for_each(|timing| timing.disturbed = true);
    let caption = |table: crate::report::table::Table| table.caption;
    let told = caption(tables::times_precision(&odd).unwrap());
    assert!(told.ends_with(" 10 of 60 times."), "{told}");
    let told = caption(tables::times_planes(&odd).unwrap());
    assert!(told.ends_with(" 0 of 28 times."), "{told}");
    let own = odd.errors.iter_mut().filter(|r| r.sampler == "conditional");
    own.for_each(|row| row.rmse *= 1e-12);
    let table = super::screen::samplers(&odd);
    let cells = |sampler: &str| {
        let name = Cell::Text(sampler.to_owned());
        let row = table.rows.iter().find(|row| row[0] == name).unwrap();
        [row[1].clone(), row[3].clone()]
    };
    assert_eq!(
        cells("conditional"),
        ["exact", "exact"].map(|t| Cell::Text(t.to_owned()))
    );
    assert!(matches!(cells("sobol"), [Cell::Value(..), Cell::Value(..)]));
}
