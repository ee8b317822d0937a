//! What the seconds say, in sentences made from the numbers.

use std::fmt::Write;

use super::times::{INTERVALS, Key, Residuals, identified, inflation, interval, unidentified};
use super::{CostVsWork, work};
use crate::report::number::{counted, digits_for, fixed, grouped, signed};
use crate::report::text::capitalised;
use crate::study::records::{ConstantRecord, ModelRecord, PredictionRecord};

/// What others take c_K:c_t to be.
const PUBLISHED: [(&str, f64, f64); 3] = [
    ("15:20 (Wald and Havran 2006)", 15.0, 20.0),
    ("1:80 (pbrt)", 1.0, 80.0),
    ("1.2:1 (Aila 2013)", 1.2, 1.0),
];

/// What is said where there are too few scenes.
pub const NONE: &str = "No constants were fitted: that takes three scenes, so that one can be left out and be \
                        predicted from the others.";

/// The findings, as Markdown.
pub fn findings(run: &CostVsWork) -> String {
    if run.models.is_empty() {
        return format!("{NONE}\n");
    }
    let disturbed = run.predictions.iter().filter(|row| row.disturbed);
    let mut text = format!(
        "By time: {}, {} of a set of rays in a tree; {} of them had even and odd rounds more than 3 % apart. Models are \
         judged on scenes that were left out. Intervals: 95 %, from a bootstrap over groups of scenes, {INTERVALS}.\n\n",
        work::trees(run),
        counted(run.predictions.len() as u64, "time"),
        grouped(disturbed.count() as u64)
    );
    let lines = [
        constants_ratio(run),
        unidentified(run),
        step(run),
        judged(run, "time-error"),
        judged(run, "time-order"),
        judged(run, "time-regret"),
        areas(run),
        worst(run),
    ];
    for line in lines.into_iter().flatten() {
        let _ = writeln!(text, "- {line}");
    }
    text
}

fn constant<'r>(run: &'r CostVsWork, model: &str, term: &str) -> Option<&'r ConstantRecord> {
    let own = |c: &&ConstantRecord| c.model == model && c.term == term;
    run.constants.iter().find(own)
}

/// The model of this name as judged on scenes left out.
fn model<'r>(run: &'r CostVsWork, name: &str) -> Option<&'r ModelRecord> {
    let own = |m: &&ModelRecord| m.model == name && m.left_out == ModelRecord::SCENE;
    run.models.iter().find(own)
}

/// c_K:c_t of the two-constant model beside published ratios.
fn constants_ratio(run: &CostVsWork) -> Option<String> {
    let of = |term| constant(run, ModelRecord::TWO, term);
    let (inner, test) = (of(ConstantRecord::INNER)?, of(ConstantRecord::TEST)?);
    let mut text = format!(
        "With two constants an inner node takes {} and an object test {}",
        interval(inner),
        interval(test)
    );
    // From the ends of both intervals, of which each fails at 5 %.
    let bounds = inner.lo.zip(inner.hi).zip(test.lo.zip(test.hi));
    let Some(((k_lo, k_hi), (t_lo, t_hi))) = bounds.filter(|(_, (_, t_hi))| *t_hi > 0.0) else {
        return Some(text + ".");
    };
    let show = |ratio: f64| fixed(ratio, digits_for(ratio, 2));
    let least = k_lo / t_hi;
    let largest = (t_lo > 0.0).then(|| k_hi / t_lo);
    let _ = match largest {
        Some(largest) => write!(text, ": c_K:c_t is {} to {}:1", show(least), show(largest)),
        None => write!(
            text,
            ": c_K:c_t is at least {}:1, without an upper bound",
            show(least)
        ),
    };
    let judged = PUBLISHED.map(|(name, c_k, c_t)| {
        let ratio = c_k / c_t;
        let place = if ratio < least {
            "lies below"
        } else if largest.is_some_and(|largest| ratio > largest) {
            "lies above"
        } else {
            "lies within"
        };
        format!("{name} {place}")
    });
    let _ = write!(
        text,
        " (ends of both intervals, so 90 %); {}.",
        judged.join(", ")
    );
    Some(text)
}

