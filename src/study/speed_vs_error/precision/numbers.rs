//! Scenes, trees and lines in the numbers of a kernel, each of which is an exact `f64`.

use glam::{DVec3, Vec3};

use crate::geom::{Aabb, Line, Triangle, Vector};
use crate::kd::Planes;
use crate::rays::{Purpose, SurfaceLines, Uniforms};

/// Points whose parts are exact as `f64`.
pub trait Exact: Vector {
    /// One unit of 2^-52, in which the oracle tells distances from a tie, over that of these numbers.
    const UNIT: f64;
    /// The same point.
    fn exact(self) -> DVec3;
    /// The nearest point.
    fn rounded(p: DVec3) -> Self;
}

impl Exact for DVec3 {
    const UNIT: f64 = 1.0;

    fn exact(self) -> DVec3 {
        self
    }

    fn rounded(p: DVec3) -> Self {
        p
    }
}

impl Exact for Vec3 {
    const UNIT: f64 = f64::EPSILON / f32::EPSILON as f64;

    fn exact(self) -> DVec3 {
        self.as_dvec3()
    }

    fn rounded(p: DVec3) -> Self {
        p.as_vec3()
    }
}

/// A tree and its triangles in the numbers of a kernel.
pub struct Subject<'a, T: Planes> {
    /// The tree.
    pub tree: &'a T,
    /// The box of every node, exact.
    pub boxes: &'a [Aabb],
    /// The triangles of the scene.
    pub triangles: &'a [Triangle<T::Vector>],
}

impl<T: Planes<Vector: Exact>> Subject<'_, T> {
    /// The study's lines, rounded.
    pub fn random(&self, lines: &SurfaceLines, count: u64) -> Vec<Line<T::Vector>> {
        let rounded = |line: Line| {
            let [origin, direction] = [line.origin, line.direction].map(T::Vector::rounded);
            Line::new(origin, direction)
        };
        lines.range(0..count).map(rounded).collect()
    }

    /// Lines from the origins of those of `random` to, in turn, an edge and a corner of a node's box, an edge and a corner of a
    /// triangle, in the kernel's own arithmetic. One that starts at its aim keeps its direction.
    pub fn aimed(&self, random: &[Line<T::Vector>], seed: u64) -> Vec<Line<T::Vector>> {
        let mut uniforms = Uniforms::of_replicate(seed, Purpose::Pairs, 0, 0);
        let aim = |(i, line): (usize, &Line<T::Vector>)| {
            let [which, along, corner, axis] = uniforms.next4();
            let of = |count: usize| (which * count as f64) as usize;
            let corner = (corner * 24.0) as usize;
            let target = if i % 4 < 2 {
                let b = &self.boxes[of(self.boxes.len())];
                let mut point = b.lo;
                for k in 0..3 {
                    point[k] = [b.lo[k], b.hi[k]][corner >> k & 1];
                }
                if i % 4 == 0 {
                    let axis = (axis * 3.0) as usize;
                    point[axis] = b.lo[axis] + along * (b.hi[axis] - b.lo[axis]);
                }
                point
            } else {
                let corners = self.triangles[of(self.triangles.len())].0.map(Exact::exact);
                let from = corners[corner % 3];
                if i % 4 == 2 {
                    from.lerp(corners[(corner + 1) % 3], along)
                } else {
                    from
                }
            };
            let direction = T::Vector::rounded(target) - line.origin;
            if direction.exact() == DVec3::ZERO {
                *line
            } else {
                Line::new(line.origin, direction)
            }
        };
        random.iter().enumerate().map(aim).collect()
    }
}
