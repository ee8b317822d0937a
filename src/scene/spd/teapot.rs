//! `teapot`: Newell's teapot of 32 bicubic patches, each cut into SIZE x SIZE cells, on a chequered board.

use glam::DVec3;

use super::stage::{opaque, quad, stage};
use crate::scene::draft::Draft;

/// Control points of a bicubic Bezier patch: rows along s, columns along t.
type Patch = [[DVec3; 4]; 4];

/// Length of the handles over the radius that makes four cubics nearly a circle.
const HANDLE: f64 = 0.56;

/// The white squares, the grey ones, then the patches cell by cell.
pub(super) fn draft(size: usize) -> Draft {
    let view = [[4.86, 7.2, 5.4], [0.0; 3], [0.0, 0.0, 1.0]];
    let lights = [[-3.1, 9.8, 12.1], [11.3, 5.1, 8.8]];
    let mut draft = Draft::new(stage(view, 45.0, 1.0, &lights));
    let place = |k: usize| 4.0 * (2.0 * k as f64 / size as f64 - 1.0);
    for (parity, colour) in [(1, [1.0; 3]), (0, [0.5; 3])] {
        draft.material(opaque(colour, [0.5, 0.5], 30.0, 0.0));
        for i in 0..size {
            for j in (0..size).filter(|j| (i + j) % 2 == parity) {
                let corners = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]];
                draft.polygon(quad(corners.map(|[i, j]| [place(i), place(j), 0.0])));
            }
        }
    }
    draft.material(opaque([1.0, 0.5, 0.1], [0.75, 0.25], 37.0, 0.0));
    for patch in patches() {
        tessellate(&patch, size, &mut draft);
    }
    draft
}

/// A corner of a cell.
#[derive(Clone, Copy)]
struct Vertex {
    point: DVec3,
    normal: DVec3,
    /// Whether it lies on the pot's axis, where a patch runs to a point.
    cusp: bool,
}

/// Emits the cells' two triangles each, but for those that a cusp makes degenerate.
fn tessellate(patch: &Patch, size: usize, draft: &mut Draft) {
    let vertices: Vec<Vec<Vertex>> = (0..=size)
        .map(|a| (0..=size).map(|b| vertex(patch, a, b, size)).collect())
        .collect();
    for rows in vertices.windows(2) {
        for b in 0..size {
            let c = [rows[0][b], rows[0][b + 1], rows[1][b + 1], rows[1][b]];
            for triangle in [[0, 1, 2], [2, 3, 0]].map(|t| t.map(|i| c[i])) {
                if triangle.iter().filter(|v| v.cusp).count() < 2 {
                    draft.patch(triangle.map(|v| v.point), triangle.map(|v| v.normal));
                }
            }
        }
    }
}

fn vertex(patch: &Patch, a: usize, b: usize, size: usize) -> Vertex {
    let [(s, ds), (t, dt)] = [a, b].map(|k| bernstein(k as f64 / size as f64));
    let sum = |along_s: &[f64; 4], along_t: &[f64; 4]| -> DVec3 {
        let row = |r: &[DVec3; 4]| -> DVec3 { r.iter().zip(along_t).map(|(&p, &w)| w * p).sum() };
        patch.iter().zip(along_s).map(|(r, &w)| w * row(r)).sum()
    };
    let point = sum(&s, &t);
    let cusp = point.x.abs() <= 1e-4 && point.y.abs() <= 1e-4;
    let normal = match cusp {
        // The knob's top looks up, the bottom's middle down.
        true if point.z > 1.5 => DVec3::Z,
        true => DVec3::NEG_Z,
        false => sum(&s, &dt).cross(sum(&ds, &t)).normalize(),
    };
    Vertex {
        point,
        normal,
        cusp,
    }
}

/// The four cubic Bernstein polynomials at t, and their derivatives.
fn bernstein(t: f64) -> ([f64; 4], [f64; 4]) {
    let u = 1.0 - t;
    let values = [u * u * u, 3.0 * t * u * u, 3.0 * t * t * u, t * t * t];
    let slopes = [
        -3.0 * u * u,
        3.0 * u * (u - 2.0 * t),
        3.0 * t * (2.0 * u - t),
        3.0 * t * t,
    ];
    (values, slopes)
}

