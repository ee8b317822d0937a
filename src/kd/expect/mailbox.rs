//! Lines that test no object twice, though it is in several leaves.
//!
//! Haines (Ray Tracing News 17(1), 2004) and Hunt (2008) take what both children share off the cost of one plane:
//! P_left n_left + P_right n_right - P_both n_both. Here for a whole tree, object by object: of the lines through both
//! children, those that test the object in one and those that test it in the other are taken as independent. As the object's
//! leaves mostly touch, that is too little overlap; so no chance is left above that to hit the box around these leaves. Exact
//! where the object is in every leaf below one of two children, and where its leaves make up a box.

use crate::geom::Aabb;
use crate::kd::Tree;

use super::Expected;
use super::ways::{Inner, from_leaves};

/// Work of a line below a node, and the objects that it may test there.
#[derive(Default)]
struct Below {
    n_k: f64,
    n_b: f64,
    /// Ascending by object.
    tested: Vec<Tested>,
}

/// How a line through a node tests one object there.
#[derive(Clone, Copy)]
struct Tested {
    object: u32,
    chance: f64,
    /// The box around the object's leaves.
    around: Aabb,
}

/// What a line is expected to do, n_t counting distinct objects.
pub(super) fn expected(tree: &Tree) -> Expected {
    let leaf = |leaf, first, count| {
        let test = |&object: &u32| Tested {
            object,
            chance: 1.0,
            around: tree.boxes[leaf],
        };
        let mut tested: Vec<_> = tree.objects(first, count).iter().map(test).collect();
        tested.sort_unstable_by_key(|t| t.object);
        Below {
            n_k: 0.0,
            n_b: 1.0,
            tested,
        }
    };
    let inner = |inner: Inner, l, r| joined(tree.boxes[inner.node].surface_area(), inner, l, r);
    let root = from_leaves(tree, leaf, inner);
    Expected {
        n_k: root.n_k,
        n_b: root.n_b,
        n_t: root.tested.iter().map(|t| t.chance).sum(),
    }
}

/// An inner node of this surface area from its children.
fn joined(area: f64, inner: Inner, l: Below, r: Below) -> Below {
    let ways = inner.ways;
    let [p_left, p_right] = [ways.left + ways.both, ways.right + ways.both];
    let mut tested = Vec::with_capacity(l.tested.len() + r.tested.len());
    let (mut left, mut right) = (
        l.tested.into_iter().peekable(),
        r.tested.into_iter().peekable(),
    );
    while let Some(object) = [left.peek(), right.peek()]
        .into_iter()
        .flatten()
        .map(|t| t.object)
        .min()
    {
        let none = Tested {
            object,
            chance: 0.0,
            around: Aabb::EMPTY,
        };
        let a = left.next_if(|t| t.object == object).unwrap_or(none);
        let b = right.next_if(|t| t.object == object).unwrap_or(none);
        let around = a.around.union(b.around);
        let independent = p_left * a.chance + p_right * b.chance - ways.both * a.chance * b.chance;
        tested.push(Tested {
            object,
            chance: independent.min(around.surface_area() / area),
            around,
        });
    }
    tested.shrink_to_fit();
    Below {
        n_k: 1.0 + p_left * l.n_k + p_right * r.n_k,
        n_b: p_left * l.n_b + p_right * r.n_b,
        tested,
    }
}
