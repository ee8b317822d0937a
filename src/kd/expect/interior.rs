//! Rays from inside the root's box that never stop.
//!
//! Fabianowski, Fowler & Dingliana (2009): for origins uniform in the box S and isotropic directions, a node N is hit with
//! the chance P(N) = V_N/V_S + (1/V_S) int_{S\N} Omega_N(x) / (4 pi) dx. A ray is one of the two halves into which its origin
//! cuts a line's chord L of S; origins are uniform along it, and lines count by it. A line through N has with equal
//! chance its origin before, in or behind N as these parts of L are long, so
//! P(N) = (E[L; the line hits N] / E[L] + V_N/V_S) / 2 with E[L] = 4 V_S/SA_S.

use crate::geom::Aabb;
use crate::kd::{NodeKind, Tree};

use super::Expected;
use super::chord::Chords;

/// With what chance rays from inside a box hit its parts.
struct Interior {
    world: Aabb,
    /// None of a flat box.
    chords: Option<Chords>,
}

impl Interior {
    fn of(world: Aabb) -> Self {
        let chords = (world.volume() > 0.0).then(|| Chords::new(&world));
        Self { world, chords }
    }

    /// P(N) of a part N of the box. In a flat box a ray leaves where it begins, so N has its share of the area.
    fn chance(&self, part: &Aabb) -> f64 {
        let area = part.surface_area() / self.world.surface_area();
        let Some(chords) = &self.chords else {
            return area;
        };
        let volume = self.world.volume();
        let relative = chords.through(part) * self.world.surface_area() / (4.0 * volume);
        0.5 * (area * relative + part.volume() / volume)
    }
}

/// What a ray from inside is expected to do.
pub(super) fn expected(tree: &Tree) -> Expected {
    let interior = Interior::of(tree.boxes[0]);
    let mut sum = Expected::default();
    for (node, part) in tree.nodes.iter().zip(&tree.boxes) {
        let visit = match node.kind() {
            NodeKind::Inner { .. } => Expected::INNER,
            NodeKind::Leaf { count, .. } => Expected::leaf(count),
        };
        sum = sum + visit * interior.chance(part);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn cube(lo: [f64; 3], size: f64) -> Aabb {
        let lo = DVec3::from(lo);
        Aabb::new(lo, lo + size)
    }

    #[test]
    fn every_ray_hits_the_root() {
        for extent in [
            [1.0, 1.0, 1.0],
            [1.0, 1.0, 0.1],
            [10.0, 1.0, 0.2],
            [1e-3, 1e3, 1.0],
        ] {
            let world = Aabb::new(DVec3::splat(-0.3), DVec3::from(extent) - 0.3);
            let chance = Interior::of(world).chance(&world);
            assert!((chance - 1.0).abs() < 1.5e-3, "{extent:?}: {chance}");
        }
    }

    /// Shares of four million rays, over the ratio of the surface areas, to two digits.
    #[test]
    fn parts_of_the_unit_cube_are_hit_as_often_as_rays_say() {
        let unit = cube([0.0; 3], 1.0);
        let interior = Interior::of(unit);
        let across = |x: f64| Aabb::new(DVec3::new(x, 0.0, 0.0), DVec3::new(x, 1.0, 1.0));
        let simulated = [
            (cube([0.5, 0.0, 0.5], 0.5), 0.87),
            (cube([0.25; 3], 0.5), 1.07),
            (cube([0.0, 0.9, 0.9], 0.1), 0.42),
            (cube([0.45, 0.45, 0.0], 0.1), 0.71),
            (cube([0.45; 3], 0.1), 0.97),
            (across(0.5), 0.74),
            (across(0.95), 0.56),
        ];
        for (part, wanted) in simulated {
            let ratio = interior.chance(&part) * unit.surface_area() / part.surface_area();
            assert!(
                (ratio - wanted).abs() < 0.006,
                "{part:?}: {ratio}, not {wanted}"
            );
        }
        let slab = Aabb::new(DVec3::ZERO, DVec3::new(1.0, 1.0, 0.1));
        let plane = Aabb::new(DVec3::new(0.5, 0.0, 0.0), DVec3::new(0.5, 1.0, 0.1));
        let ratio = Interior::of(slab).chance(&plane) * slab.surface_area() / plane.surface_area();
        assert!((ratio - 1.03).abs() < 0.006, "{ratio}");
    }

    #[test]
    fn in_a_flat_box_a_part_has_its_share_of_the_area() {
        let world = Aabb::new(DVec3::ZERO, DVec3::new(2.0, 1.0, 0.0));
        let part = Aabb::new(DVec3::ZERO, DVec3::new(0.5, 1.0, 0.0));
        assert_eq!(Interior::of(world).chance(&part), 0.25);
        // As in ever thinner boxes.
        let thin = |b: &Aabb| Aabb::new(b.lo, b.hi + 1e-5 * DVec3::Z);
        let chance = Interior::of(thin(&world)).chance(&thin(&part));
        assert!((chance - 0.25).abs() < 1e-3, "{chance}");
    }
}
