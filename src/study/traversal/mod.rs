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
use super::pieces::{Extent, Made, Piece, piece_by_piece};
use super::ray_sets::Number;
use super::records::{LinkRecord, PassTiming, Summary, TraversalRecord};
use super::store::{Store, StoreError};
use super::{Plan, RunError, SCHEMA, Watcher, guess};

pub use asked::Traversal;
use way::Way;

/// What was found in one scene.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
struct Found {
    /// Rows of `traversal.csv`.
    walks: Vec<TraversalRecord>,
    /// Rows of `link-memory.csv`.
    links: Vec<LinkRecord>,
    /// Rows of `timings.csv`, kept apart.
    #[serde(skip)]
    timings: Vec<PassTiming>,
}

/// The tree of one scene.
pub(super) struct Cell<'a> {
    id: String,
    scene: &'a Scene,
    rules: Rules,
}

/// The trees of a plan.
pub(super) fn pieces<'a>(
    plan: &Plan,
    asked: &Traversal,
    scenes: &'a [Scene],
) -> Vec<Piece<Cell<'a>>> {
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
        Piece {
            id: id.clone(),
            place: scene.name.clone(),
            extent: extent(asked, scene),
            of: Cell { id, scene, rules },
        }
    };
    scenes.iter().map(cell).collect()
}

/// How many rays of each set.
fn number(asked: &Traversal) -> Number {
    Number {
        rays: asked.number,
        pixels: asked.pixels,
        error: None,
    }
}

/// What a scene amounts to: every way, in both precisions.
fn extent(asked: &Traversal, scene: &Scene) -> Extent {
    let ways = 2 * Way::ALL.len();
    let sets = asked.rays.len();
    let rays = guess::rays_of(scene, &asked.rays, number(asked));
    let timed = rays.min(sets as u64 * asked.timing.rays);
    let rounds = f64::from(asked.timing.rounds);
    let one = guess::traced(rays) + rounds * guess::timed(timed);
    // The tree, its links and its face trees, in both precisions.
    let builds = 2.0 * f64::from(asked.timing.builds) * guess::tree(scene.bounds.len());
    Extent {
        things: 1,
        units: (sets * ways) as u64 + u64::from(asked.timing.rounds),
        lines: ways as u64 * rays,
        seconds: ways as f64 * one + builds,
        bytes: guess::rows(2 * sets * ways),
    }
}

/// Measure what is not finished and write the files of the run.
pub(super) fn run(
    plan: &Plan,
    asked: &Traversal,
    scenes: &[Scene],
    store: &Store,
    watcher: &impl Watcher,
) -> Result<(), RunError> {
    let announce = |left: &[&Piece<Cell<'_>>]| {
        let s = if left.len() == 1 { "" } else { "s" };
        watcher.announce(&format!("walking through {} tree{s}", left.len()));
    };
    let measure = |piece: &Piece<Cell<'_>>| {
        watcher.begin(&piece.place);
        let found = scene::measure(plan, asked, &piece.of, watcher);
        let mut found = found.map_err(|fault| RunError::Bug {
            place: piece.place.clone(),
            fault,
        })?;
        // Sets of rays that the scene has not, and tests that it has not in f32, are not done.
        let done = found.walks.len() as u64 + u64::from(asked.timing.rounds);
        watcher.revise(piece.extent.units, done);
        store.save(&piece.id, &found)?;
        let times = std::mem::take(&mut found.timings);
        Ok(Made {
            result: found,
            times,
        })
    };
    let pieces = pieces(plan, asked, scenes);
    let found = |piece: &Piece<Cell<'_>>| store.finished(&piece.id);
    let results = piece_by_piece(store, &pieces, "scenes", watcher, found, announce, measure)?;
    if let Some(results) = results {
        write(plan, asked, &results, store)?;
    }
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
    let line = |piece: Piece<Cell<'_>>| {
        let scene = piece.of.scene;
        let objects = scene.bounds.len();
        format!("{}  {:24} {objects:>9} objects\n", piece.id, scene.name)
    };
    let pieces = pieces(plan, asked, scenes).into_iter();
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
        pieces.map(line).collect::<String>(),
        sets.join(", "),
        asked.number,
        Way::ALL.map(Way::name).join(", ")
    )
}
