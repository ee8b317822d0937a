//! The experiment `traversal`: a stack, restarts from the root, and links between neighbouring leaves (MacDonald & Booth 1990).
//! Equal hits and equal leaves, in how many steps, in which time, for how much memory?

pub mod asked;
mod scene;
mod seconds;
mod side;
mod trail;
pub mod verdicts;
mod way;

use serde::{Deserialize, Serialize};

use crate::kd::Rules;
use crate::scene::Scene;

use super::identity::{digest, whole};
use super::records::{LinkRecord, PassTiming, Summary, TraversalRecord};
use super::resume::{Extent, piece_by_piece};
use super::store::{Store, StoreError, TIMINGS};
use super::timing::keep_rows;
use super::{Plan, RunError, SCHEMA, Watcher};

pub use asked::Traversal;
use way::Way;

/// What was found in one scene.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
struct Found {
    /// Rows of `traversal.csv`.
    walks: Vec<TraversalRecord>,
    /// Rows of `link-memory.csv`.
    links: Vec<LinkRecord>,
    /// Rows of `timings.csv`, kept there alone.
    #[serde(skip)]
    timings: Vec<PassTiming>,
}

/// The tree of one scene.
struct Cell<'a> {
    id: String,
    scene: &'a Scene,
    rules: Rules,
}

/// The trees of a plan.
fn cells<'a>(plan: &Plan, asked: &Traversal, scenes: &'a [Scene]) -> Vec<Cell<'a>> {
    let rules = Rules {
        strategy: asked.strategy,
        stop: asked.stop,
        cost: plan.cost,
        clipped: false,
    };
    let cell = |scene: &'a Scene| {
        let text = format!(
            "{SCHEMA} traversal of {} {} {rules:?} seed {} {:?} {} {} {:?}",
            scene.name,
            whole(scene),
            plan.seed,
            asked.rays,
            asked.number,
            asked.pixels,
            asked.timing
        );
        let id = digest(text.as_bytes());
        Cell { id, scene, rules }
    };
    scenes.iter().map(cell).collect()
}

/// Measure what is not finished and write the files of the run.
pub(super) fn run(
    plan: &Plan,
    asked: &Traversal,
    scenes: &[Scene],
    store: &Store,
    watcher: &impl Watcher,
) -> Result<(), RunError> {
    let cells = cells(plan, asked, scenes);
    let times: Vec<PassTiming> = store.read_rows(TIMINGS, None).unwrap_or_default();
    // A scene is finished if its seconds are there too, by this very program.
    let timed = |id: &str| {
        let mut rows = times.iter();
        rows.any(|row| row.cell == id && row.revision == crate::REVISION)
    };
    let finished = |cell: &Cell| store.finished(&cell.id).filter(|_| timed(&cell.id));
    let found = cells.iter().map(finished).collect();
    let announce = |left: &[&Cell<'_>]| {
        let s = if left.len() == 1 { "" } else { "s" };
        watcher.announce(&format!("walking through {} tree{s}", left.len()));
    };
    let units = (2 * asked.rays.len() * Way::ALL.len()) as u64 + u64::from(asked.timing.rounds);
    let extent = |_: &Cell<'_>| Extent { things: 1, units };
    let one = |cell: &Cell<'_>| {
        watcher.begin(&cell.scene.name);
        let found = scene::measure(plan, asked, cell, watcher);
        let mut found = found.map_err(|fault| RunError::Bug {
            place: cell.scene.name.clone(),
            fault,
        })?;
        // Sets of rays that the scene has not, and tests that it has not in f32, are not done.
        let done = found.walks.len() as u64 + u64::from(asked.timing.rounds);
        watcher.revise(units, done);
        keep_rows(store, std::mem::take(&mut found.timings))?;
        store.save(&cell.id, &found)?;
        Ok(found)
    };
    let results = piece_by_piece(&cells, found, extent, "scenes", watcher, announce, one)?;
    write(plan, asked, &results, store)?;
    Ok(())
}

/// Put the run's files together. The seconds are there already.
fn write(plan: &Plan, asked: &Traversal, found: &[Found], store: &Store) -> Result<(), StoreError> {
    let walks: Vec<&TraversalRecord> = found.iter().flat_map(|f| &f.walks).collect();
    let links: Vec<&LinkRecord> = found.iter().flat_map(|f| &f.links).collect();
    store.write_rows("traversal.csv", &walks)?;
    store.write_rows("link-memory.csv", &links)?;
    store.write_summary(&Summary {
        stop: Some(asked.stop.to_string()),
        verdicts: verdicts::all(&asked.expect, &walks, &links),
        ..plan.summary()
    })
}

/// The trees of a dry run, a line each.
pub(super) fn describe(plan: &Plan, asked: &Traversal, scenes: &[Scene]) -> String {
    let line = |cell: Cell<'_>| {
        let scene = cell.scene;
        let objects = scene.bounds.len();
        format!("{}  {:24} {objects:>9} objects\n", cell.id, scene.name)
    };
    let cells = cells(plan, asked, scenes).into_iter();
    let sets: Vec<String> = asked.rays.iter().map(ToString::to_string).collect();
    let asked::Timing {
        rays,
        work,
        rounds,
        builds,
    } = asked.timing;
    let pixels = asked.pixels + 1;
    format!(
        "strategy {}, stop {}, seed {}\n{}rays {}: {} of each source, {pixels} x {pixels} of a picture\nways {}, in f64 and f32\n\
         timed: {rays} rays of each set, fewer above {work} visits and tests, {rounds} times; builds {builds} times\n",
        asked.strategy,
        asked.stop,
        plan.seed,
        cells.map(line).collect::<String>(),
        sets.join(", "),
        asked.number,
        Way::ALL.map(Way::name).join(", ")
    )
}
