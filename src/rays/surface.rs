//! The lines of the study: exactly isotropic, exactly uniform, every one hits the box, none is rejected.
//!
//! A face by its area, a uniform point on it, an inward direction by the cosine law: this is the rigid-motion-invariant
//! measure of oriented lines, given that they hit the box (Santalo 1976; cosine law: Sbert, Ray Tracing News 18(1)).
//!
//! Lines are made a block at a time and without branches, so that the compiler can make several at once: more where the processor
//! has AVX2, which is found out at run time. They are the same to the bit.

use std::ops::Range;
use std::slice::from_mut;

use glam::DVec3;

use crate::geom::{Aabb, Line};

use super::Uniforms;
use super::turn::{negated_if, sines_and_cosines};

/// Lines made at a time.
const BLOCK: usize = 16;

/// The line of four uniforms in (0, 1). Its origin lies on the box's surface (t = 0), its direction has unit length.
#[inline]
pub fn surface_line(world: &Aabb, u: [f64; 4]) -> Line {
    let ([mut sine], [mut cosine]) = ([0.0], [0.0]);
    sines_and_cosines(&[u[3]], from_mut(&mut sine), from_mut(&mut cosine));
    Surface::of(world).line([u[0], u[1], u[2]], sine, cosine)
}

/// A box's surface, and what choosing a point of it takes.
#[derive(Clone, Copy)]
struct Surface {
    world: Aabb,
    extent: DVec3,
    areas: DVec3,
    /// Area of both faces across x, and across y; infinite where no face with an area follows.
    pairs: [f64; 2],
}

impl Surface {
    fn of(world: &Aabb) -> Self {
        let areas = world.face_areas();
        // Rounding may leave a rest behind the last face: a face without area is never taken for that.
        let last = (1..3).rev().find(|&k| areas[k] > 0.0).unwrap_or(0);
        let pair = |axis| {
            if axis < last {
                2.0 * areas[axis]
            } else {
                f64::INFINITY
            }
        };
        Self {
            world: *world,
            extent: world.extent(),
            areas,
            pairs: [pair(0), pair(1)],
        }
    }

    /// The line of three uniforms in (0, 1), and of the sine and the cosine of a uniform angle.
    #[inline(always)]
    fn line(&self, u: [f64; 3], sine: f64, cosine: f64) -> Line {
        // Face: the first uniform picks one of six by area, and what is left of it is uniform again.
        let (areas, [x, y]) = (self.areas, self.pairs);
        let rest = u[0] * 2.0 * (areas.x + areas.y + areas.z);
        let beyond_x = rest >= x;
        let rest = rest - if beyond_x { x } else { 0.0 };
        let beyond_y = beyond_x & (rest >= y);
        let rest = rest - if beyond_y { y } else { 0.0 };
        let by_axis = |x: f64, y: f64, z: f64| {
            let y_or_z = if beyond_y { z } else { y };
            if beyond_x { y_or_z } else { x }
        };
        let share = rest / by_axis(areas.x, areas.y, areas.z);
        let upper = share >= 1.0;
        let share = share - if upper { 1.0 } else { 0.0 };

        // Point: uniform on the face, along the next axis and the one after that; clamped, as rounding may step over its rim.
        let Aabb { lo, hi } = self.world;
        let face = |axis: usize| if upper { hi[axis] } else { lo[axis] };
        let within = |axis: usize, share: f64| {
            let x = lo[axis] + share * self.extent[axis];
            let x = if x < lo[axis] { lo[axis] } else { x };
            if x > hi[axis] { hi[axis] } else { x }
        };
        let x = within(0, if beyond_y { share } else { u[1] });
        let y = within(1, if beyond_y { u[1] } else { share });
        let z = within(2, if beyond_x { share } else { u[1] });
        let origin = DVec3::new(
            by_axis(face(0), x, x),
            by_axis(y, face(1), y),
            by_axis(z, z, face(2)),
        );

        // Direction: uniform in the disc, lifted to the hemisphere (Malley), so cosine distributed.
        let radius = u[2].sqrt();
        let (i, j) = (radius * cosine, radius * sine);
        let height = (1.0 - u[2]).max(0.0).sqrt();
        let inwards = negated_if(upper, height);
        let direction = DVec3::new(
            by_axis(inwards, j, i),
            by_axis(i, inwards, j),
            by_axis(j, i, inwards),
        );
        Line::new(origin, direction)
    }
}

/// A block's points, and its lines: each part in an array of its own, so that several lines fill a register. Of lines these are origin,
/// direction and inverse.
type Points = [[f64; BLOCK]; 4];
type Parts = [[f64; BLOCK]; 9];

