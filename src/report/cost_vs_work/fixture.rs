//! A small run whose numbers can be checked by hand.

use super::CostVsWork;
use crate::report::{Content, Run, fixture};
use crate::study::records::{
    CellRecord, ChoiceRecord, ConstantRecord, ModelRecord, OrderOfTimesRecord, PredictionRecord,
    ShareRecord, Summary, TimeVerdicts, TreeOrderRecord, Verdict, WorkRecord,
};

const SCENES: [&str; 3] = ["spd:a:1", "spd:a:2", "spd:b:1"];
const STRATEGIES: [&str; 2] = ["sah", "object-median"];

/// Two trees of each of three scenes, two sets of rays, and what was fitted to their seconds.
pub fn trees() -> CostVsWork {
    let mut run = CostVsWork {
        cells: Vec::new(),
        work: Vec::new(),
        orders: Vec::new(),
        models: vec![
            model(ModelRecord::TWO, 0.283, 0.72),
            model(ModelRecord::CHOSEN, 0.095, 0.9),
        ],
        constants: constants(),
        choices: [
            (1, "size of the tree", 0.25, 0.05, false),
            (1, "leaves", 0.2, 0.1, true),
            (1, "empty leaves", 0.3, 0.0, false),
            (2, "size of the tree", 0.2, 0.0, false),
            (2, "constant per ray", 0.19, 0.01, false),
        ]
        .map(choice)
        .into(),
        predictions: Vec::new(),
        times_order: vec![OrderOfTimesRecord {
            rays: "all".into(),
            cost: "areas, 1:1:2".into(),
            scenes: 6,
            tau: 0.8,
            pairs_right: 0.9,
            regret_mean: 0.04,
            regret_max: 0.33,
            regret_scene: "spd:b:1".into(),
        }],
        shares: Vec::new(),
        time_verdicts: TimeVerdicts {
            verdicts: vec![verdict("time-error", "error 9.5 %, at most 0.1 wanted")],
        },
    };
    for (i, scene) in SCENES.into_iter().enumerate() {
        let ratio = if i == 2 { 8.0 } else { 2.0 };
        for (j, strategy) in STRATEGIES.into_iter().enumerate() {
            let cell = fixture::cell(scene, strategy, 601);
            for (rays, ratio) in [("lines", 1.0), ("primary", ratio)] {
                run.work.push(work(&cell, rays, ratio, (j + 1) as f64));
                run.predictions.push(prediction(&cell, rays, j));
            }
            run.cells.push(cell);
        }
        run.orders
            .extend(["objects:2:16", "all"].into_iter().flat_map(|stop| {
                let wrong = i == 2;
                [
                    order(scene, "lines", stop, false),
                    order(scene, "primary", stop, wrong),
                ]
            }));
    }
    run.predictions[0].disturbed = true;
    for rays in ["lines", "primary"] {
        let shares = [
            ("constant per ray", 0.29),
            ("mispredicted branch", 0.7),
            ("leaf (c_B)", 0.01),
        ];
        run.shares.extend(shares.map(|(term, share)| ShareRecord {
            rays: rays.into(),
            term: term.into(),
            share,
        }));
    }
    run
}

/// Counts of rays of a tree: all a ratio of what is predicted, but no object test is.
fn work(cell: &CellRecord, rays: &str, ratio: f64, size: f64) -> WorkRecord {
    WorkRecord {
        cell: cell.cell.clone(),
        scene: cell.scene.clone(),
        objects: cell.objects,
        strategy: cell.strategy.clone(),
        stop: cell.stop.clone(),
        rays: rays.into(),
        n_k_predicted: 10.0 * size,
        n_k_counted: 10.0 * size * ratio,
        n_b_predicted: 5.0 * size,
        n_b_counted: 5.0 * size * ratio,
        c_predicted: 15.0 * size,
        c_counted: 15.0 * size * ratio,
        ..WorkRecord::default()
    }
}

