//! The experiment `hits-vs-area`: MacDonald & Booth's Figure 3 for every node of every tree, and the counts it implies.

pub mod asked;
pub mod cell;
pub mod findings;
pub mod samplers;
pub mod scores;
pub mod spread;
pub mod verdicts;
pub mod work;

use serde::{Deserialize, Serialize};

use crate::kd::Rules;
use crate::scene::Scene;
use crate::stats::{normal_quantile, simultaneous_quantile};

use super::choices::choices;
use super::identity::{digest, whole};
use super::pieces::{Extent, Made, Piece, piece_by_piece};
use super::records::{CellRecord, Estimate, NodeRecord, SamplerRecord, Summary, WorkRecord};
use super::store::{CELLS, Store, StoreError};
use super::{LEVEL, Plan, RunError, Watcher, guess, needed};

pub use asked::HitsVsArea;
use cell::{CellPlan, CellResult, measure_with};
use work::Gathered;

/// The trees of every scene.
fn rules(plan: &Plan, asked: &HitsVsArea) -> Vec<Rules> {
    Rules::crossed(&[asked.stop], &asked.strategies, plan.cost, asked.clipped)
}

/// The cells of a plan in canonical order: scenes, then strategies.
pub(super) fn pieces<'a>(
    plan: &Plan,
    asked: &HitsVsArea,
    scenes: &'a [Scene],
) -> Vec<Piece<CellPlan<'a>>> {
    let mut cells = Vec::new();
    for scene in scenes {
        let rules = rules(plan, asked);
        // Where rays stop depends on all of the scene.
        let work = asked.work.as_ref();
        let work = work.map(|work| format!("{} {}", whole(scene), work.identity()));
        for mut cell in CellPlan::of_scene(scene, &rules, plan.seed, asked.lines) {
            let drawn =
                scene.name == asked.figure.scene && cell.rules.strategy == asked.figure.strategy;
            cell.nodes = asked.nodes || drawn;
            if let Some(work) = &work {
                cell.id = digest(format!("{} {work}", cell.id).as_bytes());
            }
            cells.push(Piece {
                id: cell.id.clone(),
                place: format!("{} {}", scene.name, cell.rules.strategy),
                extent: extent(asked, &cell),
                of: cell,
            });
        }
    }
    cells
}

/// What a cell amounts to.
fn extent(asked: &HitsVsArea, cell: &CellPlan) -> Extent {
    let traced = asked.work.as_ref().map_or(0, |work| work.size(cell.scene));
    let lines = asked.lines.at_least();
    let objects = cell.scene.bounds.len();
    let nodes = if cell.nodes { objects } else { 0 };
    Extent {
        things: 1,
        units: asked.lines.guess(),
        lines: lines + traced,
        seconds: guess::tree(objects) + guess::streamed(lines) + guess::traced(traced),
        bytes: guess::rows(30) + guess::rows(nodes),
    }
}

/// A finished cell on disk: the nodes lie beside it.
#[derive(Serialize, Deserialize)]
struct Kept {
    result: CellResult,
    /// Digest of the file of nodes written with it, if one was.
    nodes_sha256: Option<String>,
}

fn nodes_file(id: &str) -> String {
    format!("{CELLS}/{id}.nodes.csv")
}

/// A finished cell, with its nodes if they are needed: taken only if its nodes are those written with it.
fn finished(store: &Store, cell: &CellPlan) -> Option<CellResult> {
    let Kept {
        mut result,
        nodes_sha256,
    } = store.finished(&cell.id)?;
    if cell.nodes {
        result.nodes = Some(store.read_rows(&nodes_file(&cell.id), Some(&nodes_sha256?))?);
    }
    Some(result)
}

/// Keep a finished cell. Its nodes go first: a cell counts as finished when its JSON is there.
fn keep(store: &Store, result: &CellResult) -> Result<(), StoreError> {
    let id = &result.record.cell;
    let nodes_sha256 = match &result.nodes {
        Some(nodes) => Some(store.write_rows(&nodes_file(id), nodes)?),
        None => None,
    };
    let result = CellResult {
        nodes: None,
        ..result.clone()
    };
    store.save(
        id,
        &Kept {
            result,
            nodes_sha256,
        },
    )
}

/// Measure what is not finished and write the files of the run.
pub(super) fn run(
    plan: &Plan,
    asked: &HitsVsArea,
    scenes: &[Scene],
    store: &Store,
    watcher: &impl Watcher,
) -> Result<(), RunError> {
    let announce = |left: &[&Piece<CellPlan>]| {
        let s = if left.len() == 1 { "" } else { "s" };
        watcher.announce(&format!("counting lines through {} cell{s}", left.len()));
    };
    let mut gathered = Gathered::new(asked.work.as_ref());
    let measure = |piece: &Piece<CellPlan<'_>>| {
        let Piece {
            place, of: cell, ..
        } = piece;
        watcher.begin(place);
        let (result, timing) = gathered
            .of(cell.scene, &rules(plan, asked), cell.line_seed)
            .and_then(|sets| measure_with(cell, &sets, watcher))
            .map_err(|fault| RunError::Bug {
                place: place.clone(),
                fault,
            })?;
        keep(store, &result)?;
        Ok(Made {
            result,
            times: vec![timing],
        })
    };
    let pieces = pieces(plan, asked, scenes);
    let found = |piece: &Piece<CellPlan>| finished(store, &piece.of);
    let results = piece_by_piece(store, &pieces, "cells", watcher, found, announce, measure)?;
    let Some(results) = results else {
        return Ok(());
    };
    let mut laws = samplers::check_scenes(plan.seed, asked.lines, scenes);
    if let Some(controls) = asked.controls {
        watcher.revise(0, samplers::LAWS * controls.lines);
        watcher.begin("laws of lines");
        laws.extend(samplers::check_laws(plan.seed, controls, watcher));
    }
    write(plan, asked, &results, &laws, store)?;
    Ok(())
}

