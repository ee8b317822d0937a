//! Verdicts of `hits-vs-area`: each expectation of the plan, and what the estimates say of it.

use crate::stats::holm;

use super::HitsVsArea;
use super::samplers;
use crate::study::records::{CellRecord, Estimate, SamplerRecord, Verdict};

/// Every verdict of a run.
pub fn all(
    asked: &HitsVsArea,
    cells: &[CellRecord],
    samplers: &[SamplerRecord],
    estimates: &[Estimate],
) -> Vec<Verdict> {
    let (slopes, counts): (Vec<&Estimate>, Vec<_>) =
        estimates.iter().partition(|e| e.name == "slope");
    let mut all = vec![identities(cells)];
    all.extend(samplers::verdicts(asked, samplers));
    all.extend(slope_within(asked, &slopes));
    all.extend(simultaneous(
        asked.expect.family,
        "slopes-cover",
        "1",
        &slopes,
    ));
    all.extend(simultaneous(
        asked.expect.family,
        "counts-cover",
        "the predicted count",
        &counts,
    ));
    all.extend(gate(asked, cells));
    all
}

fn place(strategy: &str, scene: &str) -> String {
    format!("{strategy} on {scene}")
}

/// A failed identity ends the run with an error, so a finished run has passed them all.
pub fn identities(cells: &[CellRecord]) -> Verdict {
    let visits: u64 = cells.iter().map(|r| r.inner_visits + r.leaf_visits).sum();
    Verdict {
        name: "identities".into(),
        held: true,
        message: format!(
            "all integer identities held over {:.2e} visits; streams equal the plain traversal on every node",
            visits as f64
        ),
    }
}

/// Equivalence: the slope is not merely "not rejected", but proved to be close to 1. Where a wanted error of C settled the
/// number of lines, that is the run's aim instead.
fn slope_within(asked: &HitsVsArea, slopes: &[&Estimate]) -> Option<Verdict> {
    if asked.lines.cost_error().is_some() {
        return None;
    }
    let bound = asked.expect.slope_within;
    let reach = |e: &Estimate| Some((e.lo? - 1.0).abs().max((e.hi? - 1.0).abs()));
    let judged: Vec<(f64, &Estimate)> = slopes
        .iter()
        .filter_map(|e| Some((reach(e)?, *e)))
        .collect();
    let (widest, at) = judged.iter().max_by(|a, b| a.0.total_cmp(&b.0))?;
    let close = judged.iter().filter(|(reach, _)| *reach <= bound).count();
    Some(Verdict {
        name: "slope-within".into(),
        held: close == judged.len(),
        message: format!(
            "99 % interval of the slope within 1 ± {} % in {close} of {} cells; widest reach {:.3} % ({}){}",
            100.0 * bound,
            judged.len(),
            100.0 * widest,
            place(&at.strategy, &at.scene),
            unjudged(slopes.len() - judged.len())
        ),
    })
}

/// What is said of estimates without an interval.
fn unjudged(count: usize) -> String {
    if count == 0 {
        return String::new();
    }
    format!(
        "; {count} not judged: their variance hangs on events too rare for the pilot, their nodes' tails stand in"
    )
}

/// The intervals of all cells together contain what theory says.
pub fn simultaneous(
    family: f64,
    name: &str,
    what: &str,
    estimates: &[&Estimate],
) -> Option<Verdict> {
    let judged: Vec<(bool, &Estimate)> = estimates
        .iter()
        .filter_map(|e| Some((covers(e)?, *e)))
        .collect();
    let missed: Vec<String> = judged
        .iter()
        .filter(|(covered, _)| !covered)
        .map(|(_, e)| {
            format!(
                "{} of {} ({} for {})",
                e.name,
                place(&e.strategy, &e.scene),
                e.value,
                e.predicted
            )
        })
        .collect();
    let told = if missed.is_empty() {
        String::new()
    } else {
        format!("; missed: {}", missed.join(", "))
    };
    (!estimates.is_empty()).then(|| Verdict {
        name: name.into(),
        held: missed.is_empty(),
        message: format!(
            "{} of {} simultaneous intervals (family {} %) contain {what}{told}{}",
            judged.len() - missed.len(),
            judged.len(),
            100.0 * family,
            unjudged(estimates.len() - judged.len())
        ),
    })
}

/// Whether the simultaneous interval contains the prediction, but for rounding; `None` without an interval.
fn covers(e: &Estimate) -> Option<bool> {
    let slack = 1e-12 * e.predicted.abs();
    Some(e.lo_all? - slack <= e.predicted && e.predicted <= e.hi_all? + slack)
}

/// Holm over slope, smallest tail and contrasts of all cells.
fn gate(asked: &HitsVsArea, cells: &[CellRecord]) -> Option<Verdict> {
    let tests = |r: &CellRecord| {
        [
            ("slope", r.slope_p),
            ("smallest tail", r.tail_p),
            ("contrasts", r.hotelling_p),
        ]
    };
    let p_values: Vec<(f64, &str, &CellRecord)> = cells
        .iter()
        .flat_map(|r| tests(r).map(|(test, p)| p.map(|p| (p, test, r))))
        .flatten()
        .collect();
    let adjusted = holm(&p_values.iter().map(|v| v.0).collect::<Vec<_>>());
    let worst = (0..adjusted.len()).min_by(|&a, &b| p_values[a].0.total_cmp(&p_values[b].0))?;
    let (p, test, r) = p_values[worst];
    Some(Verdict {
        name: "gate".into(),
        held: adjusted[worst] >= asked.expect.gate,
        message: format!(
            "smallest of {} p-values is {p:.2e} ({test}, {}), after Holm {:.3}, at least {} wanted",
            p_values.len(),
            place(&r.strategy, &r.scene),
            adjusted[worst],
            asked.expect.gate
        ),
    })
}
