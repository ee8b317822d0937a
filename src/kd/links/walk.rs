//! Walking along links, and why it meets the same leaves as the stack does.
//!
//! Write s(t) for the slack of t (none when counting); t - s(t) and t + s(t) grow with t, and so does the computed t of a plane
//! with its distance along the ray: all that follows holds of the computed numbers. Let the ray be in leaf L, entered at `t`, and let
//! `exit` and `second` be the least and second least t of the three planes it may leave L through. The walk goes on only if
//!
//! 1. `exit - s > t + s`: the ray is in L for longer than rounding could make up;
//! 2. `second - s > exit + s`: so it is in what face it leaves through.
//!
//! The stack then holds the far children of ancestors of L whose near side has L. Such an ancestor's plane is met no earlier than
//! L's own face on its axis. So one whose axis is not the exit's has its plane at `second` or later, hence beyond the exit by (2): had it
//! been below the ancestor P that owns the exit's plane, its far child would have begun behind P's near side and not been put on the stack.
//! P's far child is on top, its span begins at `exit - s`, and no other span begins earlier: if that is beyond the limit, all are, and
//! both ways end. Else the stack's next leaf is the first one below this child, where from an inner node with plane u it goes into the far
//! child if `u + s < exit - s`, else into the near one. Descending does just that, and from the root, with the t that the root
//! is entered at, in the first place. Where the link has already passed a node, its
//! plane is parallel to the face and lies behind it (u >= exit: near), or it passes the face on one side: behind L's own face on its axis
//! (u >= second: near), or before the one that L was entered through (u <= t: far, by (1)). So both go on in the same leaf, which is
//! entered at `exit`. In a leaf entered within rounding of an edge, (1) or (2) fails.
//!
//! A line parallel to an axis stays strictly between the planes of its leaves: where it lies in a plane of the tree, or in a face
//! of the root's box, the walk stops. Where it stops without being certain, the leaves so far are the stack's first ones, and all that
//! the stack still holds begins at `exit - s` or later: a stack traversal that begins there misses none of it. It may visit leaves again.
//!
//! Each link leads to a larger exit, so the walk ends.

use crate::geom::{Axis, Line, Real, Span, Vector, slack};
use crate::kd::{Mode, NodeKind, Planes, Probe, Stack, Turn, Walk, traverse};

use super::{Leaf, Links, Target, target};

/// A tree and its links: from leaf to leaf along them, from a covering node by descending.
///
/// Hits are the stack's, bit for bit; leaves are, and in the same order, unless the ray falls back on it (see
/// [`Probe::fall_back`]): where planes tie. `inner` tells the nodes of the first descent and of those from covering nodes: no node twice.
pub struct Linked<'a, T: Planes> {
    tree: &'a T,
    links: &'a Links<T::Vector>,
}

impl<'a, T: Planes> Linked<'a, T> {
    pub(super) fn new(tree: &'a T, links: &'a Links<T::Vector>) -> Self {
        Self { tree, links }
    }
}

impl<T: Planes> Walk for Linked<'_, T> {
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
        let enter = |node, way: &Way<T::Vector>, probe: &mut P| {
            let node = descend(self.tree, node, way, probe)?;
            Some(self.links.numbers[node as usize])
        };
        let ways = (self.tree, self.links);
        follow::<M, T, P>(ways, line, span, stack, probe, leaf, enter);
    }
}

/// What decides between the children of a node: the line, and where it is.
pub(super) struct Way<'a, V: Vector> {
    line: &'a Line<V>,
    padding: V::Real,
    /// Where the line enters, less its slack.
    t0: V::Real,
}

impl<V: Vector> Way<'_, V> {
    /// Whether to go on above the plane (true) or below it, and whether that is its near or far side; `None` if the line
    /// lies in the plane.
    #[inline(always)]
    pub(super) fn above(&self, axis: Axis, split: V::Real) -> Option<(bool, Turn)> {
        let line = self.line;
        if line.is_parallel(axis) {
            let origin = line.origin.parts()[axis];
            return (origin != split).then_some((origin > split, Turn::Near));
        }
        let t = line.t_at(axis, split);
        let far = t + slack(self.padding, t) < self.t0;
        let down = line.inverse.parts()[axis] < V::Real::ZERO;
        Some((far != down, if far { Turn::Far } else { Turn::Near }))
    }
}

