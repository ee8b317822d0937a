//! Verdicts of `assumptions`: each expectation of the plan, and what the counts say of it.

use crate::kd::Ask;
use crate::rays::Source;
use crate::stats::normal_quantile;
use crate::stats::simultaneous_quantile;
use crate::study::hits::verdicts::simultaneous;
use crate::study::records::{Estimate, ExactRecord, OrderRecord, Verdict, WorkRecord};
use crate::study::{LEVEL, ray_sets::RaysOf};

use super::asked::{Assumptions, Expect, is_control};

/// Every verdict of a run.
pub fn all(
    asked: &Assumptions,
    work: &[&WorkRecord],
    orders: &[&OrderRecord],
    exact: &[&ExactRecord],
    control: &[Estimate],
) -> Vec<Verdict> {
    let control: Vec<&Estimate> = control.iter().collect();
    let Expect { family, .. } = asked.expect;
    [
        simultaneous(family, "control", "the predicted count", &control),
        agrees(family, exact),
        stops_less(work),
        order(asked.expect, orders),
        regret(asked.expect, orders),
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// The counts of the rays that keep every assumption, with their intervals.
pub fn control(asked: &Assumptions, work: &[&WorkRecord]) -> Vec<Estimate> {
    let is_control = |row: &&&WorkRecord| row.rays.parse::<RaysOf>().is_ok_and(is_control);
    let rows: Vec<_> = work.iter().filter(is_control).collect();
    if rows.is_empty() {
        return Vec::new();
    }
    let each = normal_quantile(LEVEL);
    let all = simultaneous_quantile(1.0 - asked.expect.family, 3 * rows.len());
    let estimates = |row: &&&WorkRecord| {
        [
            ("n_K", row.n_k_counted, row.n_k_se, row.n_k_predicted),
            ("n_B", row.n_b_counted, row.n_b_se, row.n_b_predicted),
            ("n_t", row.n_t_counted, row.n_t_se, row.n_t_predicted),
        ]
        .map(|(name, value, se, predicted)| {
            let end = |reach: f64| se.map(|se| value + reach * se);
            Estimate {
                name: name.into(),
                scene: row.scene.clone(),
                strategy: row.strategy.clone(),
                stop: row.stop.clone(),
                value,
                lo: end(-each),
                hi: end(each),
                se,
                n: row.cast,
                predicted,
                lo_all: end(-all),
                hi_all: end(all),
            }
        })
    };
    rows.iter().flat_map(estimates).collect()
}

/// Rays that begin inside hit every node as often as theory says.
fn agrees(family: f64, exact: &[&ExactRecord]) -> Option<Verdict> {
    let worst = exact
        .iter()
        .min_by(|a, b| a.p_value.total_cmp(&b.p_value))?;
    let nodes: u64 = exact.iter().map(|row| row.nodes).sum();
    let corrected = (nodes as f64 * worst.p_value).min(1.0);
    Some(Verdict {
        name: "exact".into(),
        held: corrected >= family,
        message: format!(
            "rays that begin inside, held against weighted isotropic lines and closed forms on {nodes} nodes of {} trees: \
             smallest p-value, times the nodes, {corrected:.3} ({} of {}, strategy {}, node {}: {:.5} counted, {:.5} \
             expected with a standard error of {:.5} besides that of the count), at least {family} wanted",
            trees(exact),
            worst.rays,
            worst.scene,
            worst.strategy,
            worst.node,
            worst.counted,
            worst.expected,
            worst.expected_se
        ),
    })
}

fn trees(exact: &[&ExactRecord]) -> usize {
    let mut all: Vec<_> = exact.iter().map(|r| (&r.scene, &r.strategy)).collect();
    all.sort_unstable();
    all.dedup();
    all.len()
}

/// Of the same rays, those that objects stop visit and test no more than those that nothing stops.
fn stops_less(work: &[&WorkRecord]) -> Option<Verdict> {
    let endless = |row: &WorkRecord| {
        let (source, ask) = source_of(&row.rays)?;
        let same = |other: &&&WorkRecord| {
            other.cell == row.cell && source_of(&other.rays) == Some((source, Ask::All))
        };
        work.iter().find(same).filter(|_| ask != Ask::All)
    };
    let pairs: Vec<_> = work
        .iter()
        .filter_map(|row| Some((row, endless(row)?)))
        .collect();
    let less = |(stopped, endless): &&(&&WorkRecord, &&WorkRecord)| {
        let work = |r: &WorkRecord| [r.inner_visits, r.leaf_visits, r.object_tests];
        let (stopped, endless) = (work(stopped), work(endless));
        stopped.iter().zip(endless).all(|(a, b)| *a <= b)
    };
    let held = pairs.iter().filter(less).count();
    (!pairs.is_empty()).then(|| Verdict {
        name: "stops-less".into(),
        held: held == pairs.len(),
        message: format!(
            "of the same rays, those that stop at hits visit and test no more than those that nothing stops: in {held} of {} \
             cases (trees by sets of rays)",
            pairs.len()
        ),
    })
}

/// Whether a set is of a source, and which: to find the sets of the same rays that ask something else.
fn source_of(set: &str) -> Option<(Source, Ask)> {
    match set.parse() {
        Ok(RaysOf::Source(source, ask)) => Some((source, ask)),
        _ => None,
    }
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// The metric ranks the trees much as the rays do, over all.
fn order(expect: Expect, orders: &[&OrderRecord]) -> Option<Verdict> {
    let taus: Vec<f64> = orders.iter().filter_map(|row| row.tau).collect();
    let unlike = orders.iter().filter(|row| row.wrong > 0).count();
    let mean = mean(&taus);
    (!taus.is_empty()).then(|| Verdict {
        name: "order".into(),
        held: mean >= expect.tau,
        message: format!(
            "Kendall's tau of cost predicted and counted, over the strategies: {mean:.2} in the mean of {} cases (scenes by sets \
             of rays), at least {} wanted; in {unlike} of {} cases a pair of trees that the rays tell apart is the other way \
             round",
            taus.len(),
            expect.tau,
            orders.len()
        ),
    })
}

/// Taking the tree predicted to be cheapest costs little, over all.
fn regret(expect: Expect, orders: &[&OrderRecord]) -> Option<Verdict> {
    let told: Vec<(f64, &OrderRecord)> = orders
        .iter()
        .filter_map(|row| Some((row.regret?, *row)))
        .collect();
    let regrets: Vec<f64> = told.iter().map(|one| one.0).collect();
    let (worst, at) = told.iter().max_by(|a, b| a.0.total_cmp(&b.0))?;
    let mean = mean(&regrets);
    Some(Verdict {
        name: "regret".into(),
        held: mean <= expect.regret,
        message: format!(
            "the tree predicted to be cheapest costs {:.1} % more than the cheapest counted, in the mean of {} cases, at most {} % \
             wanted; worst {:.0} % ({} rays of {})",
            100.0 * mean,
            regrets.len(),
            100.0 * expect.regret,
            100.0 * worst,
            at.rays,
            at.scene
        ),
    })
}
