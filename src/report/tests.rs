//! Figures and tables as a whole: equal bytes, extremes, nothing off the page, files where they belong.

mod tables;

use std::fs;
use std::path::Path;

use super::figure::{Figure, Form, Segment};
use super::fixture::{cell, cells, nodes, summary};
use super::text::caption_lines;
use super::{
    Content, ReportError, Run, cost, figure3, read_run, screen, slopes, write_plots, write_tables,
};
use crate::study::records::CellRecord;

fn figure3_of(count: u64, least: f64) -> Figure {
    let cell = cell("spd:balls:4", "sah", count);
    let nodes = nodes(&cell, count, least);
    figure3::figure(&cell, &nodes, false).unwrap()
}

/// Every point of every shape lies on the page.
pub(in crate::report) fn assert_on_page(figure: &Figure) {
    let (width, height) = (figure.size.0 as f32, figure.size.1 as f32);
    let check = |[x, y]: [f32; 2], reach: f32| {
        let inside = x >= reach && y >= reach && x <= width - reach && y <= height - reach;
        assert!(
            inside,
            "{x} {y} off a page of {width} {height}: {}",
            figure.title
        );
    };
    assert!(!figure.shapes.is_empty());
    for shape in &figure.shapes {
        match &shape.form {
            Form::Disc(centre, radius) => check(*centre, *radius),
            Form::Picture(corners, _) => corners.iter().for_each(|&corner| check(corner, 0.0)),
            Form::Stroke(line, width) => line.iter().for_each(|&point| check(point, width / 2.0)),
            Form::Fill(segments) => segments.iter().for_each(|segment| match *segment {
                Segment::Move(to) | Segment::Line(to) => check(to, 0.0),
                Segment::Quad(control, to) => {
                    check(control, 0.0);
                    check(to, 0.0);
                }
            }),
        }
    }
}

#[test]
fn equal_rows_give_equal_bytes() {
    for count in [601, 6001] {
        let (a, b) = (figure3_of(count, 1e-6), figure3_of(count, 1e-6));
        assert_eq!(a.svg(), b.svg());
        assert_eq!(a.png(72.0).unwrap(), b.png(72.0).unwrap());
    }
}

#[test]
fn extremes_stay_on_the_page() {
    for (count, least) in [
        (1, 1.0),
        (2, 0.5),
        (3, 0.9),
        (601, 1e-6),
        (601, 1e-12),
        (6001, 1e-7),
    ] {
        assert_on_page(&figure3_of(count, least));
    }
    for (scenes, strategies) in [(1, 1), (2, 1), (1, 3), (8, 5), (11, 11)] {
        let cells = cells(scenes, strategies);
        assert_on_page(&slopes::figure(&cells, 0.002, true).unwrap());
        assert_on_page(&cost::figure(&cells, true).unwrap());
    }
}

#[test]
fn strange_rows_stay_on_the_page() {
    let mut odd = cells(2, 2);
    odd[0].scene = format!("{}/dragon.ply", "a-long-name".repeat(20));
    odd[1].slope = Some(40.0);
    odd[2].slope_se = Some(f64::NAN);
    odd[2].c_counted = f64::INFINITY;
    odd[3].n_k_predicted = 0.0;
    odd[3].c_predicted = 0.0;
    (odd[3].n_b_se, odd[3].c_se) = (None, None);
    assert_on_page(&slopes::figure(&odd, 0.002, true).unwrap());
    assert_on_page(&cost::figure(&odd, true).unwrap());

    let mut nodes = nodes(&odd[0], 601, 1e-6);
    nodes[3].hits = 0;
    nodes[4].hits = odd[0].lines;
    nodes[4].z = Some(1e4);
    (nodes[5].area, nodes[5].p, nodes[5].hits, nodes[5].z) = (0.0, 0.0, 0, None);
    assert_on_page(&figure3::figure(&odd[0], &nodes, false).unwrap());
}

