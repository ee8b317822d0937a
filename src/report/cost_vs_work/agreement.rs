//! How well areas put the trees of many scenes into the order of what is counted.

use crate::study::records::TreeOrderRecord;

/// Orders of several scenes together.
#[derive(Clone, Debug, PartialEq)]
pub struct Agreement<'r> {
    /// Mean of Kendall's tau-b over the scenes that have one.
    pub tau: Option<f64>,
    /// Share of all pairs of trees that are in the right order.
    pub pairs_right: Option<f64>,
    /// Scenes.
    pub scenes: u64,
    /// Scenes whose tree of least C predicted is the one of least C counted.
    pub cheapest_right: u64,
    /// Mean regret.
    pub regret_mean: f64,
    /// Worst regret, and its scene.
    pub regret_worst: (f64, &'r str),
}

impl<'r> Agreement<'r> {
    /// Of scenes whose regret is known; `None` without one.
    pub fn of(orders: impl IntoIterator<Item = &'r TreeOrderRecord>) -> Option<Self> {
        let orders: Vec<&TreeOrderRecord> = orders.into_iter().collect();
        let regrets: Vec<(f64, &str)> = orders
            .iter()
            .filter_map(|order| Some((order.regret?, order.scene.as_str())))
            .collect();
        let taus: Vec<f64> = orders.iter().filter_map(|order| order.tau).collect();
        let pairs: u64 = orders.iter().map(|order| order.pairs).sum();
        let right: u64 = orders.iter().map(|order| order.pairs_right).sum();
        let &regret_worst = regrets.iter().max_by(|a, b| a.0.total_cmp(&b.0))?;
        Some(Self {
            tau: (!taus.is_empty()).then(|| taus.iter().sum::<f64>() / taus.len() as f64),
            pairs_right: (pairs > 0).then(|| right as f64 / pairs as f64),
            scenes: regrets.len() as u64,
            cheapest_right: regrets.iter().filter(|(regret, _)| *regret == 0.0).count() as u64,
            regret_mean: regrets.iter().map(|(regret, _)| regret).sum::<f64>()
                / regrets.len() as f64,
            regret_worst,
        })
    }
}
