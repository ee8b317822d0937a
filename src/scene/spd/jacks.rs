//! `jacks`: a cross of three cylinders with a ball at each of its six ends, and in each octant a cross of half the size.

use glam::{DMat3, DVec3};

use super::stage::{opaque, stage};
use super::turn::turn_by;
use crate::geom::Cone;
use crate::scene::draft::Draft;
use crate::scene::look::{Stage, View};

/// The crosses depth first, all turned by -20 degrees about y, then by -30 degrees about x.
pub(super) fn draft(size: usize) -> Draft {
    let view = [[0.0, 0.0, -8.0], [0.0; 3], [0.0, 1.0, 0.0]];
    let usual = stage(view, 25.0, 0.001, &[[-10.0, 3.0, -20.0]]);
    let mut draft = Draft::new(Stage {
        background: DVec3::new(0.2, 0.05, 0.2),
        view: View {
            resolution: [256, 256],
            ..usual.view
        },
        ..usual
    });
    draft.material(opaque([0.737, 0.561, 0.561], [0.7, 0.7], 20.0, 1.0));
    let frame = turn_by(DVec3::X, -30_f64.to_radians()) * turn_by(DVec3::Y, -20_f64.to_radians());
    grow(size, DVec3::ZERO, 1.0, &frame, &mut draft);
    draft
}

/// Emits the cross at `centre`, before it is turned by `frame`, and the crosses of `size - 1` generations in it.
fn grow(size: usize, centre: DVec3, scale: f64, frame: &DMat3, draft: &mut Draft) {
    let arm = 0.75 * scale;
    for axis in DVec3::AXES {
        draft.cone(Cone {
            base: *frame * (centre - arm * axis),
            base_radius: 0.075 * scale,
            apex: *frame * (centre + arm * axis),
            apex_radius: 0.075 * scale,
        });
    }
    for side in [arm, -arm] {
        for axis in DVec3::AXES {
            draft.sphere(*frame * (centre + side * axis), 0.15 * scale);
        }
    }
    if size == 1 {
        return;
    }
    for x in [-0.5, 0.5] {
        for y in [-0.5, 0.5] {
            for z in [-0.5, 0.5] {
                let octant = centre + scale * DVec3::new(x, y, z);
                grow(size - 1, octant, 0.5 * scale, frame, draft);
            }
        }
    }
}