/// Put the run's files together. The seconds are there already.
fn write(
    plan: &Plan,
    asked: &HitsVsArea,
    results: &[CellResult],
    samplers: &[SamplerRecord],
    store: &Store,
) -> Result<(), StoreError> {
    let records: Vec<CellRecord> = results.iter().map(|r| r.record.clone()).collect();
    store.write_rows("cells.csv", &records)?;
    store.write_rows("bins.csv", results.iter().flat_map(|r| &r.bins))?;
    let nodes = results.iter().filter_map(|r| r.nodes.as_ref()).flatten();
    store.write_rows::<&NodeRecord>("nodes.csv", nodes)?;
    store.write_rows("samplers.csv", samplers)?;
    write_work(asked, results, store)?;
    let work: Vec<&WorkRecord> = results.iter().flat_map(|r| &r.work).collect();
    store.write_summary(&summarise(plan, asked, &records, &work, samplers))
}

/// What rays did in every tree, and which strategy to take for them.
fn write_work(asked: &HitsVsArea, results: &[CellResult], store: &Store) -> Result<(), StoreError> {
    if asked.work.is_none() {
        store.remove(WORK)?;
        return store.remove(CHOICES);
    }
    let work: Vec<WorkRecord> = results.iter().flat_map(|r| r.work.clone()).collect();
    store.write_rows(WORK, &work)?;
    store.write_rows(CHOICES, choices(&work))?;
    Ok(())
}

/// The files of a run that traces rays.
const WORK: &str = "work.csv";
const CHOICES: &str = "choices.csv";

/// The cells of a dry run, a line each.
pub(super) fn describe(plan: &Plan, asked: &HitsVsArea, scenes: &[Scene]) -> String {
    let line = |cell: &CellPlan| {
        format!(
            "{}  {:24} {:24} {:>9} objects, at least {} lines\n",
            cell.id,
            cell.scene.name,
            cell.rules.strategy,
            cell.scene.bounds.len(),
            asked.lines.at_least()
        )
    };
    let pieces = pieces(plan, asked, scenes);
    let mut head = format!("stop {}, seed {}\n", asked.stop, plan.seed);
    if let Some(work) = &asked.work {
        head += &format!("{}\n", work.describe());
    }
    head + &pieces
        .iter()
        .map(|piece| line(&piece.of))
        .collect::<String>()
}

/// Estimates of every cell, each with its own interval and one that holds for all together.
pub fn estimates(cells: &[CellRecord], family: f64) -> Vec<Estimate> {
    let mut estimates = Vec::new();
    // Slope, three counts and C of every cell are judged together.
    let judged = cells.len() * 5;
    let one = normal_quantile(LEVEL);
    let all = simultaneous_quantile(1.0 - family, judged);
    for r in cells {
        let mut push = |name: &str, value: f64, se: Option<f64>, predicted: f64| {
            let at = |sigmas: f64| se.map(|se| value + sigmas * se);
            estimates.push(Estimate {
                name: name.into(),
                scene: r.scene.clone(),
                strategy: r.strategy.clone(),
                stop: r.stop.clone(),
                value,
                lo: at(-one),
                hi: at(one),
                se,
                n: r.lines,
                predicted,
                lo_all: at(-all),
                hi_all: at(all),
            });
        };
        if let Some(slope) = r.slope {
            push("slope", slope, r.slope_se, 1.0);
        }
        push("n_K", r.n_k_counted, r.n_k_se, r.n_k_predicted);
        push("n_B", r.n_b_counted, r.n_b_se, r.n_b_predicted);
        push("n_t", r.n_t_counted, r.n_t_se, r.n_t_predicted);
        push("C", r.c_counted, r.c_se, r.c_predicted);
    }
    estimates
}

/// The run's answer: estimates with intervals, and whether the expectations held.
fn summarise(
    plan: &Plan,
    asked: &HitsVsArea,
    cells: &[CellRecord],
    work: &[&WorkRecord],
    samplers: &[SamplerRecord],
) -> Summary {
    let estimates = estimates(cells, asked.expect.family);
    let mut verdicts = verdicts::all(asked, cells, samplers, &estimates);
    let mut known = needed::of_cells(&asked.lines, cells);
    let rays_error = asked.work.as_ref().and_then(|work| work.error);
    known.extend(needed::of_rays(rays_error, work));
    verdicts.extend(needed::verdict(&known));
    Summary {
        stop: Some(asked.stop.to_string()),
        slope_within: Some(asked.expect.slope_within),
        figure_scene: Some(asked.figure.scene.clone()),
        figure_strategy: Some(asked.figure.strategy.name()),
        family_level: Some(1.0 - asked.expect.family),
        verdicts,
        estimates,
        ..plan.summary()
    }
}
