//! What a ray set costs in a tree: visits and tests of every kind of ray and of every pixel corner.

use rayon::prelude::*;

use super::{RayKind, RaySet};
use crate::geom::Objects;
use crate::kd::{Stack, Tracing, Tree, Work, traverse};

/// What the rays of one kind did together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Rays cast.
    pub rays: u64,
    /// Rays that hit something.
    pub hits: u64,
    /// Rays that hit something and did not when they were made, or the other way round: none in a correct program.
    pub surprises: u64,
    /// Their visits and tests.
    pub work: Work,
}

impl std::ops::AddAssign for Tally {
    fn add_assign(&mut self, other: Self) {
        self.rays += other.rays;
        self.hits += other.hits;
        self.surprises += other.surprises;
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
/// Integers throughout, so that the number of threads does not matter. What hits nothing is known from the making of the
/// rays and does not depend on the tree: such a ray visits all that it meets, and its objects are counted without being
/// tested, but for one piece in sixteen, where everything is tested again.
pub fn count(set: &RaySet, tree: &Tree, objects: &Objects) -> RayCounts {
    count_testing(set, tree, objects, 16)
}

/// As [`count`], testing everything in every piece of this many.
fn count_testing(set: &RaySet, tree: &Tree, objects: &Objects, every: usize) -> RayCounts {
    /// Corners in one piece of work.
    const PIECE: usize = 512;
    let corners: Vec<usize> = (0..set.corners()).collect();
    let pieces: Vec<([Tally; 3], Vec<Work>)> = corners
        .par_chunks(PIECE)
        .enumerate()
        .map(|(number, piece)| {
            let test_all = number.is_multiple_of(every);
            let mut kinds = [Tally::default(); 3];
            let mut stack = Stack::default();
            let works = piece.iter().map(|&corner| {
                let mut work = Work::default();
                for kind in RayKind::ALL {
                    let tally = &mut kinds[kind as usize];
                    for (cast, known) in set.of(kind).of_corner_with_hits(corner) {
                        let mut own = Work::default();
                        let ray = cast.ray();
                        let hit = if known || test_all {
                            kind.ask().hits(tree, objects, &ray, &mut stack, &mut own)
                        } else {
                            traverse::<Tracing, _, _>(
                                tree,
                                &ray.line,
                                ray.span,
                                &mut stack,
                                &mut own,
                                |_, _| f64::INFINITY,
                            );
                            false
                        };
                        work += own;
                        *tally += Tally {
                            rays: 1,
                            hits: u64::from(hit),
                            surprises: u64::from(hit != known),
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kd::{Rules, Strategy, build};
    use crate::scene::Scene;
    use crate::tracer::trace;

    #[test]
    fn rays_known_to_miss_count_as_if_tested() {
        for name in ["spd:balls:1", "spd:gears:1", "spd:tree:3", "spd:mount:3"] {
            let scene = Scene::load(name).expect("a scene");
            let look = scene.look.as_ref().expect("a look");
            for strategy in [Strategy::Sah, Strategy::SpatialMedian] {
                let rules = Rules {
                    strategy,
                    stop: "objects:1:12".parse().expect("a rule"),
                    cost: crate::cost::CostModel::WALD_HAVRAN,
                    clipped: false,
                };
                let tree = build(&scene.bounds, scene.world, &rules);
                let rays = trace(&scene, look, &tree, 48).rays;
                let count = |every| count_testing(&rays, &tree, &scene.objects, every);
                let all = count(1);
                assert!(all == count(usize::MAX), "{name} {strategy}");
                assert!(all.of(RayKind::Shadow).hits < all.of(RayKind::Shadow).rays);
            }
        }
    }
}
