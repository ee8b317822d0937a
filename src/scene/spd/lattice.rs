//! `lattice`: spheres at the points of a cubic grid, neighbours joined by thin cylinders whose ends lie within them.

use glam::DVec3;

use super::stage::{opaque, stage};
use crate::geom::Cone;
use crate::scene::draft::Draft;

/// The points of the grid with x slowest; after each sphere the cylinders to its next neighbours in x, y, z.
pub(super) fn draft(size: usize) -> Draft {
    let n = size as f64;
    // The middle of a cell, in the plane of the top layer.
    let x = ((size / 2) as f64 + 0.5) / n;
    let drop = 1.0 / (2.0 * n);
    let view = [
        [x, 1.0, 1.0 - drop],
        [x, -1.0, -1.0 - drop],
        [0.2, 1.0, 0.0],
    ];
    let lights = [
        [2.0, 0.5, 0.5],
        [-1.0, 0.5, 0.5],
        [0.5, 2.0, 0.5],
        [0.5, -1.0, 0.5],
        [0.5, 0.5, 2.0],
        [0.5, 0.5, -1.0],
    ];
    let mut draft = Draft::new(stage(view, 60.0, 0.0, &lights));

    let white = opaque([0.9, 0.9, 0.9], [0.5, 0.5], 37.0, 0.0);
    let along = [[0.9, 0.1, 0.1], [0.1, 0.9, 0.1], [0.1, 0.1, 0.9]]
        .map(|colour| opaque(colour, [0.99, 0.0], 0.0, 0.0));
    let (ball, rod) = (1.0 / (4.0 * n), 1.0 / (16.0 * n));
    let inset = 0.99 * ball * (1.0 - (rod / ball).sqrt());
    for x in 0..=size {
        for y in 0..=size {
            for z in 0..=size {
                let cell = [x, y, z];
                let centre = DVec3::from(cell.map(|i| i as f64 / n));
                draft.material(white);
                draft.sphere(centre, ball);
                for (k, axis) in DVec3::AXES.into_iter().enumerate() {
                    if cell[k] < size {
                        draft.material(along[k]);
                        draft.cone(Cone {
                            base: centre + inset * axis,
                            base_radius: rod,
                            apex: centre + (1.0 / n - inset) * axis,
                            apex_radius: rod,
                        });
                    }
                }
            }
        }
    }
    draft
}
