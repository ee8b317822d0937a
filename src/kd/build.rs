//! Building a tree in O(N log N): the strategy picks planes, the stop rule ends, everything else is equal for all.
//!
//! Placement: an object goes left if lo < s, right if hi > s (so a straddler goes both ways); one lying in the plane goes
//! to the cheaper side, left on a tie. Where the rules clip, a straddler's box is its part's in each node, and it does not
//! go where it has no part. The tree is a deterministic function of the objects' boxes (clipped: of the objects) and the
//! rules.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use crate::cost::CostModel;
use crate::geom::{Aabb, Axis, Objects};

use super::arena::spread;
use super::clip::Clipping;
use super::events::EventLists;
use super::medians::{clipped_centre, object_median, spatial_median};
use super::planes::{Fractions, Planes};
use super::split::{Coster, Split};
use super::strategy::{AxisOrder, Positions};
use super::sweep::Sweep;
use super::tally::Tally;
use super::{Node, StopRule, Strategy, Tree};

/// All that decides a tree besides the objects.
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
/// # Panics
/// If a box is not valid, lies outside `world`, the rules ask for clipping, or the tree would need 2^32 nodes or
/// references.
pub fn build(bounds: &[Aabb], world: Aabb, rules: &Rules) -> Tree {
    assert!(!rules.clipped, "boxes alone cannot be clipped");
    build_over(bounds, world, rules, None, rules.strategy.sweeps())
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
    build_over(bounds, world, rules, clipping, rules.strategy.sweeps())
}

/// Every strategy can sweep sorted events; what it must not, it does faster without (the same planes, bit for bit).
fn build_over(
    bounds: &[Aabb],
    world: Aabb,
    rules: &Rules,
    clipping: Option<Clipping>,
    sweeps: bool,
) -> Tree {
    for (i, b) in bounds.iter().enumerate() {
        assert!(
            b.is_valid() && world.contains(b),
            "box {i} is {b:?}, world {world:?}"
        );
    }
    let objects = u32::try_from(bounds.len()).expect("more than 2^32 objects");
    let fractions = rules.strategy.parts().1.fractions();
    let mut builder = Builder {
        bounds: Cow::Borrowed(bounds),
        rules,
        depth_bound: rules.stop.depth_bound(bounds.len()),
        root_area: world.surface_area(),
        tree: Tree {
            nodes: vec![Node::leaf(0, 0)],
            boxes: vec![world],
            references: Vec::new(),
            depth: 0,
            world,
        },
        objects: (0..objects).collect(),
        events: sweeps.then(|| EventLists::new(bounds)),
        tallies: [(); 3].map(|()| Tally::new(&fractions)),
        fractions,
        sides: vec![0; bounds.len()],
        centres: Vec::new(),
        clipping,
    };
    let patience = rules.stop.patience(bounds.len());
    builder.grow(0, Path { depth: 0, patience }, Region::default());
    builder.tree
}

/// Where a node's lists begin in the builder's arenas; they end where the arenas do.
#[derive(Clone, Copy, Default)]
struct Region {
    objects: usize,
    events: [usize; 3],
}

/// What the way from the root to a node leaves to the stop rule.
#[derive(Clone, Copy)]
struct Path {
    depth: usize,
    /// Planes of little gain still allowed, see [`StopRule::patience`].
    patience: usize,
}

struct Builder<'a> {
    /// Every object's box; clipped, that of its part in the node at hand.
    bounds: Cow<'a, [Aabb]>,
    rules: &'a Rules,
    depth_bound: usize,
    root_area: f64,
    tree: Tree,
    /// Arena of object lists: a stack, the current node's on top.
    objects: Vec<u32>,
    /// Sorted events, likewise, where the rules sweep.
    events: Option<EventLists>,
    /// Where the strategy's named planes are, between its ends.
    fractions: Fractions,
    /// Scratch: counts at these planes by axis, where the rules do not sweep.
    tallies: [Tally; 3],
    /// Sides of the current split an object goes to: bit 0 left, bit 1 right.
    sides: Vec<u8>,
    /// Scratch: centres of clipped bounds.
    centres: Vec<f64>,
    /// Set where the rules clip.
    clipping: Option<Clipping<'a>>,
}

