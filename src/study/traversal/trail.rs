//! What rays do along a way, ray by ray, and where that differs from what they do with a stack.

use std::hint::black_box;

use rayon::prelude::*;

use crate::geom::{Ray, Real, Targets, Vector};
use crate::kd::hits::nearest_watched;
use crate::kd::{Counting, Hit, Probe, Stack, Walk, Work};

use super::way::{Point, Task, Way};

/// A set of rays in the numbers of a tree.
pub struct Set<'a, V: Vector, O: ?Sized> {
    /// The rays.
    pub rays: &'a [Ray<V>],
    /// What they are tested against up to their nearest hit; `None`: nothing stops them and nothing is tested.
    pub objects: Option<&'a O>,
}

impl<V: Vector, O: ?Sized> Clone for Set<'_, V, O> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<V: Vector, O: ?Sized> Copy for Set<'_, V, O> {}

impl<V: Vector, O: Targets<Vector = V> + ?Sized> Set<'_, V, O> {
    /// Take one of its rays along a way; gives its nearest hit, if it asks for that.
    #[inline]
    pub fn follow<W: Walk<Vector = V>>(
        &self,
        walk: &W,
        ray: &Ray<V>,
        stack: &mut Stack<V::Real>,
        mut probe: impl Probe,
    ) -> Option<Hit<V::Real>> {
        if let Some(objects) = self.objects {
            return nearest_watched(walk, objects, ray, stack, probe);
        }
        let (line, span) = (&ray.line, ray.span);
        walk.walk::<Counting, _>(line, span, stack, &mut probe, |objects, _| {
            // Or a compiler sees that a way without a stack comes to nothing.
            black_box(objects.len());
            V::Real::INFINITY
        });
        None
    }
}

/// What one ray did.
#[derive(Clone, Debug, PartialEq)]
pub struct Trail<T> {
    /// Its nearest hit.
    pub hit: Option<Hit<T>>,
    /// Its visits and tests.
    pub work: Work,
    /// Links followed, or restarts.
    pub links: u64,
    /// Whether it was finished with a stack.
    pub fell_back: bool,
    /// Whether it met a leaf so thin that its planes are not told apart.
    pub thin: bool,
    /// Stands for its leaves, in their order.
    pub leaves: u64,
    /// Sum of the depths of its leaves.
    pub depths: u64,
}

/// Writes down what a ray does.
struct Tracker<'d, T> {
    nodes: Nodes<'d>,
    trail: Trail<T>,
}

/// What is told of a ray by the nodes that it visits.
#[derive(Clone, Copy)]
pub struct Nodes<'d> {
    /// Depth of every node.
    pub depths: &'d [u32],
    /// Which are leaves so thin that their planes are not told apart.
    pub thin: &'d [bool],
}

impl<'d, T> Tracker<'d, T> {
    fn new(nodes: Nodes<'d>) -> Self {
        let trail = Trail {
            hit: None,
            work: Work::default(),
            links: 0,
            fell_back: false,
            thin: false,
            leaves: 0xcbf2_9ce4_8422_2325,
            depths: 0,
        };
        Self { nodes, trail }
    }
}

impl<T> Probe for Tracker<'_, T> {
    #[inline]
    fn inner(&mut self, node: u32) {
        self.trail.work.inner(node);
    }

    #[inline]
    fn leaf(&mut self, node: u32, objects: u32) {
        let trail = &mut self.trail;
        trail.work.leaf(node, objects);
        trail.depths += u64::from(self.nodes.depths[node as usize]);
        trail.thin |= self.nodes.thin[node as usize];
        // FNV with words for bytes, and a turn so that high bits come down again.
        trail.leaves =
            (trail.leaves.rotate_left(23) ^ u64::from(node)).wrapping_mul(0x0100_0000_01b3);
    }

    #[inline]
    fn link(&mut self) {
        self.trail.links += 1;
    }

    #[inline]
    fn fall_back(&mut self) {
        self.trail.fell_back = true;
    }
}

/// The trails of a set, in its order: the same for any number of threads.
pub struct Follow<'a, V: Vector, O: ?Sized> {
    /// The rays.
    pub set: Set<'a, V, O>,
    /// What is told of nodes.
    pub nodes: Nodes<'a>,
}

impl<V, O> Task<V> for Follow<'_, V, O>
where
    V: Point,
    O: Targets<Vector = V> + Sync + ?Sized,
{
    type Done = Vec<Trail<V::Real>>;

    fn along<W: Walk<Vector = V> + Sync>(self, walk: &W) -> Self::Done {
        let follow = |stack: &mut Stack<V::Real>, ray: &Ray<V>| {
            let mut tracker = Tracker::new(self.nodes);
            let hit = self.set.follow(walk, ray, stack, &mut tracker);
            Trail {
                hit,
                ..tracker.trail
            }
        };
        let rays = self.set.rays.par_iter().with_min_len(256);
        rays.map_init(Stack::default, follow).collect()
    }
}

