//! What a ray set costs in a tree: visits and tests of every kind of ray and of every pixel corner.

use rayon::prelude::*;

use super::{RayKind, RaySet};
use crate::geom::{Objects, Ray};
use crate::kd::traverse::{nearest_watched, occluded_watched};
use crate::kd::{Probe, Stack, Tree, Work};

/// What the rays of one kind did together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Rays cast.
    pub rays: u64,
    /// Rays that hit something.
    pub hits: u64,
    /// Their visits and tests.
    pub work: Work,
}

impl std::ops::AddAssign for Tally {
    fn add_assign(&mut self, other: Self) {
        self.rays += other.rays;
        self.hits += other.hits;
        self.work += other.work;
    }
}

/// What a ray set did in a tree.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RayCounts {
    /// By kind, in the order of [`RayKind::ALL`].
    kinds: [Tally; 3],
    /// By pixel corner: its primary ray and all that came of it.
    pub corners: Vec<Work>,
}

impl RayCounts {
    /// What the rays of a kind did.
    pub fn of(&self, kind: RayKind) -> Tally {
        self.kinds[kind as usize]
    }
}

/// Trace a ray set through a tree: shadow rays until they are blocked, all others to their nearest hit.
///
/// Integers throughout, so that the number of threads does not matter.
pub fn count(set: &RaySet, tree: &Tree, objects: &Objects) -> RayCounts {
    /// Corners in one piece of work.
    const PIECE: usize = 512;
    let corners: Vec<usize> = (0..set.corners()).collect();
    let pieces: Vec<([Tally; 3], Vec<Work>)> = corners
        .par_chunks(PIECE)
        .map(|piece| {
            let mut kinds = [Tally::default(); 3];
            let mut stack = Stack::default();
            let works = piece.iter().map(|&corner| {
                let mut work = Work::default();
                for kind in RayKind::ALL {
                    let tally = &mut kinds[kind as usize];
                    for cast in set.of(kind).of_corner(corner) {
                        let mut own = Work::default();
                        let hit = hits(kind, tree, objects, &cast.ray(), &mut stack, &mut own);
                        work += own;
                        *tally += Tally {
                            rays: 1,
                            hits: u64::from(hit),
                            work: own,
                        };
                    }
                }
                work
            });
            let works = works.collect();
            (kinds, works)
        })
        .collect();
    let mut counts = RayCounts {
        kinds: [Tally::default(); 3],
        corners: Vec::with_capacity(corners.len()),
    };
    for (kinds, works) in pieces {
        for (sum, tally) in counts.kinds.iter_mut().zip(kinds) {
            *sum += tally;
        }
        counts.corners.extend(works);
    }
    counts
}

/// Whether a ray hits anything, asked as its kind asks.
pub fn hits(
    kind: RayKind,
    tree: &Tree,
    objects: &Objects,
    ray: &Ray,
    stack: &mut Stack,
    probe: impl Probe,
) -> bool {
    match kind {
        RayKind::Shadow => occluded_watched(tree, objects, ray, stack, probe),
        RayKind::Primary | RayKind::Secondary => {
            nearest_watched(tree, objects, ray, stack, probe).is_some()
        }
    }
}
