//! Which of Havran's findings hold, in sentences made from the numbers.

use std::fmt::Write;

use super::averages::Averages;
use super::greedy;
use super::havran::{self, NAMES};
use super::part::{Measure, Part, REFERENCE};
use super::tables::Spread;
use crate::report::number::{counted, fixed, percent_above, signed};
use crate::report::series::distinct;
use crate::report::text::capitalised;

/// Havran's strategies that take the plane of least cost, and those that take a median.
const COST_DRIVEN: [&str; 3] = [NAMES[2], NAMES[3], NAMES[4]];
const MEDIANS: [&str; 2] = [NAMES[0], NAMES[1]];

/// Strategies differ little where the geometric mean of their ratio is within this of 1. (Havran's means are 0, −3, +7 %.)
const LITTLE: f64 = 0.10;

/// A mean is looked into where it is at least so many per cent.
const TELLING: f64 = 10.0;

/// Least share of a mean that a scene is named for.
const RULING: f64 = 0.1;

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

/// Which scenes rule the arithmetic means.
fn rulers(part: &Part, measure: Measure) -> String {
    let mut text = String::new();
    for strategy in part
        .strategies
        .iter()
        .filter(|name| havran::number(name).is_some())
    {
        let mut ratios = part.ratios(measure, strategy, REFERENCE);
        // The two largest are left out below, and some must stay.
        if ratios.len() < 3 {
            continue;
        }
        ratios.sort_by(|a, b| b.1.total_cmp(&a.1));
        let mean = |ratios: &[(&str, f64)]| {
            ratios
                .iter()
                .map(|&(_, ratio)| percent_above(ratio))
                .sum::<f64>()
                / ratios.len() as f64
        };
        let all = mean(&ratios);
        if all < TELLING {
            continue;
        }
        let share = |ratio: f64| percent_above(ratio) / ratios.len() as f64 / all;
        let ruling: Vec<String> = ratios
            .iter()
            .map(|&(scene, ratio)| (scene, share(ratio)))
            .filter(|&(_, share)| share >= RULING)
            .map(|(scene, share)| format!("{scene} makes {} %", fixed(100.0 * share, 0)))
            .collect();
        let ruling = match ruling.len() {
            0 => format!("no scene makes {} %", fixed(100.0 * RULING, 0)),
            _ => ruling.join(", "),
        };
        let _ = writeln!(
            text,
            "- Arithmetic mean of {strategy}, {} % by {}: {ruling}; without {} and {} it is {} %.",
            in_percent(all),
            measure.name(),
            ratios[0].0,
            ratios[1].0,
            in_percent(mean(&ratios[2..]))
        );
    }
    text
}

/// On how many scenes some tree costs less than the greedy one's.
fn greedy_loses(part: &Part) -> String {
    let better = greedy::better(part);
    let mut text = String::new();
    // A tree beside the reference's must be there to be better.
    if !part.strategies.contains(&REFERENCE) || part.strategies.len() < 2 {
        return text;
    }
    for (i, measure) in Measure::COSTS.into_iter().enumerate() {
        let mut least: Vec<(&str, &str, f64)> = Vec::new();
        for tree in &better {
            let Some(percent) = tree.percent[i].filter(|&percent| percent < -greedy::EQUAL) else {
                continue;
            };
            match least.iter_mut().find(|(scene, ..)| *scene == tree.scene) {
                Some(found) if percent < found.2 => *found = (tree.scene, tree.strategy, percent),
                Some(_) => {}
                None => least.push((tree.scene, tree.strategy, percent)),
            }
        }
        let by = measure.name();
        let of = counted(part.scenes.len() as u64, "scene");
        let most = least.iter().min_by(|a, b| a.2.total_cmp(&b.2));
        let _ = match most {
            None => writeln!(
                text,
                "- By {by} no tree is better than {REFERENCE}'s on any of {of}."
            ),
            Some((scene, strategy, percent)) => writeln!(
                text,
                "- By {by} some tree is better than {REFERENCE}'s on {} of {of}: the best plane of every node does not make \
                 the best tree. Most by {strategy} on {scene}: {} %.",
                least.len(),
                in_percent(*percent)
            ),
        };
    }
    text
}

/// Trees whose trace times differ by less are equally fast: what is left of the machine's noise and of sampling.
const NOISE: f64 = 0.01;

/// What one loses in trace time who takes the tree of least cost.
fn loss(part: &Part, measure: Measure) -> Option<String> {
    let least = |measure, scene: &str| {
        let of = |&strategy: &&'_ str| {
            Some((strategy.to_owned(), part.value(measure, scene, strategy)?))
        };
        let all = part.strategies.iter().filter_map(of);
        all.min_by(|a, b| a.1.total_cmp(&b.1))
    };
    let ratio = |&scene| {
        let (chosen, _) = least(measure, scene)?;
        let (_, fastest) = least(Measure::Trace, scene)?;
        Some((scene, part.value(Measure::Trace, scene, &chosen)? / fastest))
    };
    let ratios: Vec<_> = part.scenes.iter().filter_map(ratio).collect();
    let averages = Averages::of(&ratios)?;
    let close = 1.0 + NOISE;
    let right = ratios.iter().filter(|(_, ratio)| *ratio <= close).count();
    Some(format!(
        "The tree of least {} is the fastest to trace, or within {} % of it, on {right} of {}; taking it costs {} % of trace time over the fastest \
         (geometric mean), at worst {} % on {}.",
        measure.name(),
        fixed(100.0 * NOISE, 0),
        counted(averages.scenes as u64, "scene"),
        in_percent(percent_above(averages.geometric)),
        in_percent(percent_above(averages.worst.1)),
        averages.worst.0
    ))
}

/// How far the seconds can be believed.
fn disturbances(part: &Part) -> String {
    let spreads: Vec<_> = part
        .trees
        .iter()
        .map(|tree| (tree, Spread::of(tree)))
        .collect();
    let timed = spreads
        .iter()
        .filter(|(_, spread)| spread.timed_share.is_some())
        .count();
    if timed == 0 {
        return "No times were kept.".to_owned();
    }
    let sampled = spreads
        .iter()
        .filter(|(_, spread)| spread.timed_share.is_some_and(|share| share < 1.0));
    let disturbed: Vec<_> = spreads
        .iter()
        .filter(|(_, spread)| !spread.disturbed.is_empty())
        .collect();
    let apart = |spread: &Spread| spread.apart.unwrap_or(0.0);
    let worst = disturbed
        .iter()
        .max_by(|a, b| apart(&a.1).total_cmp(&apart(&b.1)));
    let worst = worst.map_or(String::new(), |(tree, spread)| {
        format!(
            " (total furthest apart: {} % for {} on {})",
            fixed(100.0 * apart(spread), 1),
            tree.cell.strategy,
            tree.cell.scene
        )
    });
    format!(
        "Of {} timed, {} had a time whose even and odd rounds are more than 3 % apart{worst}; of {} only a random sample of \
         the rays was timed. Each tree: times-cells.",
        counted(timed as u64, "tree"),
        disturbed.len(),
        sampled.count(),
    )
}
