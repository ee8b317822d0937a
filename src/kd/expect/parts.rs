//! How much surface lies in each leaf of a tree, and with what chance a line meets it.

use crate::geom::{Aabb, Clipper, Objects};
use crate::kd::{NodeKind, Tree};

/// What the objects of one leaf are to a line.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Part {
    /// Area of their surfaces in the leaf, one side of them; half of what lies in a face of the root, which one
    /// side of only is inside.
    pub area: f64,
    /// The chance that an isotropic line that hits the leaf hits none of them in it.
    pub miss: f64,
    /// The same of those that do not lie in a face of the root: the others stop no ray from inside before it leaves.
    pub miss_inside: f64,
}

/// The surfaces in the leaves of a tree: what the metrics read that know of hits.
#[derive(Clone, Debug, PartialEq)]
pub struct Parts(Vec<Part>);

impl Parts {
    /// The parts that the objects with these boxes have in each leaf of a tree over them.
    ///
    /// Objects of one leaf are taken as independent, so the chance to miss them all is the product of the chances to miss each:
    /// exact for one object.
    pub fn new(tree: &Tree, objects: &Objects, bounds: &[Aabb]) -> Self {
        let mut clipper = Clipper::default();
        let mut part_of = |region: &Aabb, in_leaf: &[u32]| {
            let mut part = Part {
                area: 0.0,
                miss: 1.0,
                miss_inside: 1.0,
            };
            for &number in in_leaf {
                let own = &bounds[number as usize];
                let area = objects.area_within(number, own, region, &mut clipper);
                let object = objects.get(number);
                let share = area / object.area();
                let miss = 1.0 - chance(area, region, object.is_round().then_some(share));
                part.miss *= miss;
                if in_face(own, &tree.world) {
                    part.area += 0.5 * area;
                } else {
                    part.area += area;
                    part.miss_inside *= miss;
                }
            }
            part
        };
        let nodes = tree.nodes.iter().zip(&tree.boxes);
        let parts = nodes.map(|(node, region)| match node.kind() {
            NodeKind::Leaf { first, count } => part_of(region, tree.objects(first, count)),
            NodeKind::Inner { .. } => Part::default(),
        });
        Self(parts.collect())
    }

    /// The part of a leaf.
    pub(super) fn of(&self, leaf: usize) -> Part {
        self.0[leaf]
    }
}

/// The chance that a line that hits `region` hits the part of an object there that has this area.
///
/// It crosses the part 2 area / SA times on average (Santalo 1976): a flat one once at most, a whole round one twice.
/// Of a sphere's cap that is the share s of its area the chance is that of the cap's convex hull, 1 - s/2 of the crossings.
fn chance(area: f64, region: &Aabb, round: Option<f64>) -> f64 {
    let crossings = 2.0 * area / region.surface_area();
    (crossings * (1.0 - 0.5 * round.unwrap_or(0.0))).min(1.0)
}

/// Whether an object is flat and lies in a face of the world.
fn in_face(own: &Aabb, world: &Aabb) -> bool {
    let at = |face: &glam::DVec3| (own.lo.cmpeq(*face) & own.hi.cmpeq(*face)).any();
    at(&world.lo) || at(&world.hi)
}
