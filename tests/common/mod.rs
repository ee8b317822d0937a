//! Small worlds for tests.
#![allow(dead_code, clippy::unwrap_used)]

pub mod scenes;

use glam::DVec3;
use sahlab::cost::CostModel;
use sahlab::geom::{Aabb, Line, Object, Objects};
use sahlab::kd::{Probe, Rules, StopRule, Strategy, Tree, build};
use sahlab::rays::{SurfaceLines, Uniforms};

/// Rules with the usual costs.
pub fn rules(strategy: Strategy, stop: &str) -> Rules {
    Rules {
        strategy,
        stop: stop.parse().unwrap(),
        cost: CostModel::WALD_HAVRAN,
        clipped: false,
    }
}

/// The smallest box around all.
pub fn world(bounds: &[Aabb]) -> Aabb {
    bounds.iter().fold(Aabb::EMPTY, |w, b| w.union(*b))
}

/// n boxes in the unit cube, on a coarse grid so that many bounds coincide; some flat, some equal, some large.
pub fn gridded_boxes(n: usize, seed: u64) -> Vec<Aabb> {
    let mut uniforms = Uniforms::starting_at(seed, 0);
    let snap = |u: f64| (u * 16.0).round() / 16.0;
    (0..n)
        .map(|i| {
            let [x, y, z, size] = uniforms.next4();
            let [flat, a, b, c] = uniforms.next4();
            let scale = if i % 7 == 0 { 0.8 } else { 0.3 * size };
            let lo = DVec3::new(snap(x), snap(y), snap(z));
            let mut extent = DVec3::new(snap(scale * a), snap(scale * b), snap(scale * c));
            if flat < 0.3 {
                extent[i % 3] = 0.0;
            }
            Aabb::new(lo, lo + extent)
        })
        .collect()
}

/// n boxes with no coincidences.
pub fn random_boxes(n: usize, seed: u64) -> Vec<Aabb> {
    let mut uniforms = Uniforms::starting_at(seed, 0);
    let size = 1.0 / (n as f64).cbrt();
    (0..n)
        .map(|_| {
            let [x, y, z, _] = uniforms.next4();
            let [a, b, c, _] = uniforms.next4();
            let lo = DVec3::new(x, y, z);
            Aabb::new(lo, lo + size * DVec3::new(a, b, c))
        })
        .collect()
}

/// A tree with its world taken from the boxes.
pub fn tree(bounds: &[Aabb], strategy: Strategy, stop: &str) -> Tree {
    build(bounds, world(bounds), &rules(strategy, stop))
}

/// Lines that stress ties: isotropic ones, then axis-parallel and in-plane ones through object bounds.
pub fn hard_lines(bounds: &[Aabb], n: usize) -> Vec<Line> {
    let world = world(bounds);
    let mut lines: Vec<Line> = SurfaceLines { world, seed: 5 }.range(0..n as u64).collect();
    for (i, b) in bounds.iter().enumerate().take(n / 4) {
        let axis = i % 3;
        let mut along = DVec3::ZERO;
        along[axis] = if i % 2 == 0 { 1.0 } else { -1.0 };
        // Through a corner along an axis; in a bound's plane, slanted; through a corner and the world's corner.
        lines.push(Line::new(b.lo, along));
        let mut in_plane = DVec3::new(0.3, 0.5, -0.7);
        in_plane[axis] = if i % 4 < 2 { 0.0 } else { -0.0 };
        lines.push(Line::new(b.hi, in_plane));
        if b.hi != world.lo {
            lines.push(Line::new(b.hi, world.lo - b.hi));
        }
        lines.push(Line::new(b.lo, DVec3::new(1.0, 1.0, -1.0)));
    }
    lines
}

/// Strategies and stop rules that property tests go over.
pub const STOPS: [&str; 7] = [
    "objects:2:16",
    "objects:1",
    "cost-gain",
    "automatic",
    "cost-k:0.5",
    "depth:6",
    "octree:3:9",
];

/// A rule as parsed.
pub fn stop(text: &str) -> StopRule {
    text.parse().unwrap()
}

/// The leaves of a traversal, in order.
#[derive(Default)]
pub struct Leaves(pub Vec<u32>);

impl Probe for Leaves {
    fn leaf(&mut self, node: u32, _: u32) {
        self.0.push(node);
    }
}

/// A point of an object that structured rays go for: a corner or an edge's middle, a pole of a sphere, the rim of a cone or
/// the middle of its side.
pub fn target(objects: &Objects, i: usize) -> DVec3 {
    let corner = |corners: &[DVec3]| {
        let a = corners[i % corners.len()];
        if i.is_multiple_of(2) {
            a
        } else {
            0.5 * (a + corners[(i + 1) % corners.len()])
        }
    };
    match objects.get((i % objects.len()) as u32) {
        Object::Triangle(t) => corner(&t.0),
        Object::Polygon(p) => corner(p.corners()),
        Object::Sphere(s) => s.centre + s.radius * DVec3::AXES[i % 3],
        Object::Cone(c) => {
            let across = (c.apex - c.base)
                .cross(DVec3::AXES[i % 3])
                .normalize_or_zero();
            let rim = [
                c.base + c.base_radius * across,
                c.apex + c.apex_radius * across,
            ];
            if i.is_multiple_of(2) {
                rim[i / 2 % 2]
            } else {
                0.5 * (rim[0] + rim[1])
            }
        }
    }
}
