//! The stack traversal, generic over a [`Probe`], a padding [`Mode`] and the numbers of a tree ([`Planes`]); and what every
//! traversal is ([`Walk`]).
//!
//! A line with span [t0, t1] in a node meets the plane at t: it visits the near child if t >= t0 and the far one if
//! t <= t1, both ends included; a line parallel to the plane visits its side, or both sides if it lies in the plane.
//! Near and far are told by the direction's sign, never by the origin's side. Unpadded, the visited nodes are exactly
//! those whose closed boxes pass the slab test, bit for bit.

use glam::DVec3;

use crate::geom::{Aabb, Line, Real, Span, Vector, slack};

use super::{NodeKind, Probe, Tree, Turn};

/// How parameters of planes are treated.
pub trait Mode {
    /// Whether each plane's t is widened by [`Real::PADDING`] of itself.
    const PADDED: bool;
}

/// Counting: closed and unpadded, equal to the slab test on every node's box.
pub struct Counting;

/// Tracing: widened, so that rounding never loses a hit.
pub struct Tracing;

impl Mode for Counting {
    const PADDED: bool = false;
}

impl Mode for Tracing {
    const PADDED: bool = true;
}

/// What a traversal reads of a tree.
pub trait Planes {
    /// Points of its numbers.
    type Vector: Vector<Real = Self::Real>;
    /// Its numbers.
    type Real: Real;

    /// The root's box.
    fn world(&self) -> &Aabb<Self::Vector>;
    /// What a node is, with its data.
    fn node(&self, number: u32) -> NodeKind<Self::Real>;
    /// Objects in a leaf given by its reference range.
    fn objects(&self, first: u32, count: u32) -> &[u32];
}

impl Planes for Tree {
    type Vector = DVec3;
    type Real = f64;

    #[inline(always)]
    fn world(&self) -> &Aabb {
        &self.world
    }

    #[inline(always)]
    fn node(&self, number: u32) -> NodeKind {
        self.nodes[number as usize].kind()
    }

    #[inline(always)]
    fn objects(&self, first: u32, count: u32) -> &[u32] {
        self.objects(first, count)
    }
}

/// A way through a tree: from leaf to leaf along a line, front to back.
///
/// A tree alone ([`Planes`]) is walked with a stack.
pub trait Walk {
    /// Points of the tree's numbers.
    type Vector: Vector;

    /// Visit the nodes that `line` meets within `span`, front to back.
    ///
    /// `leaf` gets a leaf's objects and the probe, and returns the t up to which further nodes matter: +inf for a line,
    /// the best hit so far for a nearest hit, -inf to stop.
    fn walk<M: Mode, P: Probe>(
        &self,
        line: &Line<Self::Vector>,
        span: Span<<Self::Vector as Vector>::Real>,
        stack: &mut Stack<<Self::Vector as Vector>::Real>,
        probe: &mut P,
        leaf: impl FnMut(&[u32], &mut P) -> <Self::Vector as Vector>::Real,
    );
}

impl<T: Planes> Walk for T {
    type Vector = T::Vector;

    #[inline(always)]
    fn walk<M: Mode, P: Probe>(
        &self,
        line: &Line<T::Vector>,
        span: Span<T::Real>,
        stack: &mut Stack<T::Real>,
        probe: &mut P,
        leaf: impl FnMut(&[u32], &mut P) -> T::Real,
    ) {
        traverse::<M, T, P>(self, line, span, stack, probe, leaf);
    }
}

/// Nodes still to visit, kept between traversals to spare allocations.
#[derive(Default)]
pub struct Stack<T = f64>(Vec<(u32, Span<T>)>);

/// [`Walk::walk`] with a stack.
#[inline]
pub fn traverse<M: Mode, T: Planes, P: Probe>(
    tree: &T,
    line: &Line<T::Vector>,
    span: Span<T::Real>,
    stack: &mut Stack<T::Real>,
    probe: &mut P,
    mut leaf: impl FnMut(&[u32], &mut P) -> T::Real,
) {
    let padding = if M::PADDED {
        T::Real::PADDING
    } else {
        T::Real::ZERO
    };
    let Some(Span { mut t0, mut t1 }) = tree.world().clip_padded(line, span, padding) else {
        return;
    };
    let stack = &mut stack.0;
    stack.clear();
    let mut node = 0;
    loop {
        match tree.node(node) {
            NodeKind::Inner { axis, split, left } => {
                probe.inner(node);
                if line.is_parallel(axis) {
                    let origin = line.origin.parts()[axis];
                    let inside = origin == split;
                    probe.turn(node, if inside { Turn::Both } else { Turn::Near });
                    node = left + u32::from(origin > split);
                    if inside {
                        stack.push((left + 1, Span { t0, t1 }));
                    }
                    continue;
                }
                let right_first = u32::from(line.inverse.parts()[axis] < T::Real::ZERO);
                let (near, far) = (left + right_first, left + 1 - right_first);
                let t = line.t_at(axis, split);
                let slack = slack(padding, t);
                if t - slack > t1 {
                    probe.turn(node, Turn::Near);
                    node = near;
                } else if t + slack < t0 {
                    probe.turn(node, Turn::Far);
                    node = far;
                } else {
                    probe.turn(node, Turn::Both);
                    let far_t0 = t0.max(t - slack);
                    stack.push((far, Span { t0: far_t0, t1 }));
                    node = near;
                    t1 = t1.min(t + slack);
                }
            }
            NodeKind::Leaf { first, count } => {
                probe.leaf(node, count);
                let limit = leaf(tree.objects(first, count), probe);
                // Skip what begins beyond the limit, but do not stop there: the right side of a plane that the line
                // lies in waits below nodes that begin later.
                loop {
                    match stack.pop() {
                        Some((next, span)) if span.t0 <= limit => {
                            node = next;
                            Span { t0, t1 } = span;
                            break;
                        }
                        Some(_) => {}
                        None => return,
                    }
                }
            }
        }
    }
}

/// Visit every node that a line meets, as the area prediction assumes: the line never stops.
#[inline]
pub fn traverse_line(
    tree: &Tree,
    line: &Line,
    span: Span,
    stack: &mut Stack,
    mut probe: impl Probe,
) {
    traverse::<Counting, _, _>(tree, line, span, stack, &mut probe, |_, _| f64::INFINITY);
}
