//! From times to constants: the models that are compared, what each predicts of scenes left out, and whether that is as good
//! as was expected.

use std::collections::HashMap;

use crate::stats::cluster_bootstrap;
use crate::study::records::{
    ChoiceRecord, ConstantRecord, ModelRecord, OrderOfTimesRecord, PassTiming, PredictionRecord,
    ShareRecord, TimeVerdicts, Verdict,
};
use crate::study::store::{Store, StoreError};
use crate::study::{Plan, Watcher};

use super::asked::CostVsWork;
use super::cells::Measured;
use super::choice::{CHOSEN, choose};
use super::fit::{Errors, Fitter, Model, Orders};
use super::shares;
use super::terms::{Row, Term};

/// Fewest scenes for terms to be chosen without one and judged on it.
const FEWEST_SCENES: usize = 3;

/// Fewest groups of scenes for draws of them to tell anything.
const FEWEST_GROUPS: usize = 3;

/// Share of disturbed times above which times are not judged.
const MOST_DISTURBED: f64 = 0.25;

/// Level of the intervals of constants.
const LEVEL: f64 = 0.95;

/// What is left out at a time.
const SCENE: &str = ModelRecord::SCENE;
const GROUP: &str = ModelRecord::GROUP;

/// The model that areas can be put into.
const TWO: &str = ModelRecord::TWO;

/// Models whose terms are given.
fn given() -> Vec<Model> {
    let ratio = |name: &str, c_k: f64, c_t: f64| Model {
        ratio: Some(vec![c_k, c_t]),
        ..Model::of(name, &[Term::Inner, Term::Test])
    };
    vec![
        Model::of("n_t", &[Term::Test]),
        ratio("15:20 (Wald & Havran 2006)", 15.0, 20.0),
        ratio("1:80 (pbrt)", 1.0, 80.0),
        ratio("1.2:1 (Aila 2013)", 1.2, 1.0),
        Model::of(TWO, &[Term::Inner, Term::Test]),
        Model::of(ModelRecord::THREE, &[Term::Inner, Term::Leaf, Term::Test]),
    ]
}

/// What was fitted.
#[derive(Default)]
struct Calibrated {
    models: Vec<ModelRecord>,
    constants: Vec<ConstantRecord>,
    choices: Vec<ChoiceRecord>,
    predictions: Vec<PredictionRecord>,
    orders: Vec<OrderOfTimesRecord>,
    shares: Vec<ShareRecord>,
}

/// Fit constants to the seconds of a run and write what came of it; of too few scenes nothing.
pub fn write(
    plan: &Plan,
    asked: &CostVsWork,
    measured: &[Measured],
    times: &[PassTiming],
    store: &Store,
    watcher: &impl Watcher,
) -> Result<(), StoreError> {
    let rows = rows(measured, times);
    let fitter = Fitter::new(&rows);
    let found = if fitter.scenes.len() < FEWEST_SCENES {
        watcher.note(&format!(
            "constants are fitted to at least {FEWEST_SCENES} scenes, and judged on those left out; these are {}",
            fitter.scenes.len()
        ));
        Calibrated::default()
    } else {
        watcher.begin("calibration");
        calibrate(plan, asked, &fitter)
    };
    store.write_rows("times-models.csv", &found.models)?;
    store.write_rows("times-constants.csv", &found.constants)?;
    store.write_rows("times-choice.csv", &found.choices)?;
    store.write_rows("times-predictions.csv", &found.predictions)?;
    store.write_rows("times-order.csv", &found.orders)?;
    store.write_rows("times-shares.csv", &found.shares)?;
    let verdicts = TimeVerdicts {
        verdicts: verdicts(asked, &found.models, &rows),
    };
    let mut json = serde_json::to_vec_pretty(&verdicts).expect("verdicts are plain data");
    json.push(b'\n');
    store.write("times-verdicts.json", &json)
}

/// Counts and seconds of every set of rays in every tree, where rays were timed.
fn rows<'r>(measured: &'r [Measured], times: &[PassTiming]) -> Vec<Row<'r>> {
    let times: HashMap<(&str, &str), &PassTiming> = times
        .iter()
        .map(|row| ((row.cell.as_str(), row.what.as_str()), row))
        .collect();
    let all = measured.iter().flat_map(|tree| {
        let pairs = tree.work.iter().zip(&tree.steps);
        pairs.map(move |(work, steps)| (&tree.record, work, steps))
    });
    all.filter_map(|(cell, work, steps)| {
        let timed = times.get(&(work.cell.as_str(), work.rays.as_str()))?;
        let ns = 1e9 * timed.seconds / timed.units as f64;
        (ns > 0.0 && steps.cast > 0).then_some(Row {
            cell,
            work,
            steps,
            ns,
            disturbed: timed.disturbed,
        })
    })
    .collect()
}

