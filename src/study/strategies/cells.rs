//! The trees of one scene: counted, checked and timed together, as they share the rays.

use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::geom::{Ray, Targets};
use crate::kd::{Hit, Rules, Stack, StopRule, Strategy, Tree, nearest, occluded, predict};
use crate::scene::{Look, Scene};
use crate::study::hits::cell::{CellPlan, CellResult, compare, plant};
use crate::study::identity::{digest, whole};
use crate::study::pieces::{Extent, Made};
use crate::study::records::{CellRecord, PassTiming, RayRecord};
use crate::study::store::Store;
use crate::study::timing::Timed;
use crate::study::{Plan, RunError, Watcher, guess, timing};
use crate::tracer::{RayCounts, RayKind, RaySet, count, trace};

use super::asked::Strategies;
use super::pictures::{self, Pictures};

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
    let seen = whole(scene);
    let all = Rules::crossed(&asked.stops, &asked.strategies, plan.cost, asked.clipped);
    let cell = |mut plan: CellPlan<'a>| {
        let identity = format!("{} {seen} {} {}", plan.id, asked.pixels, asked.checked);
        plan.id = digest(identity.as_bytes());
        TreeCell { plan, look }
    };
    let plans = CellPlan::of_scene(scene, &all, plan.seed, asked.lines);
    plans.into_iter().map(cell).collect()
}

/// Identity of the trees of a scene together: trees are timed together or not at all, and in the same way.
pub fn identity(asked: &Strategies, cells: &[TreeCell]) -> String {
    let ids: Vec<&str> = cells.iter().map(|cell| &*cell.plan.id).collect();
    digest(format!("{ids:?} {:?}", asked.timing).as_bytes())
}

/// The finished trees of a scene, if all of them and their pictures are there.
pub fn finished(asked: &Strategies, store: &Store, cells: &[TreeCell]) -> Option<Vec<Studied>> {
    let one = |cell: &TreeCell| kept(asked, store, &cell.plan);
    cells.iter().map(one).collect()
}

/// A finished tree on disk: the pictures lie beside it.
#[derive(Serialize, Deserialize)]
struct Kept {
    studied: Studied,
    pictures: Pictures,
}

/// A finished tree: taken only if its pictures are those written with it.
fn kept(asked: &Strategies, store: &Store, cell: &CellPlan) -> Option<Studied> {
    let CellPlan {
        id, rules, scene, ..
    } = cell;
    let Kept { studied, pictures } = store.finished(id)?;
    let drawn = pictures.are_there(store, asked, scene, rules);
    drawn.then_some(studied)
}

/// What the trees of a scene amount to.
pub fn extent(asked: &Strategies, cells: &[TreeCell]) -> Extent {
    let Some(first) = cells.first() else {
        return Extent::default();
    };
    let scene = first.plan.scene;
    let objects = scene.bounds.len();
    let lines = asked.lines.at_least();
    let rays = guess::pictured(scene, asked.pixels);
    let rounds = 1.0 + f64::from(asked.timing.rounds);
    let passes = RayKind::ALL.len() as f64 * asked.timing.pass_s;
    let seconds = guess::streamed(lines)
        + guess::traced(rays)
        + rounds * passes.min(guess::timed(rays))
        + guess::tree(objects) * f64::from(asked.timing.builds);
    let trees = cells.len();
    Extent {
        things: trees,
        units: trees as u64 * u64::from(1 + asked.timing.rounds),
        lines: trees as u64 * (lines + rays),
        seconds: trees as f64 * seconds,
        bytes: guess::rows(8 * trees) + 7 * u64::from(asked.pixels + 1).pow(2),
    }
}