#[test]
fn nothing_to_draw_is_an_error_that_says_so() {
    let cell = cell("spd:balls:4", "sah", 3);
    let error = figure3::figure(&cell, &[], false).unwrap_err().to_string();
    assert_eq!(error, "cell spd:balls:4-sah: no nodes to draw");
    let mut flat = nodes(&cell, 2, 0.5);
    flat.iter_mut()
        .for_each(|node| (node.area, node.p) = (0.0, 0.0));
    let error = figure3::figure(&cell, &flat, false)
        .unwrap_err()
        .to_string();
    assert_eq!(error, "cell spd:balls:4-sah: no node has an area");
    assert_eq!(
        cost::figure(&[], false).unwrap_err().to_string(),
        "no cells to draw"
    );
}

#[test]
fn many_nodes_are_drawn_as_a_density() {
    let discs = |figure: &Figure| {
        let forms = figure.shapes.iter().map(|shape| &shape.form);
        forms.filter(|form| matches!(form, Form::Disc(..))).count()
    };
    assert!(discs(&figure3_of(4999, 1e-6)) > 4999);
    assert_eq!(discs(&figure3_of(5001, 1e-6)), 0);
}

#[test]
fn a_png_has_size_and_resolution() {
    let figure = Figure::draw("", (&[], 0.0), 72.0, 36.0, |_| {});
    let bytes = figure.png(216.0).unwrap();
    let reader = png::Decoder::new(std::io::Cursor::new(bytes))
        .read_info()
        .unwrap();
    let info = reader.info();
    assert_eq!((info.width, info.height), (216, 108));
    assert_eq!(
        info.pixel_dims.map(|dims| (dims.xppu, dims.unit)),
        Some((8504, png::Unit::Meter))
    );
}

#[test]
fn svg_text_is_escaped() {
    let figure = Figure::draw("a < b & c", (&[], 0.0), 10.0, 10.0, |_| {});
    assert!(figure.svg().contains("<title>a &lt; b &amp; c</title>"));
}

fn save(dir: &Path, cells: &[CellRecord], nodes_of: Option<&CellRecord>) {
    let mut writer = csv::Writer::from_path(dir.join("cells.csv")).unwrap();
    cells
        .iter()
        .for_each(|cell| writer.serialize(cell).unwrap());
    writer.flush().unwrap();
    if let Some(cell) = nodes_of {
        let mut writer = csv::Writer::from_path(dir.join("nodes.csv")).unwrap();
        nodes(cell, 31, 1e-3)
            .iter()
            .for_each(|node| writer.serialize(node).unwrap());
        writer.flush().unwrap();
    }
    let summary = serde_json::to_string(&summary("spd:scene:1")).unwrap();
    fs::write(dir.join("summary.json"), summary).unwrap();
}

