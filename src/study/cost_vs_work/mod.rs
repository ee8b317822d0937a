//! The experiment `cost-vs-work`: what surface areas predict of every tree, what rays of many kinds do in it, and how long they
//! take. Constants c_K, c_B and c_t are fitted to the seconds and judged on scenes left out.

pub mod asked;
mod calibration;
mod cells;
mod choice;
mod fit;
mod order;
mod processor;
mod shares;
mod steps;
mod terms;

use crate::scene::Scene;

use super::hits;
use super::hits::cell::CellPlan;
use super::pieces::{Piece, piece_by_piece};
use super::records::{CellRecord, Estimate, PassTiming, Summary, WorkRecord};
use super::store::{Store, TIMINGS};
use super::{Plan, RunError, Watcher, needed};

pub use asked::CostVsWork;
use cells::Measured;

/// Measure what is not finished and write the files of the run.
pub(super) fn run(
    plan: &Plan,
    asked: &CostVsWork,
    scenes: &[Scene],
    store: &Store,
    watcher: &impl Watcher,
) -> Result<(), RunError> {
    let announce = |left: &[&Piece<Vec<CellPlan>>]| {
        let trees: usize = left.iter().map(|piece| piece.extent.things).sum();
        watcher.announce(&format!("tracing rays through {trees} trees"));
    };
    let measured = piece_by_piece(
        store,
        &pieces(plan, asked, scenes),
        "trees",
        watcher,
        |piece| cells::finished(store, &piece.of),
        announce,
        |piece| cells::measure(plan, asked, &piece.of, store, watcher),
    )?;
    let Some(measured) = measured else {
        return Ok(());
    };
    let measured: Vec<Measured> = measured.into_iter().flatten().collect();
    let times: Vec<PassTiming> = store.read_rows(TIMINGS, None).unwrap_or_default();
    calibration::write(plan, asked, &measured, &times, store, watcher)?;
    let records: Vec<CellRecord> = measured.iter().map(|tree| tree.record.clone()).collect();
    store.write_rows("cells.csv", &records)?;
    let work: Vec<&WorkRecord> = measured.iter().flat_map(|tree| &tree.work).collect();
    store.write_rows("work.csv", &work)?;
    store.write_rows("tree-order.csv", order::orders(&work))?;
    store.write_rows("steps.csv", measured.iter().flat_map(|tree| &tree.steps))?;
    let estimates = hits::estimates(&records, asked.expect.family);
    let counts: Vec<&Estimate> = estimates.iter().filter(|e| e.name != "slope").collect();
    let mut verdicts = vec![hits::verdicts::identities(&records)];
    verdicts.extend(hits::verdicts::simultaneous(
        asked.expect.family,
        "counts-cover",
        "the predicted count",
        &counts,
    ));
    let mut known = needed::of_cells(&asked.lines, &records);
    known.extend(needed::of_rays(asked.error, &work));
    verdicts.extend(needed::verdict(&known));
    store.write_summary(&Summary {
        stop: match asked.stops[..] {
            [stop] => Some(stop.to_string()),
            _ => None,
        },
        family_level: Some(1.0 - asked.expect.family),
        verdicts,
        estimates,
        ..plan.summary()
    })?;
    Ok(())
}

/// The trees of each scene, which are measured together.
pub(super) fn pieces<'a>(
    plan: &Plan,
    asked: &CostVsWork,
    scenes: &'a [Scene],
) -> Vec<Piece<Vec<CellPlan<'a>>>> {
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

/// The cells of a dry run, a line each.
pub(super) fn describe(plan: &Plan, asked: &CostVsWork, scenes: &[Scene]) -> String {
    let mut text = format!("seed {}\n", plan.seed);
    for scene in scenes {
        for cell in cells::of_scene(plan, asked, scene) {
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
    let sets: Vec<String> = asked.rays.iter().map(ToString::to_string).collect();
    text + &format!(
        "rays: {} of each source, {} corners of pixels; {}; {} rounds of times\n",
        asked.number,
        u64::from(asked.pixels + 1).pow(2),
        sets.join(", "),
        asked.timing.rounds
    )
}
