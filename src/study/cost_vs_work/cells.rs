//! The trees of one scene: counted and timed together, as they share the rays.

use std::ops::Range;

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::kd::{Rules, Tree, predict};
use crate::scene::Scene;
use crate::study::chunks::spread;
use crate::study::hits::cell::{CellPlan, CellResult, compare, plant};
use crate::study::identity::{digest, whole};
use crate::study::pieces::{Extent, Made};
use crate::study::ray_sets::{Number, Rays, gather};
use crate::study::records::{CellRecord, PassTiming, RUN, StepRecord, WorkRecord};
use crate::study::store::Store;
use crate::study::timing::{CHUNK, Pass, Timed, trace_times};
use crate::study::{Plan, RunError, Watcher, guess, timing, work};

use super::asked::CostVsWork;
use super::steps;

/// What was found of a tree, its seconds aside.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Measured {
    /// The row of `cells.csv`.
    pub record: CellRecord,
    /// The rows of `work.csv`, a set of rays each.
    pub work: Vec<WorkRecord>,
    /// The rows of `steps.csv`, likewise.
    pub steps: Vec<StepRecord>,
}

/// The trees of a scene in canonical order: stop rules, then strategies.
pub fn of_scene<'a>(plan: &Plan, asked: &CostVsWork, scene: &'a Scene) -> Vec<CellPlan<'a>> {
    let all = Rules::crossed(&asked.stops, &asked.strategies, plan.cost, asked.clipped);
    let mut plans = CellPlan::of_scene(scene, &all, plan.seed, asked.lines);
    // What the rays depend on besides the boxes, and what is timed of them on the other trees.
    let seen = whole(scene);
    for plan in &mut plans {
        let identity = format!(
            "{} {seen} {:?} {} {:?} {} {} {} {:?} {:?}",
            plan.id,
            asked.rays,
            asked.number,
            asked.error,
            asked.pixels,
            asked.timing.rays,
            asked.timing.work,
            asked.strategies,
            asked.stops
        );
        plan.id = digest(identity.as_bytes());
    }
    plans
}

/// How the passes are timed: on what [`chunks`] gives; no builds.
pub fn rule(asked: &CostVsWork) -> timing::Timing {
    timing::Timing {
        rounds: asked.timing.rounds,
        builds: asked.timing.rounds,
        pass_s: f64::INFINITY,
    }
}

/// Identity of the trees of a scene together: trees are timed together or not at all, and in the same way.
pub fn identity(asked: &CostVsWork, cells: &[CellPlan]) -> String {
    let ids: Vec<&str> = cells.iter().map(|cell| &*cell.id).collect();
    digest(format!("{ids:?} {}", asked.timing.rounds).as_bytes())
}

/// The finished trees of a scene, if all of them are there.
pub fn finished(store: &Store, cells: &[CellPlan]) -> Option<Vec<Measured>> {
    cells.iter().map(|cell| store.finished(&cell.id)).collect()
}

/// How many rays of each set.
fn number(asked: &CostVsWork) -> Number {
    Number {
        rays: asked.number,
        pixels: asked.pixels,
        error: asked.error,
    }
}

/// What the trees of a scene amount to.
pub fn extent(asked: &CostVsWork, cells: &[CellPlan]) -> Extent {
    let Some(CellPlan { scene, .. }) = cells.first() else {
        return Extent::default();
    };
    let lines = asked.lines.at_least();
    let rays = guess::rays_of(scene, &asked.rays, number(asked));
    let sets = asked.rays.len();
    let timed = rays.min(sets as u64 * asked.timing.rays);
    let seconds = guess::tree(scene.bounds.len())
        + guess::streamed(lines)
        + guess::traced(rays)
        + f64::from(asked.timing.rounds) * guess::timed(timed);
    let trees = cells.len();
    Extent {
        things: trees,
        units: trees as u64 * u64::from(1 + asked.timing.rounds),
        lines: trees as u64 * (lines + rays),
        seconds: trees as f64 * seconds,
        bytes: guess::rows((8 + 8 * sets) * trees),
    }
}

/// The chunks of a set that are timed: as many as the tree affords in which a ray takes the most work. The same in every tree of
/// a scene.
fn chunks(asked: &CostVsWork, rays: usize, most_work: f64) -> Vec<Range<usize>> {
    let affordable = (asked.timing.work as f64 / most_work.max(1.0)) as usize;
    spread(rays, (asked.timing.rays as usize).min(affordable))
}

