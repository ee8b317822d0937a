//! Tables over sets of rays.

use super::Assumptions;
use super::names::{Broken, words};
use crate::report::means::{arithmetic, geometric};
use crate::report::number::percent_above;
use crate::report::table::{Cell, Column, Table};
use crate::study::records::{BiasRecord, ExactRecord, OrderRecord};

/// A number to so many decimals, if it is known.
pub fn value(value: Option<f64>, decimals: usize) -> Cell {
    value.map_or(Cell::Missing, |value| Cell::Value(value, decimals))
}

/// What is known of a set in all trees.
pub struct OfSet<'r> {
    /// The set.
    pub set: &'r str,
    /// How far the metric errs, a row a tree.
    pub bias: Vec<&'r BiasRecord>,
    /// How it ranks the strategies, a row a scene.
    pub orders: Vec<&'r OrderRecord>,
}

impl<'r> OfSet<'r> {
    /// Every set of a run.
    pub fn all(run: &'r Assumptions) -> Vec<Self> {
        let one = |set| OfSet {
            set,
            bias: run.bias.iter().filter(|row| row.rays == set).collect(),
            orders: run.orders.iter().filter(|row| row.rays == set).collect(),
        };
        run.sets().into_iter().map(one).collect()
    }

    /// A ratio in each tree where it is a positive number.
    fn ratios(&self, of: fn(&BiasRecord) -> Option<f64>) -> Vec<f64> {
        let own = self.bias.iter().filter_map(|row| of(row));
        own.filter(|ratio| *ratio > 0.0).collect()
    }

    /// Least, geometric mean and largest.
    pub fn range(&self, of: fn(&BiasRecord) -> Option<f64>) -> [Option<f64>; 3] {
        let all = self.ratios(of);
        [
            all.iter().copied().reduce(f64::min),
            geometric(&all),
            all.iter().copied().reduce(f64::max),
        ]
    }

    /// Mean scatter of single nodes, a factor.
    pub fn scatter(&self) -> Option<f64> {
        geometric(&self.ratios(|row| row.spread.map(f64::exp)))
    }

    fn rank_correlation(&self) -> Option<f64> {
        let own = self.bias.iter().filter_map(|row| row.rank_correlation);
        arithmetic(&own.collect::<Vec<_>>())
    }

    /// Rank correlations of the scenes.
    pub fn taus(&self) -> Vec<f64> {
        self.orders.iter().filter_map(|row| row.tau).collect()
    }

    fn count(&self, is: fn(&OrderRecord) -> bool) -> u64 {
        self.orders.iter().filter(|row| is(row)).count() as u64
    }

    /// Mean and worst, in per cent, and where.
    pub fn regret(&self) -> (Option<f64>, Option<(f64, &'r str)>) {
        let percent = |row: &&&'r OrderRecord| {
            let regret = row.regret?;
            Some((percent_above(1.0 + regret), &*row.scene))
        };
        let all: Vec<(f64, &str)> = self.orders.iter().filter_map(|row| percent(&row)).collect();
        let mean = arithmetic(&all.iter().map(|one| one.0).collect::<Vec<_>>());
        (mean, all.into_iter().max_by(|a, b| a.0.total_cmp(&b.0)))
    }
}

/// Whether no pair of trees told apart is ranked wrongly.
fn survives(row: &OrderRecord) -> bool {
    row.wrong == 0
}

/// Whether the tree taken is the cheapest.
fn cheapest(row: &OrderRecord) -> bool {
    row.predicted_best == row.counted_best
}

/// How far the metric errs in total and per node, a row a set of rays.
pub fn totals(run: &Assumptions) -> Table {
    let columns = vec![
        Column::left("rays", "rays"),
        Column::left("in words", "words"),
        Column::left("breaks", "breaks"),
        Column::right("inside, %", "inside_pct"),
        Column::right("stopped, %", "stopped_pct"),
        Column::right("trees", "trees"),
        Column::right("C", "c"),
        Column::right("least", "c_least"),
        Column::right("largest", "c_largest"),
        Column::right("n_K", "n_k"),
        Column::right("least", "n_k_least"),
        Column::right("largest", "n_k_largest"),
        Column::right("n_B", "n_b"),
        Column::right("least", "n_b_least"),
        Column::right("largest", "n_b_largest"),
        Column::right("n_t", "n_t"),
        Column::right("least", "n_t_least"),
        Column::right("largest", "n_t_largest"),
        Column::right("nodes ×/÷", "scatter"),
        Column::right("rank correlation", "rank_correlation"),
    ];
    let row = |of: OfSet| {
        let broken = Broken::of(&run.bias, of.set);
        let share = |share: fn(&BiasRecord) -> f64| {
            let all: Vec<f64> = of.bias.iter().map(|row| 100.0 * share(row)).collect();
            value(arithmetic(&all), 0)
        };
        let mut row = vec![
            Cell::Text(of.set.to_owned()),
            Cell::Text(words(of.set)),
            Cell::Text(broken.words()),
            share(|row| row.inside),
            share(|row| row.stopped),
            Cell::Count(of.bias.len() as u64),
        ];
        let ratios: [fn(&BiasRecord) -> Option<f64>; 4] =
            [|row| row.c, |row| row.n_k, |row| row.n_b, |row| row.n_t];
        for ratio in ratios {
            let [least, mean, largest] = of.range(ratio);
            row.extend([mean, least, largest].map(|v| value(v, 3)));
        }
        row.extend([value(of.scatter(), 2), value(of.rank_correlation(), 3)]);
        row
    };
    Table {
        caption: "Counted over predicted, per ray that hits the root's box: tree cost C, inner nodes n_K, leaves n_B and object \
                  tests n_t, as geometric mean over all trees with the least and the largest; 1 where the metric is right. Inside, \
                  stopped: mean shares of the rays that begin in the root's box and that an object stops. Nodes ×/÷: geometric mean \
                  over the trees of exp(s), s being the standard deviation of the logarithm of counted over predicted hits of the \
                  nodes below the root that at least 25 rays are predicted to hit, weighted by p, sampling noise taken out. Rank \
                  correlation: Spearman's, over these nodes, of p and hits, mean over the trees; sampling noise lowers it, as it does the \
                  control's."
            .to_owned(),
        columns,
        keys: 1,
        rows: OfSet::all(run).into_iter().map(row).collect(),
    }
}

