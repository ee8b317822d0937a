//! Neighbour links: six per leaf, one a face, to what lies behind it (MacDonald & Booth 1990, section 5; "ropes" of Popov,
//! Guenther, Seidel & Slusallek 2007).
//!
//! A link leads to the leaf behind the face; if several touch it, to the smallest node that covers the face; on the root's box
//! nowhere. A ray that leaves a leaf goes on along the link of the face it leaves through and needs no stack ([`Linked`]); from
//! a covering node it descends, or goes through a face's own tree ([`FaceTrees`], "rope trees" of Havran, Bittner &
//! Zara 1998). Hapala & Havran 2011 review all of them.

mod faces;
mod walk;

use crate::geom::{Axis, Real, Vector};

use super::{NodeKind, Planes};

pub use faces::{FaceTrees, FacesLinked};
pub use walk::Linked;
pub(super) use walk::fall_back;

/// A link that leads nowhere.
const OUTSIDE: u32 = u32::MAX;

/// Set in links to leaves; the other bits are the leaf's number. In the others it is not, and they are an inner node's.
const LEAF: u32 = 1 << 31;

/// The faces of a box, or what belongs to each: by axis, then lower and upper.
type Faces<T> = [[T; 2]; 3];

/// Where a link leads.
enum Target {
    /// Out of the root's box.
    Outside,
    /// To the leaf of this number.
    Leaf(u32),
    /// To an inner node.
    Inner(u32),
}

#[inline(always)]
fn target(link: u32) -> Target {
    if link & LEAF == 0 {
        Target::Inner(link)
    } else if link == OUTSIDE {
        Target::Outside
    } else {
        Target::Leaf(link & !LEAF)
    }
}

/// All that a walk reads of a leaf.
#[derive(Clone, Debug, PartialEq)]
struct Leaf<T> {
    /// Where its faces lie.
    planes: Faces<T>,
    links: Faces<u32>,
    /// Its references.
    first: u32,
    count: u32,
}

/// The links of a tree's leaves, with the boxes and references of these.
///
/// ```
/// use sahlab::cost::CostModel;
/// use sahlab::geom::{Ray, Span};
/// use sahlab::kd::{Links, Rules, Stack, StopRule, Strategy, build, nearest};
/// use sahlab::rays::SurfaceLines;
/// use sahlab::scene::Scene;
///
/// let scene = Scene::load("simple:soup:200")?;
/// let (strategy, stop) = (Strategy::Sah, StopRule::CostGain { depth: None });
/// let rules = Rules { strategy, stop, cost: CostModel::WALD_HAVRAN, clipped: false };
/// let tree = build(&scene.bounds, scene.world, &rules);
/// let links = Links::of(&tree);
/// let facts = links.facts();
/// assert_eq!(facts.to_leaves + facts.to_inner + facts.outside, 6 * tree.leaves());
///
/// // The same hits as with a stack, to the bit.
/// let mut stack = Stack::default();
/// for line in (SurfaceLines { world: scene.world, seed: 1 }).range(0..1000) {
///     let ray = Ray::new(line, Span::from(0.0));
///     let plain = nearest(&tree, &scene.objects, &ray, &mut stack);
///     let linked = nearest(&links.walk(&tree), &scene.objects, &ray, &mut stack);
///     assert_eq!(linked.map(|hit| hit.bits()), plain.map(|hit| hit.bits()));
/// }
/// # Ok::<(), sahlab::scene::SceneError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Links<V: Vector> {
    /// Leaves from left to right.
    leaves: Vec<Leaf<V::Real>>,
    /// The node of each: what only probes are told.
    nodes: Vec<u32>,
    /// Each node's leaf number; [`OUTSIDE`] for inner nodes.
    numbers: Vec<u32>,
}

/// Where links lead: their numbers add up to six per leaf.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LinkFacts {
    /// Straight to the leaf behind the face.
    pub to_leaves: usize,
    /// To the smallest node that covers the face.
    pub to_inner: usize,
    /// Nowhere: the face lies in the root's box.
    pub outside: usize,
}

/// A node on the way down: its box, and for each face the smallest node known to cover it.
struct Cell<T> {
    planes: Faces<T>,
    covering: Faces<Option<u32>>,
}

