//! Which of Havran's findings hold, in sentences made from the numbers.

mod remarks;

use std::fmt::Write;

use super::averages::Averages;
use super::havran::NAMES;
use super::part::{Measure, Part, REFERENCE};
use crate::report::number::{counted, fixed, percent_above, signed};
use crate::report::series::distinct;
use crate::report::text::capitalised;
use remarks::{disturbances, greedy_loses, loss, rulers};

/// Havran's strategies that take the plane of least cost, and those that take a median.
const COST_DRIVEN: [&str; 3] = [NAMES[2], NAMES[3], NAMES[4]];
const MEDIANS: [&str; 2] = [NAMES[0], NAMES[1]];

/// Strategies differ little where the geometric mean of their ratio is within this of 1. (Havran's means are 0, −3, +7 %.)
const LITTLE: f64 = 0.10;

/// What the numbers say of a claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Judgement {
    /// Every interval lies where the claim wants it.
    Holds,
    /// Some interval lies outside.
    Fails,
    /// Neither.
    Undecided,
}

impl Judgement {
    /// In words.
    pub fn name(self) -> &'static str {
        match self {
            Self::Holds => "holds",
            Self::Fails => "does not hold",
            Self::Undecided => "undecided",
        }
    }

    /// Of a claim that geometric means lie in this range (of ratios): all of the 99 % intervals inside, one outside, or
    /// neither.
    fn of(averages: &[Averages], range: [f64; 2]) -> Self {
        let [low, high] = range;
        let intervals = || averages.iter().map(|a| a.interval);
        if intervals().all(|i| i.is_some_and(|[lo, hi]| lo > low && hi < high)) {
            Self::Holds
        } else if intervals().flatten().any(|[lo, hi]| hi < low || lo > high) {
            Self::Fails
        } else {
            Self::Undecided
        }
    }
}

/// A claim of Havran's, judged by one measure.
pub struct Finding {
    /// The claim, short.
    pub claim: &'static str,
    /// What is judged by.
    pub measure: Measure,
    /// What came of it.
    pub judgement: Judgement,
    /// The numbers, in words.
    pub numbers: String,
}

/// His findings, as far as the run has their strategies, by one measure.
pub fn judged(part: &Part, measure: Measure) -> Vec<Finding> {
    let findings = [
        cost_beats_medians(part, measure),
        cost_driven_alike(part, measure),
        object_beats_spatial(part, measure),
    ];
    findings.into_iter().flatten().collect()
}

/// A geometric mean and its interval: "+88 % (+41 to +150)".
fn geometric(averages: &Averages) -> String {
    let show = |ratio| in_percent(percent_above(ratio));
    let interval = averages.interval.map_or(String::new(), |[lo, hi]| {
        format!(" ({} to {})", show(lo), show(hi))
    });
    format!("{} %{interval}", show(averages.geometric))
}

fn in_percent(percent: f64) -> String {
    signed(percent, usize::from(percent.abs() < 10.0))
}

fn over<'r>(
    part: &Part<'r>,
    measure: Measure,
    strategy: &str,
    other: &str,
) -> Option<Averages<'r>> {
    Averages::of(&part.ratios(measure, strategy, other))
}

fn cost_beats_medians(part: &Part, measure: Measure) -> Option<Finding> {
    let pairs = MEDIANS
        .iter()
        .flat_map(|m| COST_DRIVEN.iter().map(move |c| (*m, *c)));
    let averages = pairs.map(|(median, cost)| over(part, measure, median, cost));
    let averages = averages.collect::<Option<Vec<_>>>()?;
    let value = |scene, strategy: &&str| part.value(measure, scene, strategy);
    let all = |scene, strategies: &[&str]| -> Option<Vec<f64>> {
        strategies
            .iter()
            .map(|strategy| value(scene, strategy))
            .collect()
    };
    let both = part
        .scenes
        .iter()
        .filter_map(|scene| Some((all(scene, &MEDIANS)?, all(scene, &COST_DRIVEN)?)));
    let beaten = both
        .clone()
        .filter(|(medians, costs)| costs.iter().all(|c| medians.iter().all(|m| c < m)));
    let against_reference = MEDIANS.map(|median| over(part, measure, median, REFERENCE));
    let [spatial, object] = against_reference.map(|a| a.as_ref().map_or(String::new(), geometric));
    Some(Finding {
        claim: "cost-driven strategies (3, 4, 5) beat both medians (1, 2)",
        measure,
        judgement: Judgement::of(&averages, [1.0, f64::INFINITY]),
        numbers: format!(
            "all three beat both on {} of {}; against {REFERENCE}, {} takes {spatial} and {} {object}",
            beaten.count(),
            counted(both.count() as u64, "scene"),
            MEDIANS[0],
            MEDIANS[1],
        ),
    })
}