/// The first leaf below a node; `None` if the line lies in a plane on the way.
#[inline(always)]
fn descend<T: Planes, P: Probe>(
    tree: &T,
    mut node: u32,
    way: &Way<T::Vector>,
    probe: &mut P,
) -> Option<u32> {
    while let NodeKind::Inner { axis, split, left } = tree.node(node) {
        probe.inner(node);
        let (above, turn) = way.above(axis, split)?;
        probe.turn(node, turn);
        node = left + u32::from(above);
    }
    Some(node)
}

/// Where the line may leave a leaf: the least t of its planes, the axis of that, and the second least t.
#[inline(always)]
fn exits<V: Vector>(
    leaf: &Leaf<V::Real>,
    line: &Line<V>,
    up: [usize; 3],
) -> (V::Real, Axis, V::Real) {
    let [x, y, z] = [0, 1, 2].map(|axis| {
        if line.is_parallel(axis) {
            V::Real::INFINITY
        } else {
            line.t_at(axis, leaf.planes[axis][up[axis]])
        }
    });
    let (least, most, axis) = if y < x { (y, x, 1) } else { (x, y, 0) };
    if z < least {
        (z, 2, least)
    } else {
        (least, axis, most.min(z))
    }
}

/// The loop of both ways along links: `enter` gives the leaf number that a link to something inner leads to, `None` if the
/// line lies in a plane on the way.
#[inline(always)]
pub(super) fn follow<M: Mode, T: Planes, P: Probe>(
    (tree, links): (&T, &Links<T::Vector>),
    line: &Line<T::Vector>,
    span: Span<T::Real>,
    stack: &mut Stack<T::Real>,
    probe: &mut P,
    mut leaf: impl FnMut(&[u32], &mut P) -> T::Real,
    enter: impl Fn(u32, &Way<T::Vector>, &mut P) -> Option<u32>,
) {
    let zero = T::Real::ZERO;
    let padding = if M::PADDED { T::Real::PADDING } else { zero };
    let world = tree.world();
    let Some(Span { t0, t1 }) = world.clip_padded(line, span, padding) else {
        return;
    };
    let mut way = Way { line, padding, t0 };
    // What is left for the stack, should the walk not be certain.
    let mut rest = Span { t0, t1 };
    let in_a_face = (0..3).any(|axis| {
        let origin = line.origin.parts()[axis];
        line.is_parallel(axis) && (origin == world.lo[axis] || origin == world.hi[axis])
    });
    let first = if in_a_face {
        None
    } else {
        descend(tree, 0, &way, probe)
    };
    let mut next = first.map(|node| links.numbers[node as usize]);
    // The root is entered up to a slack later than its widened span begins.
    let start = slack(padding, t0);
    let mut entered = t0 + start + start + start + start;
    let up = [0, 1, 2].map(|axis| usize::from(line.inverse.parts()[axis] > zero));
    while let Some(number) = next {
        let here = &links.leaves[number as usize];
        probe.leaf(links.node(number), here.count);
        rest.t1 = t1.min(leaf(tree.objects(here.first, here.count), probe));
        let (exit, axis, second) = exits(here, line, up);
        let widened = slack(padding, exit);
        rest.t0 = exit - widened;
        if rest.t0 > rest.t1 {
            return;
        }
        let certain = rest.t0 > entered && second - slack(padding, second) > exit + widened;
        if !certain {
            break;
        }
        (way.t0, entered) = (rest.t0, exit + widened);
        next = match target(here.links[axis][up[axis]]) {
            Target::Outside => return,
            Target::Leaf(number) => {
                probe.link();
                Some(number)
            }
            Target::Inner(node) => {
                probe.link();
                enter(node, &way, probe)
            }
        };
    }
    // An exit within rounding of where the ray begins: what is before is none of its.
    rest.t0 = rest.t0.max(t0);
    fall_back::<M, T, P>(tree, line, rest, stack, probe, leaf);
}

/// The rest of a walk that is not certain, kept out of the loop's way.
#[cold]
#[inline(never)]
pub(in crate::kd) fn fall_back<M: Mode, T: Planes, P: Probe>(
    tree: &T,
    line: &Line<T::Vector>,
    rest: Span<T::Real>,
    stack: &mut Stack<T::Real>,
    probe: &mut P,
    leaf: impl FnMut(&[u32], &mut P) -> T::Real,
) {
    probe.fall_back();
    traverse::<M, T, P>(tree, line, rest, stack, probe, leaf);
}