fn calibrate(plan: &Plan, asked: &CostVsWork, fitter: &Fitter) -> Calibrated {
    let rows = fitter.rows;
    let scenes = fitter.single_scenes();
    let mut models = Vec::new();
    let mut two = Vec::new();
    // Of a single group nothing would be left to fit.
    let groups = Some(&fitter.groups).filter(|groups| groups.len() > 1);
    for model in given() {
        let by_scene = fitter.left_out(&[], &scenes, |_| model.clone());
        models.extend(record(&model, SCENE, rows, &by_scene));
        if let Some(groups) = groups {
            let by_group = fitter.left_out(&[], groups, |_| model.clone());
            models.extend(record(&model, GROUP, rows, &by_group));
        }
        if model.name == TWO {
            two = by_scene;
        }
    }

    // Terms are chosen without the scenes they are judged on; the model that is shown is chosen from all.
    let mut choices = Vec::new();
    let model = choose(fitter, &[], |row| choices.push(row));
    let choose = |out: &[usize]| choose(fitter, out, |_| ());
    let chosen = fitter.left_out(&[], &scenes, choose);
    models.extend(record(&model, SCENE, rows, &chosen));
    if let Some(groups) = groups {
        let by_group = fitter.left_out(&[], groups, choose);
        models.extend(record(&model, GROUP, rows, &by_group));
    }

    let fitted = fitter.constants_without(&model, &[]);
    let sets: Vec<String> = asked.rays.iter().map(ToString::to_string).collect();
    let shares = shares::by_set(&model, &fitted, rows, &sets);

    let shown = given().into_iter().filter(|model| model.ratio.is_none());
    let shown = shown.filter(|model| model.terms.len() > 1).chain([model]);
    let constants = shown.flat_map(|model| constants(plan, asked, fitter, &model));
    let constants = constants.collect();

    let areas = areas(fitter);
    let predictions = rows.iter().zip(&areas).zip(two.iter().zip(&chosen));
    let predictions = predictions.map(|((row, areas), (two, chosen))| PredictionRecord {
        cell: row.work.cell.clone(),
        scene: row.work.scene.clone(),
        group: row.group().into(),
        strategy: row.work.strategy.clone(),
        stop: row.work.stop.clone(),
        rays: row.work.rays.clone(),
        measured_ns: row.ns,
        disturbed: row.disturbed,
        areas_ns: *areas,
        two_ns: *two,
        chosen_ns: *chosen,
    });
    let predictions = predictions.collect();
    Calibrated {
        models,
        constants,
        choices,
        predictions,
        orders: orders(plan, asked, rows, &areas, &two, &chosen),
        shares,
    }
}

fn record(model: &Model, left_out: &str, rows: &[Row], predicted: &[f64]) -> Option<ModelRecord> {
    let errors = Errors::of(rows, predicted)?;
    let orders = Orders::of(rows, predicted, |_| true);
    Some(ModelRecord {
        model: model.name.clone(),
        constants: model.constants() as u64,
        left_out: left_out.into(),
        rows: rows.len() as u64,
        error_median: errors.median,
        error_mean: errors.mean,
        error_p90: errors.p90,
        error_max: errors.max,
        tau: orders.ranked(orders.tau),
        pairs_right: orders.ranked(orders.pairs_right),
        regret_mean: orders.ranked(orders.regret_mean),
        regret_max: orders.ranked(orders.regret_max),
    })
}

/// The constants of a model fitted to all groups.
fn constants(
    plan: &Plan,
    asked: &CostVsWork,
    fitter: &Fitter,
    model: &Model,
) -> Vec<ConstantRecord> {
    let all = fitter.constants_without(model, &[]);
    let draws = asked.calibration.draws as usize;
    // Sizes of one scene are drawn together: they are much alike.
    let groups = &fitter.groups;
    let intervals = cluster_bootstrap(groups.len(), draws, plan.seed, LEVEL, |drawn| {
        let scenes = drawn.iter().flat_map(|&group| &groups[group]);
        Some(fitter.constants(model, scenes.copied()))
    });
    let interval = |number: usize| intervals[number].filter(|_| groups.len() >= FEWEST_GROUPS);
    let inflation = fitter.inflation(model);
    let shares = shares::mean_shares(model, &all, fitter.rows.iter());
    let constant = |number: usize| ConstantRecord {
        model: model.name.clone(),
        term: model.terms[number].name(),
        ns: all[number],
        lo: interval(number).map(|(lo, _)| lo),
        hi: interval(number).map(|(_, hi)| hi),
        inflation: inflation[number],
        share: shares[number],
    };
    (0..model.terms.len()).map(constant).collect()
}

