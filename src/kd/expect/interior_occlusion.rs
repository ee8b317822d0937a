//! Rays from inside the root's box that stop at their nearest hit.
//!
//! A ray that starts in a node starts in one of its children, by their volumes, and leaves that one unhit with some
//! chance. Of the rays that leave a child, its faces are taken to let through their shares of its area, and those through
//! the common face to cross the other child as rays from outside do. This tells what share of the work stopping saves; the
//! work without stopping is that of `interior`, which needs no such simplification.

use crate::geom::Aabb;
use crate::kd::Tree;

use super::occlusion::Crossing;
use super::ways::{Inner, from_leaves};
use super::{Expected, Metric, Parts};

/// What a node is to a ray that starts in it, and to one that crosses it.
#[derive(Clone, Copy, Default)]
struct Start {
    crossing: Crossing,
    /// Work of a ray that starts in the node, in it and below.
    work: Expected,
    /// The chance that the ray leaves the node without a hit.
    leave: f64,
}

/// What a ray from inside is expected to do until its nearest hit.
pub(super) fn expected(tree: &Tree, parts: &Parts) -> Expected {
    let never = Metric::Interior.expected(tree, parts);
    let with = recursion(tree, |leaf| parts.of(leaf).miss_inside);
    let without = recursion(tree, |_| 1.0);
    let scaled = |never: f64, with: f64, without: f64| {
        if without > 0.0 {
            never * (with / without)
        } else {
            0.0
        }
    };
    Expected {
        n_k: scaled(never.n_k, with.n_k, without.n_k),
        n_b: scaled(never.n_b, with.n_b, without.n_b),
        n_t: scaled(never.n_t, with.n_t, without.n_t),
    }
}

/// The recursion for leaves that are missed with these chances. In a flat box a ray leaves where it begins.
fn recursion(tree: &Tree, miss: impl Fn(usize) -> f64) -> Expected {
    let flat = tree.boxes[0].volume() == 0.0;
    let size = |b: &Aabb| if flat { b.surface_area() } else { b.volume() };
    let leaf = |leaf, _, objects| {
        let crossing = Crossing::leaf(objects, miss(leaf));
        Start {
            crossing,
            work: crossing.work,
            leave: from_anywhere(crossing.miss),
        }
    };
    let inner = |inner: Inner, l: Start, r: Start| {
        let [node, left, right] =
            [inner.node, inner.left, inner.left + 1].map(|node| &tree.boxes[node]);
        let face = 0.5 * inner.ways.both * node.surface_area();
        // Work and chance to leave of a ray that starts in `own`.
        let from = |own: Start, part: &Aabb, other: Start| {
            let through = own.leave * face / part.surface_area();
            let work = own.work + other.crossing.work * through;
            (work, own.leave - through * (1.0 - other.crossing.miss))
        };
        let (l_work, l_leave) = from(l, left, r);
        let (r_work, r_leave) = from(r, right, l);
        let share = size(left) / size(node);
        Start {
            crossing: Crossing::inner(inner, l.crossing, r.crossing),
            work: Expected::INNER + l_work * share + r_work * (1.0 - share),
            leave: l_leave * share + r_leave * (1.0 - share),
        }
    };
    from_leaves(tree, leaf, inner).work
}

/// The chance to leave for a ray that starts anywhere on a chord which a line crosses unhit with the chance `miss`, hits
/// being equally likely all along it: the mean of miss^u over u from 0 to 1.
fn from_anywhere(miss: f64) -> f64 {
    if miss <= 0.0 {
        0.0
    } else if miss > 1.0 - 1e-8 {
        // The quotient's limit; beside it the quotient loses its digits.
        0.5 * (1.0 + miss)
    } else {
        (miss - 1.0) / libm::log(miss)
    }
}
