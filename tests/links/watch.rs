//! One ray, along every way through a tree and with the stack.

use std::collections::BTreeSet;

use sahlab::geom::{Line, Real, Span, Vector};
use sahlab::kd::{FaceTrees, Links, Mode, NodeKind, Planes, Probe, Restart, Stack, Turn, Walk};

/// What a walk tells, in order.
#[derive(Clone, Default)]
pub struct Watched {
    pub leaves: Vec<u32>,
    pub inner: Vec<u32>,
    pub links: usize,
    /// How many leaves and inner nodes there were when it fell back.
    pub fell_back: Option<(usize, usize)>,
    /// Whether it has a stack, and may go both ways.
    stack: bool,
    turn: Option<u32>,
}

impl Probe for Watched {
    fn inner(&mut self, node: u32) {
        self.inner.push(node);
    }

    fn turn(&mut self, node: u32, turn: Turn) {
        assert_eq!(self.inner.last(), Some(&node));
        assert!(self.fell_back.is_some() || self.stack || turn != Turn::Both);
        self.turn = Some(node);
    }

    fn leaf(&mut self, node: u32, _: u32) {
        self.leaves.push(node);
    }

    fn link(&mut self) {
        assert_eq!(self.fell_back, None, "a stack follows no links");
        assert_eq!(self.links + 1, self.leaves.len());
        self.links += 1;
    }

    fn fall_back(&mut self) {
        assert_eq!(self.fell_back, None, "it falls back once");
        self.fell_back = Some((self.leaves.len(), self.inner.len()));
    }
}

/// A tree with its links, and each node's depth.
pub struct Ways<'a, T: Planes> {
    pub tree: &'a T,
    pub links: Links<T::Vector>,
    pub faces: FaceTrees<T::Vector>,
    depths: Vec<u32>,
}

/// Rays, and how many of them fell back.
#[derive(Clone, Copy, Debug, Default)]
pub struct FallBacks {
    pub rays: usize,
    pub leaves: usize,
    /// Along links, through face trees, by restarting.
    pub by: [usize; 3],
}

impl std::ops::AddAssign for FallBacks {
    fn add_assign(&mut self, other: Self) {
        self.rays += other.rays;
        self.leaves += other.leaves;
        for (a, b) in self.by.iter_mut().zip(other.by) {
            *a += b;
        }
    }
}

fn watched<M: Mode, W: Walk>(
    (walk, stack): (&W, bool),
    line: &Line<W::Vector>,
    span: Span<<W::Vector as Vector>::Real>,
    limit: <W::Vector as Vector>::Real,
) -> Watched {
    let mut watched = Watched {
        stack,
        ..Watched::default()
    };
    let mut stack = Stack::default();
    walk.walk::<M, _>(line, span, &mut stack, &mut watched, |_, _| limit);
    watched
}

impl<'a, T: Planes> Ways<'a, T> {
    pub fn new(tree: &'a T) -> Self {
        let links = Links::of(tree);
        let faces = FaceTrees::of(tree, &links);
        let mut depths = vec![0];
        let mut pending = vec![0];
        while let Some(node) = pending.pop() {
            if let NodeKind::Inner { left, .. } = tree.node(node) {
                let below = depths[node as usize] + 1;
                depths.resize(depths.len().max(left as usize + 2), 0);
                depths[left as usize..][..2].fill(below);
                pending.extend([left, left + 1]);
            }
        }
        Self {
            tree,
            links,
            faces,
            depths,
        }
    }

    /// All that must hold of a ray whose nodes matter up to `limit`.
    pub fn check<M: Mode>(
        &self,
        line: &Line<T::Vector>,
        span: Span<T::Real>,
        limit: T::Real,
    ) -> FallBacks {
        let ray = || format!("{line:?} within {span:?} up to {limit:?}");
        let stack = watched::<M, _>((self.tree, true), line, span, limit);
        let links = watched::<M, _>((&self.links.walk(self.tree), false), line, span, limit);
        let faces = watched::<M, _>((&self.faces.walk(self.tree), false), line, span, limit);
        let restart = watched::<M, _>((&Restart(self.tree), false), line, span, limit);
        let all = [&links, &faces, &restart];
        for (way, walk) in all.iter().enumerate() {
            let Some((leaves, _)) = walk.fell_back else {
                assert_eq!(walk.leaves, stack.leaves, "way {way}: {}", ray());
                assert_eq!(walk.links, walk.leaves.len().saturating_sub(1));
                continue;
            };
            // The stack's first leaves, then all others in its order, with some of the first again.
            let (before, after) = walk.leaves.split_at(leaves);
            assert!(stack.leaves.starts_with(before), "way {way}: {}", ray());
            let behind = &stack.leaves[leaves..];
            assert!(after.ends_with(behind), "way {way}: {}", ray());
            let again = &after[..after.len() - behind.len()];
            let known = again.iter().all(|leaf| before.contains(leaf));
            assert!(known, "way {way}: {again:?} after {before:?}: {}", ray());
        }
        let steps = |walk: &Watched| {
            let own = walk.fell_back.map_or(walk.inner.len(), |(_, inner)| inner);
            walk.inner[..own].to_vec()
        };
        let [by_links, by_faces, by_restart] = all.map(steps);
        if links.fell_back.is_none() {
            let set = |nodes: &[u32]| nodes.iter().copied().collect::<BTreeSet<_>>();
            let (all, some) = (set(&by_links), set(&by_faces));
            assert_eq!(all.len(), by_links.len(), "a node twice: {}", ray());
            assert!(all.is_subset(&set(&stack.inner)), "{}", ray());
            assert!(some.is_subset(&all) && some.len() == by_faces.len());
        }
        if restart.fell_back.is_none() {
            let depths = restart
                .leaves
                .iter()
                .map(|&leaf| self.depths[leaf as usize]);
            assert_eq!(by_restart.len(), depths.sum::<u32>() as usize);
            // Where planes tie for links they do for a restart, but for the root's faces, which it need not know.
            let world = self.tree.world();
            let in_a_face = (0..3).any(|axis| {
                let faces = [world.lo[axis], world.hi[axis]];
                line.is_parallel(axis) && faces.contains(&line.origin[axis])
            });
            let fell_back = if in_a_face {
                (None, None)
            } else {
                (links.fell_back, faces.fell_back)
            };
            assert_eq!(fell_back, (None, None), "{}", ray());
        }
        FallBacks {
            rays: 1,
            leaves: stack.leaves.len(),
            by: all.map(|walk| usize::from(walk.fell_back.is_some())),
        }
    }

    /// The ray, on and on and up to limits within its span.
    pub fn check_up_to<M: Mode>(
        &self,
        line: &Line<T::Vector>,
        span: Span<T::Real>,
        limits: &[T::Real],
    ) -> FallBacks {
        let mut sum = self.check::<M>(line, span, T::Real::INFINITY);
        self.check::<M>(line, span, T::Real::NEG_INFINITY);
        for &limit in limits {
            sum += self.check::<M>(line, span, limit);
        }
        sum
    }
}
