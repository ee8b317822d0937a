//! Lines for a kernel, in its own numbers: drawn by the metric's law, or aimed at what is hard to judge.

use std::ops::Range;

use glam::DVec3;
use rand::Rng;
use rand::RngExt;
use rand::rngs::ChaCha8Rng;

use crate::geom::{Line, Real, Vector};
use crate::kd::Planes;
use crate::rays::{Purpose, SurfaceLines, generator};

use super::{Exact, Subject};

/// What lines are held against.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Against {
    /// The boxes of nodes, by the traversal.
    Box,
    /// Triangles, by the object test.
    Triangle,
}

impl Against {
    /// The name in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Box => "box",
            Self::Triangle => "triangle",
        }
    }
}

/// Lines through a subject: line i is a function of the seed and i.
pub struct Aim<'a, T: Planes> {
    /// The boxes and triangles to aim at.
    pub subject: &'a Subject<'a, T>,
    /// The metric's lines through the scene's box.
    pub lines: SurfaceLines,
}

impl<T: Planes<Vector: Exact>> Aim<'_, T> {
    /// The metric's own lines with these indices, rounded.
    pub fn drawn(&self, indices: Range<u64>) -> impl Iterator<Item = Line<T::Vector>> {
        let rounded = |line: Line| {
            let [origin, direction] = [line.origin, line.direction].map(T::Vector::rounded);
            Line::new(origin, direction)
        };
        self.lines.range(indices).map(rounded)
    }

    /// Lines with these indices, each through an edge or a corner of a node's box or of a triangle, as `at` says, up to the rounding of
    /// its ends and of their difference.
    pub fn aimed(
        &self,
        indices: Range<u64>,
        at: impl Fn(u64) -> Against,
    ) -> impl Iterator<Item = Line<T::Vector>> {
        let drawn = self.drawn(indices.clone());
        indices.zip(drawn).map(move |(i, drawn)| {
            let mut rng = generator(self.lines.seed, Purpose::Pairs);
            rng.set_stream(i);
            let target = match at(i) {
                Against::Box => self.on_box(&mut rng),
                Against::Triangle => self.on_triangle(&mut rng),
            };
            self.through(target, drawn, &mut rng)
        })
    }

    /// The line through a target from the surface of the scene's box, from far outside, parallel to one coordinate plane in which the
    /// target lies, or to two. Where that makes no line, as where it begins at its target, the one that was drawn.
    fn through(
        &self,
        target: DVec3,
        drawn: Line<T::Vector>,
        rng: &mut ChaCha8Rng,
    ) -> Line<T::Vector> {
        let from = drawn.origin.exact();
        let axis = rng.random_range(0..3);
        let mut origin = from;
        match rng.random_range(0..16) {
            0..8 => {}
            8..12 => origin = target + 16.0 * (from - target),
            12..15 => origin[axis] = target[axis],
            _ => {
                origin = target;
                origin[axis] = self.lines.world.lo[axis] - self.lines.world.extent()[axis];
            }
        }
        let [origin, target] = [origin, target].map(T::Vector::rounded);
        let direction = target - origin;
        if makes_line(origin, direction) {
            Line::new(origin, direction)
        } else {
            drawn
        }
    }

    /// A corner or a point of an edge of some node's box.
    fn on_box(&self, rng: &mut ChaCha8Rng) -> DVec3 {
        let boxes = self.subject.boxes;
        let b = &boxes[rng.random_range(0..boxes.len() as u32) as usize];
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
        let triangles = self.subject.triangles;
        let triangle = &triangles[rng.random_range(0..triangles.len() as u32) as usize];
        let corners = triangle.0.map(Exact::exact);
        let k = rng.random_range(0..3);
        if rng.next_u32() & 3 == 0 {
            corners[k]
        } else {
            corners[k].lerp(corners[(k + 1) % 3], rng.random())
        }
    }
}

/// Whether [`Line::new`] takes these.
fn makes_line<V: Vector>(origin: V, direction: V) -> bool {
    let finite = (0..3).all(|k| origin[k].is_finite() && direction[k].is_finite());
    finite && (0..3).any(|k| (V::Real::ONE / direction[k]).is_finite())
}
