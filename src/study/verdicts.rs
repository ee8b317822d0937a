//! Verdicts of `hits-vs-area`: each expectation of the plan, and what the estimates say of it.

use crate::stats::holm;

use super::plan::Plan;
use super::records::{CellRecord, Estimate, SamplerRecord, Verdict};
use super::samplers;

/// Every verdict of a run.
pub fn all(
    plan: &Plan,
    cells: &[CellRecord],
    samplers: &[SamplerRecord],
    estimates: &[Estimate],
) -> Vec<Verdict> {
    let (slopes, others): (Vec<&Estimate>, Vec<_>) =
        estimates.iter().partition(|e| e.name == "slope");
    // C is a form of the counts: judging it too would judge them twice.
    let counts: Vec<&Estimate> = others.into_iter().filter(|e| e.name != "C").collect();
    let mut all = vec![identities(cells)];
    all.extend(samplers::verdicts(plan, samplers));
    all.extend(slope_within(plan, &slopes));
    all.extend(simultaneous(plan, "slopes-cover", "1", &slopes));
    all.extend(simultaneous(
        plan,
        "counts-cover",
        "the predicted count",
        &counts,
    ));
    all.extend(gate(plan, cells));
    all
}

fn place(strategy: &str, scene: &str) -> String {
    format!("{strategy} on {scene}")
}

/// A failed identity ends the run with an error, so a finished run has passed them all.
fn identities(cells: &[CellRecord]) -> Verdict {
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

/// Equivalence: the slope is not merely "not rejected", but proved to be close to 1.
fn slope_within(plan: &Plan, slopes: &[&Estimate]) -> Option<Verdict> {
    let bound = plan.expect.slope_within;
    let reach = |e: &Estimate| (e.lo - 1.0).abs().max((e.hi - 1.0).abs());
    let widest = slopes.iter().max_by(|a, b| reach(a).total_cmp(&reach(b)))?;
    let close = slopes.iter().filter(|e| reach(e) <= bound).count();
    Some(Verdict {
        name: "slope-within".into(),
        held: close == slopes.len(),
        message: format!(
            "99 % interval of the slope within 1 ± {} % in {close} of {} cells; widest reach {:.3} % ({})",
            100.0 * bound,
            slopes.len(),
            100.0 * reach(widest),
            place(&widest.strategy, &widest.scene)
        ),
    })
}

/// The intervals of all cells together contain what theory says.
fn simultaneous(plan: &Plan, name: &str, what: &str, estimates: &[&Estimate]) -> Option<Verdict> {
    let missed: Vec<&&Estimate> = estimates.iter().filter(|e| !covers(e)).collect();
    let told = missed.first().map_or(String::new(), |e| {
        format!("; missed: {} of {}", e.name, place(&e.strategy, &e.scene))
    });
    (!estimates.is_empty()).then(|| Verdict {
        name: name.into(),
        held: missed.is_empty(),
        message: format!(
            "{} of {} simultaneous intervals (family {} %) contain {what}{told}",
            estimates.len() - missed.len(),
            estimates.len(),
            100.0 * plan.expect.family
        ),
    })
}

/// Whether the simultaneous interval contains the prediction. Without variance both must be equal but for rounding.
fn covers(e: &Estimate) -> bool {
    let slack = 1e-12 * e.predicted.abs();
    e.lo_all - slack <= e.predicted && e.predicted <= e.hi_all + slack
}

/// Holm over slope, smallest tail and contrasts of all cells.
fn gate(plan: &Plan, cells: &[CellRecord]) -> Option<Verdict> {
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
        held: adjusted[worst] >= plan.expect.gate,
        message: format!(
            "smallest of {} p-values is {p:.2e} ({test}, {}), after Holm {:.3}, at least {} wanted",
            p_values.len(),
            place(&r.strategy, &r.scene),
            adjusted[worst],
            plan.expect.gate
        ),
    })
}
