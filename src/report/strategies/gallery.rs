//! The pictures of a run: all scenes at a glance, and each beside what it cost.

use std::path::PathBuf;

use plotters::style::text_anchor::{HPos, VPos};

use super::netpbm::{read_pfm, read_ppm};
use super::part::{KINDS, REFERENCE};
use super::{Named, Strategies};
use crate::report::figure::{Figure, LEFT, WIDTH};
use crate::report::number::counted;
use crate::report::palette::INK;
use crate::report::render::{self, Render};
use crate::report::series::distinct;
use crate::report::text::{LEADING, SMALL, caption_lines, fit};
use crate::report::{Bitmap, DOTS_PER_INCH, ReportError};
use crate::study::records::{CellRecord, RayRecord, Summary, file_stem};

const TITLE: &str = "The scenes, as their rays see them";
const TOP: f64 = 24.0;
/// Between two pictures, and for the name below one.
const GAP: f64 = 4.0;
const NAME: f64 = 12.0;
/// Pictures beside each other: of a few scenes, and of many.
const COLUMNS: [usize; 2] = [5, 10];
/// Pixels of a picture in the gallery for each point: as many as the figure's PNG has.
const PIXELS: f64 = DOTS_PER_INCH / 72.0;

/// What the names of most scenes begin with; there is no room for it.
const DATABASES: &str = "spd:";

/// A scene with its files.
struct Shown<'r> {
    scene: &'r str,
    render: PathBuf,
    costs: PathBuf,
}

/// The gallery and a figure for each scene whose picture was kept.
pub fn figures(run: &Strategies, summary: &Summary) -> Result<Vec<Named<Figure>>, ReportError> {
    // The costs kept are those of the first stop rule's tree.
    let stop = run.cells.first().map_or("", |cell| &cell.stop);
    let file = |name: &str| run.pictures.join(name);
    let scenes = distinct(run.cells.iter().map(|cell| cell.scene.as_str())).into_iter();
    let shown = scenes.map(|scene| Shown {
        scene,
        render: file(&format!("{}.ppm", file_stem(scene))),
        costs: file(&format!("{}-{}.pfm", file_stem(scene), file_stem(stop))),
    });
    let mut pictures = Vec::new();
    let mut figures = Vec::new();
    for shown in shown.filter(|shown| shown.render.exists()) {
        let picture = read_ppm(&shown.render)?;
        pictures.push((shown.scene, picture.clone()));
        if shown.costs.exists() {
            let figure = of_scene(run, summary.quick, &shown, picture)?;
            figures.extend(
                figure.map(|figure| (format!("render-{}", file_stem(shown.scene)), figure)),
            );
        }
    }
    if !pictures.is_empty() {
        figures.insert(0, ("gallery".to_owned(), gallery(&pictures, summary)));
    }
    Ok(figures)
}

/// All pictures, in rows.
fn gallery(pictures: &[(&str, Bitmap)], summary: &Summary) -> Figure {
    let columns = COLUMNS
        .into_iter()
        .find(|&few| pictures.len() <= 2 * few)
        .unwrap_or(COLUMNS[1]);
    let side = (WIDTH - 2.0 * LEFT + GAP) / columns as f64 - GAP;
    let rows = pictures.len().div_ceil(columns);
    let baseline = TOP + (side + NAME) * rows as f64 + 10.0;
    let caption = format!(
        "{}, traced from the cameras and under the lights of their databases. Run {}, seed {}.",
        counted(pictures.len() as u64, "scene"),
        summary.experiment,
        summary.seed
    );
    let caption = caption_lines(caption, WIDTH - 2.0 * LEFT, summary.quick);
    let height = baseline + LEADING * (caption.len() - 1) as f64 + 6.0;
    Figure::draw(TITLE, (&caption, baseline), WIDTH, height, |pen| {
        for (i, (scene, picture)) in pictures.iter().enumerate() {
            let left = LEFT + (side + GAP) * (i % columns) as f64;
            let top = TOP + (side + NAME) * (i / columns) as f64;
            let small = picture.shrunk_to((PIXELS * side) as usize);
            pen.picture((left, top), (left + side, top + side), small);
            let name = fit(
                scene.strip_prefix(DATABASES).unwrap_or(scene),
                SMALL,
                side + GAP,
            );
            let at = (left + 0.5 * side, top + side + 7.5);
            pen.text(&name, at, SMALL, INK, (HPos::Center, VPos::Bottom));
        }
    })
}

/// One picture beside the cost of its rays in the reference's tree under the first stop rule; None without that tree.
fn of_scene(
    run: &Strategies,
    quick: bool,
    shown: &Shown,
    picture: Bitmap,
) -> Result<Option<Figure>, ReportError> {
    let costs = read_pfm(&shown.costs)?;
    if costs.width != costs.height {
        let (width, height) = (costs.width, costs.height);
        return Err(ReportError::Picture {
            path: shown.costs.clone(),
            what: format!("{width} by {height} numbers, expected as many rows as columns"),
        });
    }
    let is_shown = |cell: &&CellRecord| cell.scene == shown.scene && cell.strategy == REFERENCE;
    let Some(cell) = run.cells.iter().find(is_shown) else {
        return Ok(None);
    };
    let of_kind = |kind: &'static str| {
        let of_tree = |row: &&RayRecord| row.cell == cell.cell && row.kind == kind;
        let row = run.rays.iter().find(of_tree)?;
        Some((kind, row.rays, row.hits))
    };
    Ok(Some(render::figure(&Render {
        scene: shown.scene.to_owned(),
        picture,
        costs: costs.values,
        constants: [cell.c_k, cell.c_b, cell.c_t],
        rays: KINDS.into_iter().filter_map(of_kind).collect(),
        tree: format!("tree of strategy {REFERENCE}, stop {}", cell.stop),
        quick,
    })))
}
