//! One set of rays in one tree: the rows that tell of it.

use crate::geom::{Aabb, Cast};
use crate::kd::{Ask, Prediction, Tree};
use crate::study::hits::cell::CellPlan;
use crate::study::ray_sets::Rays;
use crate::study::records::{BiasRecord, ExactRecord};

use super::asked::is_uniform;
use super::exact::{self, Inside, Share};
use super::nodes::Errors;
use super::visits::Visits;

/// Isotropic lines behind an exact expectation, for each counted ray.
const LINES_A_RAY: u64 = 16;
/// Nodes of a tree, the largest ones below the root, that are held against exact expectations.
const EXACT_NODES: usize = 200;

/// One set of rays in one tree.
pub struct One<'a> {
    /// The tree's cell.
    pub plan: &'a CellPlan<'a>,
    /// The tree.
    pub tree: &'a Tree,
    /// What areas predict of it.
    pub prediction: &'a Prediction,
    /// The rays.
    pub rays: &'a Rays,
    /// What they did, node by node.
    pub errors: Errors<'a>,
}

impl One<'_> {
    /// The row of `bias.csv`.
    pub fn bias(&self) -> BiasRecord {
        let visits: &Visits = self.errors.visits;
        let (entered, work) = (visits.entered(), visits.counted.work);
        let cost = self.plan.rules.cost;
        let Prediction { n_k, n_b, n_t, .. } = *self.prediction;
        let ratio = |counted: f64, predicted: f64| {
            let n = entered as f64 * predicted;
            (n > 0.0).then(|| counted / n)
        };
        let [inner, leaves, tests] = [work.inner, work.leaves, work.tests].map(|n| n as f64);
        let judged = self.errors.judged();
        let cast = self.rays.casts.len() as f64;
        let stops = self.rays.of.ask() != Ask::All;
        BiasRecord {
            cell: self.plan.id.clone(),
            scene: self.plan.scene.name.clone(),
            strategy: self.plan.rules.strategy.name(),
            rays: self.rays.of.to_string(),
            uniform: is_uniform(self.rays.of),
            inside: inside(self.rays, &self.tree.world) as f64 / cast,
            stopped: if stops {
                visits.counted.hits as f64 / cast
            } else {
                0.0
            },
            entered,
            visits: ratio(inner + leaves, n_k + n_b),
            n_k: ratio(inner, n_k),
            n_b: ratio(leaves, n_b),
            n_t: ratio(tests, n_t),
            c: ratio(cost.cost(inner, leaves, tests), cost.cost(n_k, n_b, n_t)),
            judged: judged.len() as u64,
            spread: self.errors.spread(&judged),
            rank_correlation: self.errors.rank_correlation(&judged),
        }
    }

    /// The rows of `exact.csv`, of rays that theory knows, in a root with a volume.
    pub fn exact(&self) -> Vec<ExactRecord> {
        let root = &self.tree.world;
        let Some(inside) = Inside::of(self.rays.of).filter(|_| root.volume() > 0.0) else {
            return Vec::new();
        };
        let p = &self.prediction.p;
        let mut nodes: Vec<usize> = (1..p.len()).filter(|&i| p[i] > 0.0).collect();
        nodes.sort_by(|&i, &j| p[j].total_cmp(&p[i]).then(i.cmp(&j)));
        nodes.truncate(EXACT_NODES);
        let boxes: Vec<Aabb> = nodes.iter().map(|&i| self.tree.boxes[i]).collect();
        let lines = LINES_A_RAY * self.rays.casts.len() as u64;
        let shares = exact::expected(root, &boxes, inside, self.plan.line_seed, lines);
        let by_lines = nodes.iter().copied().zip(shares).collect();
        let mut rows = vec![self.worst("lines", by_lines)];
        if inside == Inside::Segment {
            let slab = |i: &usize| {
                let share = exact::slab(root, &self.tree.boxes[*i])?;
                Some((*i, Share::known(share)))
            };
            rows.push(self.worst("slab", nodes.iter().filter_map(slab).collect()));
        }
        rows.into_iter().flatten().collect()
    }

    /// The row of these expectations; `None` where no node can be judged.
    fn worst(&self, by: &str, shares: Vec<(usize, Share)>) -> Option<ExactRecord> {
        let cast = self.rays.casts.len() as u64;
        let hits = &self.errors.visits.hits;
        let judge =
            |(i, share): (usize, Share)| Some((exact::p_value(share, hits[i], cast)?, i, share));
        let judged: Vec<_> = shares.into_iter().filter_map(judge).collect();
        let nodes = judged.len() as u64;
        let least = judged.into_iter().min_by(|a, b| a.0.total_cmp(&b.0));
        least.map(|(p_value, node, share)| ExactRecord {
            scene: self.plan.scene.name.clone(),
            strategy: self.plan.rules.strategy.name(),
            rays: self.rays.of.to_string(),
            by: by.into(),
            nodes,
            node: node as u64,
            p: self.prediction.p[node],
            expected: share.mean,
            expected_se: share.se,
            counted: hits[node] as f64 / cast as f64,
            p_value,
        })
    }
}

