//! Hard cases of cones and cylinders: tangents, generators, ends, the apex and the nappe behind it.

use glam::DVec3;

use crate::geom::{Cone, Object, Sphere};

use super::case::{Case, Finding, Group};
use super::first_hit::{First, line, once, ray};

fn cone(base_radius: f64, apex_radius: f64, scale: f64) -> Cone {
    Cone {
        base: DVec3::ZERO,
        base_radius: scale * base_radius,
        apex: scale * DVec3::new(0.0, 0.0, 4.0),
        apex_radius: scale * apex_radius,
    }
}

/// The cylinder of radius 5 about z, from z = 0 to 4.
fn cylinder(first: First) -> Finding {
    first.check(Object::Cone(&cone(5.0, 5.0, 1.0)))
}

/// The cone of radius 4 at z = 0 and apex at z = 4.
fn pointed(first: First) -> Finding {
    first.check(Object::Cone(&cone(4.0, 0.0, 1.0)))
}

fn scaled(k: i32) -> Finding {
    let s = libm::ldexp(1.0, k);
    let first = line(
        [-10.0 * s, 3.0 * s, 2.0 * s],
        [1.0, 0.0, 0.0],
        Some(6.0 * s),
    );
    first.check(Object::Cone(&cone(5.0, 5.0, s)))
}

const X: [f64; 3] = [1.0, 0.0, 0.0];
const Z: [f64; 3] = [0.0, 0.0, 1.0];

/// The cases of this group.
pub fn cases() -> Vec<Case> {
    let case = |name, stresses, check| once(Group::Cones, name, stresses, check);
    vec![
        case(
            "cylinder-across",
            "two roots at a distance from the axis",
            || cylinder(line([-10.0, 3.0, 2.0], X, Some(6.0))),
        ),
        case("cylinder-tangent", "a double root", || {
            cylinder(line([-10.0, 5.0, 2.0], X, Some(10.0)))
        }),
        case("cylinder-beyond-tangent", "one step outside", || {
            cylinder(line([-10.0, 5_f64.next_up(), 2.0], X, None))
        }),
        case(
            "cylinder-axis",
            "along the axis, through both open ends: no root at all",
            || cylinder(line([0.0, 0.0, -1.0], Z, None)),
        ),
        case(
            "cylinder-parallel-inside",
            "parallel to the axis inside",
            || cylinder(line([3.0, 0.0, -1.0], Z, None)),
        ),
        case(
            "cylinder-parallel-outside",
            "parallel to the axis outside",
            || cylinder(line([6.0, 0.0, -1.0], Z, None)),
        ),
        case(
            "cylinder-generator",
            "a line in the surface is no hit, as one in a triangle's plane",
            || cylinder(line([5.0, 0.0, -1.0], Z, None)),
        ),
        case(
            "cylinder-end-circle",
            "through the end circle, which belongs to it",
            || cylinder(line([-10.0, 3.0, 4.0], X, Some(6.0))),
        ),
        case(
            "cylinder-beyond-its-end",
            "one step beyond the end circle",
            || cylinder(line([-10.0, 3.0, 4_f64.next_up()], X, None)),
        ),
        case(
            "cylinder-before-its-base",
            "below the base circle by the least number",
            || cylinder(line([-10.0, 3.0, -f64::from_bits(1)], X, None)),
        ),
        case("cylinder-from-inside", "the first root is behind", || {
            cylinder(ray([0.0, 3.0, 2.0], X, Some(4.0)))
        }),
        case(
            "cylinder-in-and-out-of-ends",
            "enters by one open end, leaves by the other: both roots are beyond them",
            || cylinder(line([0.0, 0.0, -10.0], [0.0625, 0.0, 1.0], None)),
        ),
        case(
            "cylinder-second-root",
            "enters by an open end: only the second root counts",
            || cylinder(line([4.0, 0.0, -1.0], [0.5, 0.0, 1.0], Some(2.0))),
        ),
        case("cone-across", "half way up", || {
            pointed(line([-10.0, 0.0, 2.0], X, Some(8.0)))
        }),
        case(
            "cone-apex",
            "through the apex, where the normal is not defined",
            || pointed(line([-10.0, 0.0, 4.0], X, Some(10.0))),
        ),
        case("cone-over-its-apex", "one step over the apex", || {
            pointed(line([-10.0, 0.0, 4_f64.next_up()], X, None))
        }),
        case(
            "cone-mirrored-nappe",
            "the nappe beyond the apex is none of it",
            || pointed(line([-10.0, 0.0, 6.0], X, None)),
        ),
        case(
            "cone-parallel-to-generator",
            "the quadratic term vanishes: one root",
            || pointed(line([-4.0, 0.0, 4.0], [1.0, 0.0, -1.0], Some(2.0))),
        ),
        case(
            "cone-down-its-axis",
            "along the axis: the apex alone",
            || pointed(line([0.0, 0.0, 10.0], [0.0, 0.0, -1.0], Some(6.0))),
        ),
        case("cylinder-far-origin", "the origin 2^30 away", || {
            let x = -libm::ldexp(1.0, 30);
            cylinder(line([x, 3.0, 2.0], X, Some(-x - 4.0)))
        }),
        case("cylinder-thin", "radius 2^-20 and length 4", || {
            let r = libm::ldexp(1.0, -20);
            let first = line([-1.0, 0.0, 2.0], X, Some(1.0 - r));
            first.check(Object::Cone(&cone(r, r, 1.0)))
        }),
        case("cylinder-scale-2^100", "coordinates of 10^30", || {
            scaled(100)
        }),
        case("cylinder-scale-2^-100", "coordinates of 10^-30", || {
            scaled(-100)
        }),
        case(
            "seam-of-sphere-and-cylinder",
            "a sphere on the end of a cylinder of its radius: both hit at the same t",
            seam,
        ),
    ]
}

/// Through the circle that a cylinder and a sphere of its radius share: (-4, 3, 4).
fn seam() -> Finding {
    let first = line([-10.0, 3.0, 4.0], X, Some(6.0));
    let sphere = Sphere {
        centre: DVec3::new(0.0, 0.0, 4.0),
        radius: 5.0,
    };
    let ray = first.as_ray();
    let found = [cone(5.0, 5.0, 1.0).intersect(&ray), sphere.intersect(&ray)];
    Finding::of(format!("{:?}", [first.t; 2]), format!("{found:?}"))
}
