//! The experiment `speed-vs-error`: what a sampler, a kernel, a plane search costs in time, and what it costs in error.

pub mod asked;
pub mod check;
pub mod coverage;
mod errors;
mod exponents;
mod method;
mod part;
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
use super::pieces::{self, Made, piece_by_piece};
use super::records::{
    CoverageRecord, EnoughRecord, ErrorRecord, ExponentRecord, PassTiming, PlaneRecord,
    PrecisionRecord, Summary, Verdict,
};
use super::store::{Store, StoreError};
use super::{Plan, RunError, SCHEMA, Watcher};

pub use asked::SpeedVsError;
use part::Part;

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
    /// Rows of `timings.csv`, kept apart.
    #[serde(skip)]
    pub timings: Vec<PassTiming>,
}

/// One part of one scene.
pub struct Piece<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// The tree, but for plane searches.
    pub rules: Rules,
    /// Seed of the run.
    pub seed: u64,
    /// Identity; the cell of its rows where they have no tree of their own.
    pub id: String,
}

impl Piece<'_> {
    /// A row of seconds with the names of its tree.
    pub fn named(&self, row: PassTiming) -> PassTiming {
        PassTiming {
            cell: self.id.clone(),
            scene: self.scene.name.clone(),
            strategy: self.rules.strategy.name(),
            stop: self.rules.stop.to_string(),
            ..row
        }
    }
}

/// A piece of the run: the part, and the scene.
type Whole<'a> = pieces::Piece<(Part<'a>, Piece<'a>)>;

/// The pieces of a plan: part by part, scene by scene.
pub(super) fn pieces<'a>(
    plan: &Plan,
    asked: &'a SpeedVsError,
    scenes: &'a [Scene],
) -> Vec<Whole<'a>> {
    let rules = Rules {
        strategy: asked.strategy,
        stop: asked.stop,
        cost: plan.cost,
        clipped: false,
    };
    let piece = |part: Part<'a>, scene: &'a Scene| {
        let text = format!(
            "{SCHEMA} {} of {} {} {rules:?} {} seed {}",
            part.name(),
            scene.name,
            whole(scene),
            part.section(),
            plan.seed
        );
        let piece = Piece {
            scene,
            rules,
            seed: plan.seed,
            id: digest(text.as_bytes()),
        };
        Whole {
            id: piece.id.clone(),
            place: format!("{} of {}", part.name(), scene.name).to_lowercase(),
            extent: part.extent(scene),
            of: (part, piece),
        }
    };
    let of_part = |part: Part<'a>| {
        let own = scenes.iter();
        let own = own.filter(move |scene| part.scenes().contains(&scene.name));
        own.map(move |scene| piece(part, scene))
    };
    Part::all(asked).flat_map(of_part).collect()
}

/// Measure what is not finished and write the files of the run.
pub(super) fn run(
    plan: &Plan,
    asked: &SpeedVsError,
    scenes: &[Scene],
    store: &Store,
    watcher: &impl Watcher,
) -> Result<(), RunError> {
    let announce = |left: &[&Whole<'_>]| {
        watcher.announce(&format!("measuring {} parts of scenes", left.len()));
    };
    let measure = |whole: &Whole<'_>| {
        let (part, piece) = &whole.of;
        watcher.begin(&whole.place);
        let found = part.measure(piece, watcher);
        let mut found = found.map_err(|fault| RunError::Bug {
            place: whole.place.clone(),
            fault,
        })?;
        store.save(&whole.id, &found)?;
        let times = std::mem::take(&mut found.timings);
        Ok(Made {
            result: found,
            times,
        })
    };
    let pieces = pieces(plan, asked, scenes);
    let found = |whole: &Whole<'_>| store.finished(&whole.id);
    let results = piece_by_piece(store, &pieces, "parts", watcher, found, announce, measure)?;
    if let Some(results) = results {
        write(plan, asked, &results, store)?;
    }
    Ok(())
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
    for whole in pieces(plan, asked, scenes) {
        let (part, piece) = whole.of;
        let part = part.name().to_lowercase();
        text += &format!(
            "{}  {part:10} {:24} {:>9} objects\n",
            piece.id,
            piece.scene.name,
            piece.scene.bounds.len()
        );
    }
    text
}
