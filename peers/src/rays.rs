//! The two sets of rays.

use glam::DVec3;
use sahlab::geom::{Aabb, Line};
use sahlab::rays::SurfaceLines;
use sahlab::scene::look::View;
use sahlab::tracer::Camera;

use crate::Ray;

fn ray(line: Line) -> Ray {
    Ray {
        origin: line.origin.as_vec3().to_array(),
        direction: line.direction.as_vec3().to_array(),
    }
}

/// Isotropic uniform lines through the box, as rays from its surface: neighbours have nothing to do with each other.
pub fn isotropic(world: Aabb, count: u64) -> Vec<Ray> {
    let lines = SurfaceLines { world, seed: 1 };
    lines.range(0..count).map(ray).collect()
}

/// A pinhole camera outside the box that has all of it in view, row by row: neighbours run side by side.
pub fn camera(world: Aabb, side: u32) -> Vec<Ray> {
    let at = 0.5 * (world.lo + world.hi);
    let diagonal = (world.hi - world.lo).length();
    let view = View {
        from: at + diagonal * DVec3::new(0.3, 0.35, 1.0),
        at,
        up: DVec3::Y,
        angle: 40.0,
        hither: 0.0,
        resolution: [side; 2],
    };
    let camera = Camera::new(&view, side - 1);
    let rows = (0..side).flat_map(|j| (0..side).map(move |i| (i, j)));
    rows.map(|(i, j)| ray(camera.ray(i, j))).collect()
}
