//! `balls`, the sphereflake: every sphere carries nine of a third of its size; all stand on a large square.

use glam::{DMat3, DVec3};

use super::stage::{ground, opaque, stage};
use super::turn::turn;
use crate::scene::draft::Draft;

/// The floor, and the spheres depth first, each before its children. Every angle of the construction has a sine and
/// cosine in square roots, so no transcendental function is needed.
pub(super) fn draft(size: usize) -> Draft {
    let view = [[2.1, 1.3, 1.7], [0.0; 3], [0.0, 0.0, 1.0]];
    let lights = [[4.0, 3.0, 2.0], [1.0, -4.0, 4.0], [-3.0, 1.0, 5.0]];
    let mut draft = Draft::new(stage(view, 45.0, 0.01, &lights));
    draft.material(opaque([1.0, 0.75, 0.33], [0.8, 0.0], 0.0, 1.0));
    draft.polygon(ground(12.0, -0.5));
    draft.material(opaque([1.0, 0.9, 0.7], [0.5, 0.5], 37.0, 1.0));
    grow(size, DVec3::ZERO, 0.5, DVec3::Z, &directions(), &mut draft);
    draft
}

/// Where the children of a sphere that points along z are: three above, six around the equator.
fn directions() -> [DVec3; 9] {
    let q = 0.5_f64.sqrt();
    let trio = [[q, q, 0.0], [q, 0.0, -q], [0.0, q, -q]].map(DVec3::from);
    // Carries (1,1,1)/sqrt 3 to z: the turn about (q,-q,0) with sine 2/sqrt 6 and cosine 1/sqrt 3.
    let tilt = turn(
        DVec3::new(q, -q, 0.0),
        2.0 / 6_f64.sqrt(),
        1.0 / 3_f64.sqrt(),
    );
    let third = turn(DVec3::Z, 0.5 * 3_f64.sqrt(), -0.5);
    let first = trio.map(|t| tilt * t);
    let second = first.map(|t| third * t);
    let last = second.map(|t| third * t);
    std::array::from_fn(|i| [first, second, last][i / 3][i % 3])
}

/// Emits a sphere that points along `direction`, and its children `depth` generations on.
fn grow(
    depth: usize,
    centre: DVec3,
    radius: f64,
    direction: DVec3,
    directions: &[DVec3; 9],
    draft: &mut Draft,
) {
    draft.sphere(centre, radius);
    if depth == 0 {
        return;
    }
    let frame = from_z(direction);
    for d in directions {
        let towards = frame * *d;
        let child = centre + (4.0 / 3.0) * radius * towards;
        grow(depth - 1, child, radius / 3.0, towards, directions, draft);
    }
}

/// The rotation that carries z to the unit vector `d` the shortest way; next to the poles, that of the pole.
fn from_z(d: DVec3) -> DMat3 {
    if d.z >= 0.9999 {
        DMat3::IDENTITY
    } else if d.z <= -0.9999 {
        // Half a turn about y.
        DMat3::from_diagonal(DVec3::new(-1.0, 1.0, -1.0))
    } else {
        // Axis z x d, with sine its length and cosine d_z.
        let sine = (d.x * d.x + d.y * d.y).sqrt();
        turn(DVec3::new(-d.y / sine, d.x / sine, 0.0), sine, d.z)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_rotations() {
        for d in directions() {
            let m = from_z(d);
            assert!((m * DVec3::Z).distance(d) < 1e-15);
            assert!((m.determinant() - 1.0).abs() < 1e-15);
        }
        assert_eq!(from_z(-DVec3::Z) * DVec3::Z, -DVec3::Z);
    }
}
