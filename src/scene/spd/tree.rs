//! `tree`: a binary tree of cones with a sphere at each tip, small in the middle of a very large field.

use glam::{DMat3, DVec3};

use super::stage::{ground, opaque, stage};
use super::turn::turn_by;
use crate::geom::Cone;
use crate::scene::draft::Draft;

/// Each branch's radius over its parent's, and a tip's radius over its base's.
const TAPER: f64 = 0.67;

/// The field, then the branches depth first: cone, sphere at its tip, the two branches on it.
pub(super) fn draft(size: usize) -> Draft {
    let view = [[4.5, 0.4, 2.0], [0.0, 0.0, 1.5], [0.0, 0.0, 1.0]];
    let lights = [
        [-5.0, 5.0, 50.0],
        [30.0, -30.0, 30.0],
        [-40.0, -30.0, 20.0],
        [10.0, 30.0, 40.0],
        [-30.0, 40.0, 10.0],
        [50.0, 25.0, 20.0],
        [-10.0, -60.0, 30.0],
    ];
    let mut draft = Draft::new(stage(view, 45.0, 1.0, &lights));
    draft.material(opaque([0.2, 0.7, 0.2], [1.0, 0.0], 0.0, 0.0));
    draft.polygon(ground(50.0, 0.0));
    draft.material(opaque([0.55, 0.4, 0.2], [1.0, 0.0], 0.0, 0.0));
    // A branch is its parent's, shortened, tilted by the second angle and turned about it by the first.
    let forks = [(0.65, 90_f64, 40_f64), (0.70, 230.0, 25.0)].map(|(length, round, tilt)| {
        let frame = turn_by(DVec3::Z, round.to_radians()) * turn_by(DVec3::X, tilt.to_radians());
        length * frame
    });
    grow(size, DMat3::IDENTITY, DVec3::ZERO, 0.15, &forks, &mut draft);
    draft
}

/// Emits the branch that `frame` makes of the unit vector z, from `base` on, and `depth` generations on it.
fn grow(
    depth: usize,
    frame: DMat3,
    base: DVec3,
    radius: f64,
    forks: &[DMat3; 2],
    draft: &mut Draft,
) {
    let tip = base + frame.z_axis;
    let thin = TAPER * radius;
    draft.cone(Cone {
        base,
        base_radius: radius,
        apex: tip,
        apex_radius: thin,
    });
    draft.sphere(tip, thin);
    if depth > 0 {
        for fork in forks {
            grow(depth - 1, frame * *fork, tip, thin, forks, draft);
        }
    }
}
