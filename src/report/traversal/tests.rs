//! The report of this kind as a whole: hand-checked ratios, no seconds where none may be, nothing off the page.

use super::against::{Speed, outcomes};
use super::fixture::{LINKS, run, summary, traversal};
use super::{Traversal, findings, tables};
use crate::report::table::{Cell, Table};
use crate::report::tests::assert_on_page;
use crate::report::{screen, write_plots, write_tables};

fn row<'t>(table: &'t Table, names: &[&str]) -> &'t [Cell] {
    let named = |row: &&Vec<Cell>| {
        let mut pairs = row.iter().zip(names);
        pairs.all(|(cell, name)| *cell == Cell::Text((*name).to_owned()))
    };
    &table.rows.iter().find(named).unwrap()[names.len()..]
}

fn numbers(cells: &[Cell]) -> Vec<f64> {
    let number = |cell: &Cell| match cell {
        Cell::Value(value, _) | Cell::Change(value, _) => Some(*value),
        Cell::Count(count) => Some(*count as f64),
        _ => None,
    };
    cells.iter().filter_map(number).collect()
}

#[test]
fn a_way_is_faster_where_the_seconds_can_tell() {
    let run = traversal();
    let rows = run.of("lines", "f64", "links");
    let speeds: Vec<_> = rows.iter().map(|row| row.speed().unwrap()).collect();
    // Four times as long, but its odd rounds took nine times as long as the even ones.
    let wanted = [
        Speed::Faster,
        Speed::Undecided,
        Speed::Slower,
        Speed::Undecided,
    ];
    assert_eq!(speeds, wanted);
    assert_eq!(outcomes(&rows), [1, 1, 2]);
    assert!(rows[3].disturbed() && !rows[0].disturbed());
    // Half a per cent is less than what is told apart at all.
    let rows = run.of("lines", "f64", "face-trees");
    assert_eq!(outcomes(&rows), [0, 0, 4]);
    assert!((rows[0].error().unwrap() - 0.01).abs() < 1e-12);
    // Two runs of rays, 39 ratios: Student's t of one degree at 1 - 0.005/39, cot(pi 0.005/39), is 2483 standard errors.
    assert_eq!(run.ratios(), 39);
    let mut uncertain = traversal();
    for row in &mut uncertain.timings {
        row.sampling_se_s = 1e-3 * row.seconds;
    }
    let rows = uncertain.of("lines", "f64", "links");
    assert!((rows[0].error().unwrap() - (2.4828 + 0.01)).abs() < 1e-3);
    assert_eq!(outcomes(&rows), [0, 0, 4]);
    // One run does not tell.
    let mut few = traversal();
    few.timings.iter_mut().for_each(|row| row.timed_units = 512);
    assert_eq!(outcomes(&few.of("lines", "f64", "links")), [0, 0, 4]);
}

#[test]
fn means_are_geometric() {
    let run = traversal();
    let times = tables::times_summary(&run);
    let links = numbers(row(&times, &["lines", "f64", "links"]));
    // Scenes, inner nodes, then seconds: the fourth root of 1/2 · 1 · 2 · 4, its interval, least, most; faster, slower, undecided.
    let mean = LINKS.iter().product::<f64>().sqrt().sqrt();
    let wanted = [4.0, 0.5, mean, 0.5, 4.0, 1.0, 1.0, 2.0];
    assert_eq!(links.len(), wanted.len() + 2);
    let (lo, hi) = (links[3], links[4]);
    assert!(lo < mean && (lo * hi / (mean * mean) - 1.0).abs() < 1e-12);
    let but_interval = links[..3].iter().chain(&links[5..]);
    assert!(but_interval.zip(wanted).all(|(a, b)| (a - b).abs() < 1e-12));
    // Only the first scene is in f32: it stands in f64 alone too, and has no interval.
    for precision in ["f64 of those in f32", "f32"] {
        let one = numbers(row(&times, &["lines:nearest", precision, "links"]));
        assert_eq!(one, [1.0, 0.5, 0.5, 0.5, 0.5, 1.0, 0.0, 0.0]);
    }
    let precision = numbers(row(&tables::times_precision(&run), &["lines", "links"]));
    assert_eq!(precision[..2], [4.0, 1.0]);
    let pays = tables::times_pays(&run);
    assert!(
        pays.caption.contains(": 4 of 39 ratios"),
        "{}",
        pays.caption
    );
    assert_eq!(pays.rows.len(), 4);

    let steps = tables::steps_summary(&run);
    let restart = numbers(row(&steps, &["lines", "f32", "restart"]));
    // Scenes, leaves of a ray, inner nodes, their interval, least and most; no links; rays that fell back, in thin leaves, of how many,
    // the largest share in per cent.
    assert_eq!(restart[..7], [4.0, 5.0, 2.0, 2.0, 2.0, 2.0, 2.0]);
    assert_eq!(restart[7..], [4.0, 0.0, 4000.0, 0.1]);

    let memory = tables::memory_summary(&run);
    let faces = numbers(row(&memory, &["f64", "face-trees"]));
    assert!((faces[2] - 4.0).abs() < 1e-3, "{faces:?}");
    assert_eq!(faces.len(), 2 + 5);
    let built = numbers(row(&tables::times_links(&run), &["spd:tree:8", "f64"]));
    assert!((built[5] - 0.4).abs() < 1e-12, "{built:?}");
}

