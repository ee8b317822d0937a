//! The lines of the study: exactly isotropic, exactly uniform, every one hits the box, none is rejected.
//!
//! A face by its area, a uniform point on it, an inward direction by the cosine law: this is the rigid-motion-invariant
//! measure of oriented lines, given that they hit the box (Santalo 1976; cosine law: Sbert, Ray Tracing News 18(1)).
//!
//! Lines are made a block at a time and without branches, so that the compiler can make several at once.

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

/// The lines of points of the unit cube in four dimensions, through a box.
pub(super) struct Lines<P> {
    surface: Surface,
    points: P,
    /// Each part of a block's lines in an array of its own, so that several lines fill a register: origin, direction, inverse.
    parts: [[f64; BLOCK]; 9],
    /// Those of the block that are still to come.
    left: Range<usize>,
}

impl<P: Iterator<Item = [f64; 4]>> Lines<P> {
    pub(super) fn new(world: &Aabb, points: P) -> Self {
        Self {
            surface: Surface::of(world),
            points,
            parts: [[0.0; BLOCK]; 9],
            left: 0..0,
        }
    }

    /// The next block.
    #[inline(never)]
    fn refill(&mut self) {
        let [mut faces, mut along, mut discs, mut turns] = [[0.0; BLOCK]; 4];
        let mut n = 0;
        for u in self.points.by_ref().take(BLOCK) {
            [faces[n], along[n], discs[n], turns[n]] = u;
            n += 1;
        }
        let [mut sines, mut cosines] = [[0.0; BLOCK]; 2];
        sines_and_cosines(&turns[..n], &mut sines, &mut cosines);
        let [ox, oy, oz, dx, dy, dz, ix, iy, iz] = &mut self.parts;
        let surface = self.surface;
        for k in 0..n {
            let line = surface.line([faces[k], along[k], discs[k]], sines[k], cosines[k]);
            [ox[k], oy[k], oz[k]] = line.origin.to_array();
            [dx[k], dy[k], dz[k]] = line.direction.to_array();
            [ix[k], iy[k], iz[k]] = line.inverse.to_array();
        }
        self.left = 0..n;
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
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::geom::Span;

    /// The law in plain words, line by line, with branches and libm's sine and cosine.
    fn plain_line(world: &Aabb, u: [f64; 4]) -> Line {
        let areas = world.face_areas();
        let mut rest = u[0] * 2.0 * (areas.x + areas.y + areas.z);
        let last = (1..3).rev().find(|&k| areas[k] > 0.0).unwrap_or(0);
        let mut axis = 0;
        while axis < last && rest >= 2.0 * areas[axis] {
            rest -= 2.0 * areas[axis];
            axis += 1;
        }
        let mut share = rest / areas[axis];
        let upper = share >= 1.0;
        share -= f64::from(u8::from(upper));

        let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
        let extent = world.extent();
        let mut origin = if upper { world.hi } else { world.lo };
        origin[i] = (world.lo[i] + share * extent[i]).clamp(world.lo[i], world.hi[i]);
        origin[j] = (world.lo[j] + u[1] * extent[j]).clamp(world.lo[j], world.hi[j]);

        let radius = u[2].sqrt();
        let (sine, cosine) = libm::sincos(TAU * u[3]);
        let height = (1.0 - u[2]).max(0.0).sqrt();
        let mut direction = DVec3::ZERO;
        direction[i] = radius * cosine;
        direction[j] = radius * sine;
        direction[axis] = if upper { -height } else { height };
        Line::new(origin, direction)
    }

    fn bits(line: &Line) -> [[u64; 3]; 3] {
        [line.origin, line.direction, line.inverse].map(|v| v.to_array().map(f64::to_bits))
    }

    #[test]
    fn lines_are_those_of_the_plain_law_to_the_bit() {
        let worlds = [
            Aabb::new(DVec3::ZERO, DVec3::new(1.0, 0.8, 0.5)),
            Aabb::new(DVec3::new(1e8, -3.0, 0.1), DVec3::new(1e8 + 1.0, -2.9, 0.3)),
            Aabb::new(DVec3::new(-0.0, -0.0, -0.0), DVec3::new(0.0, 2.0, 7.0)),
            Aabb::new(DVec3::new(-1.0, 5.0, -0.0), DVec3::new(2.0, 5.0, 0.1)),
            Aabb::new(DVec3::new(-1.0, -1.0, -0.0), DVec3::new(1.0, 3.0, -0.0)),
            Aabb::new(DVec3::ZERO, DVec3::new(1e6, 1.0, 1e-6)),
            Aabb::new(DVec3::splat(-1e70), DVec3::new(1e70, 1e60, -1e69)),
        ];
        for (seed, world) in worlds.into_iter().enumerate() {
            let seed = seed as u64;
            let mut uniforms = Uniforms::starting_at(seed, 5);
            let mut i = 5;
            for line in (SurfaceLines { world, seed }).range(5..200_000) {
                let u = uniforms.next4();
                let plain = bits(&plain_line(&world, u));
                assert_eq!(bits(&line), plain, "{world:?}, line {i}");
                assert_eq!(
                    bits(&surface_line(&world, u)),
                    plain,
                    "{world:?}, line {i} alone"
                );
                i += 1;
            }
            assert_eq!(i, 200_000);
        }
    }

    /// Where faces meet, where the angle's quadrants do, and the ends of (0, 1).
    #[test]
    fn lines_of_borders_are_those_of_the_plain_law_to_the_bit() {
        let least = 0.5_f64.powi(53);
        let mut places = vec![least, 3.0 * least, 1e-9, 1.0 - least];
        for k in 1..24 {
            let u = f64::from(k) / 24.0;
            places.extend([u.next_down(), u, u.next_up()]);
        }
        for size in [
            DVec3::ONE,
            DVec3::new(1.0, 0.0, 1.0),
            DVec3::new(0.1, 0.7, 0.3),
        ] {
            let world = Aabb::new(DVec3::splat(0.1), DVec3::splat(0.1) + size);
            for &face in &places {
                for &u in &places {
                    let u = [face, u, 1.0 - u, u];
                    let line = surface_line(&world, u);
                    assert_eq!(bits(&line), bits(&plain_line(&world, u)), "{u:?}");
                }
            }
        }
    }

    #[test]
    fn every_line_starts_on_the_box_and_hits_it() {
        let worlds = [
            Aabb::new(DVec3::ZERO, DVec3::new(1.0, 0.8, 0.5)),
            Aabb::new(DVec3::new(1e8, -3.0, 0.1), DVec3::new(1e8 + 1.0, -2.9, 0.3)),
            Aabb::new(DVec3::ZERO, DVec3::new(1.0, 1.0, 0.0)),
            Aabb::new(DVec3::ZERO, DVec3::new(1e6, 1.0, 1.0)),
        ];
        for world in worlds {
            for line in (SurfaceLines { world, seed: 1 }).range(0..10_000) {
                assert!(world.contains(&Aabb::new(line.origin, line.origin)));
                let span = world.clip(&line, Span::FULL).expect("hits the box");
                assert!(span.t0 <= 0.0 && span.t1 >= 0.0);
                assert!((line.direction.length() - 1.0).abs() < 1e-15);
            }
        }
    }

    #[test]
    fn a_face_without_area_is_never_taken() {
        let least = 0.5_f64.powi(53);
        for flat in 0..3 {
            for (a, b) in [(1.0, 1.0), (0.1, 0.7), (3.7, 1e-9), (1e70, 1e-70)] {
                let mut hi = DVec3::ZERO;
                hi[(flat + 1) % 3] = a;
                hi[(flat + 2) % 3] = b;
                let world = Aabb::new(DVec3::ZERO, hi);
                for u in [least, 0.5 - least, 0.5, 0.5 + least, 1.0 - least] {
                    let line = surface_line(&world, [u, 0.3, 0.25, 0.1]);
                    assert!(line.origin.is_finite() && line.direction.is_finite());
                    // The face is the flat box itself, so its normal part of the direction is the cosine.
                    assert!((line.direction[flat].abs() - 0.75_f64.sqrt()).abs() < 1e-15);
                    assert!(world.contains(&Aabb::new(line.origin, line.origin)));
                }
            }
        }
    }

    #[test]
    fn a_line_depends_on_seed_and_index_alone() {
        let lines = SurfaceLines {
            world: Aabb::new(DVec3::ZERO, DVec3::ONE),
            seed: 3,
        };
        let all: Vec<Line> = lines.range(0..1000).collect();
        for start in [0, 1, 64, 999] {
            let part: Vec<Line> = lines.range(start as u64..1000).collect();
            assert_eq!(part, all[start..]);
        }
    }
}