/// Count, check and time the trees of a scene.
pub fn measure(
    plan: &Plan,
    asked: &Strategies,
    cells: &[TreeCell],
    store: &Store,
    watcher: &impl Watcher,
) -> Result<Made<Vec<Studied>, PassTiming>, RunError> {
    let Some(TreeCell {
        plan: CellPlan { scene, .. },
        look,
    }) = cells.first()
    else {
        return Ok(Made::nothing());
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
    let picture = Pictures::of_scene(store, scene, &traced.picture)?;
    let probes = Probes::new(scene, &traced.rays, asked.checked, plan.seed);

    let mut studied = Vec::new();
    let mut trees = Vec::new();
    for cell in cells {
        let CellPlan { id, rules, .. } = &cell.plan;
        let place = format!("{} {} {}", scene.name, rules.strategy, rules.stop);
        watcher.begin(&place);
        let (tree, _) = plant(scene, rules).map_err(bug(place.clone()))?;
        let found = if let Some(found) = kept(asked, store, &cell.plan) {
            found
        } else {
            let (studied, counts) =
                count_tree(cell, &tree, &traced.rays, &probes).map_err(bug(place))?;
            let mut pictures = picture.clone();
            if pictures::is_shown(asked, rules) {
                pictures = pictures.with_costs(store, scene, rules, &counts.corners)?;
            }
            let new = Kept { studied, pictures };
            store.save(id, &new)?;
            new.studied
        };
        studied.push(found);
        trees.push(tree);
        watcher.done(1);
    }
    drop(tree);

    watcher.begin(&format!("{} times", scene.name));
    let rules: Vec<Rules> = cells.iter().map(|cell| cell.plan.rules).collect();
    let builds = timing::build_times(scene, &rules, asked.timing, plan.seed);
    let sets = RayKind::ALL.map(|kind| {
        let rays = &traced.rays.of(kind).rays;
        Timed::all(kind.name().into(), kind.ask(), rays)
    });
    let passes = timing::sampled(scene, &trees, &sets, asked.timing.pass_s, plan.seed);
    let passes = timing::trace_times(scene, &trees, passes, asked.timing, plan.seed, || {
        watcher.done(cells.len() as u64);
    });
    let rows = builds.into_iter().zip(passes).map(|(build, mut passes)| {
        passes.insert(0, build);
        passes
    });
    Ok(Made {
        result: studied,
        times: timing::named(cells.iter().map(|cell| &cell.plan), rows),
    })
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
    let (CellResult { record, .. }, _) = compare(&cell.plan, tree, &predict(tree), &())?;
    let counts = count(rays, tree, &scene.objects);
    let row = |kind: RayKind| {
        let tally = counts.of(kind);
        if tally.surprises > 0 {
            return Err(format!(
                "{} {kind} rays hit something and did not when they were made, or the other way round",
                tally.surprises
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

/// Random rays with their hits by brute force: over all objects, without a tree. Of an eye ray or a secondary one the nearest
/// hit, of a shadow ray whether there is any.
struct Probes<'a> {
    scene: &'a Scene,
    rays: &'a RaySet,
    answers: Vec<(RayKind, usize, Option<Hit>)>,
}

/// For one shadow or secondary ray held against brute force so many eye rays are.
const EYE_RAYS: usize = 4;

impl<'a> Probes<'a> {
    fn new(scene: &'a Scene, rays: &'a RaySet, number: u32, seed: u64) -> Self {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let mut drawn = Vec::new();
        for kind in RayKind::ALL {
            let all = rays.of(kind).rays.len() as u64;
            let number = match kind {
                _ if all == 0 => 0,
                RayKind::Primary => number as usize,
                RayKind::Shadow | RayKind::Secondary => (number as usize).div_ceil(EYE_RAYS),
            };
            drawn.extend((0..number).map(|_| (kind, random.random_range(0..all) as usize)));
        }
        let nearest_of_all = |ray: &Ray| {
            (0..scene.bounds.len() as u32).fold(None, |best, object| {
                match scene.objects.intersect(object, ray) {
                    Some(t) => Hit::nearer(best, object, t),
                    None => best,
                }
            })
        };
        let answers = drawn.into_par_iter().map(|(kind, number)| {
            let hit = nearest_of_all(&rays.of(kind).rays[number].ray());
            (kind, number, hit)
        });
        Self {
            scene,
            rays,
            answers: answers.collect(),
        }
    }

    /// The tree finds the same objects at the same t, bit for bit, and blocks the same shadow rays.
    fn check(&self, tree: &Tree) -> Result<(), String> {
        let mut stack = Stack::default();
        for &(kind, number, hit) in &self.answers {
            let ray = self.rays.of(kind).rays[number].ray();
            let objects = &self.scene.objects;
            let found = nearest(tree, objects, &ray, &mut stack);
            let blocked = occluded(tree, objects, &ray, &mut stack);
            if found != hit || blocked != hit.is_some() {
                return Err(format!(
                    "{kind} ray {number} hits {found:?} (any: {blocked}), by brute force {hit:?}"
                ));
            }
        }
        Ok(())
    }
}
