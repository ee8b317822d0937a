//! The experiment `speed-vs-error`: what a sampler, a kernel, a plane search costs in time, and what it costs in error.

pub mod asked;
pub mod check;
pub mod coverage;
mod errors;
mod exponents;
mod method;
pub mod planes;
pub mod precision;
mod replicates;
mod sampler_times;
mod sampler_verdicts;
pub mod samplers;

use serde::{Deserialize, Serialize};

use crate::kd::Rules;
use crate::scene::Scene;

use super::identity::{digest, whole};
use super::records::{
    CoverageRecord, EnoughRecord, ErrorRecord, ExponentRecord, PassTiming, PlaneRecord,
    PrecisionRecord, Summary, Verdict,
};
use super::resume::{Extent, piece_by_piece};
use super::store::{Store, StoreError, TIMINGS};
use super::timing::keep_rows;
use super::{Plan, RunError, SCHEMA, Watcher};

pub use asked::SpeedVsError;

/// What was found in one scene by one part.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Found {
    /// Rows of `errors.csv`.
    pub errors: Vec<ErrorRecord>,
    /// Rows of `exponents.csv`.
    pub exponents: Vec<ExponentRecord>,
    /// Rows of `enough.csv`.
    pub enough: Vec<EnoughRecord>,
    /// Rows of `precision.csv`.
    pub precision: Vec<PrecisionRecord>,
    /// Rows of `planes.csv`.
    pub planes: Vec<PlaneRecord>,
    /// Rows of `coverage.csv`.
    pub coverage: Vec<CoverageRecord>,
    /// Cells of its rows of `timings.csv`.
    timed: Vec<String>,
    /// Rows of `timings.csv`, kept there alone.
    #[serde(skip)]
    pub timings: Vec<PassTiming>,
}

/// The parts of the experiment, in their order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Part {
    Samplers,
    Precision,
    Planes,
    Coverage,
}

/// One part of one scene.
pub struct Piece<'a> {
    part: Part,
    /// The scene.
    pub scene: &'a Scene,
    /// The tree, but for plane searches.
    pub rules: Rules,
    /// Seed of the run.
    pub seed: u64,
    /// Identity; the cell of its rows where they have no tree of their own.
    pub id: String,
}

/// The pieces of a plan: part by part, scene by scene.
fn pieces<'a>(plan: &Plan, asked: &SpeedVsError, scenes: &'a [Scene]) -> Vec<Piece<'a>> {
    let rules = Rules {
        strategy: asked.strategy,
        stop: asked.stop,
        cost: plan.cost,
        clipped: false,
    };
    let mut pieces = Vec::new();
    let mut add = |part: Part, own: &[String], section: String| {
        for scene in scenes.iter().filter(|scene| own.contains(&scene.name)) {
            let text = format!(
                "{SCHEMA} {part:?} of {} {} {rules:?} {section} seed {}",
                scene.name,
                whole(scene),
                plan.seed
            );
            pieces.push(Piece {
                part,
                scene,
                rules,
                seed: plan.seed,
                id: digest(text.as_bytes()),
            });
        }
    };
    if let Some(part) = &asked.samplers {
        add(Part::Samplers, &part.scenes, format!("{part:?}"));
    }
    if let Some(part) = &asked.precision {
        add(Part::Precision, &part.scenes, format!("{part:?}"));
    }
    if let Some(part) = &asked.planes {
        add(Part::Planes, &part.scenes, format!("{part:?}"));
    }
    if let Some(part) = &asked.coverage {
        let own = std::slice::from_ref(&part.scene);
        add(Part::Coverage, own, format!("{part:?}"));
    }
    pieces
}

fn measure(
    asked: &SpeedVsError,
    piece: &Piece<'_>,
    watcher: &impl Watcher,
) -> Result<Found, String> {
    let section = "a piece is of a part that is asked for";
    match piece.part {
        Part::Samplers => {
            samplers::measure(asked.samplers.as_ref().expect(section), piece, watcher)
        }
        Part::Precision => {
            precision::measure(asked.precision.as_ref().expect(section), piece, watcher)
        }
        Part::Planes => planes::measure(asked.planes.as_ref().expect(section), piece, watcher),
        Part::Coverage => {
            coverage::measure(asked.coverage.as_ref().expect(section), piece, watcher)
        }
    }
}