#[test]
fn what_has_no_test_is_left_empty_and_told() {
    let run = traversal();
    let steps = tables::steps(&run);
    assert_eq!(steps.rows.len(), 4 * 3 + 1);
    assert!(steps.caption.contains("Only triangles have a test in f32"));
    // Lines test nothing.
    assert_eq!(
        row(&steps, &["spd:tree:8", "lines", "f64"])[2],
        Cell::Missing
    );
    let mut whole = run.clone();
    whole.walks.retain(|row| row.rays == "lines");
    assert!(!tables::steps(&whole).caption.contains("triangles"));
}

#[test]
fn findings_are_made_from_the_numbers() {
    let text = findings::text(&traversal());
    for sentence in [
        "- Links, lines. f64: 0.500 times the stack's inner nodes, 1.41 times its seconds (",
        "; least 0.500 on spd:balls:3, most 4.00 on spd:balls:4); faster on 1 of 4 scenes, slower on 1, undecided on 2. f32: ",
        "f32: 0.500 times the stack's inner nodes, 0.500 times its seconds (least 0.500 on spd:balls:3, most 0.500 on spd:balls:3); \
         faster on 1 of 1 scene",
        "- Memory, f64. Tree and links: 3.00 times the bytes of the tree alone",
        "- Building, f64. Links: 0.100 times the seconds of the tree",
        // Of four trees two make the first part.
        "- Links, lines, f64, by bytes of the tree. 40000 to 40001: 0.707 times the stack's seconds, faster on 1 of 2; 40002 to 40003",
    ] {
        assert!(text.contains(sentence), "{sentence}\n{text}");
    }
    let mut untimed = traversal();
    untimed.timings.clear();
    let text = findings::text(&untimed);
    assert!(text.contains("f64: 0.500 times the stack's inner nodes."));
    assert!(!text.contains("its seconds ("), "{text}");
}

#[test]
fn pages_stay_within_their_edges() {
    let figures = |run: &Traversal| {
        let all = run.figures(&summary());
        all.iter().for_each(|(_, figure)| assert_on_page(figure));
        all.into_iter().map(|(name, _)| name).collect::<Vec<_>>()
    };
    let all = ["traversal", "times-traversal", "times-traversal-saved"];
    assert_eq!(figures(&traversal()), all);
    let mut untimed = traversal();
    untimed.timings.clear();
    assert_eq!(figures(&untimed), all[..1]);
    // Six sets of rays, names without end, ratios that are none.
    let mut odd = traversal();
    for number in 0..4 {
        let mut more = traversal().walks;
        more.retain(|row| row.rays == "lines");
        for row in &mut more {
            row.rays = format!("set-{number}");
            row.inner_visits *= 1 + 10_u64.pow(3 * number);
        }
        more[0].inner_visits = 0;
        odd.walks.extend(more);
    }
    for (walk, link) in odd.walks.iter_mut().zip(odd.links.iter_mut()) {
        walk.scene = "a-long-name".repeat(20);
        link.tree_bytes = 1;
    }
    let names = figures(&odd);
    assert!(names.contains(&"traversal-2".to_owned()), "{names:?}");
}

#[test]
fn a_run_fits_one_screen() {
    let text = screen::study(&run(traversal()));
    assert!(text.lines().count() <= 40, "{text}");
    for line in text.lines() {
        assert!(line.chars().count() <= 100, "{line}");
    }
    assert!(text.contains("1 / 1 / 2"), "{text}");
}

#[test]
fn seconds_are_in_files_of_their_own() {
    let folder = tempfile::tempdir().unwrap();
    let written = |run: Traversal| {
        let run = super::fixture::run(run);
        let mut files = write_tables(&run, &folder.path().join("tables")).unwrap();
        files.extend(write_plots(&run, &folder.path().join("plots")).unwrap());
        let own = files.iter().filter(|path| {
            let name = path.file_name().unwrap().to_string_lossy();
            !name.starts_with("times-")
        });
        let bytes: Vec<_> = own.map(|path| std::fs::read(path).unwrap()).collect();
        (files.len(), bytes)
    };
    let mut slow = traversal();
    slow.timings.iter_mut().for_each(|row| row.seconds *= 3.0);
    let (files, before) = written(traversal());
    assert_eq!(files, 1 + 10 * 3 + 3 * 2);
    assert!(before == written(slow).1);
}