fn order(scene: &str, rays: &str, stop: &str, wrong: bool) -> TreeOrderRecord {
    TreeOrderRecord {
        scene: scene.into(),
        rays: rays.into(),
        stop: stop.into(),
        trees: 2,
        tau: Some(if wrong { -1.0 } else { 1.0 }),
        pairs: 1,
        pairs_right: u64::from(!wrong),
        taken: format!("{scene}-sah"),
        regret: Some(if wrong { 0.3 } else { 0.0 }),
    }
}

fn model(name: &str, error: f64, tau: f64) -> ModelRecord {
    ModelRecord {
        model: name.into(),
        constants: 2,
        left_out: ModelRecord::SCENE.into(),
        rows: 12,
        error_median: error,
        error_mean: error,
        error_p90: 2.0 * error,
        error_max: 3.0 * error,
        tau: Some(tau),
        pairs_right: Some(0.9),
        regret_mean: Some(0.01),
        regret_max: Some(0.05),
    }
}

fn constants() -> Vec<ConstantRecord> {
    let (two, three, chosen) = (ModelRecord::TWO, ModelRecord::THREE, ModelRecord::CHOSEN);
    let one =
        |model: &str, term: &str, ns, interval: Option<(f64, f64)>, inflation| ConstantRecord {
            model: model.into(),
            term: term.into(),
            ns,
            lo: interval.map(|(lo, _)| lo),
            hi: interval.map(|(_, hi)| hi),
            inflation,
            share: 0.57,
        };
    let (inner, leaf, test) = (
        ConstantRecord::INNER,
        ConstantRecord::LEAF,
        ConstantRecord::TEST,
    );
    vec![
        one(two, inner, 16.9478, Some((13.782, 20.029)), Some(4.8)),
        one(two, test, 4.385, Some((2.0, 14.88)), Some(4.8)),
        one(three, inner, 15.569, Some((10.32, 20.03)), Some(18.3)),
        one(three, leaf, 6.11, Some((0.0, 22.52)), Some(17.39)),
        one(three, test, 4.014, Some((0.0, 14.67)), Some(4.98)),
        one(chosen, inner, 0.2606, Some((0.0, 1.4557)), Some(17.5)),
        one(chosen, ConstantRecord::SURPRISE, 15.558, None, None),
    ]
}

fn choice((step, candidate, after, gain, taken): (u64, &str, f64, f64, bool)) -> ChoiceRecord {
    ChoiceRecord {
        step,
        candidate: candidate.into(),
        error_before: if step == 1 { 0.3 } else { 0.2 },
        error_after: after,
        gain,
        gain_se: 0.02,
        taken,
    }
}

/// Chosen terms: right, but over `spd:b:1` 10 % too much for the second strategy and 20 % too little for the first.
fn prediction(cell: &CellRecord, rays: &str, strategy: usize) -> PredictionRecord {
    let off = match (cell.scene.as_str(), strategy) {
        ("spd:b:1", 0) => 0.8,
        ("spd:b:1", _) => 1.1,
        _ => 1.0,
    };
    PredictionRecord {
        cell: cell.cell.clone(),
        scene: cell.scene.clone(),
        group: cell.scene[..5].into(),
        strategy: cell.strategy.clone(),
        stop: cell.stop.clone(),
        rays: rays.into(),
        measured_ns: 200.0,
        disturbed: false,
        areas_ns: 100.0,
        two_ns: 400.0,
        chosen_ns: 200.0 * off,
    }
}

fn verdict(name: &str, message: &str) -> Verdict {
    Verdict {
        name: name.into(),
        held: true,
        message: message.into(),
    }
}

/// The summary of the run.
pub fn summary() -> Summary {
    Summary {
        kind: "cost-vs-work".into(),
        verdicts: vec![verdict("counts-cover", "all do")],
        ..fixture::summary("spd:a:1")
    }
}

/// The run as it is read.
pub fn run(trees: CostVsWork) -> Run {
    Run {
        dir: "data/test".into(),
        summary: summary(),
        content: Content::CostVsWork(trees),
    }
}
