//! Offsets, scales and aspects near the end of what numbers can tell.

use glam::DVec3;

use crate::geom::{Objects, Triangle};
use crate::scene::Random;
use crate::scene::simple::soup;

/// The triangles of `simple:soup`, each corner mapped.
fn mapped(n: usize, random: Random, map: impl Fn(DVec3) -> DVec3) -> Objects {
    let mut objects = soup(n, random);
    for triangle in &mut objects.triangles {
        triangle.0 = triangle.0.map(&map);
    }
    objects
}

pub(super) fn far_1e6(n: usize, random: Random) -> Objects {
    mapped(n, random, |p| p + 1e6)
}

pub(super) fn far_1e8(n: usize, random: Random) -> Objects {
    mapped(n, random, |p| p + 1e8)
}

pub(super) fn aspect(n: usize, random: Random) -> Objects {
    mapped(n, random, |p| p * DVec3::new(1e6, 1.0, 1.0))
}

pub(super) fn tiny(n: usize, random: Random) -> Objects {
    mapped(n, random, |p| libm::ldexp(1.0, -100) * p)
}

pub(super) fn huge(n: usize, random: Random) -> Objects {
    mapped(n, random, |p| libm::ldexp(1.0, 100) * p)
}

pub(super) fn smallest(n: usize, random: Random) -> Objects {
    mapped(n, random, |p| libm::ldexp(1.0, -460) * p)
}

pub(super) fn largest(n: usize, random: Random) -> Objects {
    mapped(n, random, |p| libm::ldexp(1.0, 460) * p)
}

/// n triangles at random places of the unit cube, with legs from 1 to 1e-6: areas from 1/2 to 5e-13.
pub(super) fn decades(n: usize, mut random: Random) -> Objects {
    let one = |i: usize| {
        let corner = random.point();
        let leg = libm::exp10(-6.0 * i as f64 / (n - 1).max(1) as f64);
        Triangle([corner, corner + DVec3::X * leg, corner + DVec3::Y * leg])
    };
    Objects {
        triangles: (0..n).map(one).collect(),
        ..Objects::default()
    }
}

/// Half of the triangles in the unit cube, half of them in one of side 2^-20 at its corner.
pub(super) fn mixed_scales(n: usize, random: Random) -> Objects {
    let mut objects = soup(n, random);
    for triangle in objects.triangles.iter_mut().skip(n / 2) {
        triangle.0 = triangle.0.map(|p| p * libm::ldexp(1.0, -20));
    }
    objects
}
