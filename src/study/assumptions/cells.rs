//! One scene: every tree, traced by every set of rays.

use serde::{Deserialize, Serialize};

use crate::geom::{Aabb, Cast};
use crate::kd::{Ask, Prediction, Tree, predict};
use crate::rays::Source;
use crate::scene::Scene;
use crate::study::hits::cell::{CellPlan, plant};
use crate::study::identity::{digest, whole};
use crate::study::ray_sets::{Rays, RaysOf, gather};
use crate::study::records::{
    BiasRecord, ExactRecord, GroupRecord, MetricRecord, OrderRecord, VisitRecord, WorkRecord,
};
use crate::study::{LineRule, Plan, Watcher};

use super::asked::{Assumptions, is_uniform};
use super::exact::{self, Inside, Share};
use super::metrics::{self, METRICS};
use super::nodes::{Errors, Places};
use super::order::{Ranked, order};
use super::visits::{Visits, count};

/// What was found in a scene.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Found {
    /// Rows of `work.csv`.
    pub work: Vec<WorkRecord>,
    /// Rows of `bias.csv`.
    pub bias: Vec<BiasRecord>,
    /// Rows of `nodes-by.csv`.
    pub groups: Vec<GroupRecord>,
    /// Rows of `visits.csv`.
    pub visits: Vec<VisitRecord>,
    /// Rows of `order.csv`.
    pub orders: Vec<OrderRecord>,
    /// Rows of `metrics.csv`.
    pub metrics: Vec<MetricRecord>,
    /// Rows of `exact.csv`.
    pub exact: Vec<ExactRecord>,
}

/// The trees of a scene, and the identity of all that is measured of it.
pub struct SceneCell<'a> {
    /// Identity.
    pub id: String,
    /// A tree each.
    pub trees: Vec<CellPlan<'a>>,
}

impl<'a> SceneCell<'a> {
    /// The cell of a scene.
    pub fn of(plan: &Plan, asked: &Assumptions, scene: &'a Scene) -> Self {
        let lines = LineRule::exactly(asked.number.max(1 << 16)).expect("enough lines");
        let trees = CellPlan::of_scene(scene, &asked.rules(plan), plan.seed, lines);
        let drawn = (asked.figure.scene == scene.name).then_some(asked.figure.strategy);
        let ids: Vec<&str> = trees.iter().map(|tree| &*tree.id).collect();
        let text = format!(
            "assumptions of {} {} {ids:?} {:?} {:?} {drawn:?}",
            scene.name,
            whole(scene),
            asked.rays,
            asked.sizes(),
        );
        Self {
            id: digest(text.as_bytes()),
            trees,
        }
    }
}

/// Isotropic lines behind an exact expectation, for each counted ray.
const LINES_A_RAY: u64 = 16;
/// Nodes of a tree, the largest ones below the root, that are held against exact expectations.
const EXACT_NODES: usize = 200;

/// Measure a scene.
///
/// # Errors
/// If the program contradicts itself.
pub fn measure(
    asked: &Assumptions,
    scene: &Scene,
    cell: &SceneCell<'_>,
    watcher: &impl Watcher,
) -> Result<Found, String> {
    let seed = cell.trees.first().map_or(0, |tree| tree.line_seed);
    let sets = gather(scene, &asked.rays, asked.sizes(), seed)?;
    let mut found = Found {
        work: Vec::new(),
        bias: Vec::new(),
        groups: Vec::new(),
        visits: Vec::new(),
        orders: Vec::new(),
        metrics: Vec::new(),
        exact: Vec::new(),
    };
    // By tree; costs by set, too.
    let mut expectations = Vec::new();
    let mut costs: Vec<Vec<Vec<f64>>> = Vec::new();
    for plan in &cell.trees {
        let (tree, _) = plant(scene, &plan.rules)?;
        let prediction = predict(&tree);
        let expected = metrics::expected(scene, &tree);
        let places = Places::of(&tree, &prediction);
        let mut own = Vec::new();
        for rays in &sets {
            let visits = count(&tree, &scene.objects, rays, plan.rules.cost)?;
            let one = One {
                plan,
                tree: &tree,
                prediction: &prediction,
                rays,
                errors: Errors {
                    places: &places,
                    visits: &visits,
                    complete: rays.complete,
                },
            };
            one.look(asked, &mut found);
            let rows = metrics::records(plan, rays, &visits, &expected);
            found.metrics.extend(rows);
            own.push(visits.costs);
        }
        expectations.push(expected);
        costs.push(own);
        watcher.done(1);
    }
    for (s, rays) in sets.iter().enumerate() {
        for (m, metric) in METRICS.iter().enumerate() {
            let trees: Vec<Ranked<'_>> = cell
                .trees
                .iter()
                .zip(&expectations)
                .zip(&costs)
                .map(|((plan, expected), costs)| Ranked {
                    strategy: plan.rules.strategy.name(),
                    predicted: metrics::cost(plan.rules.cost, expected[m]),
                    costs: &costs[s],
                })
                .collect();
            let (scene, set) = (&*scene.name, rays.of.to_string());
            let row = order(scene, &set, metric.name(), rays.complete, &trees);
            found.orders.extend(row);
        }
    }
    Ok(found)
}

/// One set of rays in one tree.
struct One<'a> {
    plan: &'a CellPlan<'a>,
    tree: &'a Tree,
    prediction: &'a Prediction,
    rays: &'a Rays,
    errors: Errors<'a>,
}

impl One<'_> {
    fn look(&self, asked: &Assumptions, found: &mut Found) {
        let (scene, strategy) = (&*self.plan.scene.name, self.plan.rules.strategy);
        let set = self.rays.of.to_string();
        let counted = &self.errors.visits.counted;
        let cost = self.plan.rules.cost;
        let record = counted.record(self.plan, self.rays, cost, self.prediction);
        found.work.push(record);
        found.bias.push(self.bias());
        found
            .groups
            .extend(self.errors.groups(scene, &strategy.name(), &set));
        if (&*asked.figure.scene, asked.figure.strategy) == (scene, strategy) {
            found.visits.extend(self.errors.visits(&set));
        }
        found.exact.extend(self.exact());
    }

    /// The row of `bias.csv`.
    fn bias(&self) -> BiasRecord {
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
    fn exact(&self) -> Vec<ExactRecord> {
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

/// Whether a set is of a source, and which: to find the sets of the same rays that ask something else.
pub fn source_of(set: &str) -> Option<(Source, Ask)> {
    match set.parse() {
        Ok(RaysOf::Source(source, ask)) => Some((source, ask)),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cost::CostModel;
    use crate::kd::{Rules, StopRule, Strategy};
    use crate::study::ray_sets::Number;

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
        };
        let set = of.parse().expect("a set");
        let mut rays = gather(&scene, &[set], number, plan.line_seed).expect("rays");
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
