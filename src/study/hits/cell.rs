//! One cell: build a tree, predict, count, compare.

use std::time::Instant;

use serde::{Deserialize, Serialize};

use crate::geom::Span;
use crate::kd::audit::{audit, audit_clipped};
use crate::kd::stream::{Streams, count_lines};
use crate::kd::traverse::traverse_line;
use crate::kd::{Counts, Prediction, Rules, Stack, Tree, Work, build_objects, predict};
use crate::rays::SurfaceLines;
use crate::scene::Scene;

use crate::study::identity::{content, digest, line_seed, whole};
use crate::study::needed::{Rare, needed};
use crate::study::ray_sets::Rays;
use crate::study::{LineRule, SCHEMA, Watcher, work};

use super::findings::Found;
use super::scores::{FIRST_SCORE, Scoring, WEIGHTED, score_lines};
use super::spread::Spread;
use crate::study::records::{BinRecord, CellRecord, NodeRecord, TimingRecord, WorkRecord};

/// What a cell is made of.
#[derive(Clone)]
pub struct CellPlan<'a> {
    /// Identity, from all parameters.
    pub id: String,
    /// The objects.
    pub scene: &'a Scene,
    /// The tree.
    pub rules: Rules,
    /// Seed of the run.
    pub seed: u64,
    /// Seed of the lines: the run's and the scene's, so that scenes meet independent lines and the trees of one scene the
    /// same.
    pub line_seed: u64,
    /// How many lines.
    pub lines: LineRule,
    /// Whether to keep a row for every node.
    pub nodes: bool,
}

impl<'a> CellPlan<'a> {
    /// A cell for each of these trees over a scene, without nodes. What all of them need of the scene is worked out once.
    pub fn of_scene(scene: &'a Scene, all: &[Rules], seed: u64, lines: LineRule) -> Vec<Self> {
        let content = content(scene);
        let shapes = if all.iter().any(|rules| rules.clipped) {
            whole(scene)
        } else {
            String::new()
        };
        let cell = |&rules: &Rules| {
            let shapes = if rules.clipped { &*shapes } else { "" };
            let identity = format!(
                "{SCHEMA} {} {content}{shapes} {rules:?} seed {seed} {lines:?}",
                scene.name
            );
            Self {
                id: digest(identity.as_bytes()),
                scene,
                rules,
                seed,
                line_seed: line_seed(seed, &content),
                lines,
                nodes: false,
            }
        };
        all.iter().map(cell).collect()
    }
}

/// What a cell found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CellResult {
    /// The row of `cells.csv`.
    pub record: CellRecord,
    /// The rows of `bins.csv`.
    pub bins: Vec<BinRecord>,
    /// The rows of `work.csv`.
    pub work: Vec<WorkRecord>,
    /// The rows of `nodes.csv`, if asked for.
    #[serde(skip)]
    pub nodes: Option<Vec<NodeRecord>>,
}

/// First lines that are traversed one by one for standard errors, and that the streams are checked against.
pub const PILOT: u64 = 1 << 16;

/// Measure one cell on the current rayon pool; gives its row of `timings.csv` too.
///
/// # Errors
/// If an integer identity fails, if the streams and the plain traversal disagree on any node, or if the tree fails its
/// audit: each is a bug in the program, never a property of the scene.
pub fn measure(
    plan: &CellPlan<'_>,
    watcher: &impl Watcher,
) -> Result<(CellResult, TimingRecord), String> {
    measure_with(plan, &[], watcher)
}

/// As [`measure`], and these sets of rays traced through the tree.
///
/// # Errors
/// As [`measure`].
pub fn measure_with(
    plan: &CellPlan<'_>,
    sets: &[&Rays],
    watcher: &impl Watcher,
) -> Result<(CellResult, TimingRecord), String> {
    let (tree, build_s) = plant(plan.scene, &plan.rules)?;
    let prediction = predict(&tree);
    let (mut result, timing) = compare(plan, &tree, &prediction, watcher)?;
    for rays in sets {
        let cast = rays.casts.len() as u64;
        watcher.revise(0, cast);
        let counted = work::count(&tree, &plan.scene.objects, rays);
        let record = counted.record(plan, rays, plan.rules.cost, &prediction);
        result.work.push(record);
        watcher.done(cast);
    }
    Ok((result, TimingRecord { build_s, ..timing }))
}

