//! What independent replicates of a set of lines find in a tree.
//!
//! Each replicate is counted by one thread in integers, and its figures follow from these alone, so they do not depend on
//! the number of threads.

use rayon::prelude::*;

use crate::cost::CostModel;
use crate::geom::{Line, Ray, Span};
use crate::kd::stream::Streams;
use crate::kd::{Ask, Counts, Prediction, Stack, Tree, Work, predict};
use crate::rays::{Conditional, PointSet};
use crate::scene::Scene;

use super::method::{Method, Way};

/// A tree, what areas predict of it, and the seed of its lines.
pub struct Subject<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// Its tree.
    pub tree: &'a Tree,
    /// Shares of hits and counts from areas.
    pub prediction: Prediction,
    /// The cost model.
    pub cost: CostModel,
    /// Seed of all replicates.
    pub seed: u64,
}

/// Figures of one set of lines.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Replicate {
    /// n_K, n_B, n_t and C of a line.
    pub rates: [f64; 4],
    /// Mean over the nodes of (y - p)^2 / (p(1 - p)); `None` where it is not asked or no node has 0 < p < 1.
    pub nodes: Option<f64>,
}

/// Lines that go through the streams at a time: they and their lists stay in the cache.
const BLOCK: u64 = 1 << 14;

/// What a thread keeps from replicate to replicate.
#[derive(Default)]
struct Workshop {
    streams: Streams,
    stack: Stack,
    lines: Vec<Line>,
}

impl<'a> Subject<'a> {
    /// Of a tree over a scene.
    pub fn new(scene: &'a Scene, tree: &'a Tree, cost: CostModel, seed: u64) -> Self {
        Self {
            scene,
            tree,
            prediction: predict(tree),
            cost,
            seed,
        }
    }

    /// Replicates of so many lines, in order; `done` is told the lines of each. Another `level` means other lines.
    pub fn replicates(
        &self,
        way: Way,
        level: u32,
        lines: u64,
        replicates: u32,
        done: impl Fn(u64) + Sync,
    ) -> Vec<Replicate> {
        let one = |workshop: &mut Workshop, replicate: u32| {
            let set = self.set(way.method, level, replicate, lines);
            let found = match way.ask {
                _ if way.method.is_conditional() => self.directions(&set, lines),
                Ask::All => self.hits(&set, lines, workshop),
                ask => self.traced(ask, &set, lines, workshop),
            };
            done(lines);
            found
        };
        (0..replicates)
            .into_par_iter()
            .map_init(Workshop::default, one)
            .collect()
    }

    /// One set of lines; different methods, levels and replicates are independent.
    pub fn set(&self, method: Method, level: u32, replicate: u32, lines: u64) -> PointSet {
        let number = (method as u64) << 48 | u64::from(level) << 32 | u64::from(replicate);
        PointSet::new(method.sampler(), self.seed, number, lines)
    }

    /// Lines that nothing stops: the hits of every node.
    fn hits(&self, set: &PointSet, lines: u64, workshop: &mut Workshop) -> Replicate {
        let mut counts = Counts::new(self.tree);
        for start in (0..lines).step_by(BLOCK as usize) {
            let block = start..lines.min(start + BLOCK);
            workshop.lines.clear();
            workshop.lines.extend(set.lines(&self.scene.world, block));
            workshop
                .streams
                .count(self.tree, &workshop.lines, &mut counts);
        }
        let shares = counts.hits.iter().map(|&hits| hits as f64 / lines as f64);
        Replicate {
            nodes: self.deviation(shares),
            ..self.of_work(counts.work, lines)
        }
    }

    /// Rays that end early: their work alone.
    fn traced(&self, ask: Ask, set: &PointSet, lines: u64, workshop: &mut Workshop) -> Replicate {
        let mut work = Work::default();
        for line in set.lines(&self.scene.world, 0..lines) {
            let ray = Ray::new(line, Span::FULL);
            let stack = &mut workshop.stack;
            ask.hits(self.tree, &self.scene.objects, &ray, stack, &mut work);
        }
        self.of_work(work, lines)
    }

    /// Directions alone.
    fn directions(&self, set: &PointSet, lines: u64) -> Replicate {
        let mut mean = Conditional::new(&self.scene.world);
        let directions = set.lines(&self.scene.world, 0..lines);
        directions.for_each(|line| mean.push(line.direction));
        let share = |node| mean.hit_share(node).expect("a set has lines");
        let found = Prediction::of_shares(self.tree, self.tree.boxes.iter().map(share).collect());
        Replicate {
            rates: self.rates([found.n_k, found.n_b, found.n_t]),
            nodes: self.deviation(found.p.iter().copied()),
        }
    }

    fn of_work(&self, work: Work, lines: u64) -> Replicate {
        let counts = [work.inner, work.leaves, work.tests];
        Replicate {
            rates: self.rates(counts.map(|n| n as f64 / lines as f64)),
            nodes: None,
        }
    }

    /// n_K, n_B and n_t with the C that follows.
    pub fn rates(&self, [n_k, n_b, n_t]: [f64; 3]) -> [f64; 4] {
        [n_k, n_b, n_t, self.cost.cost(n_k, n_b, n_t)]
    }

    fn deviation(&self, shares: impl Iterator<Item = f64>) -> Option<f64> {
        let both = shares.zip(&self.prediction.p);
        let judged = both.filter(|&(_, &p)| 0.0 < p && p < 1.0);
        let scaled = judged.map(|(y, p)| (y - p) * (y - p) / (p * (1.0 - p)));
        let (sum, nodes) = scaled.fold((0.0, 0_u64), |(sum, n), square| (sum + square, n + 1));
        (nodes > 0).then(|| sum / nodes as f64)
    }
}
