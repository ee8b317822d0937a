//! One scene: every tree, traced by every set of rays.

use serde::{Deserialize, Serialize};

use crate::kd::expect::Parts;
use crate::kd::{Rules, predict};
use crate::scene::Scene;
use crate::study::hits::cell::{CellPlan, plant};
use crate::study::identity::{digest, whole};
use crate::study::ray_sets::gather;
use crate::study::records::{
    BiasRecord, ExactRecord, GroupRecord, MetricRecord, OrderRecord, VisitRecord, WorkRecord,
};
use crate::study::{LineRule, Plan, Watcher};

use super::asked::Assumptions;
use super::mailbox;
use super::metrics::{self, METRICS};
use super::nodes::{Errors, Places};
use super::one::One;
use super::order::{Ranked, order};
use super::visits::count;

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

impl Found {
    /// Add the rows of one set of rays in one tree.
    fn add(&mut self, asked: &Assumptions, one: &One<'_>) {
        let (scene, strategy) = (&*one.plan.scene.name, one.plan.rules.strategy);
        let set = one.rays.of.to_string();
        let counted = &one.errors.visits.counted;
        let cost = one.plan.rules.cost;
        let record = counted.record(one.plan, one.rays, cost, one.prediction);
        self.work.push(record);
        self.bias.push(one.bias());
        self.groups
            .extend(one.errors.groups(scene, &strategy.name(), &set));
        if (&*asked.figure.scene, asked.figure.strategy) == (scene, strategy) {
            self.visits.extend(one.errors.visits(&set));
        }
        self.exact.extend(one.exact());
    }
}

/// The trees of a scene, and the identity of all that is measured of it.
pub struct SceneCell<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// Identity.
    pub id: String,
    /// A tree each.
    pub trees: Vec<CellPlan<'a>>,
}

impl<'a> SceneCell<'a> {
    /// The cell of a scene.
    pub fn of(plan: &Plan, asked: &Assumptions, scene: &'a Scene) -> Self {
        // No stream of lines is counted, but a cell names how many.
        let lines = LineRule::exactly(1 << 16).expect("enough lines");
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
            scene,
            id: digest(text.as_bytes()),
            trees,
        }
    }
}

/// Measure a scene.
///
/// # Errors
/// If the program contradicts itself.
pub fn measure(
    asked: &Assumptions,
    cell: &SceneCell<'_>,
    watcher: &impl Watcher,
) -> Result<Found, String> {
    let scene = cell.scene;
    let seed = cell.trees.first().map_or(0, |tree| tree.line_seed);
    let rules: Vec<Rules> = cell.trees.iter().map(|tree| tree.rules).collect();
    let sets = gather(scene, &asked.rays, asked.sizes(), &rules, seed)?;
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
        let parts = Parts::new(&tree, &scene.objects, &scene.bounds);
        let expected = metrics::expected(&tree, &parts);
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
            found.add(asked, &one);
            let rows = metrics::records(plan, rays, &visits, &expected);
            found.metrics.extend(rows);
            let rows = mailbox::records(plan, &tree, &parts, rays);
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
