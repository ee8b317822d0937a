//! The experiment `stability`: named hard cases with their exact outcome, by every strategy and kernel; random cases held against
//! exact integers; trees and lines transformed together.

pub mod asked;
mod boxes;
pub mod case;
mod catalogue;
mod cones;
pub mod files;
mod first_hit;
mod guard;
mod judge;
mod leaks;
mod lines;
mod metamorphic;
mod pieces;
mod polygons;
mod random;
mod spheres;
pub mod statistics;
mod table;
mod trees;
mod triangles;
mod verdicts;

use serde::{Deserialize, Serialize};

use super::pieces::{Made, piece_by_piece};
use super::records::{CaseRecord, MetamorphicRecord, RandomRecord, Summary, TieRecord};
use super::store::Store;
use super::{Plan, RunError, Watcher};
use crate::scene::Scene;

pub use asked::Stability;
pub use catalogue::catalogue;
use pieces::Piece;
pub(super) use pieces::pieces;
use verdicts::verdicts;

/// What a piece of the run found.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(super) struct Found {
    cases: Vec<CaseRecord>,
    random: Vec<RandomRecord>,
    ties: Vec<TieRecord>,
    metamorphic: Vec<MetamorphicRecord>,
    /// What the user should know.
    notes: Vec<String>,
}

/// Measure what is not finished and write the files of the run.
pub(super) fn run(
    plan: &Plan,
    asked: &Stability,
    scenes: &[Scene],
    store: &Store,
    watcher: &impl Watcher,
) -> Result<(), RunError> {
    let announce = |left: &[&Piece<'_>]| {
        watcher.announce(&format!(
            "judging {} groups of hard cases and trees of random lines",
            left.len()
        ));
    };
    let measure = |piece: &Piece<'_>| {
        watcher.begin(&piece.place);
        let found = piece.of.measure(plan, asked);
        let found: Found = found.map_err(|fault| RunError::Bug {
            place: piece.place.clone(),
            fault,
        })?;
        store.save(&piece.id, &found)?;
        watcher.done(piece.extent.units);
        Ok(Made::untimed(found))
    };
    let pieces = pieces(plan, asked, scenes);
    let found = |piece: &Piece<'_>| store.finished(&piece.id);
    let found = piece_by_piece(store, &pieces, "parts", watcher, found, announce, measure)?;
    let Some(found) = found else {
        return Ok(());
    };
    for note in found.iter().flat_map(|f| &f.notes) {
        watcher.note(note);
    }
    store.write_rows("cases.csv", found.iter().flat_map(|f| &f.cases))?;
    store.write_rows("random.csv", found.iter().flat_map(|f| &f.random))?;
    store.write_rows("ties.csv", found.iter().flat_map(|f| &f.ties))?;
    store.write_rows("metamorphic.csv", found.iter().flat_map(|f| &f.metamorphic))?;
    store.write_summary(&Summary {
        stop: Some(asked.stop.to_string()),
        verdicts: verdicts(&found),
        ..plan.summary()
    })?;
    Ok(())
}

/// The cases and the pieces of a dry run, a line each.
pub(super) fn describe(plan: &Plan, asked: &Stability, scenes: &[Scene]) -> String {
    let mut text = format!("stop {}, seed {}\n", asked.stop, plan.seed);
    for piece in pieces(plan, asked, scenes) {
        text += &format!("{}  {}\n", piece.id, piece.place);
        for case in piece.of.cases() {
            text += &format!("    {:32}  {}\n", case.name, case.stresses);
        }
    }
    text
}
