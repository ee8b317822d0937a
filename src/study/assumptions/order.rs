//! Does the metric rank the strategies' trees as the rays do?

use crate::stats::{ScoreMoments, Taken, kendall_tau_b, simultaneous_quantile, take_least};
use crate::study::LEVEL;
use crate::study::records::OrderRecord;

/// The tree of one strategy.
pub struct Ranked<'a> {
    /// The strategy.
    pub strategy: String,
    /// C predicted.
    pub predicted: f64,
    /// What each ray of the set cost in it: the same rays in the same order in every tree.
    pub costs: &'a [f64],
}

impl Ranked<'_> {
    fn counted(&self) -> f64 {
        self.costs.iter().sum::<f64>() / self.costs.len() as f64
    }

    /// By how much the other tree is dearer, counted, where the rays tell: 0 where 0 lies in the interval of the difference.
    /// All rays there are have no interval.
    /// The intervals of all `pairs` hold together.
    fn dearer(&self, other: &Self, complete: bool, pairs: usize) -> f64 {
        let mut moments = ScoreMoments::<1>::default();
        for (mine, theirs) in self.costs.iter().zip(other.costs) {
            moments.push([theirs - mine]);
        }
        let [difference] = moments.mean().unwrap_or_default();
        let variance = moments.covariance().map_or(0.0, |c| c[0][0]);
        let se = (variance / moments.n().max(1) as f64).sqrt();
        let reach = if complete {
            0.0
        } else {
            simultaneous_quantile(LEVEL, pairs) * se
        };
        if difference.abs() <= reach {
            0.0
        } else {
            difference
        }
    }
}

/// The row of a scene, a set of rays and the metric that ranks its trees; `None` without trees.
pub fn order(
    scene: &str,
    rays: &str,
    metric: &str,
    complete: bool,
    trees: &[Ranked<'_>],
) -> Option<OrderRecord> {
    let predicted: Vec<f64> = trees.iter().map(|t| t.predicted).collect();
    let counted: Vec<f64> = trees.iter().map(Ranked::counted).collect();
    let pairs = (trees.len() * trees.len().saturating_sub(1) / 2).max(1);
    let [mut right, mut wrong, mut tied] = [0, 0, 0];
    for (i, tree) in trees.iter().enumerate() {
        for other in &trees[i + 1..] {
            let agreement =
                (other.predicted - tree.predicted) * tree.dearer(other, complete, pairs);
            let kind = if agreement > 0.0 {
                &mut right
            } else if agreement < 0.0 {
                &mut wrong
            } else {
                &mut tied
            };
            *kind += 1;
        }
    }
    let Taken {
        taken,
        cheapest,
        regret,
    } = take_least(&predicted, &counted)?;
    Some(OrderRecord {
        scene: scene.into(),
        rays: rays.into(),
        metric: metric.into(),
        trees: trees.len() as u64,
        tau: kendall_tau_b(&predicted, &counted),
        right,
        wrong,
        tied,
        predicted_best: trees[taken].strategy.clone(),
        counted_best: trees[cheapest].strategy.clone(),
        regret: regret.filter(|_| counted[cheapest] > 0.0),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_are_right_wrong_or_tied() {
        let tree = |strategy: &str, predicted, costs| Ranked {
            strategy: strategy.into(),
            predicted,
            costs,
        };
        // b costs 2 more than a for every ray; c costs as much as a in the mean, give or take.
        let (a, b, c) = (
            [1.0, 2.0, 6.0, 3.0],
            [3.0, 4.0, 8.0, 5.0],
            [4.0, 1.0, 3.1, 4.0],
        );
        let trees = [
            tree("a", 5.0, &a[..]),
            tree("b", 4.0, &b[..]),
            tree("c", 9.0, &c[..]),
        ];
        let row = order("s", "r", "m", false, &trees).expect("trees");
        assert_eq!((row.right, row.wrong, row.tied), (0, 1, 2));
        // All rays there are: c is dearer than a by 0.025 and cheaper than b.
        let row = order("s", "r", "m", true, &trees).expect("trees");
        assert_eq!((row.right, row.wrong, row.tied), (1, 2, 0));
        assert_eq!((&*row.predicted_best, &*row.counted_best), ("b", "a"));
        assert_eq!(row.regret, Some(5.0 / 3.0 - 1.0));
        assert!((row.tau.expect("three trees") + 1.0 / 3.0).abs() < 1e-15);
        assert_eq!(order("s", "r", "m", true, &[]), None);
    }
}
