//! Rotations.

use glam::{DMat3, DVec3};

/// Right-handed rotation about a unit axis by the angle with this sine and cosine (Rodrigues).
pub(super) fn turn(axis: DVec3, sine: f64, cosine: f64) -> DMat3 {
    let column = |e: DVec3| cosine * e + sine * axis.cross(e) + (1.0 - cosine) * axis.dot(e) * axis;
    DMat3::from_cols(column(DVec3::X), column(DVec3::Y), column(DVec3::Z))
}

/// Right-handed rotation about a unit axis by an angle in radians.
pub(super) fn turn_by(axis: DVec3, angle: f64) -> DMat3 {
    turn(axis, libm::sin(angle), libm::cos(angle))
}
