//! Building a tree in O(N log N): the strategy picks planes, the stop rule ends, everything else is equal for all.
//!
//! Placement: an object goes left if lo < s, right if hi > s (so a straddler goes both ways); one lying in the plane goes
//! to the cheaper side, left on a tie. Where the rules clip, a straddler's box is its part's in each node, and it does not
//! go where it has no part. The tree is a deterministic function of the objects' boxes (clipped: of the objects) and the
//! rules.
//!
//! Large nodes are built by all threads of the current rayon pool: the axes and, below them, the two children at the same
//! time. The tree is the same for any number of threads, and a pool of one builds as if there were none.

use serde::{Deserialize, Serialize};

use crate::cost::CostModel;
use crate::geom::{Aabb, Objects};

use super::clip::Clipping;
use super::events::MOST_OBJECTS;
use super::{StopRule, Strategy, Tree};

use builder::{Builder, Frame, Path};

mod axes;
mod builder;
mod choose;
mod growth;

/// All that decides a tree besides the objects.
///
/// ```
/// use sahlab::cost::CostModel;
/// use sahlab::kd::{Rules, Strategy};
///
/// let stops = ["objects:2:16".parse()?, "automatic".parse()?];
/// let all = Rules::crossed(&stops, &Strategy::ALL, CostModel::WALD_HAVRAN, false);
/// assert_eq!(all.len(), 2 * Strategy::ALL.len());
/// assert_eq!((all[0].stop, all[0].strategy), (stops[0], Strategy::ALL[0]));
/// # Ok::<(), String>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rules {
    /// Which plane.
    pub strategy: Strategy,
    /// When to stop.
    pub stop: StopRule,
    /// What steps cost: read by the cost-driven strategies and by the rules `cost-gain` and `automatic`.
    pub cost: CostModel,
    /// Whether objects that planes cut are clipped to the nodes (see [`build_objects`]).
    #[serde(default)]
    pub clipped: bool,
}

impl Rules {
    /// Every strategy under every stop rule: strategies follow each other, stop rule by stop rule.
    pub fn crossed(
        stops: &[StopRule],
        strategies: &[Strategy],
        cost: CostModel,
        clipped: bool,
    ) -> Vec<Self> {
        let rules = |stop: StopRule, strategy: Strategy| Self {
            strategy,
            stop,
            cost,
            clipped,
        };
        let under = |&stop: &StopRule| strategies.iter().map(move |&s| rules(stop, s));
        stops.iter().flat_map(under).collect()
    }
}

/// Build a tree over objects given by their boxes, with `world` around them all.
///
/// ```
/// use glam::DVec3;
/// use sahlab::cost::CostModel;
/// use sahlab::geom::Aabb;
/// use sahlab::kd::{NodeKind, Rules, StopRule, Strategy, build};
///
/// // Small boxes in two opposite corners of a large one: cuts at both leave empty space between them.
/// let small = |at: f64| Aabb::new(DVec3::splat(at), DVec3::splat(at + 1.0));
/// let boxes: Vec<Aabb> = (0..10).map(|i| small(f64::from(i % 2) * 9.0)).collect();
/// let (strategy, stop) = (Strategy::Sah, StopRule::CostGain { depth: None });
/// let rules = Rules { strategy, stop, cost: CostModel::WALD_HAVRAN, clipped: false };
/// let tree = build(&boxes, Aabb::new(DVec3::ZERO, DVec3::splat(10.0)), &rules);
///
/// assert!(tree.empty_leaves() > 0);
/// assert!(matches!(tree.nodes[0].kind(), NodeKind::Inner { split, .. } if split == 1.0 || split == 9.0));
/// ```
///
/// # Panics
/// If a box is not valid, lies outside `world`, the rules ask for clipping, there are 2^30 boxes or more, or the tree would
/// need 2^32 nodes or references.
pub fn build(bounds: &[Aabb], world: Aabb, rules: &Rules) -> Tree {
    assert!(!rules.clipped, "boxes alone cannot be clipped");
    build_over(
        bounds,
        world,
        rules,
        None,
        rules.strategy.sweeps(),
        grain(bounds.len()),
    )
}

/// As [`build`], of objects with these boxes; if the rules say so, objects are clipped to the nodes.
///
/// Clipped, a node knows each object by the bounds of its part there (Havran & Bittner 2002, "split clipping"; Wald &
/// Havran 2006, "perfect splits"): strategies see these, and an object is in no leaf that only its box reaches. Spheres
/// and cones are known by their box cut to the node. Parts are taken too large by [`clip_slack`](crate::geom::clip_slack),
/// so that rounding loses no hit; only a ray that runs in an object's plane up to rounding, whose t is then arbitrary
/// within the object's box, may find another object before it.
///
/// # Panics
/// As [`build`] does.
pub fn build_objects(objects: &Objects, bounds: &[Aabb], world: Aabb, rules: &Rules) -> Tree {
    assert_eq!(objects.len(), bounds.len(), "one box an object");
    let clipping = rules.clipped.then(|| Clipping::new(objects, &world));
    build_over(
        bounds,
        world,
        rules,
        clipping,
        rules.strategy.sweeps(),
        grain(bounds.len()),
    )
}

/// Objects of a node from which on it is worth another thread's while.
const GRAIN: usize = 4096;

/// The grain for so many objects on the current pool: where there is one thread, no node is large enough.
fn grain(objects: usize) -> usize {
    if objects >= GRAIN && rayon::current_num_threads() > 1 {
        GRAIN
    } else {
        usize::MAX
    }
}

/// Every strategy can sweep sorted events; what it must not, it does faster without (the same planes, bit for bit). Nodes of
/// at least `grain` objects are shared among threads.
fn build_over(
    bounds: &[Aabb],
    world: Aabb,
    rules: &Rules,
    clipping: Option<Clipping>,
    sweeps: bool,
    grain: usize,
) -> Tree {
    for (i, b) in bounds.iter().enumerate() {
        assert!(
            b.is_valid() && world.contains(b),
            "box {i} is {b:?}, world {world:?}"
        );
    }
    assert!(bounds.len() <= MOST_OBJECTS, "2^30 objects or more");
    let frame = Frame::new(rules, bounds.len(), &world, sweeps, grain);
    let root = Path {
        depth: 0,
        patience: rules.stop.patience(bounds.len()),
    };
    let builder = Builder::new(&frame, bounds, clipping);
    builder.build(world, root).into_tree(world)
}

#[cfg(test)]
mod tests;