/// The 32 patches: rim, body, handle, spout, lid, bottom.
fn patches() -> Vec<Patch> {
    let round = |profile: [[f64; 2]; 4]| revolved(profile, profile.map(|[a, _]| HANDLE * a));
    let rim = [[1.4, 2.4], [1.3375, 2.53125], [1.4375, 2.53125], [1.5, 2.4]];
    let upper_body = [[1.5, 2.4], [1.75, 1.875], [2.0, 1.35], [2.0, 0.9]];
    let lower_body = [[2.0, 0.9], [2.0, 0.45], [1.5, 0.225], [1.5, 0.15]];
    let handle = [
        mirrored(
            [[-1.6, 2.025], [-2.3, 2.025], [-2.7, 2.025], [-2.7, 1.8]],
            [[-1.5, 2.25], [-2.5, 2.25], [-3.0, 2.25], [-3.0, 1.8]],
            [0.3; 4],
        ),
        mirrored(
            [[-2.7, 1.8], [-2.7, 1.575], [-2.5, 1.125], [-2.0, 0.9]],
            [[-3.0, 1.8], [-3.0, 1.35], [-2.65, 0.9375], [-1.9, 0.6]],
            [0.3; 4],
        ),
    ];
    let spout = [
        mirrored(
            [[1.7, 1.425], [2.6, 1.425], [2.3, 2.1], [2.7, 2.4]],
            [[1.7, 0.6], [3.1, 0.825], [2.4, 2.025], [3.3, 2.4]],
            [0.66, 0.66, 0.25, 0.25],
        ),
        mirrored(
            [[2.7, 2.4], [2.8, 2.475], [2.9, 2.475], [2.8, 2.4]],
            [[3.3, 2.4], [3.525, 2.49375], [3.45, 2.5125], [3.2, 2.4]],
            [0.25, 0.25, 0.15, 0.15],
        ),
    ];
    let knob = [[0.0, 3.15], [0.8, 3.15], [0.0, 2.85], [0.2, 2.7]];
    let lid = [[0.2, 2.7], [0.4, 2.55], [1.3, 2.55], [1.3, 2.4]];
    let bottom = [[0.0, 0.0], [1.425, 0.0], [1.5, 0.075], [1.5, 0.15]];
    // The bottom's profile runs outward: the other sense of turning keeps its normals out.
    let bottom = round(bottom).map(|patch| patch.map(|row| row.map(|p| p.with_y(-p.y))));
    let mut all = [round(rim), round(upper_body), round(lower_body)].concat();
    all.extend([handle, spout].concat().concat());
    // The handles of the knob's second row are its own: 0.45, not 0.448.
    all.extend(revolved(knob, [0.0, 0.45, 0.0, 0.112]));
    all.extend([round(lid), bottom].concat());
    all
}

/// Four patches of a surface of revolution: a profile of radii and heights, with the lengths of the handles, clockwise.
fn revolved(profile: [[f64; 2]; 4], handles: [f64; 4]) -> [Patch; 4] {
    std::array::from_fn(|quarter| {
        std::array::from_fn(|row| {
            let ([a, z], h) = (profile[row], handles[row]);
            [[a, 0.0], [a, -h], [h, -a], [0.0, -a]].map(|[mut x, mut y]| {
                for _ in 0..quarter {
                    (x, y) = (y, -x);
                }
                DVec3::new(x, y, z)
            })
        })
    })
}

/// Two patches that mirror each other in y: rows of a tube from the points a over the half width w to the points b, both
/// in the plane y = 0, and back.
fn mirrored(a: [[f64; 2]; 4], b: [[f64; 2]; 4], w: [f64; 4]) -> [Patch; 2] {
    let row = |r: usize, [from, to]: [[[f64; 2]; 4]; 2], w: f64| {
        let ([x0, z0], [x1, z1]) = (from[r], to[r]);
        [[x0, 0.0, z0], [x0, w, z0], [x1, w, z1], [x1, 0.0, z1]].map(DVec3::from)
    };
    [
        std::array::from_fn(|r| row(r, [a, b], -w[r])),
        std::array::from_fn(|r| row(r, [b, a], w[r])),
    ]
}
