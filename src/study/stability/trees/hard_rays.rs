//! Rays that are hard for a scene and its tree: along axes through vertices, towards vertices, in split planes.

use glam::DVec3;

use crate::geom::{Line, Ray, Span};
use crate::kd::{NodeKind, Tree};
use crate::rays::SurfaceLines;
use crate::scene::Scene;

/// Rays of each sort.
const EACH: usize = 16;

/// The rays: some are whole lines, some begin at t = 0.
pub fn hard_rays(scene: &Scene, tree: &Tree) -> Vec<Ray> {
    let world = scene.world;
    let drawn: Vec<Line> = SurfaceLines { world, seed: 1 }
        .range(0..EACH as u64)
        .collect();
    let mut lines = drawn.clone();
    let points = spread(&points(scene));
    for (i, &point) in points.iter().enumerate() {
        // Along an axis through the point, with zeros of both signs.
        let sign = if i / 3 % 2 == 0 { 1.0 } else { -1.0 };
        let axis = i % 3;
        let mut direction = DVec3::ZERO * -sign;
        direction[axis] = sign;
        let mut origin = point;
        origin[axis] -= sign * 1.5 * world.extent()[axis];
        lines.push(Line::new(origin, direction));
        // From the middle, and from the surface.
        for origin in [world.centre(), drawn[i % EACH].origin] {
            if origin != point {
                lines.push(Line::new(origin, point - origin));
            }
        }
    }
    let planes: Vec<usize> = (0..tree.nodes.len())
        .filter(|&i| !tree.nodes[i].is_leaf())
        .collect();
    for (i, node) in spread(&planes).into_iter().enumerate() {
        if let NodeKind::Inner { axis, split, .. } = tree.nodes[node].kind() {
            let mut origin = tree.boxes[node].centre();
            origin[axis] = split;
            let mut direction = drawn[i % EACH].direction;
            direction[axis] = if i % 2 == 0 { 0.0 } else { -0.0 };
            lines.push(Line::new(origin, direction));
        }
    }
    let span = |i: usize| [Span::FULL, Span::from(0.0)][i % 2];
    let ray = |(i, line)| Ray::new(line, span(i));
    lines.into_iter().enumerate().map(ray).collect()
}

/// Corners of triangles; of other objects, corners of their boxes and the middles of the boxes' faces, where spheres touch them.
fn points(scene: &Scene) -> Vec<DVec3> {
    let triangles = &scene.objects.triangles;
    let corners = triangles.iter().flat_map(|t| t.0);
    let others = scene.bounds[triangles.len()..].iter().flat_map(|b| {
        let on_face = |k: usize| {
            let mut point = b.centre();
            point[k] = b.hi[k];
            point
        };
        [b.lo, on_face(0), on_face(1), on_face(2), b.hi]
    });
    corners.chain(others).collect()
}

/// At most [`EACH`] of some things, evenly spread.
fn spread<T: Copy>(all: &[T]) -> Vec<T> {
    let count = all.len().min(EACH);
    (0..count).map(|i| all[i * all.len() / count]).collect()
}