/// Count and time the trees of a scene.
pub fn measure(
    plan: &Plan,
    asked: &CostVsWork,
    cells: &[CellPlan],
    store: &Store,
    watcher: &impl Watcher,
) -> Result<Made<Vec<Measured>, PassTiming>, RunError> {
    let Some(CellPlan {
        scene, line_seed, ..
    }) = cells.first()
    else {
        return Ok(Made::nothing());
    };
    watcher.begin(&format!("{} rays", scene.name));
    let bug = |place: String| move |fault: String| RunError::Bug { place, fault };
    let rules: Vec<Rules> = cells.iter().map(|cell| cell.rules).collect();
    let sets = gather(scene, &asked.rays, number(asked), &rules, *line_seed);
    let sets = sets.map_err(bug(scene.name.clone()))?;
    let mut trees: Vec<Tree> = Vec::new();
    let mut counted = Vec::new();
    for cell in cells {
        let rules = &cell.rules;
        let place = format!("{} {} {}", scene.name, rules.strategy, rules.stop);
        watcher.begin(&place);
        let (tree, _) = plant(scene, rules).map_err(bug(place.clone()))?;
        counted.push(count(cell, &tree, &sets).map_err(bug(place))?);
        trees.push(tree);
        watcher.done(1);
    }

    watcher.begin(&format!("{} steps", scene.name));
    let most = |set: usize| {
        let rows = counted.iter().map(|(_, work)| per_ray(&work[set]));
        rows.fold(0.0, f64::max)
    };
    let timed = sets.iter().enumerate().map(|(number, rays)| {
        let chunks = chunks(asked, rays.casts.len(), most(number));
        (rays, chunks)
    });
    let timed: Vec<(&Rays, Vec<Range<usize>>)> = timed.collect();
    let with_steps = |(tree, (record, work)): (&Tree, (CellRecord, Vec<WorkRecord>))| {
        let sets = timed.par_iter().zip(&work);
        let steps =
            sets.map(|((rays, chunks), row)| steps::count(scene, tree, rays, chunks, named(row)));
        Measured {
            steps: steps.collect(),
            record,
            work,
        }
    };
    let measured: Vec<Measured> = trees.iter().zip(counted).map(with_steps).collect();
    for (cell, found) in cells.iter().zip(&measured) {
        store.save(&cell.id, found)?;
    }

    watcher.begin(&format!("{} times", scene.name));
    let all: Vec<Timed> = sets
        .iter()
        .map(|rays| Timed {
            together: RUN / CHUNK,
            ..Timed::all(rays.of.to_string(), rays.of.ask(), &rays.casts)
        })
        .collect();
    let of_tree = |tree: usize| {
        let chunks = timed.iter().map(|(_, chunks)| chunks.clone());
        all.iter()
            .zip(chunks)
            .map(move |(set, chunks)| Pass::new(set, tree, chunks))
    };
    let passes = (0..trees.len()).flat_map(of_tree).collect();
    let rows = trace_times(scene, &trees, passes, rule(asked), plan.seed, || {
        watcher.done(cells.len() as u64);
    });
    Ok(Made {
        result: measured,
        times: timing::named(cells.iter(), rows),
    })
}

/// Visits and tests of a ray.
fn per_ray(row: &WorkRecord) -> f64 {
    row.n_k_counted + row.n_b_counted + row.n_t_counted
}

/// Count lines and all sets of rays through a tree.
fn count(
    cell: &CellPlan,
    tree: &Tree,
    sets: &[Rays],
) -> Result<(CellRecord, Vec<WorkRecord>), String> {
    let prediction = predict(tree);
    let (CellResult { record, .. }, _) = compare(cell, tree, &prediction, &())?;
    let objects = &cell.scene.objects;
    let row = |rays: &Rays| {
        work::count(tree, objects, rays).record(cell, rays, cell.rules.cost, &prediction)
    };
    Ok((record, sets.iter().map(row).collect()))
}

/// The names of a row of steps.
fn named(row: &WorkRecord) -> StepRecord {
    StepRecord {
        cell: row.cell.clone(),
        scene: row.scene.clone(),
        strategy: row.strategy.clone(),
        stop: row.stop.clone(),
        rays: row.rays.clone(),
        ..StepRecord::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::cost_vs_work::asked::{Calibration, Expect, Timing};

    #[test]
    fn runs_are_spread_and_heavy_trees_have_fewer() {
        let asked = CostVsWork {
            strategies: vec![],
            stops: vec![],
            clipped: false,
            lines: crate::study::LineRule::exactly(2048).expect("a rule"),
            rays: vec![],
            number: 1,
            error: None,
            pixels: 1,
            timing: Timing {
                rays: 1024,
                work: 100_000,
                rounds: 2,
            },
            calibration: Calibration { draws: 1 },
            expect: Expect {
                family: 0.01,
                error_median: None,
                tau: None,
                regret: None,
            },
        };
        let runs = |rays, work| {
            let chunks = chunks(&asked, rays, work);
            let all: usize = chunks.iter().map(ExactSizeIterator::len).sum();
            (chunks[0].start, chunks[chunks.len() - 1].end, all)
        };
        // Of eight runs the third and the seventh; of eight the fifth.
        assert_eq!(runs(4096, 10.0), (1024, 3072 + 512, 1024));
        assert_eq!(runs(4096, 1000.0), (2048, 2048 + 512, 512));
        assert_eq!(runs(100, 10.0), (0, 100, 100));
        assert_eq!(runs(700, 1.0), (0, 700, 700));
        assert_eq!(runs(1100, 1000.0), (512, 1024, 512));
    }
}
