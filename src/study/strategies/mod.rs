//! The experiment `strategies`: Havran's table (2000). Trees of several strategies over scenes that have a look: what they
//! hold, what areas predict of them, what isotropic lines and the rays of the picture do in them, and in which time.

pub mod asked;
pub mod cells;
pub mod pictures;
pub mod slices;
pub mod verdicts;

use crate::scene::Scene;
use crate::tracer::RayKind;

use super::hits;
use super::pieces::{Piece, piece_by_piece};
use super::records::{CellRecord, RayRecord, Summary};
use super::store::{Store, StoreError};
use super::{Plan, RunError, Watcher, needed};

pub use asked::Strategies;
use cells::{Studied, TreeCell};

/// Measure what is not finished and write the files of the run.
pub(super) fn run(
    plan: &Plan,
    asked: &Strategies,
    scenes: &[Scene],
    store: &Store,
    watcher: &impl Watcher,
) -> Result<(), RunError> {
    let announce = |left: &[&Piece<Vec<TreeCell>>]| {
        let trees: usize = left.iter().map(|piece| piece.extent.things).sum();
        watcher.announce(&format!("tracing rays through {trees} trees"));
        let seconds: f64 = left.iter().map(|piece| piece.extent.seconds).sum();
        if seconds > 60.0 {
            let minutes = (seconds / 60.0).ceil();
            watcher.note(&format!(
                "this takes about {minutes} minutes on two cores of 2024; a stopped run goes on where it was"
            ));
        }
    };
    let results = piece_by_piece(
        store,
        &pieces(plan, asked, scenes),
        "trees",
        watcher,
        |piece| cells::finished(asked, store, &piece.of),
        announce,
        |piece| cells::measure(plan, asked, &piece.of, store, watcher),
    )?;
    let Some(results) = results else {
        return Ok(());
    };
    let results: Vec<Studied> = results.into_iter().flatten().collect();
    slices::write(plan, asked, scenes, store, watcher)?;
    write(plan, asked, &results, store)?;
    Ok(())
}

/// The trees of each scene, which are measured together.
pub(super) fn pieces<'a>(
    plan: &Plan,
    asked: &Strategies,
    scenes: &'a [Scene],
) -> Vec<Piece<Vec<TreeCell<'a>>>> {
    let piece = |scene: &'a Scene| {
        let cells = cells::of_scene(plan, asked, scene);
        Piece {
            id: cells::identity(asked, &cells),
            place: scene.name.clone(),
            extent: cells::extent(asked, &cells),
            of: cells,
        }
    };
    scenes.iter().map(piece).collect()
}

/// Put the run's files together. Seconds and pictures are there already.
fn write(
    plan: &Plan,
    asked: &Strategies,
    results: &[Studied],
    store: &Store,
) -> Result<(), StoreError> {
    let records: Vec<CellRecord> = results.iter().map(|r| r.record.clone()).collect();
    let rays: Vec<&RayRecord> = results.iter().flat_map(|r| &r.rays).collect();
    store.write_rows("cells.csv", &records)?;
    store.write_rows("rays.csv", &rays)?;
    let estimates = hits::estimates(&records, asked.expect.family);
    let mut verdicts = verdicts::all(asked, &records, &rays, &estimates);
    verdicts.extend(needed::verdict(&needed::of_cells(&asked.lines, &records)));
    store.write_summary(&Summary {
        stop: match asked.stops[..] {
            [stop] => Some(stop.to_string()),
            _ => None,
        },
        family_level: Some(1.0 - asked.expect.family),
        verdicts,
        estimates,
        ..plan.summary()
    })
}

/// The cells of a dry run, a line each.
pub(super) fn describe(plan: &Plan, asked: &Strategies, scenes: &[Scene]) -> String {
    let mut text = format!("seed {}\n", plan.seed);
    for scene in scenes {
        for TreeCell { plan: cell, .. } in cells::of_scene(plan, asked, scene) {
            text += &format!(
                "{}  {:20} {:24} {:14} {:>9} objects\n",
                cell.id,
                cell.scene.name,
                cell.rules.strategy,
                cell.rules.stop.to_string(),
                cell.scene.bounds.len(),
            );
        }
    }
    text + &format!(
        "{} corners of pixels a scene, rays by kind ({}), {} rounds of times\n",
        u64::from(asked.pixels + 1).pow(2),
        RayKind::ALL.map(RayKind::name).join(", "),
        asked.timing.rounds
    )
}
