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

use super::clip::Clipping;
use super::medians::{clipped_centre, object_median, samples, spatial_median};
use super::strategy::Positions;
use super::sweep::{Event, Split, Sweep, sorted_events};
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
    build_over(bounds, world, rules, None)
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
    build_over(bounds, world, rules, clipping)
}

fn build_over(bounds: &[Aabb], world: Aabb, rules: &Rules, clipping: Option<Clipping>) -> Tree {
    for (i, b) in bounds.iter().enumerate() {
        assert!(
            b.is_valid() && world.contains(b),
            "box {i} is {b:?}, world {world:?}"
        );
    }
    let objects = u32::try_from(bounds.len()).expect("more than 2^32 objects");
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
        events: [0, 1, 2].map(|axis| sorted_events(bounds, axis)),
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
    /// Arenas of sorted events by axis, likewise.
    events: [Vec<Event>; 3],
    /// Sides of the current split an object goes to: bit 0 left, bit 1 right.
    sides: Vec<u8>,
    /// Scratch: centres of clipped bounds.
    centres: Vec<f64>,
    /// Set where the rules clip.
    clipping: Option<Clipping<'a>>,
}

pub(super) const LEFT: u8 = 1;
pub(super) const RIGHT: u8 = 2;

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
        for axis in 0..3 {
            self.events[axis].truncate(kept.events[axis]);
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
        let (order, positions) = strategy.parts();
        let all_compete = order == super::strategy::AxisOrder::All;
        let mut best: Option<Split> = None;
        for axis in order.axes(path.depth, bounds) {
            let candidate = self.cheapest(bounds, axis, region, positions);
            if let Some(split) = candidate
                && best.is_none_or(|b| split.cost < b.cost)
            {
                best = Some(split);
            }
            if best.is_some() && !all_compete {
                break;
            }
        }
        let split = best?;
        let patience = stop.cuts(split.cost, cost.leaf(n as f64), path.patience)?;
        Some((split, patience))
    }

    /// The strategy's cheapest plane on one axis.
    fn cheapest(
        &mut self,
        bounds: &Aabb,
        axis: Axis,
        region: Region,
        positions: Positions,
    ) -> Option<Split> {
        let spatial = spatial_median(bounds, axis);
        let mut medians = || {
            self.object_median(bounds, axis, region)
                .map(|object| (spatial.min(object), spatial.max(object)))
        };
        // `window`: object bounds in it are candidates; `extra`: further positions, ascending.
        let mut window = None;
        let mut extra = match positions {
            Positions::AllBounds => {
                window = Some((bounds.lo[axis], bounds.hi[axis]));
                vec![]
            }
            Positions::SpatialMedian => vec![spatial],
            Positions::ObjectMedian => vec![self.object_median(bounds, axis, region)?],
            Positions::MedianMidpoint => {
                let (a, b) = medians()?;
                vec![0.5 * a + 0.5 * b]
            }
            Positions::BoundsBetweenMedians => {
                let (a, b) = medians()?;
                window = Some((a, b));
                vec![a, b]
            }
            Positions::Samples(count) => {
                let (a, b) = medians()?;
                samples(a, b, count)
            }
        };
        // Medians that meet, and samples between nearly equal ones, are one candidate.
        extra.dedup();
        let sweep = Sweep {
            axis,
            bounds,
            events: &self.events[axis][region.events[axis]..],
            n: self.objects.len() - region.objects,
            cost: &self.rules.cost,
            keep_useless: self.rules.stop.takes_useless_planes(),
        };
        sweep.cheapest(window, &extra)
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
        let Split {
            axis,
            position: s,
            planar_left,
            ..
        } = *split;
        let bounds: &[Aabb] = &self.bounds;
        for &object in &self.objects[region.objects..] {
            let b = &bounds[object as usize];
            let (left, right) = (b.lo[axis] < s, b.hi[axis] > s);
            self.sides[object as usize] = match (left, right) {
                (false, false) if planar_left => LEFT,
                (false, false) => RIGHT,
                _ => u8::from(left) * LEFT + u8::from(right) * RIGHT,
            };
        }
        if let Some(clipping) = &mut self.clipping {
            let objects = &self.objects[region.objects..];
            let bounds = self.bounds.to_mut();
            clipping.cut(objects, &mut self.sides, bounds, (axis, s));
        }
        let mut top = Region::default();
        let mut kept = Region::default();
        (top.objects, kept.objects) = spread(&mut self.objects, region.objects, |&object| {
            self.sides[object as usize]
        });
        if let Some(clipping) = &self.clipping {
            // Their events here end: the parts have their own.
            for &object in &clipping.cut {
                self.sides[object as usize] = 0;
            }
        }
        let sides = &self.sides;
        for k in 0..3 {
            let start = region.events[k];
            let events = &mut self.events[k];
            (top.events[k], kept.events[k]) = if k == axis {
                // An event beyond the plane leaves the child's box: its object now reaches the face.
                spread(events, start, |e| {
                    let inside =
                        u8::from(e.position <= s) * LEFT + u8::from(e.position >= s) * RIGHT;
                    sides[e.object as usize] & inside
                })
            } else {
                spread(events, start, |e| sides[e.object as usize])
            };
            if let Some(clipping) = &self.clipping {
                // At most as many as the objects had here, so the right list still ends below the left one.
                kept.events[k] = clipping.merge(1, k, events, start, kept.events[k]);
                debug_assert!(kept.events[k] <= top.events[k]);
                clipping.merge(0, k, events, top.events[k], events.len());
            }
        }
        (top, kept)
    }
}

/// Split the list on top of an arena (from `start` on): right entries move down into its place, left entries are put on
/// top; entries may do both. Returns where the left list begins and where the right one ends. Keeps order.
fn spread<T: Copy>(arena: &mut Vec<T>, start: usize, side: impl Fn(&T) -> u8) -> (usize, usize) {
    let top = arena.len();
    let mut end = start;
    for i in start..top {
        let entry = arena[i];
        let side = side(&entry);
        if side & LEFT != 0 {
            arena.push(entry);
        }
        arena[end] = entry;
        end += usize::from(side & RIGHT != 0);
    }
    (top, end)
}
