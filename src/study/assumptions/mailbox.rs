//! Tests that a mailbox would spare: lines that test no object twice, held against what the metric `mailbox` expects.

use rayon::prelude::*;

use crate::geom::Objects;
use crate::kd::expect::{Metric, Parts};
use crate::kd::{Probe, Stack, Tree, Work};
use crate::study::hits::cell::CellPlan;
use crate::study::ray_sets::Rays;
use crate::study::records::MetricRecord;
use crate::study::work::PIECE;

use super::asked::is_control;
use super::metrics;

/// The objects that rays test, each once a ray.
struct Mailbox {
    /// Of every object the last ray that tested it.
    last: Vec<u32>,
    /// The ray at hand, from 1.
    ray: u32,
    /// Tests that were no repetitions.
    distinct: u64,
}

impl Probe for Mailbox {
    fn test(&mut self, object: u32) {
        let last = &mut self.last[object as usize];
        self.distinct += u64::from(*last != self.ray);
        *last = self.ray;
    }
}

/// Visits and distinct tests of rays, together. The same whatever the number of threads.
fn distinct_work(tree: &Tree, objects: &Objects, rays: &Rays) -> Work {
    let ask = rays.of.ask();
    let pieces: Vec<Work> = rays
        .casts
        .par_chunks(PIECE)
        .map(|piece| {
            let mut stack = Stack::default();
            let mut work = Work::default();
            let mut mailbox = Mailbox {
                last: vec![0; objects.len()],
                ray: 0,
                distinct: 0,
            };
            for cast in piece {
                mailbox.ray += 1;
                let probe = (&mut work, &mut mailbox);
                ask.hits(tree, objects, &cast.ray(), &mut stack, probe);
            }
            Work {
                tests: mailbox.distinct,
                ..work
            }
        })
        .collect();
    pieces.into_iter().fold(Work::default(), |mut sum, piece| {
        sum += piece;
        sum
    })
}

/// The rows of `metrics.csv` of a tree and the metric's own lines, each with a mailbox: the surface area metric, which tests
/// again, and the metric `mailbox`. None for other rays.
pub fn records(plan: &CellPlan<'_>, tree: &Tree, parts: &Parts, rays: &Rays) -> Vec<MetricRecord> {
    if !is_control(rays.of) {
        return Vec::new();
    }
    let (scene, cost) = (plan.scene, plan.rules.cost);
    let counted = distinct_work(tree, &scene.objects, rays);
    let counted = [counted.inner, counted.leaves, counted.tests];
    let [n_k, n_b, n_t] = counted.map(|n| n as f64 / rays.casts.len() as f64);
    let c_counted = cost.cost(n_k, n_b, n_t);
    let row = |metric: Metric| {
        let e = metric.expected(tree, parts);
        let c = metrics::cost(cost, e);
        MetricRecord {
            scene: scene.name.clone(),
            strategy: plan.rules.strategy.name(),
            rays: format!("{} with a mailbox", rays.of),
            metric: metric.name().into(),
            suited: metric == Metric::Mailbox,
            n_k: e.n_k,
            n_b: e.n_b,
            n_t: e.n_t,
            c,
            c_counted,
            ratio: (c > 0.0).then(|| c_counted / c),
        }
    };
    vec![row(Metric::Area), row(Metric::Mailbox)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cost::CostModel;
    use crate::kd::{Rules, Strategy, build};
    use crate::scene::Scene;
    use crate::study::ray_sets::{Number, gather};

    #[test]
    fn an_object_in_several_leaves_counts_once_a_ray() {
        let scene = Scene::load("simple:soup:60").expect("a scene");
        let sets = ["lines".parse().expect("a set")];
        let number = Number {
            rays: 3000,
            pixels: 1,
            error: None,
        };
        let rays = &gather(&scene, &sets, number, &[], 1).expect("rays")[0];
        let of = |stop: &str| {
            let rules = Rules {
                strategy: Strategy::SpatialMedian,
                stop: stop.parse().expect("a rule"),
                cost: CostModel::WALD_HAVRAN,
                clipped: false,
            };
            let tree = build(&scene.bounds, scene.world, &rules);
            distinct_work(&tree, &scene.objects, rays).tests as f64 / 3000.0
        };
        // One leaf: every object once. Many leaves: fewer than all, at least those whose own box is hit.
        assert_eq!(of("depth:0"), 60.0);
        let hit = |cast: &crate::geom::Cast| {
            let line = cast.ray().line;
            let own = scene.bounds.iter();
            own.filter(|b| b.clip(&line, cast.span).is_some()).count() as f64
        };
        let least = rays.casts.iter().map(hit).sum::<f64>() / rays.casts.len() as f64;
        let many = of("objects:1:12");
        assert!(least <= many && many < 30.0, "{least} {many}");
    }
}
