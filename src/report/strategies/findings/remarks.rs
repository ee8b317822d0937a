//! What the numbers say besides: which scenes rule the means, where greed loses, what the metric's choice costs, how far the
//! seconds can be believed.

use std::fmt::Write;

use super::in_percent;
use crate::report::number::{counted, fixed, percent_above};
use crate::report::strategies::averages::Averages;
use crate::report::strategies::part::{Measure, Part, REFERENCE};
use crate::report::strategies::tables::Spread;
use crate::report::strategies::{greedy, havran};

/// A mean is looked into where it is at least so many per cent.
const TELLING: f64 = 10.0;

/// Least share of a mean that a scene is named for.
const RULING: f64 = 0.1;

/// Which scenes rule the arithmetic means.
pub(super) fn rulers(part: &Part, measure: Measure) -> String {
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
pub(super) fn greedy_loses(part: &Part) -> String {
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
pub(super) fn loss(part: &Part, measure: Measure) -> Option<String> {
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
pub(super) fn disturbances(part: &Part) -> String {
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
