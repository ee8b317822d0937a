//! The experiment `assumptions`: the metric (MacDonald & Booth 1990) takes rays to be uniform in origin and direction, to come
//! from outside, and to be stopped by nothing. Each is broken alone and all together: how far does it err then, node by node
//! and in total, and does it still rank trees?

pub mod asked;
pub mod cells;
pub mod exact;
pub mod mailbox;
pub mod metrics;
pub mod nodes;
pub mod one;
pub mod order;
pub mod verdicts;
pub mod visits;

use crate::kd::expect::Metric;
use crate::scene::Scene;

use super::pieces::{Extent, Made, Piece, piece_by_piece};
use super::records::{ExactRecord, OrderRecord, Summary, WorkRecord};
use super::store::{Store, StoreError};
use super::{Plan, RunError, Watcher, guess, needed};

pub use asked::Assumptions;
use cells::{Found, SceneCell, measure};

/// Measure what is not finished and write the files of the run.
pub(super) fn run(
    plan: &Plan,
    asked: &Assumptions,
    scenes: &[Scene],
    store: &Store,
    watcher: &impl Watcher,
) -> Result<(), RunError> {
    let announce = |left: &[&Piece<SceneCell<'_>>]| {
        watcher.announce(&format!(
            "tracing {} sets of rays through the trees of {} scenes",
            asked.rays.len(),
            left.len()
        ));
    };
    let measure = |piece: &Piece<SceneCell<'_>>| {
        watcher.begin(&piece.place);
        let found = measure(asked, &piece.of, watcher).map_err(|fault| RunError::Bug {
            place: piece.place.clone(),
            fault,
        })?;
        store.save(&piece.id, &found)?;
        Ok(Made::untimed(found))
    };
    let pieces = pieces(plan, asked, scenes);
    let found = |piece: &Piece<SceneCell<'_>>| store.finished(&piece.id);
    let results = piece_by_piece(store, &pieces, "scenes", watcher, found, announce, measure)?;
    if let Some(results) = results {
        write(plan, asked, &results, store)?;
    }
    Ok(())
}

/// The scenes of a plan, each with all its trees.
pub(super) fn pieces<'a>(
    plan: &Plan,
    asked: &Assumptions,
    scenes: &'a [Scene],
) -> Vec<Piece<SceneCell<'a>>> {
    let piece = |scene: &'a Scene| {
        let cell = SceneCell::of(plan, asked, scene);
        let trees = cell.trees.len();
        let rays = guess::rays_of(scene, &asked.rays, asked.sizes());
        // Every tree is measured under each metric besides.
        let one = 10.0 * guess::tree(scene.bounds.len()) + 5.0 * guess::traced(rays);
        Piece {
            id: cell.id.clone(),
            place: scene.name.clone(),
            extent: Extent {
                things: 1,
                units: trees as u64,
                lines: trees as u64 * rays,
                seconds: trees as f64 * one,
                bytes: guess::rows(100 * trees * asked.rays.len()),
            },
            of: cell,
        }
    };
    scenes.iter().map(piece).collect()
}

/// Put the run's files together.
fn write(
    plan: &Plan,
    asked: &Assumptions,
    found: &[Found],
    store: &Store,
) -> Result<(), StoreError> {
    let work: Vec<&WorkRecord> = found.iter().flat_map(|f| &f.work).collect();
    let orders: Vec<&OrderRecord> = found.iter().flat_map(|f| &f.orders).collect();
    let of_areas = |row: &&&OrderRecord| row.metric == Metric::Area.name();
    let by_area: Vec<&OrderRecord> = orders.iter().filter(of_areas).copied().collect();
    let exact: Vec<&ExactRecord> = found.iter().flat_map(|f| &f.exact).collect();
    store.write_rows("work.csv", &work)?;
    store.write_rows("bias.csv", found.iter().flat_map(|f| &f.bias))?;
    store.write_rows("nodes-by.csv", found.iter().flat_map(|f| &f.groups))?;
    store.write_rows("visits.csv", found.iter().flat_map(|f| &f.visits))?;
    store.write_rows("order.csv", &orders)?;
    store.write_rows("metrics.csv", found.iter().flat_map(|f| &f.metrics))?;
    store.write_rows("exact.csv", &exact)?;
    let estimates = verdicts::control(asked, &work);
    let mut verdicts = verdicts::all(asked, &work, &by_area, &exact, &estimates);
    verdicts.extend(needed::verdict(&needed::of_rays(asked.error, &work)));
    store.write_summary(&Summary {
        stop: Some(asked.stop.to_string()),
        family_level: Some(1.0 - asked.expect.family),
        figure_scene: Some(asked.figure.scene.clone()),
        figure_strategy: Some(asked.figure.strategy.name()),
        verdicts,
        estimates,
        ..plan.summary()
    })
}

/// The scenes of a dry run, a line each.
pub(super) fn describe(plan: &Plan, asked: &Assumptions, scenes: &[Scene]) -> String {
    let mut text = format!("stop {}, seed {}\n", asked.stop, plan.seed);
    for scene in scenes {
        let cell = SceneCell::of(plan, asked, scene);
        text += &format!(
            "{}  {:24} {:>9} objects, {} trees\n",
            cell.id,
            scene.name,
            scene.bounds.len(),
            cell.trees.len()
        );
    }
    let sets: Vec<String> = asked.rays.iter().map(ToString::to_string).collect();
    text + &format!(
        "{} rays each of {}; rays of pictures from {} pixels across\n",
        asked.number,
        sets.join(", "),
        asked.pixels
    )
}
