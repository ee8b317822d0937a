//! Proof of a tree's invariants from the tree and the objects' boxes, independent of how it was built.

use crate::geom::{Aabb, Clipper, Object, Objects, clip_slack};

use super::{NodeKind, Tree};

/// Check every invariant; the error lists what is wrong, at most a few of each kind.
///
/// Proved: the nodes are one tree in the arena; each box is its parent's cut at the parent's plane, strictly inside; the
/// root's box is the world and holds every object; references tile their array; an object is in a leaf if and only if the placement rule leads it
/// there (lying in a plane: on exactly one side); the depth is right. An object stands in a leaf at most once.
pub fn audit(tree: &Tree, bounds: &[Aabb]) -> Result<(), Vec<String>> {
    audit_over(tree, bounds, None)
}

/// As [`audit()`], of a tree that was built with clipping: an object may be missing from a leaf that its box reaches if it
/// has no part there, not even within half the slack that parts are widened by ([`clip_slack`]).
pub fn audit_clipped(tree: &Tree, objects: &Objects, bounds: &[Aabb]) -> Result<(), Vec<String>> {
    audit_over(tree, bounds, Some(objects))
}

fn audit_over(tree: &Tree, bounds: &[Aabb], objects: Option<&Objects>) -> Result<(), Vec<String>> {
    let mut audit = Audit {
        tree,
        bounds,
        objects,
        faults: Vec::new(),
    };
    if audit.shape() {
        audit.boxes();
        audit.references();
    }
    if audit.faults.is_empty() {
        Ok(())
    } else {
        Err(audit.faults)
    }
}

struct Audit<'a> {
    tree: &'a Tree,
    bounds: &'a [Aabb],
    /// The objects if they were clipped.
    objects: Option<&'a Objects>,
    faults: Vec<String>,
}

/// Rounding of the areas of seams that cancel, as a share of their polygon's.
const SEAMS: f64 = 1e-12;

/// Faults told before the audit gives up looking for more.
const ENOUGH: usize = 10;

