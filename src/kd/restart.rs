//! Restarting: after each leaf the ray begins again at the root, where it left off (kd-restart of Foley & Sugerman 2005).
//!
//! Neither stack nor links: what is ahead follows from the planes met on the way down. It meets the stack's leaves for the reason
//! that the walk along links does (see [`links`](super::links)): with `exit` and `second` the two least t of all planes whose near side the
//! way down took, the nodes above the one whose plane is the exit's are passed as before, that one is left for its far child, and below
//! it the stack's own rule decides. Where a plane's t is within both slacks of where the ray is, the walk is not certain.

use crate::geom::{Axis, Line, Real, Span, Vector, slack};

use super::links::fall_back;
use super::{Mode, NodeKind, Planes, Probe, Stack, Turn, Walk};

/// A tree, walked with neither stack nor links.
///
/// Hits are the stack's, bit for bit; leaves are, and in the same order, unless the ray falls back on it (see
/// [`Probe::fall_back`]). `inner` tells all nodes above each leaf each time: their number is the sum of the leaves' depths.
pub struct Restart<'a, T: Planes>(pub &'a T);

/// The planes that the way down left ahead.
#[derive(Clone, Copy)]
struct Ahead<T> {
    /// The least t.
    exit: T,
    /// The plane that has it; none is that of a face of the root's box.
    plane: Option<(Axis, T)>,
    /// The second least.
    second: T,
}

impl<T: Real> Ahead<T> {
    /// Faces of the root's box.
    fn of_root<V: Vector<Real = T>>(
        tree: &impl Planes<Vector = V, Real = T>,
        line: &Line<V>,
    ) -> Self {
        let mut ahead = Self {
            exit: T::INFINITY,
            plane: None,
            second: T::INFINITY,
        };
        let world = tree.world();
        for axis in (0..3).filter(|&axis| !line.is_parallel(axis)) {
            let up = line.inverse.parts()[axis] > T::ZERO;
            let face = if up { world.hi } else { world.lo };
            ahead.add(line.t_at(axis, face[axis]), None);
        }
        ahead
    }

    #[inline(always)]
    fn add(&mut self, t: T, plane: Option<(Axis, T)>) {
        if t < self.exit {
            *self = Self {
                exit: t,
                plane,
                second: self.exit,
            };
        } else {
            self.second = self.second.min(t);
        }
    }
}

impl<T: Planes> Walk for Restart<'_, T> {
    type Vector = T::Vector;

    #[inline]
    fn walk<M: Mode, P: Probe>(
        &self,
        line: &Line<T::Vector>,
        span: Span<T::Real>,
        stack: &mut Stack<T::Real>,
        probe: &mut P,
        mut leaf: impl FnMut(&[u32], &mut P) -> T::Real,
    ) {
        let tree = self.0;
        let zero = T::Real::ZERO;
        let padding = if M::PADDED { T::Real::PADDING } else { zero };
        let Some(Span { t0, t1 }) = tree.world().clip_padded(line, span, padding) else {
            return;
        };
        let root = Ahead::of_root(tree, line);
        // What is left for the stack, should the walk not be certain.
        let mut rest = Span { t0, t1 };
        // The root is entered up to a slack later than its widened span begins.
        let start = slack(padding, t0);
        let mut entered = t0 + start + start + start + start;
        // The plane that the last leaf was left through, until the way down has crossed it.
        let mut crossing = None;
        'restart: loop {
            let mut ahead = root;
            let mut node = 0;
            let (first, count) = loop {
                let (axis, split, left) = match tree.node(node) {
                    NodeKind::Inner { axis, split, left } => (axis, split, left),
                    NodeKind::Leaf { first, count } => break (first, count),
                };
                probe.inner(node);
                if line.is_parallel(axis) {
                    let origin = line.origin.parts()[axis];
                    if origin == split {
                        break 'restart;
                    }
                    probe.turn(node, Turn::Near);
                    node = left + u32::from(origin > split);
                    continue;
                }
                let t = line.t_at(axis, split);
                let widened = slack(padding, t);
                let plane = Some((axis, split));
                let far = if t + widened < rest.t0 {
                    true
                } else if t - widened > entered {
                    ahead.add(t, plane);
                    false
                } else if crossing == plane {
                    crossing = None;
                    true
                } else {
                    break 'restart;
                };
                probe.turn(node, if far { Turn::Far } else { Turn::Near });
                let down = line.inverse.parts()[axis] < zero;
                node = left + u32::from(far != down);
            };
            probe.leaf(node, count);
            rest.t1 = t1.min(leaf(tree.objects(first, count), probe));
            let Ahead {
                exit,
                plane,
                second,
            } = ahead;
            let widened = slack(padding, exit);
            rest.t0 = exit - widened;
            if rest.t0 > rest.t1 {
                return;
            }
            let certain = rest.t0 > entered && second - slack(padding, second) > exit + widened;
            if !certain {
                break;
            }
            if plane.is_none() {
                return;
            }
            entered = exit + widened;
            crossing = plane;
            probe.link();
        }
        // An exit within rounding of where the ray begins: what is before is none of its.
        rest.t0 = rest.t0.max(t0);
        fall_back::<M, T, P>(tree, line, rest, stack, probe, leaf);
    }
}
