//! `gears`: layers of meshing gears, some of glass. Their faces are polygons of 144 corners, half of them reflex.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use super::stage::{ground, opaque, stage};
use crate::geom::Polygon;
use crate::scene::draft::Draft;
use crate::scene::look::Material;

/// Teeth of a gear.
const TEETH: usize = 36;

/// The ground, then the gears from the top layer down, each with its own material: top, sides, bottom.
pub(super) fn draft(size: usize) -> Draft {
    let view = [[-1.1, -2.1, 2.6], [0.0; 3], [0.0, 0.0, 1.0]];
    let lights = [
        [2.0, 4.0, 4.0],
        [-2.0, 4.0, 3.0],
        [2.0, -2.5, 2.5],
        [-1.0, -4.0, 2.0],
        [-1.111, -2.121, 2.626],
    ];
    let mut draft = Draft::new(stage(view, 45.0, 1.0, &lights));
    draft.material(opaque([1.0, 0.85, 0.7], [0.3, 0.6], 37.0, 0.0));
    draft.polygon(ground(2.0, 0.0));

    let n = size as f64;
    let radius = 1.0 / (n - 0.05 * (n - 1.0));
    let thickness = (1.0 / (2.0 * n)).min(0.1);
    for k in 0..size {
        for j in 0..size {
            for i in 0..size {
                let place = |index: usize| -1.0 + radius + 1.9 * radius * index as f64;
                let centre = DVec3::new(place(i), place(j), 1.0 - k as f64 / n);
                // Neighbours are half a tooth apart, so that they mesh.
                let phase = if (i + j + k).is_multiple_of(2) {
                    0.0
                } else {
                    PI / 36.0
                };
                draft.material(material(i, j, k));
                gear(centre, radius, phase, thickness, &mut draft);
            }
        }
    }
    draft
}

/// Emits a gear below its top's centre.
fn gear(centre: DVec3, radius: f64, phase: f64, thickness: f64, draft: &mut Draft) {
    let tooth = TAU / TEETH as f64;
    let (tip, root) = (0.995 * radius, 0.9 * radius);
    let top: Vec<DVec3> = (0..TEETH)
        .flat_map(|m| {
            let start = phase + m as f64 * tooth;
            [(-0.19, tip), (0.19, tip), (0.3, root), (0.7, root)].map(|(part, r)| {
                let angle = start + part * tooth;
                centre + r * DVec3::new(libm::cos(angle), libm::sin(angle), 0.0)
            })
        })
        .collect();
    let n = top.len();
    let lowered = |p: DVec3| p.with_z(centre.z - thickness);
    // Backwards, and beginning with the first tooth's second corner.
    let bottom = (0..n).map(|i| lowered(top[(n + 1 - i) % n])).collect();
    let polygon =
        |corners: Vec<DVec3>| Polygon::new(corners).expect("an outline without crossings");
    draft.polygon(polygon(top.clone()));
    for i in 0..n {
        let (a, b) = (top[i], top[(i + 1) % n]);
        draft.polygon(polygon(vec![a, lowered(a), lowered(b), b]));
    }
    draft.polygon(polygon(bottom));
}

/// Colours from the gear's place; every gear with 4i + 2j + k divisible by 5 is of glass.
fn material(i: usize, j: usize, k: usize) -> Material {
    let part = |number: usize| 0.01 + (number % 7) as f64 / 7.0;
    let colour = DVec3::new(
        part(5 * (3 * i + 2 * j + k + 1)),
        part(3 * (3 * j + 2 * k + i + 1)),
        part(2 * (3 * k + 2 * i + j + 1)),
    );
    let colour = (colour / colour.max_element()).to_array();
    if (4 * i + 2 * j + k).is_multiple_of(5) {
        Material {
            transmittance: 0.8,
            ..opaque(colour, [0.2, 0.0], 0.0, 1.1)
        }
    } else {
        opaque(colour, [1.0, 0.0], 0.0, 0.0)
    }
}