/// What the rays of a set did along a way, beside what they did with a stack.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Rays that meet the root's box.
    pub entered: u64,
    /// Rays that hit something.
    pub hits: u64,
    /// Visits and tests.
    pub work: Work,
    /// Links followed, or restarts.
    pub links: u64,
    /// Rays finished with a stack.
    pub fall_backs: u64,
    /// Of these, rays that meet a leaf so thin that its planes are not told apart.
    pub thin_fall_backs: u64,
    /// Rays whose nearest hit is another one.
    pub differing_hits: u64,
    /// Rays not finished with a stack whose leaves, or their order, are others.
    pub differing_leaves: u64,
    /// Rays not finished with a stack that break an identity of the way.
    pub broken: u64,
}

impl Tally {
    /// Of these trails along a way, and those of the same rays with a stack.
    pub fn of<T: Real>(way: Way, own: &[Trail<T>], stack: &[Trail<T>]) -> Self {
        let mut sum = Self::default();
        for (own, stack) in own.iter().zip(stack) {
            sum.entered += u64::from(own.work.leaves > 0);
            sum.hits += u64::from(own.hit.is_some());
            sum.work += own.work;
            sum.links += own.links;
            sum.fall_backs += u64::from(own.fell_back);
            sum.thin_fall_backs += u64::from(own.fell_back && own.thin);
            sum.differing_hits += u64::from(own.hit.map(Hit::bits) != stack.hit.map(Hit::bits));
            if !own.fell_back {
                sum.differing_leaves += u64::from(own.leaves != stack.leaves);
                sum.broken += u64::from(!keeps_identities(way, own, stack));
            }
        }
        sum
    }
}

/// What must hold of a ray that was not finished with a stack. Each leaf but the first is reached by a link or a restart. A restart
/// visits all nodes above a leaf; links visit no inner node twice and none that the stack does not visit.
fn keeps_identities<T: Real>(way: Way, own: &Trail<T>, stack: &Trail<T>) -> bool {
    let Work { inner, leaves, .. } = own.work;
    let linked = own.links == leaves.saturating_sub(1);
    match way {
        Way::Stack => own.links == 0,
        Way::Restart => linked && inner == own.depths,
        Way::Links | Way::FaceTrees => linked && inner <= stack.work.inner,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn trail(leaves: &[u32], links: u64, inner: u32) -> Trail<f64> {
        let mut tracker = Tracker::new(Nodes {
            depths: &[0, 1, 1, 2, 2],
            thin: &[false, false, true, false, false],
        });
        (0..inner).for_each(|node| tracker.inner(node));
        leaves.iter().for_each(|&leaf| tracker.leaf(leaf, 1));
        (0..links).for_each(|_| tracker.link());
        tracker.trail
    }

    #[test]
    fn leaves_count_in_their_order() {
        let [ab, ba] = [[3, 4], [4, 3]].map(|leaves| trail(&leaves, 1, 2));
        assert_ne!(ab.leaves, ba.leaves);
        assert_eq!((ab.work.leaves, ab.depths), (2, 4));
        let tally = Tally::of(
            Way::Links,
            &[ba.clone(), ab.clone()],
            &[ab.clone(), ab.clone()],
        );
        assert_eq!((tally.differing_leaves, tally.broken), (1, 0));
        // Who falls back may visit others, but must hit the same.
        let fell = Trail {
            fell_back: true,
            hit: Some(Hit { object: 1, t: 1.0 }),
            ..ba
        };
        let tally = Tally::of(Way::Links, &[fell], &[ab]);
        assert_eq!((tally.fall_backs, tally.differing_leaves), (1, 0));
        assert_eq!((tally.differing_hits, tally.thin_fall_backs), (1, 0));
        // Zeros of either sign are equal, but not the same; the second leaf is thin.
        let at = |t| Trail {
            fell_back: true,
            hit: Some(Hit { object: 1, t }),
            ..trail(&[3, 2], 1, 2)
        };
        let tally = Tally::of(Way::Links, &[at(0.0)], &[at(-0.0)]);
        assert_eq!((tally.differing_hits, tally.thin_fall_backs), (1, 1));
    }

    #[test]
    fn identities_are_those_of_the_way() {
        let stack = trail(&[3, 4], 0, 2);
        let broken = |way, links, inner| {
            let own = trail(&[3, 4], links, inner);
            Tally::of(way, &[own], std::slice::from_ref(&stack)).broken == 1
        };
        assert!(!broken(Way::Stack, 0, 2) && broken(Way::Stack, 1, 2));
        // Two leaves of depth 2.
        assert!(!broken(Way::Restart, 1, 4) && broken(Way::Restart, 1, 3));
        for way in [Way::Links, Way::FaceTrees] {
            assert!(!broken(way, 1, 2) && broken(way, 2, 2) && broken(way, 1, 3));
        }
    }
}
