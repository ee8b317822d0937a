//! What a set of rays does in a tree: integers, and the standard errors of their means.

use rayon::prelude::*;

use crate::cost::CostModel;
use crate::geom::Objects;
use crate::kd::{Ask, Prediction, Stack, Tree, Work};
use crate::stats::ScoreMoments;

use super::hits::cell::CellPlan;
use super::ray_sets::Rays;
use super::records::WorkRecord;

/// What rays did together. Sums of their own counts and of products of these, so that any linear form has its error.
#[derive(Clone, Debug, Default)]
pub struct Counted {
    /// Rays that hit an object.
    pub hits: u64,
    /// Rays that hit the root's box: these are what the metric tells of.
    pub entered: u64,
    /// Their visits and tests.
    pub work: Work,
    /// Of n_K, n_B and n_t of a ray that hits the root's box.
    moments: ScoreMoments<3>,
}

/// Rays of one piece of work.
pub(super) const PIECE: usize = 1024;

/// Trace rays through a tree. The same whatever the number of threads.
pub fn count(tree: &Tree, objects: &Objects, rays: &Rays) -> Counted {
    let pieces: Vec<Counted> = rays
        .casts
        .par_chunks(PIECE)
        .map(|piece| {
            let mut sum = Counted::default();
            let mut stack = Stack::default();
            for cast in piece {
                let mut own = Work::default();
                let ask: Ask = rays.of.ask();
                let hit = ask.hits(tree, objects, &cast.ray(), &mut stack, &mut own);
                sum.push(hit, own);
            }
            sum
        })
        .collect();
    pieces
        .into_iter()
        .fold(Counted::default(), |mut sum, piece| {
            sum.merge(&piece);
            sum
        })
}

impl Counted {
    /// Add a ray: whether it hit an object, and what it did.
    pub fn push(&mut self, hit: bool, work: Work) {
        self.hits += u64::from(hit);
        self.work += work;
        // Whoever hits the root's box visits at least the root.
        if work.inner + work.leaves > 0 {
            self.entered += 1;
            self.moments
                .push([work.inner, work.leaves, work.tests].map(|n| n as f64));
        }
    }

    /// Add other rays.
    pub fn merge(&mut self, other: &Self) {
        self.hits += other.hits;
        self.entered += other.entered;
        self.work += other.work;
        self.moments.merge(&other.moments);
    }

    /// The row of a tree and a set of rays.
    pub fn record(
        &self,
        plan: &CellPlan<'_>,
        rays: &Rays,
        cost: CostModel,
        prediction: &Prediction,
    ) -> WorkRecord {
        let Work {
            inner,
            leaves,
            tests,
        } = self.work;
        let entered = self.entered.max(1) as f64;
        let [n_k, n_b, n_t] = [inner, leaves, tests].map(|n| n as f64 / entered);
        let se = |form: [f64; 3]| self.standard_error(form).filter(|_| !rays.complete);
        let &Prediction {
            n_k: k,
            n_b: b,
            n_t: t,
            ..
        } = prediction;
        WorkRecord {
            cell: plan.id.clone(),
            scene: plan.scene.name.clone(),
            objects: plan.scene.bounds.len() as u64,
            strategy: plan.rules.strategy.name(),
            stop: plan.rules.stop.to_string(),
            rays: rays.of.to_string(),
            ask: rays.of.ask().to_string(),
            cast: rays.casts.len() as u64,
            complete: rays.complete,
            entered: self.entered,
            hits: self.hits,
            inner_visits: inner,
            leaf_visits: leaves,
            object_tests: tests,
            n_k_predicted: k,
            n_k_counted: n_k,
            n_k_se: se([1.0, 0.0, 0.0]),
            n_b_predicted: b,
            n_b_counted: n_b,
            n_b_se: se([0.0, 1.0, 0.0]),
            n_t_predicted: t,
            n_t_counted: n_t,
            n_t_se: se([0.0, 0.0, 1.0]),
            c_predicted: cost.cost(k, b, t),
            c_counted: cost.cost(n_k, n_b, n_t),
            c_se: se([cost.c_k, cost.c_b, cost.c_t]),
        }
    }

    /// Standard error of the mean of a linear form of n_K, n_B and n_t; of fewer than two rays there is none.
    fn standard_error(&self, form: [f64; 3]) -> Option<f64> {
        let covariance = self.moments.covariance()?;
        let mut variance = 0.0;
        for (row, a) in covariance.iter().zip(form) {
            for (value, b) in row.iter().zip(form) {
                variance += a * b * value;
            }
        }
        Some((variance.max(0.0) / self.moments.n() as f64).sqrt())
    }
}
