//! Spheres, cones and polygons that touch, nest or meet in one place.

use std::f64::consts::TAU;

use glam::DVec3;

use crate::geom::{Cone, Objects, Polygon, Sphere};
use crate::scene::Random;
use crate::scene::simple::soup;

/// n spheres around the origin, the k-th of radius k: object medians are one point.
pub(super) fn nested(n: usize, _: Random) -> Objects {
    let one = |k: usize| Sphere {
        centre: DVec3::ZERO,
        radius: k as f64,
    };
    Objects {
        spheres: (1..=n).map(one).collect(),
        ..Objects::default()
    }
}

/// n x n x n spheres of diameter 1, each touching its neighbours in one point.
pub(super) fn tangent_spheres(n: usize, _: Random) -> Objects {
    let one = |cell: usize| {
        let cell = [cell % n, cell / n % n, cell / n / n].map(|k| k as f64);
        Sphere {
            centre: DVec3::from(cell) + 0.5,
            radius: 0.5,
        }
    };
    Objects {
        spheres: (0..n * n * n).map(one).collect(),
        ..Objects::default()
    }
}

/// A staircase of n cylinders along x, y, z in turn, of length 1 and radius 1/8, with a sphere of that radius at each joint: the
/// cylinder's end circle lies on the sphere.
pub(super) fn seams(n: usize, _: Random) -> Objects {
    let radius = 0.125;
    let mut objects = Objects::default();
    let mut joint = DVec3::ZERO;
    for k in 0..n {
        let mut next = joint;
        next[k % 3] += 1.0;
        objects.cones.push(cone(joint, radius, next, radius));
        objects.spheres.push(Sphere {
            centre: next,
            radius,
        });
        joint = next;
    }
    objects
}

fn cone(base: DVec3, base_radius: f64, apex: DVec3, apex_radius: f64) -> Cone {
    Cone {
        base,
        base_radius,
        apex,
        apex_radius,
    }
}

/// A direction for each of n, the three axes first.
fn directions(n: usize, mut random: Random) -> impl Iterator<Item = DVec3> {
    (0..n).map(move |k| match k {
        0 => DVec3::X,
        1 => DVec3::Y,
        2 => DVec3::Z,
        _ => (random.point() - 0.5).normalize(),
    })
}

/// n cylinders of length 2 whose middles are the origin.
pub(super) fn crossing(n: usize, random: Random) -> Objects {
    Objects {
        cones: directions(n, random)
            .map(|d| cone(-d, 0.0625, d, 0.0625))
            .collect(),
        ..Objects::default()
    }
}

/// n cones of length 1 whose apex is the origin.
pub(super) fn apexes(n: usize, random: Random) -> Objects {
    Objects {
        cones: directions(n, random)
            .map(|d| cone(d, 0.125, DVec3::ZERO, 0.0))
            .collect(),
        ..Objects::default()
    }
}

/// A star of n rays in each of the planes z = 0, 1 and x = 0: every other corner is a reflex one.
pub(super) fn reflex(n: usize, _: Random) -> Objects {
    let corner = |k: usize| {
        let (sine, cosine) = libm::sincos(TAU * k as f64 / (2 * n) as f64);
        let radius = if k.is_multiple_of(2) { 1.0 } else { 0.5 };
        radius * DVec3::new(cosine, sine, 0.0)
    };
    let star: Vec<DVec3> = (0..2 * n).map(corner).collect();
    let moved = |map: fn(DVec3) -> DVec3| {
        Polygon::new(star.iter().map(|&p| map(p)).collect()).expect("a star is a polygon")
    };
    Objects {
        polygons: vec![
            moved(|p| p),
            moved(|p| p + DVec3::Z),
            moved(|p| DVec3::new(0.0, p.x, p.y)),
        ],
        ..Objects::default()
    }
}

/// A cube of side 1 with n triangles and a sphere that touches the ground, on a floor of 100 x 100.
pub(super) fn stadium(n: usize, random: Random) -> Objects {
    let floor = [[-50.0, -50.0], [50.0, -50.0], [50.0, 50.0], [-50.0, 50.0]];
    let floor = floor.map(|[x, y]| DVec3::new(x, y, 0.0));
    let mut objects = soup(n, random);
    for triangle in &mut objects.triangles {
        // All of them above the floor: none reaches more than an edge below the cube.
        triangle.0 = triangle.0.map(|p| p + DVec3::Z);
    }
    objects.spheres.push(Sphere {
        centre: DVec3::new(2.0, 2.0, 0.5),
        radius: 0.5,
    });
    objects
        .polygons
        .push(Polygon::new(floor.into()).expect("a square is a polygon"));
    objects
}