fn cost_driven_alike(part: &Part, measure: Measure) -> Option<Finding> {
    let others = [COST_DRIVEN[1], COST_DRIVEN[2]];
    let averages = others.map(|strategy| over(part, measure, strategy, REFERENCE));
    let [Some(between), Some(cyclic)] = averages else {
        return None;
    };
    let ends = |a: &Averages| {
        let end = |(scene, ratio): (&str, f64)| {
            format!("{} % on {scene}", in_percent(percent_above(ratio)))
        };
        format!("{}, from {} to {}", geometric(a), end(a.best), end(a.worst))
    };
    Some(Finding {
        claim: "cost-driven strategies (3, 4, 5) differ little",
        measure,
        numbers: format!(
            "against {REFERENCE}, {} takes {} and {} {}",
            others[0],
            ends(&between),
            others[1],
            ends(&cyclic)
        ),
        judgement: Judgement::of(&[between, cyclic], [1.0 - LITTLE, 1.0 + LITTLE]),
    })
}

fn object_beats_spatial(part: &Part, measure: Measure) -> Option<Finding> {
    let [spatial, object] = MEDIANS;
    let ratios = part.ratios(measure, spatial, object);
    let averages = Averages::of(&ratios)?;
    let slower = ratios.iter().filter(|(_, ratio)| *ratio > 1.0).count();
    Some(Finding {
        claim: "the object median (2) beats the spatial one (1), which the one-level theory calls its equal",
        measure,
        numbers: format!(
            "against {object}, {spatial} takes {}, median {} %, and more on {slower} of {}{}",
            geometric(&averages),
            in_percent(percent_above(averages.median)),
            counted(ratios.len() as u64, "scene"),
            arithmetic(part, measure),
        ),
        judgement: Judgement::of(&[averages], [1.0, f64::INFINITY]),
    })
}

/// Both medians by the arithmetic mean, as Havran took it.
fn arithmetic(part: &Part, measure: Measure) -> String {
    let means = MEDIANS.map(|median| over(part, measure, median, REFERENCE));
    let [Some(spatial), Some(object)] = means else {
        return String::new();
    };
    format!(
        "; by the arithmetic mean against {REFERENCE}, as he took it, {} takes {} % and {} {} %",
        MEDIANS[0],
        in_percent(percent_above(spatial.mean)),
        MEDIANS[1],
        in_percent(percent_above(object.mean))
    )
}

/// The findings by exact cost.
pub fn by_cost(part: &Part) -> String {
    let mut text = head(part, "By cost");
    text += &claims(part, &[Measure::Counted, Measure::Traced]);
    text += &rulers(part, Measure::Counted);
    text += &greedy_loses(part);
    text
}

/// The findings by seconds, and how far the seconds can be believed.
pub fn by_time(part: &Part) -> String {
    let mut text = head(part, "By time");
    text += &claims(part, &[Measure::Total, Measure::Trace]);
    text += &rulers(part, Measure::Total);
    for measure in [Measure::Predicted, Measure::Traced] {
        if let Some(loss) = loss(part, measure) {
            let _ = writeln!(text, "- {loss}");
        }
    }
    let _ = writeln!(text, "- {}", disturbances(part));
    text
}

fn head(part: &Part, by: &str) -> String {
    format!(
        "{by}: {}, {}, stop {}. Geometric means with their 99 % intervals (Student's t of the logarithms, the sizes \
         of one scene together being one observation). A claim holds where all its intervals lie on its side, and does not where one lies on the other; \
         strategies differ little within {} %.\n\n",
        counted(part.scenes.len() as u64, "scene"),
        match part.strategies.len() {
            1 => "1 strategy".to_owned(),
            n => format!("{n} strategies"),
        },
        part.stop,
        fixed(100.0 * LITTLE, 0)
    )
}

/// A point for each claim, and one below it for each measure.
fn claims(part: &Part, measures: &[Measure]) -> String {
    let all: Vec<_> = measures
        .iter()
        .flat_map(|&measure| judged(part, measure))
        .collect();
    let mut text = String::new();
    for claim in distinct(all.iter().map(|finding| finding.claim)) {
        let _ = writeln!(text, "- {}.", capitalised(claim));
        for finding in all.iter().filter(|finding| finding.claim == claim) {
            let _ = writeln!(
                text,
                "  - By {}: **{}**; {}.",
                finding.measure.name(),
                finding.judgement.name(),
                finding.numbers
            );
        }
    }
    text
}