impl Audit<'_> {
    fn fault(&mut self, message: String) {
        if self.faults.len() < ENOUGH {
            self.faults.push(message);
        }
    }

    /// Every node but the root is the child of exactly one node before it; numbers lie in range; the depth is right.
    fn shape(&mut self) -> bool {
        let n = self.tree.nodes.len();
        if self.tree.boxes.len() != n {
            self.fault(format!("{n} nodes but {} boxes", self.tree.boxes.len()));
            return false;
        }
        let mut parents = vec![0_u32; n];
        for (i, node) in self.tree.nodes.iter().enumerate() {
            if let NodeKind::Inner { left, .. } = node.kind() {
                let left = left as usize;
                if left <= i || left + 1 >= n {
                    self.fault(format!(
                        "node {i}: children {left} and {}, of {n} nodes",
                        left + 1
                    ));
                    return false;
                }
                parents[left] += 1;
                parents[left + 1] += 1;
            }
        }
        for (i, &count) in parents.iter().enumerate().skip(1) {
            if count != 1 {
                self.fault(format!("node {i}: child of {count} nodes"));
            }
        }
        let depth = self.tree.depths().into_iter().max().unwrap_or(0) as usize;
        if depth != self.tree.depth {
            self.fault(format!(
                "depth {depth}, but the tree says {}",
                self.tree.depth
            ));
        }
        self.faults.is_empty()
    }

    /// Each box is its parent's, cut.
    fn boxes(&mut self) {
        let boxes = &self.tree.boxes;
        if boxes[0] != self.tree.world {
            self.fault(format!(
                "the root's box {:?} is not the world {:?}",
                boxes[0], self.tree.world
            ));
        }
        for (i, b) in self.bounds.iter().enumerate() {
            if !(b.is_valid() && self.tree.world.contains(b)) {
                self.fault(format!("object {i} reaches outside the world"));
            }
        }
        for (i, node) in self.tree.nodes.iter().enumerate() {
            let NodeKind::Inner { axis, split, left } = node.kind() else {
                continue;
            };
            let parent = &boxes[i];
            if !(parent.lo[axis] < split && split < parent.hi[axis]) {
                self.fault(format!(
                    "node {i}: plane {split} on axis {axis} is not inside {parent:?}"
                ));
            }
            let cut = parent.split(axis, split);
            for (child, wanted) in [(left, cut.0), (left + 1, cut.1)] {
                let found = boxes[child as usize];
                if found != wanted {
                    self.fault(format!(
                        "node {child}: box {found:?}, but its parent's plane gives {wanted:?}"
                    ));
                }
            }
        }
    }

    /// Leaves hold what the placement rule leads there, each object once.
    fn references(&mut self) {
        let tree = self.tree;
        let leaf_range = |i: usize| match tree.nodes[i].kind() {
            NodeKind::Leaf { first, count } => Some((first as usize, count as usize)),
            NodeKind::Inner { .. } => None,
        };
        let mut ranges: Vec<_> = (0..tree.nodes.len()).filter_map(leaf_range).collect();
        ranges.sort_unstable();
        let mut end = 0;
        for (first, count) in ranges {
            // An empty leaf owns nothing, wherever it begins.
            if count == 0 {
                continue;
            }
            if first != end {
                self.fault(format!(
                    "references {end} to {first} belong to no leaf or to two"
                ));
                return;
            }
            end += count;
        }
        if end != tree.references.len() {
            self.fault(format!(
                "the leaves use {end} of {} references",
                tree.references.len()
            ));
            return;
        }
        if let Some(&o) = tree
            .references
            .iter()
            .find(|&&o| o as usize >= self.bounds.len())
        {
            self.fault(format!("reference to object {o} of {}", self.bounds.len()));
            return;
        }

        // Lead all objects down from the root. Where one lies in a plane, the subtree that has it tells the side.
        let held = self.held_by_subtree();
        let mut clipper = Clipper::default();
        let mut work: Vec<(usize, Vec<u32>)> = vec![(0, (0..self.bounds.len() as u32).collect())];
        while let Some((i, objects)) = work.pop() {
            match tree.nodes[i].kind() {
                NodeKind::Leaf { first, count } => {
                    let mut found = self.held(first, count).to_vec();
                    found.sort_unstable();
                    if found != objects {
                        let missing = |o: &&u32| found.binary_search(o).is_err();
                        let missed: Vec<u32> = objects.iter().filter(missing).copied().collect();
                        let extra = found.len() + missed.len() - objects.len();
                        let lost = missed
                            .into_iter()
                            .filter(|&o| self.has_part(o, i, &mut clipper))
                            .count();
                        if lost + extra == 0 {
                            continue;
                        }
                        self.fault(format!(
                            "leaf {i}: {lost} references lost, {extra} too many"
                        ));
                    }
                }
                NodeKind::Inner { axis, split, left } => {
                    let left = left as usize;
                    let (mut below, mut above) = (Vec::new(), Vec::new());
                    for o in objects {
                        let b = &self.bounds[o as usize];
                        let (goes_left, goes_right) = (b.lo[axis] < split, b.hi[axis] > split);
                        let in_plane = !goes_left && !goes_right;
                        let on_left = held[left].binary_search(&o).is_ok();
                        if goes_left || (in_plane && on_left) {
                            below.push(o);
                        }
                        if goes_right || (in_plane && !on_left) {
                            above.push(o);
                        }
                    }
                    work.push((left, below));
                    work.push((left + 1, above));
                }
            }
        }
    }

    /// Whether the object must be in the leaf that its box reaches.
    fn has_part(&self, object: u32, leaf: usize, clipper: &mut Clipper) -> bool {
        let Some(objects) = self.objects else {
            return true;
        };
        let slack = 0.5 * clip_slack(&self.tree.world);
        let leaf = &self.tree.boxes[leaf];
        if objects
            .clipped_bounds(object, leaf, slack, clipper)
            .is_none()
        {
            return false;
        }
        let Object::Polygon(polygon) = objects.get(object) else {
            return true;
        };
        // What is left of a polygon with reflex corners may be nothing but the seams between pieces that were cut away, which
        // run along the cuts and have no area.
        let bounds = &self.bounds[object as usize];
        let wide = Aabb::new(leaf.lo - slack, leaf.hi + slack);
        objects.area_within(object, bounds, &wide, clipper) > SEAMS * polygon.area()
    }

    /// What a leaf holds; an empty one may begin anywhere.
    fn held(&self, first: u32, count: u32) -> &[u32] {
        match count {
            0 => &[],
            _ => self.tree.objects(first, count),
        }
    }

    /// Objects in the leaves below each node that lie in some plane (others are empty lists): sorted.
    fn held_by_subtree(&self) -> Vec<Vec<u32>> {
        let tree = self.tree;
        let mut held: Vec<Vec<u32>> = vec![Vec::new(); tree.nodes.len()];
        let flat = |o: &u32| {
            let b = &self.bounds[*o as usize];
            b.lo.cmpeq(b.hi).any()
        };
        // Children come after their parent: from the end, every list is complete when it is passed up.
        for i in (0..tree.nodes.len()).rev() {
            held[i] = match tree.nodes[i].kind() {
                NodeKind::Leaf { first, count } => self
                    .held(first, count)
                    .iter()
                    .copied()
                    .filter(flat)
                    .collect(),
                NodeKind::Inner { left, .. } => {
                    [&held[left as usize][..], &held[left as usize + 1]].concat()
                }
            };
            held[i].sort_unstable();
            held[i].dedup();
        }
        held
    }
}
