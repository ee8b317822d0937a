//! From counts to records: what one cell's counts say of its predictions.

use crate::kd::{Counts, NodeKind, Prediction, Tree};
use crate::stats::{binomial_tail, hotelling, least_squares, student_p, weighted_least_squares};

use super::cell::CellPlan;
use super::records::{BinRecord, CellRecord, NodeRecord};
use super::scores::{FREE, ORDINARY, Scored, Scoring, WEIGHTED};

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
    /// The pilot's lines, scored one by one.
    pub scored: &'a Scored,
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
        let covariance = self
            .scored
            .work
            .covariance()
            .expect("a pilot of at least two lines");
        let variance = |a: [f64; 3]| -> f64 {
            let terms = (0..9).map(|i| a[i / 3] * a[i % 3] * covariance[i]);
            terms.sum::<f64>().max(0.0)
        };
        let se = |a: [f64; 3]| (variance(a) / n).sqrt();
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

        let fit = self.fit(nodes);
        let tested = || nodes.iter().filter(|r| r.tail.is_some());
        let smallest_tail = tested().filter_map(|r| r.tail).reduce(f64::min);
        CellRecord {
            cell: id.clone(),
            scene: scene.name.clone(),
            objects: scene.bounds.len() as u64,
            strategy: rules.strategy.name(),
            stop: rules.stop.to_string(),
            seed: *seed,
            lines,
            pilot_lines: self.scored.counts.lines,
            c_k: cost.c_k,
            c_b: cost.c_b,
            c_t: cost.c_t,
            depth: self.tree.depth as u64,
            inner_nodes: self.tree.inner_nodes() as u64,
            leaves: self.tree.leaves() as u64,
            empty_leaves: self.tree.empty_leaves() as u64,
            references: self.tree.references.len() as u64,
            zero_area_nodes: nodes.iter().filter(|r| r.p == 0.0).count() as u64,
            unhit_nodes: tested().filter(|r| r.hits == 0).count() as u64,
            inner_visits: work.inner,
            leaf_visits: work.leaves,
            object_tests: work.tests,
            n_k_predicted: p_k,
            n_k_counted: n_k,
            n_k_se: se([1.0, 0.0, 0.0]),
            n_b_predicted: p_b,
            n_b_counted: n_b,
            n_b_se: se([0.0, 1.0, 0.0]),
            n_t_predicted: p_t,
            n_t_counted: n_t,
            n_t_se: se([0.0, 0.0, 1.0]),
            c_predicted: cost.cost(p_k, p_b, p_t),
            c_counted: cost.cost(n_k, n_b, n_t),
            c_se: se([cost.c_k, cost.c_b, cost.c_t]),
            slope: fit.slope.map(|s| s.0),
            slope_se: fit.slope.map(|s| s.1),
            slope_ols: fit.ordinary.map(|s| s.0),
            slope_ols_se: fit.ordinary.map(|s| s.1),
            free_intercept: fit.free.map(|f| f.intercept.0),
            free_intercept_se: fit.free.map(|f| f.intercept.1),
            free_slope: fit.free.map(|f| f.slope.0),
            free_slope_se: fit.free.map(|f| f.slope.1),
            free_p: fit.free.map(|f| f.p),
            unexplained: fit.unexplained.map(|u| u.0),
            unexplained_expected: fit.unexplained.map(|u| u.1),
            max_abs_z: tested().filter_map(|r| r.z).map(f64::abs).reduce(f64::max),
            smallest_tail,
            slope_p: fit.slope.map(|(b, se)| self.p_of(b - 1.0, se)),
            tail_p: smallest_tail.map(|t| (t * self.scoring.nodes as f64).min(1.0)),
            hotelling_p: (self.scoring.nodes > 0).then_some(fit.contrasts.0),
            contrasts: fit.contrasts.1,
        }
    }

    /// Two-sided p of a deviation. Without variance there may be no deviation either, but for rounding.
    fn p_of(&self, deviation: f64, se: f64) -> f64 {
        if se < 1e-15 {
            return if deviation.abs() < 1e-12 { 1.0 } else { 0.0 };
        }
        student_p(deviation / se, (self.scored.counts.lines - 1) as f64)
    }

    fn fit(&self, nodes: &[NodeRecord]) -> Fits {
        let n = self.counts.lines;
        let (mut p, mut y, mut weights) = (Vec::new(), Vec::new(), Vec::new());
        for r in nodes.iter().filter(|r| r.tail.is_some()) {
            p.push(r.p);
            y.push(r.hits as f64 / n as f64);
            weights.push(1.0 / (r.p * (1.0 - r.p)));
        }
        let covariance = self
            .scored
            .scores
            .covariance()
            .expect("a pilot of at least two lines");
        let se = |score: usize| (covariance[score][score] / n as f64).sqrt();

        let weighted = weighted_least_squares(&p, 1, &y, &weights).ok();
        let ordinary = least_squares(&p, 1, &y).ok();
        let with_ones: Vec<f64> = p.iter().flat_map(|&p| [1.0, p]).collect();
        let free = if self.scoring.has_free_line {
            weighted_least_squares(&with_ones, 2, &y, &weights).ok()
        } else {
            None
        };

        let expected = {
            let noise: f64 = p.iter().map(|p| p * (1.0 - p)).sum();
            let signal: f64 = p.iter().map(|p| p * p).sum();
            noise / (n as f64 * signal)
        };
        let pilot = self.scored.counts.lines;
        let hits = self.scoring.by_contrast(|i| self.counts.hits[i] as f64);
        let predicted = self.scoring.by_contrast(|i| self.prediction.p[i]);
        let deviation: Vec<f64> = hits
            .iter()
            .zip(predicted)
            .map(|(h, p)| h / n as f64 - p)
            .collect();
        let contrast_covariance = self
            .scored
            .contrasts
            .covariance()
            .expect("a pilot of at least two lines");
        let test = hotelling(&deviation, &contrast_covariance, n, pilot);
        Fits {
            slope: weighted.map(|f| (f.coefficients[0], se(WEIGHTED))),
            unexplained: ordinary
                .as_ref()
                .and_then(|f| f.r_squared_uncentred)
                .map(|r| (1.0 - r, expected)),
            ordinary: ordinary.map(|f| (f.coefficients[0], se(ORDINARY))),
            free: free.map(|f| {
                let (a, b) = (f.coefficients[0], f.coefficients[1]);
                let s = |i: usize, j: usize| covariance[FREE + i][FREE + j];
                let spread = [s(0, 0), s(0, 1), s(1, 0), s(1, 1)];
                FreeLine {
                    intercept: (a, se(FREE)),
                    slope: (b, se(FREE + 1)),
                    p: hotelling(&[a, b - 1.0], &spread, n, pilot).p,
                }
            }),
            contrasts: (test.p, test.contrasts as u64),
        }
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

/// Value and standard error.
type Measured = (f64, f64);

struct Fits {
    slope: Option<Measured>,
    ordinary: Option<Measured>,
    free: Option<FreeLine>,
    /// 1 - R^2 and its expectation.
    unexplained: Option<(f64, f64)>,
    /// Hotelling's p and the number of contrasts.
    contrasts: (f64, u64),
}

#[derive(Clone, Copy)]
struct FreeLine {
    intercept: Measured,
    slope: Measured,
    p: f64,
}
