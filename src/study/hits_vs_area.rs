//! The experiment `hits-vs-area`: MacDonald & Booth's Figure 3 for every node of every tree, and the counts it implies.

use sha2::{Digest, Sha256};

use crate::kd::Rules;
use crate::scene::Scene;
use crate::stats::{normal_quantile, simultaneous_quantile};

use super::cell::CellPlan;
use super::records::{CellRecord, Estimate, SamplerRecord, Summary};
use super::{Plan, digest, verdicts};

/// Version of the layout of `data/`.
pub const SCHEMA: u32 = 1;

/// Level of an estimate's own interval.
const LEVEL: f64 = 0.99;

/// The cells of a plan in canonical order: scenes, then strategies.
pub fn cells<'a>(plan: &Plan, scenes: &'a [Scene]) -> Vec<CellPlan<'a>> {
    let mut cells = Vec::new();
    for scene in scenes {
        let content = content(scene);
        let line_seed = line_seed(plan.seed, &content);
        for &strategy in &plan.strategies {
            let rules = Rules {
                strategy,
                stop: plan.stop,
                cost: plan.cost,
            };
            let identity = format!(
                "{SCHEMA} {} {content} {rules:?} seed {} {:?}",
                scene.name, plan.seed, plan.lines
            );
            let drawn = scene.name == plan.figure.scene && strategy == plan.figure.strategy;
            cells.push(CellPlan {
                id: digest(identity.as_bytes()),
                scene,
                rules,
                seed: plan.seed,
                line_seed,
                lines: plan.lines,
                nodes: plan.nodes || drawn,
            });
        }
    }
    cells
}

/// Seed of a scene's lines: the run's and the scene's content.
pub fn line_seed(seed: u64, content: &str) -> u64 {
    let hash = Sha256::digest(format!("lines of {content}, seed {seed}"));
    u64::from_le_bytes(std::array::from_fn(|i| hash[i]))
}

/// A scene's content: the boxes are all that a tree and its counts depend on.
pub fn content(scene: &Scene) -> String {
    let numbers = scene
        .bounds
        .iter()
        .flat_map(|b| [b.lo.to_array(), b.hi.to_array()].concat());
    let bytes: Vec<u8> = numbers.flat_map(f64::to_le_bytes).collect();
    digest(&bytes)
}

/// The run's answer: estimates with intervals, and whether the expectations held.
pub fn summarise(plan: &Plan, cells: &[CellRecord], samplers: &[SamplerRecord]) -> Summary {
    let mut estimates = Vec::new();
    // Slope, three counts and C of every cell are judged together.
    let judged = cells.len() * 5;
    let one = normal_quantile(LEVEL);
    let all = simultaneous_quantile(1.0 - plan.expect.family, judged);
    for r in cells {
        let mut push = |name: &str, value: f64, se: Option<f64>, predicted: f64| {
            let at = |sigmas: f64| se.map(|se| value + sigmas * se);
            estimates.push(Estimate {
                name: name.into(),
                scene: r.scene.clone(),
                strategy: r.strategy.clone(),
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
    Summary {
        schema: SCHEMA,
        experiment: plan.name.clone(),
        kind: "hits-vs-area".into(),
        question: plan.question.clone(),
        seed: plan.seed,
        command: plan.command.clone(),
        stop: plan.stop.to_string(),
        interval_level: LEVEL,
        family_level: 1.0 - plan.expect.family,
        quick: plan.quick,
        slope_within: plan.expect.slope_within,
        figure_scene: plan.figure.scene.clone(),
        figure_strategy: plan.figure.strategy.name(),
        verdicts: verdicts::all(plan, cells, samplers, &estimates),
        estimates,
    }
}
