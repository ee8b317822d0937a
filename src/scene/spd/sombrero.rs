//! `sombrero`: the ripples cos(2 pi r) exp(-r) over a square, as a height field of triangles.

use glam::DVec3;

use super::stage::{opaque, stage};
use crate::scene::draft::Draft;

/// pi as the package writes it.
#[expect(
    clippy::approx_constant,
    reason = "the package's heights are made with this value"
)]
const PI: f64 = 3.14159265358;

/// The cells row by row, two triangles each.
pub(super) fn draft(size: usize) -> Draft {
    let view = [[0.0, 5.0, -8.0], [0.0; 3], [0.0, 0.0, 1.0]];
    let mut draft = Draft::new(stage(view, 40.0, 0.01, &[[10.0, 10.0, -10.0]]));
    draft.material(opaque([1.0, 0.1, 0.1], [0.8, 0.0], 40.0, 1.0));
    let side = 32 << (size - 1);
    let mut this = row(0, side);
    for i in 1..side {
        let next = row(i, side);
        for j in 1..side {
            draft.triangle([this[j - 1], next[j], this[j]]);
            draft.triangle([this[j - 1], next[j - 1], next[j]]);
        }
        this = next;
    }
    draft
}

/// Row i of the side^2 vertices. Heights are taken at steps of 8/side but placed at steps of 8/(side - 1), as in the
/// package, which also keeps them in single precision.
fn row(i: usize, side: usize) -> Vec<DVec3> {
    let sampled = |k: usize| -4.0 + 8.0 * k as f64 / side as f64;
    let placed = |k: usize| -4.0 + 8.0 * k as f64 / (side - 1) as f64;
    let vertex = |j: usize| {
        let (x, z) = (sampled(j), sampled(i));
        let r = (x * x + z * z).sqrt();
        let height = (3.0 * libm::cos(2.0 * PI * r) * libm::exp(-r) / 3.0) as f32;
        DVec3::new(placed(j), -3.0 + f64::from(height), placed(i))
    };
    (0..side).map(vertex).collect()
}