fn names(dir: &Path) -> Vec<String> {
    let entries = fs::read_dir(dir).unwrap();
    let mut names: Vec<_> = entries
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

#[test]
fn a_run_becomes_figures_and_tables() {
    let dir = tempfile::tempdir().unwrap();
    let cells = cells(2, 3);
    save(dir.path(), &cells, Some(&cells[3]));
    let run = read_run(dir.path()).unwrap();
    assert_eq!(run.hits().unwrap().cells, cells);
    let out = dir.path().join("plots/test");
    let mut written = write_plots(&run, &out).unwrap();
    written.extend(write_tables(&run, &out).unwrap());
    let mut written: Vec<_> = written
        .iter()
        .map(|path| path.file_name().unwrap().to_str().unwrap().to_owned())
        .collect();
    written.sort();
    assert_eq!(
        names(&out),
        written,
        "all files told, and no temporary one left"
    );
    assert_eq!(written.len(), 24);
    assert!(
        screen::study(&run)
            .lines()
            .all(|line| line.chars().count() <= 100)
    );
}

#[test]
fn the_figure_needs_its_nodes_only_where_nodes_were_kept() {
    let dir = tempfile::tempdir().unwrap();
    let cells = cells(2, 2);
    save(dir.path(), &cells, None);
    let run = read_run(dir.path()).unwrap();
    let out = dir.path().join("out");
    assert_eq!(write_plots(&run, &out).unwrap().len(), 4);
    let mut leaves = run.clone();
    let Content::Hits(hits) = &mut leaves.content else {
        unreachable!("it is a run of kind hits-vs-area")
    };
    hits.cells.iter_mut().for_each(|cell| cell.slope = None);
    let written = write_plots(&leaves, &dir.path().join("leaves")).unwrap();
    assert_eq!(written.len(), 2, "no slopes, no figure of slopes");
    // The nodes of another cell do not make the figure.
    save(dir.path(), &cells, Some(&cells[0]));
    let error = write_plots(&read_run(dir.path()).unwrap(), &out)
        .unwrap_err()
        .to_string();
    assert_eq!(error, "cell spd:scene:1-sah: no nodes to draw");
    let lost = Run {
        summary: summary("spd:lost"),
        ..read_run(dir.path()).unwrap()
    };
    let error = write_plots(&lost, &out).unwrap_err().to_string();
    assert!(
        error.ends_with("cells.csv: no cell of scene spd:lost with strategy sah"),
        "{error}"
    );
}

#[test]
fn tables_written_again_are_the_same() {
    let dir = tempfile::tempdir().unwrap();
    save(dir.path(), &cells(1, 2), None);
    let read = || read_run(dir.path()).unwrap();
    let bytes = |out: &Path| -> Vec<_> {
        let files = write_tables(&read(), out).unwrap();
        files.iter().map(|path| fs::read(path).unwrap()).collect()
    };
    assert_eq!(bytes(&dir.path().join("a")), bytes(&dir.path().join("b")));
    let text = fs::read_to_string(dir.path().join("a/trees.md")).unwrap();
    assert!(text.starts_with("<!-- generated by `validate run test.toml`, do not edit -->"));
}

#[test]
fn what_an_earlier_plan_left_is_removed() {
    let dir = tempfile::tempdir().unwrap();
    save(dir.path(), &cells(2, 2), None);
    let run = read_run(dir.path()).unwrap();
    let [tables, plots] = ["tables", "plots"].map(|part| dir.path().join(part));
    write_tables(&run, &tables).unwrap();
    write_plots(&run, &plots).unwrap();
    let before = [names(&tables), names(&plots)];
    for stale in ["costs-automatic.md", "costs-automatic.tex", "old.csv"] {
        fs::write(tables.join(stale), "old").unwrap();
    }
    for stale in ["old.svg", "old.png", "render-old.png"] {
        fs::write(plots.join(stale), "old").unwrap();
    }
    write_tables(&run, &tables).unwrap();
    write_plots(&run, &plots).unwrap();
    assert_eq!([names(&tables), names(&plots)], before);
    // Not of this module: the traced picture, other kinds of files, folders.
    fs::write(tables.join("notes.txt"), "mine").unwrap();
    for kept in ["render.svg", "render.png", "notes.md"] {
        fs::write(plots.join(kept), "mine").unwrap();
    }
    fs::create_dir(plots.join("folder.png")).unwrap();
    write_tables(&run, &tables).unwrap();
    write_plots(&run, &plots).unwrap();
    assert_eq!(names(&tables).len(), before[0].len() + 1);
    assert_eq!(names(&plots).len(), before[1].len() + 4);
    // Figures may be drawn beside the data, of which nothing is removed.
    fs::write(dir.path().join("photo.png"), "mine").unwrap();
    let data = names(dir.path());
    let drawn = write_plots(&run, dir.path()).unwrap().len();
    assert_eq!(names(dir.path()).len(), data.len() + drawn);
}

#[test]
fn a_quick_run_marks_its_figures() {
    let lines = caption_lines("A caption.".to_owned(), 500.0, true);
    assert_eq!(lines, ["A caption. Quick form: not for publication."]);
    let figure = |quick| cost::figure(&cells(2, 2), quick).unwrap().svg();
    assert_ne!(figure(true), figure(false));
}

#[test]
fn tables_never_overwrite_the_data() {
    let dir = tempfile::tempdir().unwrap();
    save(dir.path(), &cells(1, 1), None);
    let run = read_run(dir.path()).unwrap();
    let error = write_tables(&run, &dir.path().join(".")).unwrap_err();
    assert!(matches!(error, ReportError::Overwrite { .. }));
    let again = read_run(dir.path()).unwrap();
    assert_eq!(again.hits().unwrap().cells, run.hits().unwrap().cells);
}
