//! Ties: objects whose bounds, vertices and edges coincide to the bit.

use glam::DVec3;

use crate::geom::{Objects, Triangle};
use crate::scene::Random;

fn triangles(triangles: Vec<Triangle>) -> Objects {
    Objects {
        triangles,
        ..Objects::default()
    }
}

/// A point from whole numbers.
fn at(x: usize, y: usize, z: usize) -> DVec3 {
    DVec3::new(x as f64, y as f64, z as f64)
}

/// The two halves of a parallelogram.
fn halves(corner: DVec3, u: DVec3, v: DVec3) -> [Triangle; 2] {
    let far = corner + u + v;
    [
        Triangle([corner, corner + u, far]),
        Triangle([corner, far, corner + v]),
    ]
}

/// The unit cells of every plane x, y or z = 0 ... n, each as two triangles.
pub(super) fn coplanar(n: usize, _: Random) -> Objects {
    let units = [DVec3::X, DVec3::Y, DVec3::Z];
    let mut found = Vec::new();
    for axis in 0..3 {
        let (u, v) = (units[(axis + 1) % 3], units[(axis + 2) % 3]);
        for height in 0..=n {
            for cell in 0..n * n {
                let corner =
                    height as f64 * units[axis] + (cell % n) as f64 * u + (cell / n) as f64 * v;
                found.extend(halves(corner, u, v));
            }
        }
    }
    triangles(found)
}

/// n x n cells of unit width; the heights of their corners are random multiples of 1/8 below 2.
pub(super) fn terrain(n: usize, mut random: Random) -> Objects {
    let heights: Vec<f64> = (0..(n + 1) * (n + 1))
        .map(|_| (16.0 * random.uniform()).floor() / 8.0)
        .collect();
    let point = |x: usize, y: usize| at(x, y, 0).with_z(heights[y * (n + 1) + x]);
    let mut found = Vec::new();
    for cell in 0..n * n {
        let (x, y) = (cell % n, cell / n);
        let [a, b, c, d] = [
            point(x, y),
            point(x + 1, y),
            point(x + 1, y + 1),
            point(x, y + 1),
        ];
        found.extend([Triangle([a, b, c]), Triangle([a, c, d])]);
    }
    // Flat heights would make a flat scene.
    found.push(Triangle([at(0, 0, 0), at(0, 0, 2), at(0, 1, 2)]));
    triangles(found)
}

/// n x n x n unit cubes, all their faces: those between two cubes are there twice.
pub(super) fn lattice(n: usize, _: Random) -> Objects {
    let units = [DVec3::X, DVec3::Y, DVec3::Z];
    let mut found = Vec::new();
    for cell in 0..n * n * n {
        let corner = at(cell % n, cell / n % n, cell / n / n);
        for axis in 0..3 {
            let (u, v) = (units[(axis + 1) % 3], units[(axis + 2) % 3]);
            found.extend(halves(corner, u, v));
            found.extend(halves(corner + units[axis], u, v));
        }
    }
    triangles(found)
}

/// One triangle at every point of an n x n x n grid of spacing 2.
pub(super) fn equal_areas(n: usize, _: Random) -> Objects {
    let one = |cell: usize| {
        let corner = 2.0 * at(cell % n, cell / n % n, cell / n / n);
        Triangle([
            corner,
            corner + DVec3::new(1.0, 0.0, 1.0),
            corner + DVec3::Y,
        ])
    };
    triangles((0..n * n * n).map(one).collect())
}

/// n triangles in the unit square of the plane z = 0.
pub(super) fn planar(n: usize, mut random: Random) -> Objects {
    let width = 1.0 / (n as f64).sqrt();
    let one = |_| {
        let corner = random.point().with_z(0.0);
        let mut arm = || width * (random.point() - 0.5).with_z(0.0);
        Triangle([corner, corner + arm(), corner + arm()])
    };
    triangles((0..n).map(one).collect())
}

/// n triangles that end at 2 on every axis and begin at 1, or, every other one, at the number after 1.
pub(super) fn sliver_split(n: usize, _: Random) -> Objects {
    let one = |i: usize| {
        let lo = if i.is_multiple_of(2) {
            1.0
        } else {
            1.0 + f64::EPSILON
        };
        Triangle([
            DVec3::new(lo, lo, 2.0),
            DVec3::new(2.0, lo, lo),
            DVec3::new(lo, 2.0, lo),
        ])
    };
    triangles((0..n).map(one).collect())
}

/// n times the same triangle.
pub(super) fn duplicates(n: usize, _: Random) -> Objects {
    triangles(vec![Triangle([DVec3::X, DVec3::Y, DVec3::Z]); n])
}

/// A tetrahedron at every other point of an n x n x n grid, with its corners at cell corners.
pub(super) fn touching(n: usize, _: Random) -> Objects {
    let mut found = Vec::new();
    for cell in 0..n * n * n {
        let place = [cell % n, cell / n % n, cell / n / n];
        let o = at(place[0], place[1], place[2]);
        let corners = [
            o,
            o + DVec3::new(1.0, 1.0, 0.0),
            o + DVec3::new(1.0, 0.0, 1.0),
            o + DVec3::new(0.0, 1.0, 1.0),
        ];
        if place.iter().sum::<usize>().is_multiple_of(2) {
            for out in 0..4 {
                let [a, b, c] = [1, 2, 3].map(|k| corners[(out + k) % 4]);
                found.push(Triangle([a, b, c]));
            }
        }
    }
    triangles(found)
}
