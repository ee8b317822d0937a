//! Experiments: from a file to cells, from cells to records, from records to verdicts. One folder a kind.

pub mod assumptions;
pub mod choices;
mod chunks;
pub mod cost_vs_work;
mod guess;
pub mod hits;
pub mod identity;
pub mod incidence;
pub mod kernel;
pub mod lines;
pub mod machine;
pub mod needed;
pub mod pieces;
pub mod plan;
pub mod ray_sets;
pub mod record;
pub mod records;
pub mod shards;
pub mod share;
pub mod speed_vs_error;
pub mod split_cost;
pub mod stability;
pub mod store;
pub mod strategies;
pub mod timing;
pub mod trace;
pub mod traversal;
pub mod watcher;
pub mod work;

use thiserror::Error;

use crate::REVISION;
use crate::scene::Scene;

pub use lines::LineRule;
use pieces::Piece;
pub use plan::{Kind, Plan, PlanError};
use ray_sets::RaysOf;
use store::{EXPERIMENT, Store, StoreError};
pub use watcher::Watcher;

pub use records::SCHEMA;

/// Level of an estimate's own interval.
pub const LEVEL: f64 = 0.99;

/// Names of the axes.
pub const AXES: [&str; 3] = ["x", "y", "z"];

/// Why a run ended early.
#[derive(Debug, Error)]
pub enum RunError {
    /// An integer identity failed, or two ways to count disagree: a bug in the program, never a property of the scene.
    #[error("{place}: {fault}")]
    Bug {
        /// Scene and strategy.
        place: String,
        /// What disagrees.
        fault: String,
    },
    /// The folder cannot be written.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// Pieces that were to be there are not: identity and place of each.
    #[error("{} pieces of the run are missing: {}", .0.len(), list(.0))]
    Missing(Vec<(String, String)>),
}

/// The first few of what is missing, and how many more there are.
fn list(missing: &[(String, String)]) -> String {
    const SHOWN: usize = 5;
    let shown = missing.iter().take(SHOWN);
    let shown: Vec<String> = shown.map(|(id, place)| format!("{place} ({id})")).collect();
    let more = match missing.len().saturating_sub(SHOWN) {
        0 => String::new(),
        n => format!(" and {n} more"),
    };
    shown.join(", ") + &more
}

/// Run a plan over its scenes, in its order, and write its files but for tables; where the store takes a share of the pieces, only
/// these. A whole run is not finished before [`Store::finish`], which goes after its tables and figures.
///
/// # Errors
/// If a file cannot be written, or if the program contradicts itself; and, where the store takes only what is there, if a piece
/// is missing.
pub fn run(
    plan: &Plan,
    scenes: &[Scene],
    store: &Store,
    watcher: &impl Watcher,
) -> Result<(), RunError> {
    store.begin()?;
    if let Some(record) = &plan.record {
        store.write(EXPERIMENT, record.recorded(scenes).as_bytes())?;
    }
    measure(plan, scenes, store, watcher)?;
    if let Some(share) = store.share() {
        shards::write_contents(store, share, &pieces(plan, scenes))?;
        store.finish()?;
    }
    Ok(())
}

/// Measure the pieces that the store has not, and write the files that are put together from all of them.
fn measure(
    plan: &Plan,
    scenes: &[Scene],
    store: &Store,
    watcher: &impl Watcher,
) -> Result<(), RunError> {
    match &plan.kind {
        Kind::HitsVsArea(asked) => hits::run(plan, asked, scenes, store, watcher),
        Kind::Strategies(asked) | Kind::Termination(asked) => {
            strategies::run(plan, asked, scenes, store, watcher)
        }
        Kind::SplitCost(asked) => split_cost::run(plan, asked, scenes, store, watcher),
        Kind::CostVsWork(asked) => cost_vs_work::run(plan, asked, scenes, store, watcher),
        Kind::Assumptions(asked) => assumptions::run(plan, asked, scenes, store, watcher),
        Kind::SpeedVsError(asked) => speed_vs_error::run(plan, asked, scenes, store, watcher),
        Kind::Stability(asked) => stability::run(plan, asked, scenes, store, watcher),
        Kind::Traversal(asked) => traversal::run(plan, asked, scenes, store, watcher),
    }
}

/// The pieces of a run, in their canonical order.
pub fn pieces(plan: &Plan, scenes: &[Scene]) -> Vec<Piece<()>> {
    fn bare<P>(pieces: Vec<Piece<P>>) -> Vec<Piece<()>> {
        pieces.into_iter().map(Piece::bare).collect()
    }
    match &plan.kind {
        Kind::HitsVsArea(asked) => bare(hits::pieces(plan, asked, scenes)),
        Kind::Strategies(asked) | Kind::Termination(asked) => {
            bare(strategies::pieces(plan, asked, scenes))
        }
        Kind::SplitCost(asked) => bare(split_cost::pieces(plan, asked, scenes)),
        Kind::CostVsWork(asked) => bare(cost_vs_work::pieces(plan, asked, scenes)),
        Kind::Assumptions(asked) => bare(assumptions::pieces(plan, asked, scenes)),
        Kind::SpeedVsError(asked) => bare(speed_vs_error::pieces(plan, asked, scenes)),
        Kind::Stability(asked) => bare(stability::pieces(plan, asked, scenes)),
        Kind::Traversal(asked) => bare(traversal::pieces(plan, asked, scenes)),
    }
}

/// Whether the scenes have what the kind of experiment needs; the error names the first that has not.
pub fn check_scenes(plan: &Plan, scenes: &[Scene]) -> Result<(), String> {
    let sets = |rays: &[RaysOf]| {
        ray_sets::check_some(scenes, rays)?;
        let check = |scene| ray_sets::check_scene(scene, rays);
        scenes.iter().try_for_each(check)
    };
    match &plan.kind {
        Kind::HitsVsArea(asked) => asked.work.as_ref().map_or(Ok(()), |work| {
            let check = |scene| ray_sets::check_scene(scene, &work.rays);
            scenes.iter().try_for_each(check)
        }),
        Kind::CostVsWork(asked) => sets(&asked.rays),
        Kind::Assumptions(asked) => sets(&asked.rays),
        Kind::Traversal(asked) => sets(&asked.rays),
        Kind::SpeedVsError(asked) => asked.check_scenes(scenes),
        Kind::SplitCost(_) | Kind::Stability(_) => Ok(()),
        Kind::Strategies(_) | Kind::Termination(_) => {
            match scenes.iter().find(|scene| scene.look.is_none()) {
                Some(scene) => Err(format!(
                    "{}: has no camera and lights, but kind '{}' traces pictures; take a scene named spd: or an .nff file \
                     with a view",
                    scene.name,
                    plan.kind.name()
                )),
                None => Ok(()),
            }
        }
    }
}

/// What a run would do, a line a cell.
pub fn describe(plan: &Plan, scenes: &[Scene]) -> String {
    match &plan.kind {
        Kind::HitsVsArea(asked) => hits::describe(plan, asked, scenes),
        Kind::Strategies(asked) | Kind::Termination(asked) => {
            strategies::describe(plan, asked, scenes)
        }
        Kind::SplitCost(asked) => split_cost::describe(plan, asked, scenes),
        Kind::CostVsWork(asked) => cost_vs_work::describe(plan, asked, scenes),
        Kind::Assumptions(asked) => assumptions::describe(plan, asked, scenes),
        Kind::SpeedVsError(asked) => speed_vs_error::describe(plan, asked, scenes),
        Kind::Stability(asked) => stability::describe(plan, asked, scenes),
        Kind::Traversal(asked) => traversal::describe(plan, asked, scenes),
    }
}
