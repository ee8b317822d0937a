//! Scenes, and rays through them that stress ties.

use glam::DVec3;
use sahlab::geom::{Cone, Line, Objects, Polygon, Ray, Span, Sphere};
use sahlab::kd::{NodeKind, Tree};
use sahlab::rays::{SurfaceLines, Uniforms};
use sahlab::scene::Scene;

use super::target;

/// Rays of every hard family.
pub fn hard_rays(scene: &Scene, tree: &Tree, n: usize) -> Vec<Ray> {
    let mut rays = Vec::new();
    let world = scene.world;
    let size = world.extent().length();
    let mut uniforms = Uniforms::starting_at(77, 0);
    for (i, line) in (SurfaceLines { world, seed: 3 })
        .range(0..n as u64)
        .enumerate()
    {
        let [x, y, z, w] = uniforms.next4();
        let inside = world.lo + DVec3::new(x, y, z) * world.extent();
        let target = target(&scene.objects, (w * 1e6) as usize + i);
        let mut along = DVec3::ZERO;
        along[i % 3] = if i.is_multiple_of(2) { size } else { -size };
        // Isotropic from the surface; from inside; a whole line; to a corner or an edge; along an axis through it.
        rays.push(Ray::new(line, Span::from(0.0)));
        rays.push(Ray::new(Line::new(inside, line.direction), Span::from(0.0)));
        rays.push(Ray::new(line, Span::FULL));
        rays.push(Ray::new(
            Line::new(line.origin, target - line.origin),
            Span::from(0.0),
        ));
        rays.push(Ray::new(Line::new(target - along, along), Span::from(0.0)));
        // A shadow segment between two points; in a split plane, slanted and along an axis.
        let shadow = Span { t0: 1e-9, t1: 1.0 };
        if target != inside {
            rays.push(Ray::new(Line::new(inside, target - inside), shadow));
        }
        let node = (w * tree.nodes.len() as f64) as usize;
        if let NodeKind::Inner { axis, split, .. } = tree.nodes[node].kind() {
            let (mut origin, mut slanted) = (line.origin, line.direction);
            origin[axis] = split;
            slanted[axis] = if i.is_multiple_of(2) { 0.0 } else { -0.0 };
            if slanted != DVec3::ZERO {
                rays.push(Ray::new(Line::new(origin, slanted), Span::from(0.0)));
            }
            let mut straight = DVec3::ZERO;
            straight[(axis + 1) % 3] = 1.0;
            rays.push(Ray::new(Line::new(origin, straight), Span::FULL));
        }
    }
    rays
}

/// Cylinders along axes with spheres at their ends, tapering branches of any direction, tiny ones, and a large floor.
pub fn joints(n: usize, seed: u64) -> Scene {
    let mut uniforms = Uniforms::starting_at(seed, 0);
    let mut objects = Objects::default();
    for i in 0..n {
        let [x, y, z, w] = uniforms.next4();
        let [a, b, c, taper] = uniforms.next4();
        let base = (8.0 * DVec3::new(x, y, z)).round() / 8.0;
        let towards = DVec3::new(a, b, c) - DVec3::splat(0.5);
        let (axis, radius, apex) = match i % 4 {
            0 => (0.25 * DVec3::AXES[i / 4 % 3], 0.02, 0.02),
            1 => (0.5 * towards, 0.05 * w, 0.05 * w * taper),
            2 => (0.5 * towards, 0.03, 0.0),
            _ => (0.01 * towards, 2.5e-4, 2e-4),
        };
        objects.cones.push(Cone {
            base,
            base_radius: radius,
            apex: base + axis,
            apex_radius: apex,
        });
        objects.spheres.push(Sphere {
            centre: base,
            radius,
        });
    }
    let floor = [
        [-9.0, -9.0],
        [9.0, -9.0],
        [9.0, 9.0],
        [1.0, 1.0],
        [-9.0, 9.0],
    ];
    let floor = floor.map(|[x, y]| DVec3::new(x, y, 0.0));
    objects.polygons.push(Polygon::new(floor.into()).unwrap());
    Scene::new("joints", objects, Vec::new()).unwrap()
}