impl Surface {
    /// The lines of the first `n` points.
    #[inline(always)]
    fn lines(&self, [faces, along, discs, turns]: &Points, n: usize, parts: &mut Parts) {
        let [mut sines, mut cosines] = [[0.0; BLOCK]; 2];
        sines_and_cosines(&turns[..n], &mut sines, &mut cosines);
        let [ox, oy, oz, dx, dy, dz, ix, iy, iz] = parts;
        let surface = *self;
        for k in 0..n {
            let line = surface.line([faces[k], along[k], discs[k]], sines[k], cosines[k]);
            [ox[k], oy[k], oz[k]] = line.origin.to_array();
            [dx[k], dy[k], dz[k]] = line.direction.to_array();
            [ix[k], iy[k], iz[k]] = line.inverse.to_array();
        }
    }

    /// The same, compiled for AVX2, which rounds alike.
    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2")]
    fn lines_wide(&self, points: &Points, n: usize, parts: &mut Parts) {
        self.lines(points, n, parts);
    }
}

/// The lines of points of the unit cube in four dimensions, through a box.
pub(super) struct Lines<P> {
    surface: Surface,
    points: P,
    /// Those of the block.
    parts: Parts,
    /// Which of them are still to come.
    left: Range<usize>,
    /// Whether the processor has AVX2.
    wide: bool,
}

impl<P: Iterator<Item = [f64; 4]>> Lines<P> {
    pub(super) fn new(world: &Aabb, points: P) -> Self {
        Self {
            surface: Surface::of(world),
            points,
            parts: [[0.0; BLOCK]; 9],
            left: 0..0,
            #[cfg(target_arch = "x86_64")]
            wide: is_x86_feature_detected!("avx2"),
            #[cfg(not(target_arch = "x86_64"))]
            wide: false,
        }
    }

    /// The next block.
    #[inline(never)]
    fn refill(&mut self) {
        let mut points = [[0.0; BLOCK]; 4];
        let mut n = 0;
        for u in self.points.by_ref().take(BLOCK) {
            let [faces, along, discs, turns] = &mut points;
            [faces[n], along[n], discs[n], turns[n]] = u;
            n += 1;
        }
        self.left = 0..n;
        #[cfg(target_arch = "x86_64")]
        if self.wide {
            // SAFETY: the processor has the instructions.
            #[allow(unsafe_code)]
            unsafe {
                self.surface.lines_wide(&points, n, &mut self.parts);
            }
            return;
        }
        self.surface.lines(&points, n, &mut self.parts);
    }
}

impl<P: Iterator<Item = [f64; 4]>> Iterator for Lines<P> {
    type Item = Line;

    #[inline]
    fn next(&mut self) -> Option<Line> {
        if self.left.is_empty() {
            self.refill();
        }
        let k = self.left.next()?;
        let [ox, oy, oz, dx, dy, dz, ix, iy, iz] = &self.parts;
        Some(Line {
            origin: DVec3::new(ox[k], oy[k], oz[k]),
            direction: DVec3::new(dx[k], dy[k], dz[k]),
            inverse: DVec3::new(ix[k], iy[k], iz[k]),
        })
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        let (least, most) = self.points.size_hint();
        let left = self.left.len();
        (least + left, most.map(|most| most + left))
    }
}

/// The study's lines through a box: line i is a function of the seed and i.
///
/// ```
/// use glam::DVec3;
/// use sahlab::geom::{Aabb, Span};
/// use sahlab::rays::SurfaceLines;
///
/// let world = Aabb::new(DVec3::ZERO, DVec3::new(1.0, 2.0, 3.0));
/// let lines = SurfaceLines { world, seed: 1 };
/// let chord = |line| {
///     let span = world.clip(&line, Span::FULL).expect("every line hits the box");
///     span.t1 - span.t0
/// };
/// let mean = lines.range(0..100_000).map(chord).sum::<f64>() / 1e5;
/// // The mean chord of uniform lines through a convex body is 4V/SA.
/// assert!((mean * world.surface_area() / (4.0 * world.volume()) - 1.0).abs() < 0.01);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct SurfaceLines {
    /// The box every line hits.
    pub world: Aabb,
    /// Seed of the sequence.
    pub seed: u64,
}

impl SurfaceLines {
    /// The lines with these indices.
    pub fn range(&self, indices: Range<u64>) -> impl Iterator<Item = Line> + use<> {
        let mut uniforms = Uniforms::starting_at(self.seed, indices.start);
        Lines::new(&self.world, indices.map(move |_| uniforms.next4()))
    }
}

#[cfg(test)]
mod tests;