/// Whether the metric still ranks trees, a row a set of rays.
pub fn order(run: &Assumptions) -> Table {
    let columns = vec![
        Column::left("rays", "rays"),
        Column::right("scenes", "scenes"),
        Column::right("τ, mean", "tau_mean"),
        Column::right("least", "tau_least"),
        Column::right("order survives", "survives"),
        Column::right("pairs right", "right"),
        Column::right("wrong", "wrong"),
        Column::right("tied", "tied"),
        Column::right("cheapest found", "cheapest"),
        Column::right("regret, %", "regret_mean_pct"),
        Column::right("worst, %", "regret_worst_pct"),
        Column::left("on", "regret_worst_scene"),
    ];
    let row = |of: OfSet| {
        let taus = of.taus();
        let pairs = |of_row: fn(&OrderRecord) -> u64| {
            Cell::Count(of.orders.iter().map(|row| of_row(row)).sum())
        };
        let (mean, worst) = of.regret();
        vec![
            Cell::Text(of.set.to_owned()),
            Cell::Count(of.orders.len() as u64),
            value(arithmetic(&taus), 2),
            value(taus.iter().copied().reduce(f64::min), 2),
            Cell::Count(of.count(survives)),
            pairs(|row| row.right),
            pairs(|row| row.wrong),
            pairs(|row| row.tied),
            Cell::Count(of.count(cheapest)),
            value(mean, 2),
            value(worst.map(|w| w.0), 2),
            worst.map_or(Cell::Missing, |(percent, scene)| {
                let scene = if percent > 0.0 { scene } else { "–" };
                Cell::Text(scene.to_owned())
            }),
        ]
    };
    Table {
        caption: "The strategies ranked by predicted and by counted cost, scene by scene. τ: Kendall's rank correlation. Order survives: \
                  scenes where no pair of trees is ranked wrongly of those that the rays tell apart (99 % intervals of the differences of \
                  their costs over the same rays). Cheapest found: scenes where the tree predicted to be cheapest is the cheapest \
                  counted. Regret: by how much it is dearer than that."
            .to_owned(),
        columns,
        keys: 1,
        rows: OfSet::all(run).into_iter().map(row).collect(),
    }
}

/// Counts against exact expectations.
pub fn exact(run: &Assumptions) -> Table {
    let columns = vec![
        Column::left("rays", "rays"),
        Column::left("scene", "scene"),
        Column::left("strategy", "strategy"),
        Column::left("expected from", "by"),
        Column::right("nodes", "nodes"),
        Column::right("worst: node", "node"),
        Column::right("metric's p", "p"),
        Column::right("expected", "expected"),
        Column::right("± (SE)", "expected_se"),
        Column::right("counted", "counted"),
        Column::right("p-value", "p_value"),
    ];
    let row = |r: &ExactRecord| {
        vec![
            Cell::Text(r.rays.clone()),
            Cell::Text(r.scene.clone()),
            Cell::Text(r.strategy.clone()),
            Cell::Text(r.by.clone()),
            Cell::Count(r.nodes),
            Cell::Count(r.node),
            Cell::Value(r.p, 5),
            Cell::Value(r.expected, 5),
            // Closed forms have none.
            value(Some(r.expected_se).filter(|se| *se > 0.0), 5),
            Cell::Value(r.counted, 5),
            Cell::PValue(r.p_value),
        ]
    };
    Table {
        caption: "Rays that begin inside: the share that hits a node, counted, against what theory expects, from isotropic lines weighted \
                  by their chords, or in closed form for slabs. Of each tree, its largest nodes; shown is the one that fits worst, with \
                  its own p-value, to be multiplied by the number of nodes."
            .to_owned(),
        columns,
        keys: 4,
        rows: run.exact.iter().map(row).collect(),
    }
}
