//! The trees of one scene: counted, checked and timed together, as they share the rays.

use std::time::Instant;

use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::kd::{Hit, Rules, Stack, StopRule, Strategy, Tree, nearest, predict};
use crate::scene::{Look, Scene};
use crate::study::hits::cell::{CellPlan, build_tree, compare, plant};
use crate::study::identity::digest;
use crate::study::records::{CellRecord, PassTiming, RayRecord};
use crate::study::store::{Store, StoreError, TIMINGS};
use crate::study::{Plan, RunError, Watcher};
use crate::tracer::{RayCounts, RayKind, RaySet, count, trace};

use super::asked::Strategies;
use super::{pictures, timing};

/// One tree over a scene with a look.
pub struct TreeCell<'a> {
    /// The tree and the lines through it.
    pub plan: CellPlan<'a>,
    /// How the scene is looked at.
    look: &'a Look,
}

/// What was found of a tree, its seconds aside.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Studied {
    /// The row of `cells.csv`.
    pub record: CellRecord,
    /// The rows of `rays.csv`, by kind.
    pub rays: Vec<RayRecord>,
}

/// The trees of a scene in canonical order: stop rules, then strategies. Scenes without a look have been refused.
pub fn of_scene<'a>(plan: &Plan, asked: &Strategies, scene: &'a Scene) -> Vec<TreeCell<'a>> {
    let Some(look) = &scene.look else {
        return Vec::new();
    };
    // What the rays depend on besides the boxes.
    let seen = digest(format!("{look:?} {:?}", scene.objects).as_bytes());
    let rules = |stop: StopRule, strategy: Strategy| Rules {
        strategy,
        stop,
        cost: plan.cost,
        clipped: asked.clipped,
    };
    let cell = |rules| {
        let mut plan = CellPlan::new(scene, rules, plan.seed, asked.lines);
        let identity = format!("{} {seen} {} {}", plan.id, asked.pixels, asked.checked);
        plan.id = digest(identity.as_bytes());
        TreeCell { plan, look }
    };
    let stops = asked.stops.iter();
    stops
        .flat_map(|&stop| asked.strategies.iter().map(move |&s| cell(rules(stop, s))))
        .collect()
}

/// The finished trees of a scene, if all of them and their seconds are there: they are timed together or not at all.
pub fn finished(store: &Store, cells: &[TreeCell], times: &[PassTiming]) -> Option<Vec<Studied>> {
    let timed = |id: &str| times.iter().filter(|row| row.cell == id).count() == PASSES;
    let one = |cell: &TreeCell| {
        store
            .finished(&cell.plan.id)
            .filter(|_| timed(&cell.plan.id))
    };
    cells.iter().map(one).collect()
}

/// Rows of seconds of a tree: its building and each kind of ray.
const PASSES: usize = 1 + RayKind::ALL.len();

/// Seconds the trees of a scene take, roughly, on two cores of 2024: for the note before a long run.
pub fn guess(asked: &Strategies, cells: &[TreeCell]) -> f64 {
    let Some(first) = cells.first() else {
        return 0.0;
    };
    let trees = cells.len() as f64;
    let objects = first.plan.scene.bounds.len() as f64;
    let eye_rays = f64::from(asked.pixels + 1).powi(2);
    let lights = first.look.stage.lights.len() as f64;
    // An eye ray has about one shadow ray for each second light, and half a secondary ray.
    let rays = eye_rays * (1.5 + 0.5 * lights);
    let counting = 5e-7 * rays + 2e-6 * asked.lines.at_least() as f64;
    let passes = RayKind::ALL.len() as f64 * asked.timing.pass_s.min(1e-7 * rays);
    let building = 2.5e-6 * objects * f64::from(asked.timing.builds);
    trees * (counting + passes * (1.0 + f64::from(asked.timing.rounds)) + building)
}

/// Count, check and time the trees of a scene.
pub fn measure(
    plan: &Plan,
    asked: &Strategies,
    cells: &[TreeCell],
    store: &Store,
    watcher: &impl Watcher,
) -> Result<Vec<Studied>, RunError> {
    let Some(TreeCell {
        plan: CellPlan { scene, .. },
        look,
    }) = cells.first()
    else {
        return Ok(Vec::new());
    };
    // The rays are the same whatever tree they are made with.
    let reference = Rules {
        strategy: Strategy::Sah,
        stop: StopRule::CostGain { depth: None },
        cost: plan.cost,
        clipped: false,
    };
    watcher.begin(&format!("{} picture", scene.name));
    let bug = |what: String| {
        move |fault: String| RunError::Bug {
            place: what.clone(),
            fault,
        }
    };
    let (tree, _) = plant(scene, &reference).map_err(bug(scene.name.clone()))?;
    let traced = trace(scene, look, &tree, asked.pixels);
    pictures::write_render(store, scene, &traced.picture)?;
    let probes = Probes::new(scene, &traced.rays, asked.checked, plan.seed);

    let mut studied = Vec::new();
    let mut trees = Vec::new();
    let mut builds = Vec::new();
    for cell in cells {
        let CellPlan { id, rules, .. } = &cell.plan;
        let place = format!("{} {} {}", scene.name, rules.strategy, rules.stop);
        watcher.begin(&place);
        let (tree, build_s) = plant(scene, rules).map_err(bug(place.clone()))?;
        builds.push(vec![build_s]);
        let found = if let Some(found) = store.finished(id) {
            found
        } else {
            let (found, counts) =
                count_tree(cell, &tree, &traced.rays, &probes).map_err(bug(place))?;
            if pictures::is_shown(asked, rules) {
                pictures::write_cost(store, scene, plan.cost, &counts.corners)?;
            }
            store.save(id, &found)?;
            found
        };
        studied.push(found);
        trees.push(tree);
        watcher.done(1);
    }
    drop(tree);

    watcher.begin(&format!("{} times", scene.name));
    for _ in 1..asked.timing.builds {
        for (cell, seconds) in cells.iter().zip(&mut builds) {
            let started = Instant::now();
            drop(build_tree(scene, &cell.plan.rules));
            seconds.push(started.elapsed().as_secs_f64());
        }
    }
    let passes = timing::trace_times(scene, &trees, &traced.rays, asked.timing, plan.seed, || {
        watcher.done(cells.len() as u64);
    });
    keep_times(store, cells, builds, passes)?;
    Ok(studied)
}