impl<T: Real> Cell<T> {
    /// Follow each link down as far as one child still covers the face.
    fn push_down(&mut self, tree: &impl Planes<Real = T>) {
        for axis in 0..3 {
            for (side, covering) in self.covering[axis].iter_mut().enumerate() {
                while let Some(node) = *covering
                    && let NodeKind::Inner {
                        axis: normal,
                        split,
                        left,
                    } = tree.node(node)
                    && let Some(above) = beside(&self.planes, (axis, side), normal, split)
                {
                    *covering = Some(left + u32::from(above));
                }
            }
        }
    }

    /// Below and above a plane; each is behind the other's face in it.
    fn split(&self, axis: Axis, split: T, left: u32) -> (Self, Self) {
        let part = |side: usize, behind: u32| {
            let (mut planes, mut covering) = (self.planes, self.covering);
            planes[axis][side] = split;
            covering[axis][side] = Some(behind);
            Self { planes, covering }
        };
        (part(1, left + 1), part(0, left))
    }
}

/// Which child of a node behind a face covers it alone, the one above (true) or below its plane; `None` if the plane cuts the
/// face. A plane parallel to the face has the child next to it there.
fn beside<T: Real>(
    planes: &Faces<T>,
    (axis, side): (Axis, usize),
    normal: Axis,
    split: T,
) -> Option<bool> {
    let [lo, hi] = planes[normal];
    if normal == axis {
        Some(side == 0)
    } else if hi <= split {
        Some(false)
    } else if lo >= split {
        Some(true)
    } else {
        None
    }
}

impl<V: Vector> Links<V> {
    /// The links of a tree, in one pass down.
    ///
    /// # Panics
    /// If the tree has 2^31 nodes or more.
    pub fn of<T: Planes<Vector = V, Real = V::Real>>(tree: &T) -> Self {
        let world = tree.world();
        let root = Cell {
            planes: [0, 1, 2].map(|axis| [world.lo[axis], world.hi[axis]]),
            covering: [[None; 2]; 3],
        };
        let (mut leaves, mut nodes) = (Vec::new(), Vec::new());
        // Links of the leaves by node numbers, as long as not all leaves have theirs.
        let mut covering = Vec::new();
        let mut pending = vec![(0, root)];
        while let Some((node, mut cell)) = pending.pop() {
            cell.push_down(tree);
            match tree.node(node) {
                NodeKind::Inner { axis, split, left } => {
                    let (below, above) = cell.split(axis, split, left);
                    pending.extend([(left + 1, above), (left, below)]);
                }
                NodeKind::Leaf { first, count } => {
                    leaves.push(Leaf {
                        planes: cell.planes,
                        links: [[OUTSIDE; 2]; 3],
                        first,
                        count,
                    });
                    nodes.push(node);
                    covering.push(cell.covering);
                }
            }
        }
        let last = *nodes.iter().max().expect("a tree has a leaf");
        assert!(last < !LEAF, "links number fewer than 2^31 nodes");
        let mut numbers = vec![OUTSIDE; last as usize + 1];
        for (number, &node) in (0..).zip(&nodes) {
            numbers[node as usize] = number;
        }
        let link = |node: Option<u32>| match node {
            None => OUTSIDE,
            Some(node) => match numbers.get(node as usize) {
                Some(&number) if number != OUTSIDE => LEAF | number,
                _ => node,
            },
        };
        for (leaf, covering) in leaves.iter_mut().zip(&covering) {
            leaf.links = covering.map(|pair| pair.map(link));
        }
        Self {
            leaves,
            nodes,
            numbers,
        }
    }

    /// Bytes that a walk reads besides the tree itself: leaves and their numbers. What only probes are told is not among them.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.leaves[..]) + size_of_val(&self.numbers[..])
    }

    /// The node of a leaf; without a branch, so that nothing is left of it where no probe asks.
    #[inline(always)]
    fn node(&self, leaf: u32) -> u32 {
        self.nodes.get(leaf as usize).copied().unwrap_or_default()
    }

    /// Where the links lead.
    pub fn facts(&self) -> LinkFacts {
        let mut facts = LinkFacts::default();
        for &link in self
            .leaves
            .iter()
            .flat_map(|leaf| leaf.links.as_flattened())
        {
            match target(link) {
                Target::Outside => facts.outside += 1,
                Target::Leaf(_) => facts.to_leaves += 1,
                Target::Inner(_) => facts.to_inner += 1,
            }
        }
        facts
    }

    /// The way through the tree along these links, which must be its own: through another tree it leads anywhere, or panics.
    pub fn walk<'a, T: Planes<Vector = V, Real = V::Real>>(&'a self, tree: &'a T) -> Linked<'a, T> {
        Linked::new(tree, self)
    }
}

#[cfg(test)]
mod tests;