/// What a step costs where the processor foresees its branches, and where not; no price that cannot be told apart.
fn step(run: &CostVsWork) -> Option<String> {
    let of = |term| constant(run, ModelRecord::CHOSEN, term);
    let inner = of(ConstantRecord::INNER)?;
    let surprise = of(ConstantRecord::SURPRISE);
    if !identified(inner) {
        return Some(format!(
            "By chosen terms no price of an inner node is given: it cannot be told apart from the {} (variance inflation \
             {}){}",
            surprise.map_or("other terms", |_| "mispredicted branches"),
            inflation(inner),
            surprise.map_or(".".to_owned(), |surprise| format!(
                ". A branch that the simulated predictor gets wrong takes {}, what comes with it included; these branches \
                 make {} % of the time.",
                interval(surprise),
                fixed(100.0 * surprise.share, 0)
            ))
        ));
    }
    Some(match surprise {
        Some(surprise) => format!(
            "By chosen terms an inner node whose branches are predicted takes {}; a branch that the simulated predictor gets wrong \
             adds {}, and these branches make {} % of the time.",
            interval(inner),
            interval(surprise),
            fixed(100.0 * surprise.share, 0)
        ),
        None => format!(
            "By chosen terms an inner node takes {}; mispredicted branches are not among the terms.",
            interval(inner)
        ),
    })
}

/// What came of an expectation; without one, the numbers alone. Beside it, the model of n_K and n_t. `None` where nothing could be
/// compared.
fn judged(run: &CostVsWork, name: &str) -> Option<String> {
    let numbers = |m: &ModelRecord| {
        Some(match name {
            "time-error" => format!(
                "median relative error {} %, mean {} %, worst {} %",
                tenths(m.error_median),
                tenths(m.error_mean),
                tenths(m.error_max)
            ),
            "time-order" => format!(
                "Kendall's tau between predicted and measured times of a scene's trees {} in the mean, {} % of pairs in the right \
                 order",
                fixed(m.tau?, 3),
                tenths(m.pairs_right?)
            ),
            _ => format!(
                "the tree of least predicted time takes {} % more than the fastest in the mean, {} % at worst",
                tenths(m.regret_mean?),
                tenths(m.regret_max?)
            ),
        })
    };
    let expected = run.time_verdicts.verdicts.iter().find(|v| v.name == name);
    let found = match expected {
        Some(v) => {
            let held = if v.held { "held" } else { "missed" };
            format!("{}: **{held}**", v.message)
        }
        None => format!(
            "By chosen terms: {}",
            numbers(model(run, ModelRecord::CHOSEN)?)?
        ),
    };
    let two = numbers(model(run, ModelRecord::TWO)?);
    let beside = two.map_or(String::new(), |two| {
        format!(" By n_K and n_t alone: {two}.")
    });
    Some(format!("{}.{beside}", capitalised(&found)))
}

fn tenths(share: f64) -> String {
    fixed(100.0 * share, 1)
}

/// How well areas alone order the trees by time, beside counts and chosen terms with the rays at hand.
fn areas(run: &CostVsWork) -> Option<String> {
    let all = run.times_order.iter().filter(|o| o.rays == "all");
    let parts: Vec<String> = all
        .map(|o| {
            format!(
                "{}: tau {}, regret {} % in the mean and {} % at worst ({})",
                o.cost,
                fixed(o.tau, 3),
                tenths(o.regret_mean),
                tenths(o.regret_max),
                o.regret_scene
            )
        })
        .collect();
    (!parts.is_empty()).then(|| {
        format!(
            "The order of a scene's trees by time, over all sets of rays. {}.",
            capitalised(&parts.join("; "))
        )
    })
}

/// Where predictions are furthest off.
fn worst(run: &CostVsWork) -> Option<String> {
    let chosen = |row: &PredictionRecord| row.chosen_ns;
    let of = |key: Key| {
        let error = |name: &&str| {
            let own = run.predictions.iter().filter(|row| key.of(row) == *name);
            Residuals::of(own, chosen).map_or(0.0, |found| found.error)
        };
        let names = key.names(run);
        let worst = names.iter().max_by(|a, b| error(a).total_cmp(&error(b)))?;
        Some(format!(
            "{} {worst} ({} %)",
            key.name(),
            tenths(error(worst))
        ))
    };
    let parts: Vec<String> = Key::ALL.into_iter().filter_map(of).collect();
    let (residual, row) = Residuals::of(&run.predictions, chosen)?.worst;
    Some(format!(
        "Chosen terms have the largest median errors for {}; furthest off is {} on {}, stop {}, {}: {} % of {} ns.",
        parts.join(", "),
        row.strategy,
        row.scene,
        row.stop,
        row.rays,
        signed(100.0 * residual, 0),
        fixed(row.measured_ns, 0)
    ))
}
