//! Triangles that leak, vanish or mislead.

use glam::DVec3;

use crate::geom::{Objects, Triangle};
use crate::scene::Random;

fn triangles(triangles: Vec<Triangle>) -> Objects {
    Objects {
        triangles,
        ..Objects::default()
    }
}

/// Corners of an irregular octahedron around the origin; 2k and 2k + 1 are opposite.
const OCTAHEDRON: [DVec3; 6] = [
    DVec3::new(1.1, 0.02, -0.03),
    DVec3::new(-0.9, 0.05, 0.01),
    DVec3::new(0.03, 1.3, 0.07),
    DVec3::new(-0.02, -0.8, 0.04),
    DVec3::new(0.06, -0.01, 0.95),
    DVec3::new(-0.04, 0.03, -1.2),
];

/// Its eight faces, each cut into four at the middles of its edges `n` times over (at most 6): closed, as neighbours compute
/// the same middles.
pub(super) fn octahedron(n: usize, _: Random) -> Objects {
    let v = OCTAHEDRON;
    let mut faces = Vec::new();
    for x in [0, 1] {
        for y in [2, 3] {
            faces.extend([4, 5].map(|z| Triangle([v[x], v[y], v[z]])));
        }
    }
    for _ in 0..n.min(6) {
        faces = faces.into_iter().flat_map(quartered).collect();
    }
    triangles(faces)
}

fn quartered(Triangle([a, b, c]): Triangle) -> [Triangle; 4] {
    let middle = |p: DVec3, q: DVec3| 0.5 * (p + q);
    let (d, e, f) = (middle(a, b), middle(b, c), middle(c, a));
    [
        Triangle([a, d, f]),
        Triangle([d, b, e]),
        Triangle([f, e, c]),
        Triangle([d, e, f]),
    ]
}

/// n triangles in the unit cube, a millionth as wide as long, in any direction.
pub(super) fn needles(n: usize, mut random: Random) -> Objects {
    let one = |_| {
        let (from, to) = (random.point(), random.point());
        let aside = 1e-6 * (random.point() - 0.5);
        Triangle([from, to, to + aside])
    };
    triangles((0..n).map(one).collect())
}

/// n triangles, every other one without area: a point, a segment, or a segment with a corner twice.
pub(super) fn degenerate(n: usize, mut random: Random) -> Objects {
    let one = |i: usize| {
        let [a, b, c] = [0; 3].map(|_| random.point());
        Triangle(match i % 6 {
            1 => [a; 3],
            // Along an axis, so that the middle is on the segment to the bit.
            3 => [a, a.with_x(0.25), a.with_x(0.75)],
            5 => [a, b, b],
            _ => [a, b, c],
        })
    };
    triangles((0..n).map(one).collect())
}

/// n triangles around one vertex, with their rim on a square.
pub(super) fn fan(n: usize, _: Random) -> Objects {
    let rim = |i: usize| {
        let along = 4.0 * (i % n) as f64 / n as f64;
        let (x, y) = match along {
            a if a < 1.0 => (a, 0.0),
            a if a < 2.0 => (1.0, a - 1.0),
            a if a < 3.0 => (3.0 - a, 1.0),
            a => (0.0, 4.0 - a),
        };
        DVec3::new(x, y, 0.0)
    };
    let top = DVec3::new(0.5, 0.375, 0.75);
    // Fewer than three sectors are no fan; they have area all the same.
    let one = |i: usize| Triangle([top, rim(i), if n == 1 { DVec3::ONE } else { rim(i + 1) }]);
    triangles((0..n).map(one).collect())
}

/// n pairs of triangles along a ridge in x, that fall by 1e-6 to both sides.
pub(super) fn roof(n: usize, _: Random) -> Objects {
    let point = |x: usize, y: f64| DVec3::new(x as f64, y, 1e-6 * (1.0 - y.abs()));
    let pair =
        |x: usize| [1.0, -1.0].map(|y| Triangle([point(x, 0.0), point(x + 1, 0.0), point(x, y)]));
    triangles((0..n).flat_map(pair).collect())
}

/// One triangle.
pub(super) fn single(_: usize, _: Random) -> Objects {
    triangles(vec![Triangle([
        DVec3::ZERO,
        DVec3::new(1.0, 0.0, 0.25),
        DVec3::Y,
    ])])
}
