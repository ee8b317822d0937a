//! The exact-SAH trees as their definition says: every plane is counted from the boxes of all objects in the node, and
//! children get lists of their own. No events, no arenas, no order kept.

use super::*;
use crate::geom::{Axis, Clipper, clip_slack};
use crate::kd::split::{Coster, LEFT, RIGHT, Split};
use crate::kd::strategy::AxisOrder;
use crate::kd::{Node, StopRule};

struct Naive<'a> {
    objects: &'a Objects,
    rules: &'a Rules,
    depth_bound: usize,
    slack: f64,
    tree: Tree,
}

/// An object and the box it has in a node.
type Part = (u32, Aabb);

impl Naive<'_> {
    /// The first of the cheapest bounds on one axis.
    fn cheapest_on(&self, axis: Axis, node: &Aabb, parts: &[Part]) -> Option<Split> {
        let Rules { stop, cost, .. } = self.rules;
        let coster = Coster::new(axis, node, parts.len(), cost, stop.takes_useless_planes());
        let ends = parts.iter().flat_map(|(_, b)| [b.lo[axis], b.hi[axis]]);
        let mut planes: Vec<f64> = ends.map(|s| s + 0.0).collect();
        planes.sort_unstable_by(f64::total_cmp);
        let mut best = None;
        for s in planes {
            let count =
                |which: &dyn Fn(&Aabb) -> bool| parts.iter().filter(|p| which(&p.1)).count();
            let left = count(&|b| b.lo[axis] < s);
            let right = count(&|b| b.hi[axis] > s);
            let planar = count(&|b| b.lo[axis] == s && b.hi[axis] == s);
            coster.offer(&mut best, s, left, planar, right);
        }
        best
    }

    fn choose(&self, node: &Aabb, parts: &[Part], path: Path) -> Option<(Split, usize)> {
        let Rules {
            strategy,
            stop,
            cost,
            ..
        } = *self.rules;
        let n = parts.len();
        let share = node.surface_area() / self.tree.world.surface_area();
        if path.depth >= self.depth_bound || stop.stops_at(path.depth, n, share) {
            return None;
        }
        let (order, _) = strategy.parts();
        let axes = order.axes(path.depth, node);
        let mut on_axes = axes
            .iter()
            .filter_map(|&axis| self.cheapest_on(axis, node, parts));
        let split = if order == AxisOrder::All {
            on_axes.reduce(|a, b| if b.cost < a.cost { b } else { a })
        } else {
            on_axes.next()
        }?;
        let patience = stop.cuts(split.cost, cost.leaf(n as f64), path.patience)?;
        Some((split, patience))
    }

    fn parts(&self, split: &Split, parts: &[Part], side: u8) -> Vec<Part> {
        let there = parts.iter().filter(|(_, b)| split.sides(b) & side != 0);
        let part = |&(object, b): &Part| {
            if !self.rules.clipped || split.sides(&b) != LEFT | RIGHT {
                return Some((object, b));
            }
            let (left, right) = b.split(split.axis, split.position);
            let region = if side == LEFT { left } else { right };
            let mut clipper = Clipper::default();
            let part = self
                .objects
                .clipped_bounds(object, &region, self.slack, &mut clipper);
            part.map(|part| (object, part))
        };
        there.filter_map(part).collect()
    }

    fn grow(&mut self, node: usize, parts: &[Part], path: Path) {
        let bounds = self.tree.boxes[node];
        let Some((split, patience)) = self.choose(&bounds, parts, path) else {
            let first = self.tree.references.len() as u32;
            self.tree.nodes[node] = Node::leaf(first, parts.len() as u32);
            self.tree.references.extend(parts.iter().map(|p| p.0));
            self.tree.depth = self.tree.depth.max(path.depth);
            return;
        };
        let left = self.tree.nodes.len();
        self.tree.nodes[node] = Node::inner(split.axis, split.position, left as u32);
        self.tree.nodes.extend([Node::leaf(0, 0); 2]);
        let (left_box, right_box) = bounds.split(split.axis, split.position);
        self.tree.boxes.extend([left_box, right_box]);
        for (child, side) in [(left, LEFT), (left + 1, RIGHT)] {
            let below = Path {
                depth: path.depth + 1,
                patience,
            };
            self.grow(child, &self.parts(&split, parts, side), below);
        }
    }
}

fn naive(objects: &Objects, rules: &Rules) -> Tree {
    let bounds = objects.bounds();
    let world = world(&bounds);
    let stop: StopRule = rules.stop;
    let mut naive = Naive {
        objects,
        rules,
        depth_bound: stop.depth_bound(bounds.len()),
        slack: clip_slack(&world),
        tree: Tree {
            nodes: vec![Node::leaf(0, 0)],
            boxes: vec![world],
            references: Vec::new(),
            depth: 0,
            world,
        },
    };
    let root = Path {
        depth: 0,
        patience: stop.patience(bounds.len()),
    };
    let parts: Vec<Part> = (0..).zip(bounds).collect();
    naive.grow(0, &parts, root);
    naive.tree
}

#[test]
fn trees_are_those_of_the_definition() {
    let stops = [
        "cost-gain",
        "automatic",
        "objects:1:14",
        "cost-k:0.3",
        "depth:5",
        "octree:2:6",
    ];
    let mut inner = 0;
    for (seed, stop) in (100..).zip(stops.into_iter().cycle().take(24)) {
        let numbers = &mut Numbers(seed);
        let mut objects = numbers.triangles(120, seed % 2 == 0);
        if seed % 3 == 0 {
            // No flat ones: all that the sweep passes over is starts and ends.
            let flat = |t: &Triangle| (t.bounds().extent().min_element()) == 0.0;
            objects.triangles.retain(|t| !flat(t));
        }
        let bounds = objects.bounds();
        for strategy in [Strategy::Sah, Strategy::SahCyclic, Strategy::SahLongest] {
            for clipped in [false, true] {
                let rules = Rules {
                    strategy,
                    stop: stop.parse().expect("a stop rule"),
                    cost: CostModel::WALD_HAVRAN,
                    clipped,
                };
                let tree = build_objects(&objects, &bounds, world(&bounds), &rules);
                assert_eq!(
                    tree,
                    naive(&objects, &rules),
                    "{strategy} {stop} {seed} {clipped}"
                );
                inner += tree.inner_nodes();
            }
        }
    }
    assert!(inner > 5000, "{inner} planes compared");
}
