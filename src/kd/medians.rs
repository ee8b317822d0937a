//! The two medians of a node on one axis.

use crate::geom::{Aabb, Axis};

/// Middle of the node, b_rm.
pub(super) fn spatial_median(node: &Aabb, axis: Axis) -> f64 {
    0.5 * node.lo[axis] + 0.5 * node.hi[axis]
}

/// Middle of an object's box clipped to the node.
#[inline]
pub(super) fn clipped_centre(object: &Aabb, node: &Aabb, axis: Axis) -> f64 {
    0.5 * object.lo[axis].max(node.lo[axis]) + 0.5 * object.hi[axis].min(node.hi[axis])
}

/// Median of the objects' clipped centres, b_om; the mean of the middle two of an even number. Reorders them.
pub(super) fn object_median(centres: &mut [f64]) -> Option<f64> {
    let n = centres.len();
    if n == 0 {
        return None;
    }
    let (below, &mut upper, _) = centres.select_nth_unstable_by(n / 2, f64::total_cmp);
    if n % 2 == 1 {
        return Some(upper);
    }
    let lower = below.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    Some(0.5 * lower + 0.5 * upper)
}
