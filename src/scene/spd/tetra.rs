//! `tetra`, the recursive tetrahedron (Sierpinski's): four half-sized copies at the corners. All coordinates are
//! multiples of a power of two, hence exact; the boxes tile a grid, and the copies touch at corners only.

use glam::DVec3;

use super::stage::{opaque, stage};
use crate::scene::draft::Draft;

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
pub(super) fn draft(size: usize) -> Draft {
    let view = [
        [1.022846, -3.177154, -2.174512],
        [-0.004103, -0.004103, 0.216539],
        [-0.816497, -0.816497, 0.816497],
    ];
    let mut draft = Draft::new(stage(view, 45.0, 1.0, &[[2.0, -18.0, -5.0]]));
    draft.material(opaque([1.0, 0.2, 0.2], [1.0, 0.0], 0.0, 0.0));
    grow(size, DVec3::ZERO, 1.0, &mut draft);
    draft
}

fn grow(size: usize, centre: DVec3, half: f64, draft: &mut Draft) {
    if size <= 1 {
        let corners = CORNERS.map(|c| centre + half * c);
        for face in FACES {
            draft.triangle(face.map(|i| corners[i]));
        }
        return;
    }
    for corner in CORNERS {
        let half = 0.5 * half;
        grow(size - 1, centre + half * corner, half, draft);
    }
}
