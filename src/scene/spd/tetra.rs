//! `tetra`, the recursive tetrahedron (Sierpinski's): four half-sized copies at the corners. All coordinates are
//! multiples of a power of two, hence exact; the boxes tile a grid, and the copies touch at corners only.

use glam::DVec3;

use crate::geom::{Objects, Triangle};

/// The corners of a tetrahedron inscribed in the cube [-1,1]^3.
const CORNERS: [DVec3; 4] = [
    DVec3::new(-1.0, -1.0, 1.0),
    DVec3::new(-1.0, 1.0, -1.0),
    DVec3::new(1.0, -1.0, -1.0),
    DVec3::new(1.0, 1.0, 1.0),
];

/// Its faces, outward.
const FACES: [[usize; 3]; 4] = [[0, 1, 2], [3, 2, 1], [2, 3, 0], [1, 0, 3]];

/// The 4^size triangles, depth first.
pub(super) fn objects(size: usize) -> Objects {
    let mut triangles = Vec::new();
    grow(size, DVec3::ZERO, 1.0, &mut triangles);
    Objects {
        triangles,
        ..Objects::default()
    }
}

fn grow(size: usize, centre: DVec3, half: f64, triangles: &mut Vec<Triangle>) {
    if size <= 1 {
        let corners = CORNERS.map(|c| centre + half * c);
        triangles.extend(FACES.map(|f| Triangle(f.map(|i| corners[i]))));
        return;
    }
    for corner in CORNERS {
        let half = 0.5 * half;
        grow(size - 1, centre + half * corner, half, triangles);
    }
}