impl Builder<'_> {
    /// Make node `node` and all below it from the lists on top of the arenas.
    fn grow(&mut self, node: usize, path: Path, region: Region) {
        let bounds = self.tree.boxes[node];
        let Some((split, patience)) = self.choose(&bounds, path, region) else {
            self.make_leaf(node, path.depth, region);
            return;
        };
        let below = Path {
            depth: path.depth + 1,
            patience,
        };
        // Both children side by side, then their subtrees, the left one first.
        let left = self.tree.nodes.len();
        let first = u32::try_from(left + 1).expect("more than 2^32 nodes") - 1;
        self.tree.nodes[node] = Node::inner(split.axis, split.position, first);
        let (left_box, right_box) = bounds.split(split.axis, split.position);
        self.tree.nodes.extend([Node::leaf(0, 0); 2]);
        self.tree.boxes.extend([left_box, right_box]);

        // The right lists replace the node's own, the left ones go on top.
        let waiting = self.clipping.as_ref().map_or(0, Clipping::waiting);
        let (top, kept) = self.distribute(&split, region);
        self.grow(left, below, top);
        if let Some(clipping) = &mut self.clipping {
            clipping.turn_right(waiting, self.bounds.to_mut());
        }
        self.objects.truncate(kept.objects);
        if let Some(events) = &mut self.events {
            events.truncate(kept.events);
        }
        self.grow(left + 1, below, region);
    }

    fn make_leaf(&mut self, node: usize, depth: usize, region: Region) {
        let objects = &self.objects[region.objects..];
        let first = self.tree.references.len();
        assert!(
            first + objects.len() <= u32::MAX as usize,
            "more than 2^32 references"
        );
        self.tree.nodes[node] = Node::leaf(first as u32, objects.len() as u32);
        self.tree.references.extend_from_slice(objects);
        self.tree.depth = self.tree.depth.max(depth);
    }

    /// The plane to cut with and the patience left below it, or `None` for a leaf.
    fn choose(&mut self, bounds: &Aabb, path: Path, region: Region) -> Option<(Split, usize)> {
        let Rules {
            strategy,
            stop,
            cost,
            ..
        } = *self.rules;
        let n = self.objects.len() - region.objects;
        let share = bounds.surface_area() / self.root_area;
        if path.depth >= self.depth_bound || stop.stops_at(path.depth, n, share) {
            return None;
        }
        let (order, _) = strategy.parts();
        let axes = order.axes(path.depth, bounds);
        let split = if order == AxisOrder::All {
            self.cheapest(bounds, &axes, region)
        } else {
            axes.iter()
                .find_map(|&axis| self.cheapest(bounds, &[axis], region))
        }?;
        let patience = stop.cuts(split.cost, cost.leaf(n as f64), path.patience)?;
        Some((split, patience))
    }

    /// The strategy's cheapest plane on these axes; of equals the first axis's.
    fn cheapest(&mut self, bounds: &Aabb, axes: &[Axis], region: Region) -> Option<Split> {
        let (_, positions) = self.rules.strategy.parts();
        let mut ends = [None; 3];
        for &axis in axes {
            ends[axis] = self.ends(bounds, axis, region, positions);
        }
        let planes = ends.map(|e| e.map(|(from, to)| Planes::new(from, to, &self.fractions)));
        let objects = &self.objects[region.objects..];
        if self.events.is_none() {
            for &object in objects {
                let b = &self.bounds[object as usize];
                for &axis in axes {
                    if let Some(planes) = &planes[axis] {
                        self.tallies[axis].add(planes, b.lo[axis], b.hi[axis]);
                    }
                }
            }
        }
        let n = objects.len();
        let Rules { stop, cost, .. } = self.rules;
        let mut best: Option<Split> = None;
        for &axis in axes {
            let Some(planes) = &planes[axis] else {
                continue;
            };
            let coster = Coster::new(axis, bounds, n, cost, stop.takes_useless_planes());
            let split = if let Some(events) = &self.events {
                let events = events.on(axis, region.events[axis]);
                let window = positions.are_bounds().then_some(ends[axis]).flatten();
                // Medians that meet, and planes between nearly equal positions, are one candidate.
                let mut named: Vec<f64> = planes.iter().collect();
                named.dedup();
                Sweep { events, n }.cheapest(&coster, window, &named)
            } else {
                self.tallies[axis].cheapest(planes, &coster, n)
            };
            if let Some(split) = split
                && best.is_none_or(|b| split.cost < b.cost)
            {
                best = Some(split);
            }
        }
        best
    }

    /// Between which positions on an axis the strategy's candidates are.
    fn ends(
        &mut self,
        bounds: &Aabb,
        axis: Axis,
        region: Region,
        positions: Positions,
    ) -> Option<(f64, f64)> {
        let spatial = spatial_median(bounds, axis);
        let mut medians = || {
            self.object_median(bounds, axis, region)
                .map(|object| (spatial.min(object), spatial.max(object)))
        };
        match positions {
            Positions::AllBounds | Positions::Bins(_) => Some((bounds.lo[axis], bounds.hi[axis])),
            Positions::SpatialMedian => Some((spatial, spatial)),
            Positions::ObjectMedian => self.object_median(bounds, axis, region).map(|s| (s, s)),
            Positions::MedianMidpoint => medians().map(|(a, b)| {
                let s = 0.5 * a + 0.5 * b;
                (s, s)
            }),
            Positions::BoundsBetweenMedians | Positions::Samples(_) => medians(),
        }
    }

    /// Median of the centres of the objects' bounds clipped to the node.
    fn object_median(&mut self, bounds: &Aabb, axis: Axis, region: Region) -> Option<f64> {
        let all: &[Aabb] = &self.bounds;
        let centre = |&object: &u32| clipped_centre(&all[object as usize], bounds, axis);
        self.centres.clear();
        self.centres
            .extend(self.objects[region.objects..].iter().map(centre));
        object_median(&mut self.centres)
    }

    /// Sort the node's lists into the children's. Returns where the left child's begin, on top, and where the right
    /// child's, which take the node's own place, end.
    fn distribute(&mut self, split: &Split, region: Region) -> (Region, Region) {
        let bounds: &[Aabb] = &self.bounds;
        for &object in &self.objects[region.objects..] {
            self.sides[object as usize] = split.sides(&bounds[object as usize]);
        }
        if let Some(clipping) = &mut self.clipping {
            let objects = &self.objects[region.objects..];
            let plane = (split.axis, split.position);
            clipping.cut(objects, &mut self.sides, self.bounds.to_mut(), plane);
        }
        let mut top = Region::default();
        let mut kept = Region::default();
        (top.objects, kept.objects) = spread(&mut self.objects, region.objects, |&object| {
            self.sides[object as usize]
        });
        if let Some(events) = &mut self.events {
            let cut = self.clipping.as_ref().map_or(&[][..], |c| &c.cut);
            (top.events, kept.events) =
                events.distribute(split, &mut self.sides, cut, region.events);
        }
        (top, kept)
    }
}

#[cfg(test)]
mod tests;