/// Nanoseconds of every row by areas alone: constants of n_K and n_t, fitted to counts without the row's scene, times what
/// areas predict.
fn areas(fitter: &Fitter) -> Vec<f64> {
    let model = Model::of(TWO, &[Term::Inner, Term::Test]);
    let mut predicted = vec![0.0; fitter.rows.len()];
    for (scene, numbers) in fitter.scenes.iter().enumerate() {
        let constants = fitter.constants_without(&model, &[scene]);
        for &number in numbers {
            let work = fitter.rows[number].work;
            let enters = work.entered as f64 / work.cast as f64;
            predicted[number] =
                enters * (constants[0] * work.n_k_predicted + constants[1] * work.n_t_predicted);
        }
    }
    predicted
}

/// How well costs of every origin put trees into the order of their times.
fn orders(
    plan: &Plan,
    asked: &CostVsWork,
    rows: &[Row],
    areas: &[f64],
    two: &[f64],
    chosen: &[f64],
) -> Vec<OrderOfTimesRecord> {
    let c = plan.cost;
    let given = format!("{}:{}:{}", c.c_k, c.c_b, c.c_t);
    let of = |cost: fn(&Row) -> f64| rows.iter().map(cost).collect::<Vec<f64>>();
    let (by_areas, by_counts) = (of(|r| r.work.c_predicted), of(|r| r.work.c_counted));
    let costs = [
        (format!("areas, {given}"), &by_areas[..]),
        (format!("areas, {TWO} calibrated"), areas),
        (format!("counts, {given}"), &by_counts[..]),
        (format!("counts, {TWO} calibrated"), two),
        (format!("counts, {CHOSEN}"), chosen),
    ];
    let mut records = Vec::new();
    let sets = asked.rays.iter().map(ToString::to_string);
    for rays in sets.chain(["all".into()]) {
        for (cost, values) in &costs {
            let wanted = |row: &Row| rays == "all" || row.work.rays == rays;
            let found = Orders::of(rows, values, wanted);
            if found.scenes > 0 {
                records.push(OrderOfTimesRecord {
                    rays: rays.clone(),
                    cost: cost.clone(),
                    scenes: found.scenes,
                    tau: found.tau,
                    pairs_right: found.pairs_right,
                    regret_mean: found.regret_mean,
                    regret_max: found.regret_max,
                    regret_scene: found.worst,
                });
            }
        }
    }
    records
}

/// Whether scenes left out are predicted as well as was expected. What was expected and cannot be judged is not held.
fn verdicts(asked: &CostVsWork, models: &[ModelRecord], rows: &[Row]) -> Vec<Verdict> {
    let expect = asked.expect;
    let wanted = [
        ("time-error", expect.error_median, false),
        ("time-order", expect.tau, true),
        ("time-regret", expect.regret, false),
    ];
    let own = |row: &&ModelRecord| row.model == CHOSEN && row.left_out == SCENE;
    let found = models.iter().find(own);
    let disturbed = rows.iter().filter(|row| row.disturbed).count();
    let too_many = disturbed as f64 > MOST_DISTURBED * rows.len() as f64;
    let percent = |share: f64| format!("{:.1} %", 100.0 * share);
    let judge = |(name, bound, least): (&str, Option<f64>, bool)| {
        let bound = bound?;
        let value = found.and_then(|found| match name {
            "time-error" => Some(found.error_median),
            "time-order" => found.tau,
            _ => found.regret_mean,
        });
        let (held, message) = match (found.zip(value), too_many) {
            (None, _) => (
                false,
                format!(
                    "not judged: constants take {FEWEST_SCENES} scenes, an order takes two trees of each"
                ),
            ),
            (_, true) => (
                false,
                format!(
                    "not judged: the halves of {disturbed} of {} times are more than 3 % apart; measure on a quieter machine",
                    rows.len()
                ),
            ),
            (Some((found, value)), false) => {
                let bounds = if least {
                    format!("at least {bound}")
                } else {
                    format!("at most {}", percent(bound))
                };
                let held = if least {
                    value >= bound
                } else {
                    value <= bound
                };
                (held, format!("{}, {bounds} wanted", sentence(name, found)))
            }
        };
        Some(Verdict {
            name: name.into(),
            held,
            message,
        })
    };
    wanted.into_iter().filter_map(judge).collect()
}

/// What a verdict says of the chosen terms.
fn sentence(name: &str, found: &ModelRecord) -> String {
    let percent = |share: f64| format!("{:.1} %", 100.0 * share);
    let some = |share: Option<f64>| share.map_or_else(|| "unknown".into(), percent);
    match name {
        "time-error" => format!(
            "times of scenes left out (other sizes of them kept), predicted from chosen terms: median relative error {}, mean \
             {}, worst {}",
            percent(found.error_median),
            percent(found.error_mean),
            percent(found.error_max)
        ),
        "time-order" => format!(
            "Kendall's tau between predicted and measured times of a scene's trees: mean {:.3}; {} of pairs in the right order",
            found.tau.unwrap_or_default(),
            some(found.pairs_right)
        ),
        _ => format!(
            "the tree of least predicted time takes {} more than the fastest in the mean, {} at worst",
            some(found.regret_mean),
            some(found.regret_max)
        ),
    }
}