/// Count lines and rays through a tree and hold its hits against brute force.
fn count_tree(
    cell: &TreeCell,
    tree: &Tree,
    rays: &RaySet,
    probes: &Probes,
) -> Result<(Studied, RayCounts), String> {
    let CellPlan {
        id, scene, rules, ..
    } = &cell.plan;
    probes.check(tree)?;
    let record = compare(&cell.plan, tree, &predict(tree), &())?.record;
    let counts = count(rays, tree, &scene.objects);
    let row = |kind: RayKind| {
        let tally = counts.of(kind);
        let made = rays.of(kind).hits();
        if tally.hits != made {
            return Err(format!(
                "{} {kind} rays hit something, but {made} did when they were made",
                tally.hits
            ));
        }
        Ok(RayRecord {
            cell: id.clone(),
            scene: scene.name.clone(),
            strategy: rules.strategy.name(),
            stop: rules.stop.to_string(),
            kind: kind.name().into(),
            rays: tally.rays,
            hits: tally.hits,
            inner_visits: tally.work.inner,
            leaf_visits: tally.work.leaves,
            object_tests: tally.work.tests,
        })
    };
    let rays = RayKind::ALL.into_iter().map(row);
    let rays = rays.collect::<Result<_, String>>()?;
    Ok((Studied { record, rays }, counts))
}

/// Eye rays of random pixel corners with their nearest hits by brute force: over all objects, without a tree.
struct Probes<'a> {
    scene: &'a Scene,
    rays: &'a RaySet,
    /// Corners and hits.
    hits: Vec<(usize, Option<Hit>)>,
}

impl<'a> Probes<'a> {
    fn new(scene: &'a Scene, rays: &'a RaySet, number: u32, seed: u64) -> Self {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let corners: Vec<usize> = (0..number)
            .map(|_| random.random_range(0..rays.corners() as u64) as usize)
            .collect();
        let hit = |corner: usize| {
            let ray = rays.of(RayKind::Primary).rays[corner].ray();
            (0..scene.bounds.len() as u32).fold(None, |best, object| {
                match scene.objects.intersect(object, &ray) {
                    Some(t) => Hit::nearer(best, object, t),
                    None => best,
                }
            })
        };
        let hits = corners.into_par_iter().map(|corner| (corner, hit(corner)));
        Self {
            scene,
            rays,
            hits: hits.collect(),
        }
    }

    /// The tree finds the same objects at the same t, bit for bit.
    fn check(&self, tree: &Tree) -> Result<(), String> {
        let mut stack = Stack::default();
        for &(corner, hit) in &self.hits {
            let ray = self.rays.of(RayKind::Primary).rays[corner].ray();
            let found = nearest(tree, &self.scene.objects, &ray, &mut stack);
            if found != hit {
                return Err(format!(
                    "the eye ray of corner {corner} hits {found:?}, by brute force {hit:?}"
                ));
            }
        }
        Ok(())
    }
}

/// Put the seconds of a scene's trees in place of older ones; rows of other runs stay.
fn keep_times(
    store: &Store,
    cells: &[TreeCell],
    builds: Vec<Vec<f64>>,
    passes: Vec<Vec<PassTiming>>,
) -> Result<(), StoreError> {
    let mut rows: Vec<PassTiming> = store.read_rows(TIMINGS, None).unwrap_or_default();
    rows.retain(|row| cells.iter().all(|cell| cell.plan.id != row.cell));
    for ((cell, build), passes) in cells.iter().zip(builds).zip(passes) {
        let all = std::iter::once(timing::build_row(&build)).chain(passes);
        rows.extend(all.map(|row| PassTiming {
            cell: cell.plan.id.clone(),
            scene: cell.plan.scene.name.clone(),
            strategy: cell.plan.rules.strategy.name(),
            stop: cell.plan.rules.stop.to_string(),
            ..row
        }));
    }
    store.write_rows(TIMINGS, rows)?;
    Ok(())
}
