//! Rays from outside that stop at their nearest hit.
//!
//! Haines (Ray Tracing News 17(1), 2004) and Ize & Hansen (2011) let the far child cost only the rays that hit nothing
//! in the near one; here for a whole tree. Hits in different leaves are taken as independent.

use crate::kd::Tree;

use super::ways::{Inner, from_leaves};
use super::{Expected, Parts};

/// What a node is to a ray that comes from outside and crosses it.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Crossing {
    /// Work in the node and below.
    pub work: Expected,
    /// The chance that the ray hits nothing in it.
    pub miss: f64,
}

impl Crossing {
    /// A leaf of so many objects.
    pub fn leaf(objects: u32, miss: f64) -> Self {
        Self {
            work: Expected::leaf(objects),
            miss,
        }
    }

    /// An inner node: of the lines through both children half come from each side.
    pub fn inner(inner: Inner, l: Self, r: Self) -> Self {
        let ways = inner.ways;
        let share = |only: f64, other: Self| only + 0.5 * ways.both * (1.0 + other.miss);
        Self {
            work: Expected::INNER + l.work * share(ways.left, r) + r.work * share(ways.right, l),
            miss: ways.left * l.miss + ways.right * r.miss + ways.both * l.miss * r.miss,
        }
    }
}

/// What a ray from outside is expected to do until its nearest hit.
pub(super) fn expected(tree: &Tree, parts: &Parts) -> Expected {
    let leaf = |leaf, _, objects| Crossing::leaf(objects, parts.of(leaf).miss);
    from_leaves(tree, leaf, Crossing::inner).work
}