/// Rays that begin inside the root's box.
fn inside(rays: &Rays, root: &Aabb) -> usize {
    let begins_inside = |cast: &&Cast| {
        let origin = cast.origin + cast.span.t0.max(f64::MIN) * cast.direction;
        cast.span.t0.is_finite() && root.contains(&Aabb::new(origin, origin))
    };
    rays.casts.iter().filter(begins_inside).count()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cost::CostModel;
    use crate::kd::{Rules, StopRule, Strategy, predict};
    use crate::scene::Scene;
    use crate::study::LineRule;
    use crate::study::assumptions::nodes::Places;
    use crate::study::assumptions::visits::count;
    use crate::study::hits::cell::plant;
    use crate::study::ray_sets::{Number, gather};

    /// The least p-value of the exact checks, for rays of one kind under the name of another.
    fn exact_p(of: &str, named: &str) -> f64 {
        let scene = Scene::load("simple:uniform:300").expect("a scene");
        let rules = Rules {
            strategy: Strategy::Sah,
            stop: StopRule::Objects {
                limit: 2,
                depth: Some(10),
            },
            cost: CostModel::WALD_HAVRAN,
            clipped: false,
        };
        let lines = LineRule::exactly(1 << 16).expect("enough lines");
        let plan = &CellPlan::of_scene(&scene, &[rules], 4, lines)[0];
        let number = Number {
            rays: 1 << 14,
            pixels: 1,
            error: None,
        };
        let set = of.parse().expect("a set");
        let mut rays = gather(&scene, &[set], number, &[], plan.line_seed).expect("rays");
        let (tree, _) = plant(&scene, &rules).expect("a tree");
        let prediction = predict(&tree);
        let places = Places::of(&tree, &prediction);
        let visits = count(&tree, &scene.objects, &rays[0], rules.cost).expect("counts");
        rays[0].of = named.parse().expect("a set");
        let one = One {
            plan,
            tree: &tree,
            prediction: &prediction,
            rays: &rays[0],
            errors: Errors {
                places: &places,
                visits: &visits,
                complete: false,
            },
        };
        let rows = one.exact();
        let nodes: u64 = rows.iter().map(|row| row.nodes).sum();
        assert!(nodes > 20, "{nodes}");
        let least = rows.iter().map(|row| row.p_value).fold(1.0, f64::min);
        nodes as f64 * least
    }

    #[test]
    fn rays_of_another_law_fail_the_exact_check() {
        for [own, other] in [
            ["volume-ray", "volume-segment"],
            ["volume-segment", "volume-ray"],
        ] {
            assert!(exact_p(own, own) > 1e-3, "{own}");
            assert!(exact_p(other, own) < 1e-12, "{other} as {own}");
        }
        assert!(exact_p("volume-line", "volume-ray") < 1e-12);
        assert!(exact_p("volume-ray:nearest", "volume-ray") < 1e-12);
    }
}
