//! `rings`: a pyramid, seen from its tip, of dodecahedral knots of six interlaced pentagons of tubes, before a wall.

use std::f64::consts::{FRAC_PI_3, FRAC_PI_8, PI, TAU};

use glam::DVec3;

use super::stage::{opaque, quad, stage};
use super::turn::turn_by;
use crate::geom::Cone;
use crate::scene::draft::Draft;

/// Radius of the tubes.
const TUBE: f64 = 0.07412;

/// Colours of the six pentagons.
const COLOURS: [[f64; 3]; 6] = [
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [0.0, 1.0, 1.0],
    [1.0, 0.0, 1.0],
    [1.0, 1.0, 0.0],
];

/// The wall, then the knots layer by layer from the tip on.
pub(super) fn draft(size: usize) -> Draft {
    // Layers are this far apart, and the picture's half angle pi/8 sees one knot more to each side in every layer.
    let step = 1.0 / libm::sin(FRAC_PI_8);
    let view = [[-1.0, -step, 0.5], [-1.0, 1.0 - step, 0.5], [0.0, 0.0, 1.0]];
    let lights = [[3.0, -step, 3.0], [-4.0, -step, 1.0], [2.0, -step, -4.0]];
    let mut draft = Draft::new(stage(view, 45.0, 1.0, &lights));

    draft.material(opaque([1.0; 3], [1.0, 0.0], 0.0, 0.0));
    let y = step * (size + 1) as f64;
    let half = 1.01 * (y + step) * libm::tan(FRAC_PI_8);
    draft.polygon(quad(
        [[half, half], [-half, half], [-half, -half], [half, -half]]
            .map(|[x, z]| [x - 1.0, y, z + 0.5]),
    ));

    let materials = COLOURS.map(|colour| opaque(colour, [0.5, 0.2], 37.0, 0.0));
    let pentagons = pentagons();
    for depth in 0..size {
        let place = |k: usize| (2 * k) as f64 - depth as f64;
        for z in 0..=depth {
            for x in 0..=depth {
                let offset = DVec3::new(place(x), step * (depth + 1) as f64, place(z));
                for (pentagon, material) in pentagons.iter().zip(materials) {
                    draft.material(material);
                    for e in 0..5 {
                        let base = pentagon[e] + offset;
                        draft.cone(Cone {
                            base,
                            base_radius: TUBE,
                            apex: pentagon[(e + 4) % 5] + offset,
                            apex_radius: TUBE,
                        });
                        draft.sphere(base, TUBE);
                    }
                }
            }
        }
    }
    draft
}

/// The corners of the six pentagons: one around z, five tilted by the angle between two faces' normals of a dodecahedron.
fn pentagons() -> [[DVec3; 5]; 6] {
    let radius = 1.0 / (1.0 + TUBE);
    let flat: [DVec3; 5] = std::array::from_fn(|e| {
        let angle = TAU * e as f64 / 5.0;
        radius * DVec3::new(libm::cos(angle), libm::sin(angle), 0.0)
    });
    let tilt = 2.0 * libm::acos(libm::cos(FRAC_PI_3) / libm::sin(PI / 5.0));
    std::array::from_fn(|p| {
        if p == 0 {
            return flat;
        }
        let angle = PI * (2 * p - 1) as f64 / 5.0;
        let frame = turn_by(DVec3::Z, angle) * turn_by(DVec3::X, tilt);
        flat.map(|corner| frame * corner)
    })
}
