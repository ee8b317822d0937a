//! A plane that cuts a node: what it costs, and where it sends the objects.

use crate::cost::CostModel;
use crate::geom::{Aabb, Axis};

/// The side below the plane, as a bit of a set of sides.
pub(super) const LEFT: u8 = 1;
/// The side above the plane.
pub(super) const RIGHT: u8 = 2;

/// A plane with its one-level cost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Split {
    pub axis: Axis,
    pub position: f64,
    /// Whether objects lying in the plane go left.
    pub planar_left: bool,
    /// Expected cost of the node cut here, its parts left as leaves.
    pub cost: f64,
}

impl Split {
    /// The sides that an object with these bounds goes to.
    #[inline]
    pub fn sides(&self, object: &Aabb) -> u8 {
        let left = object.lo[self.axis] < self.position;
        let right = object.hi[self.axis] > self.position;
        match (left, right) {
            (false, false) => self.planar_side(),
            _ => u8::from(left) * LEFT + u8::from(right) * RIGHT,
        }
    }

    /// The side that an object lying in the plane goes to.
    #[inline]
    pub fn planar_side(&self) -> u8 {
        if self.planar_left { LEFT } else { RIGHT }
    }
}

/// The split cost on one axis of one node as a function of the position and the counts.
pub(super) struct Coster<'a> {
    axis: Axis,
    /// Objects in the node.
    n: usize,
    cost: &'a CostModel,
    /// Whether a plane that keeps all n objects on both sides is a candidate.
    keep_useless: bool,
    lo: f64,
    hi: f64,
    /// Area of the cut and half its perimeter: a part of length x has SA = 2 (cut + x girth).
    cut: f64,
    girth: f64,
    /// 2 / SA(node).
    scale: f64,
}

impl<'a> Coster<'a> {
    /// For planes across `axis` of a node with `n` objects; see [`StopRule`](super::StopRule) for `keep_useless`.
    pub fn new(axis: Axis, node: &Aabb, n: usize, cost: &'a CostModel, keep_useless: bool) -> Self {
        let extent = node.extent();
        Self {
            axis,
            n,
            cost,
            keep_useless,
            lo: node.lo[axis],
            hi: node.hi[axis],
            cut: extent[(axis + 1) % 3] * extent[(axis + 2) % 3],
            girth: extent[(axis + 1) % 3] + extent[(axis + 2) % 3],
            scale: 2.0 / node.surface_area(),
        }
    }

    /// The node's own faces.
    pub fn faces(&self) -> (f64, f64) {
        (self.lo, self.hi)
    }

    /// Whether more objects on a side never make a plane cheaper, not by a rounding either: costs and areas are numbers that
    /// are not negative, and area is not lost to overflow or underflow.
    pub fn is_monotone(&self) -> bool {
        let CostModel { c_k, c_b, c_t } = *self.cost;
        let sound = |x: f64| x >= 0.0 && x.is_finite();
        [c_k, c_b, c_t].into_iter().all(sound) && sound(self.scale) && self.scale > 0.0
    }

    /// The one-level cost of the plane at s with so many objects on its sides.
    #[inline(always)]
    pub fn cost(&self, s: f64, left: f64, right: f64) -> f64 {
        let p_left = self.scale * (self.cut + (s - self.lo) * self.girth);
        let p_right = self.scale * (self.cut + (self.hi - s) * self.girth);
        self.cost.split(p_left, left, p_right, right)
    }

    /// Whether a plane here parts the node: one in a face does not.
    #[inline]
    pub fn is_inside(&self, s: f64) -> bool {
        self.lo < s && s < self.hi
    }

    /// Take the split at s for the best so far if it is a candidate strictly inside the node and cheaper.
    #[inline]
    pub fn offer(
        &self,
        best: &mut Option<Split>,
        s: f64,
        left: usize,
        planar: usize,
        right: usize,
    ) {
        if !self.is_inside(s) {
            return;
        }
        if let Some(split) = self.split(s, left, planar, right)
            && best.is_none_or(|b| split.cost < b.cost)
        {
            *best = Some(split);
        }
    }

    /// The split at s with `planar` objects on its cheaper side (left on a tie), or `None` if it is no candidate.
    #[inline]
    pub fn split(&self, s: f64, left: usize, planar: usize, right: usize) -> Option<Split> {
        let with = |l: usize, r: usize| {
            let useless = l == self.n && r == self.n && !self.keep_useless;
            (!useless).then(|| self.cost(s, l as f64, r as f64))
        };
        let on_left = with(left + planar, right);
        let on_right = if planar > 0 {
            with(left, right + planar)
        } else {
            None
        };
        let (planar_left, cost) = match (on_left, on_right) {
            (Some(l), Some(r)) if r < l => (false, r),
            (Some(l), _) => (true, l),
            (None, Some(r)) => (false, r),
            (None, None) => return None,
        };
        Some(Split {
            axis: self.axis,
            position: s,
            planar_left,
            cost,
        })
    }
}
