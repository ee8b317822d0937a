//! Lines for random cases: drawn by the metric's law, or aimed at what is hard to judge.

use glam::DVec3;
use rand::Rng;
use rand::RngExt;
use rand::rngs::ChaCha8Rng;

use crate::geom::Line;
use crate::kd::Tree;
use crate::rays::{Purpose, SurfaceLines, generator};
use crate::scene::Scene;

use super::random::Against;

/// What to aim at: line i is a function of the seed and i.
pub struct Aim<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// Its tree, for its boxes.
    pub tree: &'a Tree,
    /// Seed.
    pub seed: u64,
    /// Boxes or triangles.
    pub against: Against,
}

impl Aim<'_> {
    /// The metric's own line i.
    pub fn drawn(&self, i: u64) -> Line {
        let lines = SurfaceLines {
            world: self.scene.world,
            seed: self.seed,
        };
        let line = lines.range(i..i + 1).next();
        line.expect("a range of one has one line")
    }

    /// Line i through an edge or a corner, up to the rounding of its direction: from the surface of the scene's box, from far outside, parallel to
    /// one coordinate plane in which the target lies, or to two.
    pub fn aimed(&self, i: u64) -> Line {
        let mut rng = generator(self.seed, Purpose::Pairs);
        rng.set_stream(i);
        let target = match self.against {
            Against::Box => self.on_box(&mut rng),
            Against::Triangle => self.on_triangle(&mut rng),
        };
        let from = self.drawn(i).origin;
        let axis = rng.random_range(0..3);
        let mut origin = from;
        match rng.random_range(0..16) {
            0..8 => {}
            8..12 => origin = target + 16.0 * (from - target),
            12..15 => origin[axis] = target[axis],
            _ => {
                origin = target;
                origin[axis] = self.scene.world.lo[axis] - self.scene.world.extent()[axis];
            }
        }
        let direction = target - origin;
        // The target may be where the line begins: any other direction will do.
        let direction = if direction == DVec3::ZERO {
            self.scene.world.extent()
        } else {
            direction
        };
        Line::new(origin, direction)
    }

    /// A corner or a point of an edge of some node's box.
    fn on_box(&self, rng: &mut ChaCha8Rng) -> DVec3 {
        let b = &self.tree.boxes[rng.random_range(0..self.tree.boxes.len() as u32) as usize];
        let bits = rng.next_u32();
        let mut point = DVec3::from_array([0, 1, 2].map(|k| {
            let corner = if bits >> k & 1 == 0 { b.lo } else { b.hi };
            corner[k]
        }));
        if bits >> 3 & 3 != 0 {
            let axis = rng.random_range(0..3);
            let share: f64 = rng.random();
            point[axis] = b.lo[axis] + share * (b.hi[axis] - b.lo[axis]);
        }
        point
    }

    /// A corner or a point of an edge of some triangle.
    fn on_triangle(&self, rng: &mut ChaCha8Rng) -> DVec3 {
        let triangles = &self.scene.objects.triangles;
        let corners = triangles[rng.random_range(0..triangles.len() as u32) as usize].0;
        let k = rng.random_range(0..3);
        if rng.next_u32() & 3 == 0 {
            corners[k]
        } else {
            corners[k].lerp(corners[(k + 1) % 3], rng.random())
        }
    }
}