/// Build a tree on one thread, with the seconds it took, and prove its invariants.
///
/// # Errors
/// If the tree fails its audit.
pub fn plant(scene: &Scene, rules: &Rules) -> Result<(Tree, f64), String> {
    let (tree, build_s) = on_one_thread(|| {
        let started = Instant::now();
        let tree = build_tree(scene, rules);
        (tree, started.elapsed().as_secs_f64())
    });
    let audited = if rules.clipped {
        audit_clipped(&tree, &scene.objects, &scene.bounds)
    } else {
        audit(&tree, &scene.bounds)
    };
    audited.map_err(|faults| faults.join("; "))?;
    Ok((tree, build_s))
}

/// The result of some work for which the pool has one thread, as trees are built by all that it has.
pub fn on_one_thread<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    pool.expect("one more thread can be started").install(work)
}

/// Build a scene's tree, on all threads of the current pool.
pub fn build_tree(scene: &Scene, rules: &Rules) -> Tree {
    build_objects(&scene.objects, &scene.bounds, scene.world, rules)
}

/// Count lines through a tree and hold the counts against a prediction; gives the seconds too, but for building the tree.
///
/// # Errors
/// As [`measure`], but for the audit.
pub fn compare(
    plan: &CellPlan<'_>,
    tree: &Tree,
    prediction: &Prediction,
    watcher: &impl Watcher,
) -> Result<(CellResult, TimingRecord), String> {
    // Pilot: the first lines one by one, for the standard errors and, where no error of C settles it, the number of lines.
    let lines = SurfaceLines {
        world: plan.scene.world,
        seed: plan.line_seed,
    };
    let scoring = Scoring::new(tree, prediction);
    let settled = plan.lines.cost_error().map(|error| {
        let cost = |i: u64, stack: &mut Stack| {
            let mut work = Work::default();
            for line in lines.range(i..i + 1) {
                traverse_line(tree, &line, Span::FULL, stack, &mut work);
            }
            Some(work.cost(plan.rules.cost))
        };
        let rare = Rare::of(tree, prediction, plan.rules.cost);
        needed(error, plan.lines.bounds(), &rare, cost)
    });
    // Where an error is wanted, its confirmation is worth a longer pilot.
    let pilot = match settled {
        Some(n) => n.min(8 * PILOT),
        None => plan.lines.at_least().min(PILOT),
    };
    let scored = score_lines(tree, &scoring, pilot, |range| lines.range(range));
    let spread = Spread::new(tree, prediction, &scoring, &scored);
    let sigma = spread.deviation(FIRST_SCORE + WEIGHTED);
    let n = settled.unwrap_or_else(|| plan.lines.choose(sigma));
    watcher.revise(plan.lines.guess(), n);

    // All lines through the streams, then the same check that any count must pass.
    let started = Instant::now();
    let counts = count_lines(
        tree,
        n,
        |range| lines.range(range),
        |done| watcher.done(done),
    );
    let count_s = started.elapsed().as_secs_f64();
    counts.check(tree)?;
    check_streams(tree, &lines, &scored.counts)?;

    let found = Found {
        plan,
        tree,
        prediction,
        scoring: &scoring,
        spread: &spread,
        pilot,
        counts: &counts,
    };
    let nodes = found.nodes();
    let timing = TimingRecord {
        cell: plan.id.clone(),
        scene: plan.scene.name.clone(),
        strategy: plan.rules.strategy.name(),
        build_s: 0.0,
        count_s,
        threads: rayon::current_num_threads() as u64,
        visits: counts.visits(),
    };
    let result = CellResult {
        record: found.record(&nodes),
        bins: found.bins(&nodes),
        work: Vec::new(),
        nodes: plan.nodes.then_some(nodes),
    };
    Ok((result, timing))
}

/// The pilot's lines again, as a stream: equal to the plain traversal on every node.
fn check_streams(tree: &Tree, lines: &SurfaceLines, plain: &Counts) -> Result<(), String> {
    let mut streamed = Counts::new(tree);
    let first: Vec<_> = lines.range(0..plain.lines).collect();
    Streams::default().count(tree, &first, &mut streamed);
    if streamed == *plain {
        return Ok(());
    }
    let differing = streamed
        .hits
        .iter()
        .zip(&plain.hits)
        .filter(|(a, b)| a != b)
        .count();
    Err(format!(
        "line streams and plain traversal disagree on {differing} nodes"
    ))
}
