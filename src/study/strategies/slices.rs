//! A slice through one scene: the cells of every strategy's tree, and the outlines of the objects.

use serde::{Deserialize, Serialize};

use crate::geom::Axis;
use crate::kd::slice::{SliceCell, across, slice};
use crate::kd::{Rules, Strategy};
use crate::scene::Scene;
use crate::study::hits::cell::build_tree;
use crate::study::plan::{Wrong, wrong_unless};
use crate::study::records::{OutlineRecord, SliceRecord};
use crate::study::store::{Store, StoreError};
use crate::study::{AXES, Plan, Watcher};

use super::Strategies;

/// A plane across an axis of one scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SliceOf {
    /// Its scene, one of the experiment's.
    pub scene: String,
    /// The axis it stands across.
    pub axis: AxisName,
    /// Where; without it, in the median of the objects' centres.
    pub at: Option<f64>,
}

/// An axis by its name.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum AxisName {
    /// Axis 0.
    X,
    /// Axis 1.
    Y,
    /// Axis 2.
    Z,
}

impl SliceOf {
    /// Whether the scene is among these.
    pub fn check(&self, scenes: &[String]) -> Result<(), Wrong> {
        wrong_unless(scenes.contains(&self.scene), "slice", || {
            format!("the slice's scene '{}' is not among the scenes", self.scene)
        })?;
        wrong_unless(self.at.is_none_or(f64::is_finite), "slice", || {
            "slice.at must be a finite number".into()
        })
    }
}

/// Write `slices.csv` and `outlines.csv`, without rows where the plan asks for no slice. The trees of the first stop rule are
/// built again, which takes less than their files would.
pub fn write(
    plan: &Plan,
    asked: &Strategies,
    scenes: &[Scene],
    store: &Store,
    watcher: &impl Watcher,
) -> Result<(), StoreError> {
    let (mut cells, mut outlines) = (Vec::new(), Vec::new());
    let named = |of: &SliceOf| scenes.iter().find(|scene| scene.name == of.scene);
    if let Some((of, scene)) = asked.slice.as_ref().and_then(|of| Some((of, named(of)?))) {
        watcher.begin(&format!("{} slice", scene.name));
        let axis = of.axis as Axis;
        let at = of.at.unwrap_or_else(|| middle(scene, axis));
        cells = cells_at(plan, asked, scene, (axis, at));
        outlines = outlines_at(scene, (axis, at));
    }
    store.write_rows("slices.csv", cells)?;
    store.write_rows("outlines.csv", outlines)?;
    Ok(())
}

/// The leaves that the plane cuts, strategy by strategy.
fn cells_at(
    plan: &Plan,
    asked: &Strategies,
    scene: &Scene,
    (axis, at): (Axis, f64),
) -> Vec<SliceRecord> {
    let of_strategy = |&strategy: &Strategy| {
        let rules = Rules {
            strategy,
            stop: asked.stops[0],
            cost: plan.cost,
            clipped: asked.clipped,
        };
        let record = move |cell: SliceCell| SliceRecord {
            scene: scene.name.clone(),
            strategy: strategy.name(),
            stop: rules.stop.to_string(),
            axis: AXES[axis].into(),
            at,
            u_lo: cell.lo[0],
            v_lo: cell.lo[1],
            u_hi: cell.hi[0],
            v_hi: cell.hi[1],
            depth: cell.depth.into(),
            objects: cell.objects.into(),
        };
        let cells = slice(&build_tree(scene, &rules), axis, at);
        cells.into_iter().map(record)
    };
    asked.strategies.iter().flat_map(of_strategy).collect()
}

/// The pieces of the objects' outlines in the plane.
fn outlines_at(scene: &Scene, (axis, at): (Axis, f64)) -> Vec<OutlineRecord> {
    let [u, v] = across(axis);
    let of_object = |object: u32| {
        let pieces = scene.objects.get(object).section(axis, at);
        pieces.into_iter().map(move |[a, b]| OutlineRecord {
            scene: scene.name.clone(),
            object: object.into(),
            u0: a[u],
            v0: a[v],
            u1: b[u],
            v1: b[v],
        })
    };
    let objects = 0..scene.bounds.len() as u32;
    objects.flat_map(of_object).collect()
}

/// Median of the centres of the objects' boxes.
fn middle(scene: &Scene, axis: Axis) -> f64 {
    let mut centres: Vec<f64> = scene.bounds.iter().map(|b| b.centre()[axis]).collect();
    centres.sort_by(f64::total_cmp);
    centres[centres.len() / 2]
}
