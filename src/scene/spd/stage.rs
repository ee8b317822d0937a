//! What the package's cameras, lights and materials have in common.

use glam::DVec3;

use crate::geom::Polygon;
use crate::scene::look::{Material, Stage, View};

/// The package's blue background and pictures of 512 x 512 pixels; positions of camera and lights as given.
pub(super) fn stage(
    [from, at, up]: [[f64; 3]; 3],
    angle: f64,
    hither: f64,
    lights: &[[f64; 3]],
) -> Stage {
    Stage {
        background: DVec3::new(0.078, 0.361, 0.753),
        view: View {
            from: from.into(),
            at: at.into(),
            up: up.into(),
            angle,
            hither,
            resolution: [512, 512],
        },
        lights: lights.iter().copied().map(DVec3::from).collect(),
    }
}

/// An opaque surface: colour, diffuse and specular share, and the angle in degrees at which a highlight falls to half
/// (0 for a surface without). The index of refraction, which then means nothing, is 0 in some scenes and 1 in others.
pub(super) fn opaque(
    colour: [f64; 3],
    [diffuse, specular]: [f64; 2],
    half_angle: f64,
    index: f64,
) -> Material {
    Material {
        colour: colour.into(),
        diffuse,
        specular,
        shine: shine(half_angle),
        transmittance: 0.0,
        index,
    }
}

/// The Phong exponent with which a highlight falls to half at an angle in degrees: cos^shine = 1/2. The package writes
/// 100000 for an angle of zero.
pub(super) fn shine(half_angle: f64) -> f64 {
    if half_angle <= 0.0 {
        return 1e5;
    }
    libm::log(0.5) / libm::log(libm::cos(half_angle.to_radians()))
}

/// The axis-parallel square of half a side `half` at height z, seen from above.
pub(super) fn ground(half: f64, z: f64) -> Polygon {
    quad([[half, half], [-half, half], [-half, -half], [half, -half]].map(|[x, y]| [x, y, z]))
}

/// A rectangle.
pub(super) fn quad(corners: [[f64; 3]; 4]) -> Polygon {
    Polygon::new(corners.map(DVec3::from).into()).expect("a rectangle is a polygon")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exponents_of_the_package() {
        for (angle, exponent) in [
            (0.0, 1e5),
            (6.7, 101.148),
            (10.0, 45.2776),
            (20.0, 11.1434),
            (30.0, 4.81884),
            (37.0, 3.0827),
            (40.0, 2.60078),
        ] {
            assert!((shine(angle) / exponent - 1.0).abs() < 5e-6, "{angle}");
        }
    }
}
