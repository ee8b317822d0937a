//! From counts to records: what one cell's counts say of its predictions.

use crate::kd::{Counts, NodeKind, Prediction, Tree};
use crate::stats::{
    Hotelling, binomial_tail, hotelling, least_squares, student_p, weighted_least_squares,
};

use super::cell::CellPlan;
use super::scores::{CONTRASTS, FIRST_CONTRAST, FIRST_SCORE, FREE, ORDINARY, Scoring, WEIGHTED};
use super::spread::Spread;
use crate::study::records::{BinRecord, CellRecord, NodeRecord};

/// Hits and misses expected of a node below which its z is far from normal.
const LEAST_EXPECTED: f64 = 10.0;

/// Everything known of a cell once it is counted.
pub struct Found<'a> {
    /// The cell.
    pub plan: &'a CellPlan<'a>,
    /// Its tree.
    pub tree: &'a Tree,
    /// What the areas predict.
    pub prediction: &'a Prediction,
    /// What a visit adds to a line's scores.
    pub scoring: &'a Scoring,
    /// How what is observed of a line varies.
    pub spread: &'a Spread,
    /// Lines behind the spread.
    pub pilot: u64,
    /// All lines, counted.
    pub counts: &'a Counts,
}

impl Found<'_> {
    /// A row for every node.
    pub fn nodes(&self) -> Vec<NodeRecord> {
        let depths = self.tree.depths();
        let n = self.counts.lines;
        let row = |i: usize| {
            let (p, hits) = (self.prediction.p[i], self.counts.hits[i]);
            let tested = self.scoring.included[i];
            let leaf = matches!(self.tree.nodes[i].kind(), NodeKind::Leaf { .. });
            NodeRecord {
                cell: self.plan.id.clone(),
                scene: self.plan.scene.name.clone(),
                strategy: self.plan.rules.strategy.name(),
                node: i as u64,
                depth: depths[i].into(),
                kind: if leaf { "leaf" } else { "inner" }.into(),
                area: self.tree.boxes[i].surface_area(),
                p,
                hits,
                lines: n,
                z: tested.then(|| (hits as f64 / n as f64 - p) / (p * (1.0 - p) / n as f64).sqrt()),
                tail: tested.then(|| binomial_tail(hits, n, p)),
            }
        };
        (0..self.tree.nodes.len()).map(row).collect()
    }

    /// The cell's row, from its nodes' rows.
    pub fn record(&self, nodes: &[NodeRecord]) -> CellRecord {
        let CellPlan {
            id,
            scene,
            rules,
            seed,
            ..
        } = self.plan;
        let Counts { lines, work, .. } = *self.counts;
        let n = lines as f64;
        let per_line = |count: u64| count as f64 / n;

        // Work: the counts of a line are independent of other lines'; C is a linear form of them.
        let cost = rules.cost;
        let (n_k, n_b, n_t) = (
            per_line(work.inner),
            per_line(work.leaves),
            per_line(work.tests),
        );
        let Prediction {
            n_k: p_k,
            n_b: p_b,
            n_t: p_t,
            ..
        } = *self.prediction;
        let (c_predicted, c_counted) = (cost.cost(p_k, p_b, p_t), cost.cost(n_k, n_b, n_t));
        let equal = |a: f64, b: f64| (a - b).abs() <= 1e-12 * a.abs();
        let se = |weights: [f64; 3], predicted: f64, counted: f64| {
            let form: Vec<_> = weights.into_iter().enumerate().collect();
            self.spread
                .standard_error(&form, n, equal(predicted, counted))
        };

        let fit = self.fit(nodes);
        let tested = || nodes.iter().filter(|r| r.tail.is_some());
        let smallest_tail = tested().filter_map(|r| r.tail).reduce(f64::min);
        CellRecord {
            cell: id.clone(),
            scene: scene.name.clone(),
            objects: scene.bounds.len() as u64,
            strategy: rules.strategy.name(),
            stop: rules.stop.to_string(),
            clipped: rules.clipped,
            seed: *seed,
            lines,
            pilot_lines: self.pilot,
            c_k: cost.c_k,
            c_b: cost.c_b,
            c_t: cost.c_t,
            depth: self.tree.depth as u64,
            inner_nodes: self.tree.inner_nodes() as u64,
            leaves: self.tree.leaves() as u64,
            empty_leaves: self.tree.empty_leaves() as u64,
            references: self.tree.references.len() as u64,
            bytes: self.tree.bytes() as u64,
            zero_area_nodes: nodes.iter().filter(|r| r.p == 0.0).count() as u64,
            unhit_nodes: tested().filter(|r| r.hits == 0).count() as u64,
            inner_visits: work.inner,
            leaf_visits: work.leaves,
            object_tests: work.tests,
            n_k_predicted: p_k,
            n_k_counted: n_k,
            n_k_se: se([1.0, 0.0, 0.0], p_k, n_k),
            n_b_predicted: p_b,
            n_b_counted: n_b,
            n_b_se: se([0.0, 1.0, 0.0], p_b, n_b),
            n_t_predicted: p_t,
            n_t_counted: n_t,
            n_t_se: se([0.0, 0.0, 1.0], p_t, n_t),
            c_predicted,
            c_counted,
            c_se: se([cost.c_k, cost.c_b, cost.c_t], c_predicted, c_counted),
            slope: fit.slope.value,
            slope_se: fit.slope.se,
            slope_ols: fit.ordinary.value,
            slope_ols_se: fit.ordinary.se,
            free_intercept: fit.intercept.value,
            free_intercept_se: fit.intercept.se,
            free_slope: fit.free_slope.value,
            free_slope_se: fit.free_slope.se,
            free_p: fit.free_p,
            unexplained: fit.unexplained.map(|u| u.0),
            unexplained_expected: fit.unexplained.map(|u| u.1),
            max_abs_z: tested()
                .filter(|r| (LEAST_EXPECTED..=n - LEAST_EXPECTED).contains(&(n * r.p)))
                .filter_map(|r| r.z)
                .map(f64::abs)
                .reduce(f64::max),
            smallest_tail,
            slope_p: fit
                .slope
                .value
                .zip(fit.slope.se)
                .map(|(b, se)| self.p_of(b - 1.0, se)),
            tail_p: smallest_tail.map(|t| (t * self.scoring.nodes as f64).min(1.0)),
            hotelling_p: (fit.contrasts > 0).then_some(fit.contrasts_p),
            contrasts: fit.contrasts,
        }
    }

    /// Two-sided p of a deviation. Without variance there may be no deviation either, but for rounding.
    fn p_of(&self, deviation: f64, se: f64) -> f64 {
        if se == 0.0 {
            return if deviation.abs() < 1e-12 { 1.0 } else { 0.0 };
        }
        student_p(deviation / se, (self.pilot - 1) as f64)
    }

    fn fit(&self, nodes: &[NodeRecord]) -> Fits {
        let n = self.counts.lines;
        let (mut p, mut y, mut weights) = (Vec::new(), Vec::new(), Vec::new());
        for r in nodes.iter().filter(|r| r.tail.is_some()) {
            p.push(r.p);
            y.push(r.hits as f64 / n as f64);
            weights.push(1.0 / (r.p * (1.0 - r.p)));
        }
        let measured = |score: usize, value: Option<f64>, expected: f64| {
            let as_predicted = value.is_some_and(|v| (v - expected).abs() < 1e-12);
            let form = [(FIRST_SCORE + score, 1.0)];
            Measured {
                value,
                se: value.and_then(|_| self.spread.standard_error(&form, n as f64, as_predicted)),
            }
        };

        let weighted = weighted_least_squares(&p, 1, &y, &weights).ok();
        let ordinary = least_squares(&p, 1, &y).ok();
        let with_ones: Vec<f64> = p.iter().flat_map(|&p| [1.0, p]).collect();
        let free = if self.scoring.has_free_line {
            weighted_least_squares(&with_ones, 2, &y, &weights).ok()
        } else {
            None
        };
        let free = |i: usize| free.as_ref().map(|f| f.coefficients[i]);
        let (a, b) = (free(0), free(1));

        let expected = {
            let noise: f64 = p.iter().map(|p| p * (1.0 - p)).sum();
            let signal: f64 = p.iter().map(|p| p * p).sum();
            noise / (n as f64 * signal)
        };
        let unexplained = ordinary.as_ref().and_then(|f| f.r_squared_uncentred);
        let both = [FIRST_SCORE + FREE, FIRST_SCORE + FREE + 1];
        let free_deviation = a.zip(b).map(|(a, b)| [a, b - 1.0]);
        let free_test = free_deviation
            .and_then(|d| self.test(&d, &both))
            .map(|t| t.p);

        let hits = self.scoring.by_contrast(|i| self.counts.hits[i] as f64);
        let predicted = self.scoring.by_contrast(|i| self.prediction.p[i]);
        // Contrasts whose variance the pilot cannot tell are left out: their nodes have their own tails.
        let kept: Vec<usize> = (0..CONTRASTS)
            .filter(|c| self.spread.is_reliable(FIRST_CONTRAST + c))
            .collect();
        let deviation: Vec<f64> = kept
            .iter()
            .map(|&c| hits[c] / n as f64 - predicted[c])
            .collect();
        let quantities: Vec<usize> = kept.iter().map(|c| FIRST_CONTRAST + c).collect();
        let contrasts = self.test(&deviation, &quantities);
        Fits {
            slope: measured(WEIGHTED, weighted.map(|f| f.coefficients[0]), 1.0),
            unexplained: unexplained.map(|r| (1.0 - r, expected)),
            ordinary: measured(ORDINARY, ordinary.map(|f| f.coefficients[0]), 1.0),
            intercept: measured(FREE, a, 0.0),
            free_slope: measured(FREE + 1, b, 1.0),
            free_p: free_test,
            contrasts: contrasts.map_or(0, |t| t.contrasts as u64),
            contrasts_p: contrasts.map_or(1.0, |t| t.p),
        }
    }

    /// Hotelling's test of a deviation of some quantities, or `None` if there is none or one of them is not reliable.
    fn test(&self, deviation: &[f64], quantities: &[usize]) -> Option<Hotelling> {
        let reliable = quantities.iter().all(|&q| self.spread.is_reliable(q));
        let pairs = quantities
            .iter()
            .flat_map(|&i| quantities.iter().map(move |&j| (i, j)));
        let covariance: Vec<f64> = pairs.map(|(i, j)| self.spread.covariance(i, j)).collect();
        (reliable && !quantities.is_empty())
            .then(|| hotelling(deviation, &covariance, self.counts.lines, self.pilot))
    }

    /// Nodes by p in eighths of a decade.
    pub fn bins(&self, nodes: &[NodeRecord]) -> Vec<BinRecord> {
        let mut bins = std::collections::BTreeMap::<i64, BinRecord>::new();
        let edge = |bin: i64| libm::pow(10.0, bin as f64 / 8.0);
        for r in nodes.iter().filter(|r| r.tail.is_some()) {
            let z = r.z.expect("a tested node has z");
            let bin = libm::floor(8.0 * libm::log10(r.p)) as i64;
            let record = bins.entry(bin).or_insert_with(|| BinRecord {
                cell: r.cell.clone(),
                scene: r.scene.clone(),
                strategy: r.strategy.clone(),
                p_lo: edge(bin),
                p_hi: edge(bin + 1),
                nodes: 0,
                p_sum: 0.0,
                hits: 0,
                lines: r.lines,
                z_mean: 0.0,
                z_rms: 0.0,
                z_max_abs: 0.0,
            });
            record.nodes += 1;
            record.p_sum += r.p;
            record.hits += r.hits;
            record.z_mean += z;
            record.z_rms += z * z;
            record.z_max_abs = record.z_max_abs.max(z.abs());
        }
        for record in bins.values_mut() {
            record.z_mean /= record.nodes as f64;
            record.z_rms = (record.z_rms / record.nodes as f64).sqrt();
        }
        bins.into_values().rev().collect()
    }
}

/// A value and its standard error, where they exist.
struct Measured {
    value: Option<f64>,
    se: Option<f64>,
}

struct Fits {
    slope: Measured,
    ordinary: Measured,
    intercept: Measured,
    free_slope: Measured,
    free_p: Option<f64>,
    /// 1 - R^2 and its expectation.
    unexplained: Option<(f64, f64)>,
    /// Independent contrasts tested, and Hotelling's p.
    contrasts: u64,
    contrasts_p: f64,
}
