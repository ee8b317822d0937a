//! How well one metric expects what one set of rays costs.

use super::super::Assumptions;
use crate::report::axis::extent;
use crate::report::means::{arithmetic, geometric};
use crate::study::records::{MetricRecord, OrderRecord};

/// The surface area metric's name.
pub const AREA: &str = "area";

/// What one metric makes of one set of rays, over all trees.
pub struct Fit<'r> {
    /// Its name.
    pub metric: &'r str,
    /// C counted over expected, of each tree.
    pub ratios: Vec<f64>,
    /// Of the strategies' order, of each scene.
    pub taus: Vec<f64>,
    /// What taking the tree that it expects to be cheapest costs above the cheapest, of each scene.
    pub regrets: Vec<f64>,
}

impl<'r> Fit<'r> {
    /// Of all trees of a run.
    pub fn of(run: &'r Assumptions, set: &str, metric: &'r str) -> Self {
        let own = |row: &&MetricRecord| row.rays == set && row.metric == metric;
        let orders = || {
            let own = |row: &&OrderRecord| row.rays == set && row.metric == metric;
            run.orders.iter().chain(&run.others).filter(own)
        };
        let ratios = run.metrics.iter().filter(own).filter_map(|row| row.ratio);
        Fit {
            metric,
            ratios: ratios.filter(|ratio| *ratio > 0.0).collect(),
            taus: orders().filter_map(|row| row.tau).collect(),
            regrets: orders().filter_map(|row| row.regret).collect(),
        }
    }

    /// Least, geometric mean and largest ratio.
    pub fn range(&self) -> Option<[f64; 3]> {
        let (least, largest) = extent(self.ratios.iter().copied())?;
        Some([least, geometric(&self.ratios)?, largest])
    }

    /// By what factor it errs in the mean: exp of the mean of |ln ratio|.
    pub fn error(&self) -> Option<f64> {
        let all: Vec<f64> = self.ratios.iter().map(|ratio| ratio.ln().abs()).collect();
        arithmetic(&all).map(f64::exp)
    }

    /// Scatter of the ratios: exp of the standard deviation of ln ratio.
    pub fn scatter(&self) -> Option<f64> {
        let all: Vec<f64> = self.ratios.iter().map(|ratio| ratio.ln()).collect();
        let mean = arithmetic(&all)?;
        let squares: Vec<f64> = all.iter().map(|l| (l - mean) * (l - mean)).collect();
        arithmetic(&squares).map(|variance| variance.sqrt().exp())
    }
}

/// The metric that suits a set of rays.
pub fn suited<'r>(run: &'r Assumptions, set: &str) -> &'r str {
    let own = |row: &&MetricRecord| row.rays == set && row.suited;
    run.metrics
        .iter()
        .find(own)
        .map_or(AREA, |row| &*row.metric)
}