/// Units of progress of a piece; its `measure` tells the watcher as many done.
fn units(asked: &SpeedVsError, piece: &Piece<'_>) -> u64 {
    let section = "a piece is of a part that is asked for";
    match piece.part {
        Part::Samplers => samplers::units(asked.samplers.as_ref().expect(section)),
        Part::Precision => precision::units(asked.precision.as_ref().expect(section)),
        Part::Planes => planes::units(asked.planes.as_ref().expect(section)),
        Part::Coverage => coverage::units(asked.coverage.as_ref().expect(section)),
    }
}

/// Measure what is not finished and write the files of the run.
pub(super) fn run(
    plan: &Plan,
    asked: &SpeedVsError,
    scenes: &[Scene],
    store: &Store,
    watcher: &impl Watcher,
) -> Result<(), RunError> {
    let pieces = pieces(plan, asked, scenes);
    let times: Vec<PassTiming> = store.read_rows(TIMINGS, None).unwrap_or_default();
    let found = pieces
        .iter()
        .map(|piece| finished(store, piece, &times))
        .collect();
    let announce = |left: &[&Piece<'_>]| {
        watcher.announce(&format!("measuring {} parts of scenes", left.len()));
    };
    let one = |piece: &Piece<'_>| {
        let place = format!("{:?} of {}", piece.part, piece.scene.name).to_lowercase();
        watcher.begin(&place);
        let mut found =
            measure(asked, piece, watcher).map_err(|fault| RunError::Bug { place, fault })?;
        found.timed = found.timings.iter().map(|row| row.cell.clone()).collect();
        found.timed.dedup();
        keep_rows(store, std::mem::take(&mut found.timings))?;
        store.save(&piece.id, &found)?;
        Ok(found)
    };
    let extent = |piece: &Piece<'_>| Extent {
        things: 1,
        units: units(asked, piece),
    };
    let results = piece_by_piece(&pieces, found, extent, "parts", watcher, announce, one)?;
    write(plan, asked, &results, store)?;
    Ok(())
}

/// A finished piece, if its seconds are there too and by this very program.
fn finished(store: &Store, piece: &Piece<'_>, times: &[PassTiming]) -> Option<Found> {
    let found: Found = store.finished(&piece.id)?;
    let is_there = |cell: &String| {
        let row = |row: &PassTiming| row.cell == *cell && row.revision == crate::REVISION;
        times.iter().any(row)
    };
    found.timed.iter().all(is_there).then_some(found)
}

/// Put the run's files together. The seconds are there already.
fn write(
    plan: &Plan,
    asked: &SpeedVsError,
    found: &[Found],
    store: &Store,
) -> Result<(), StoreError> {
    store.write_rows("errors.csv", found.iter().flat_map(|f| &f.errors))?;
    store.write_rows("exponents.csv", found.iter().flat_map(|f| &f.exponents))?;
    store.write_rows("enough.csv", found.iter().flat_map(|f| &f.enough))?;
    store.write_rows("precision.csv", found.iter().flat_map(|f| &f.precision))?;
    store.write_rows("planes.csv", found.iter().flat_map(|f| &f.planes))?;
    store.write_rows("coverage.csv", found.iter().flat_map(|f| &f.coverage))?;
    store.write_summary(&Summary {
        stop: Some(asked.stop.to_string()),
        verdicts: verdicts(asked, found),
        ..plan.summary()
    })
}

/// Each expectation and what came of it.
fn verdicts(asked: &SpeedVsError, found: &[Found]) -> Vec<Verdict> {
    let mut all = Vec::new();
    all.extend(samplers::verdicts(asked, found));
    all.extend(precision::verdicts(asked, found));
    all.extend(planes::verdicts(asked, found));
    all.extend(coverage::verdicts(asked, found));
    all
}

/// The pieces of a dry run, a line each.
pub(super) fn describe(plan: &Plan, asked: &SpeedVsError, scenes: &[Scene]) -> String {
    let mut text = format!(
        "strategy {}, stop {}, seed {}\n",
        asked.strategy, asked.stop, plan.seed
    );
    for piece in pieces(plan, asked, scenes) {
        let part = format!("{:?}", piece.part).to_lowercase();
        text += &format!(
            "{}  {part:10} {:24} {:>9} objects\n",
            piece.id,
            piece.scene.name,
            piece.scene.bounds.len()
        );
    }
    text
}
