//! The lines of the study: exactly isotropic, exactly uniform, every one hits the box, none is rejected.
//!
//! A face by its area, a uniform point on it, an inward direction by the cosine law: this is the rigid-motion-invariant
//! measure of oriented lines, given that they hit the box (Santalo 1976; cosine law: Sbert, Ray Tracing News 18(1)).

use std::f64::consts::TAU;
use std::ops::Range;

use glam::DVec3;

use crate::geom::{Aabb, Line};

use super::Uniforms;

/// The line of four uniforms in (0, 1). Its origin lies on the box's surface (t = 0), its direction has unit length.
#[inline]
pub fn surface_line(world: &Aabb, u: [f64; 4]) -> Line {
    // Face: the first uniform picks one of six by area, and what is left of it is uniform again.
    let areas = world.face_areas();
    let mut rest = u[0] * 2.0 * (areas.x + areas.y + areas.z);
    // Rounding may leave a rest behind the last face: a face without area is never taken for that.
    let last = (1..3).rev().find(|&k| areas[k] > 0.0).unwrap_or(0);
    let mut axis = 0;
    while axis < last && rest >= 2.0 * areas[axis] {
        rest -= 2.0 * areas[axis];
        axis += 1;
    }
    let mut share = rest / areas[axis];
    let upper = share >= 1.0;
    share -= f64::from(u8::from(upper));

    // Point: uniform on the face; clamped, as rounding may step over its rim.
    let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
    let extent = world.extent();
    let mut origin = if upper { world.hi } else { world.lo };
    origin[i] = (world.lo[i] + share * extent[i]).clamp(world.lo[i], world.hi[i]);
    origin[j] = (world.lo[j] + u[1] * extent[j]).clamp(world.lo[j], world.hi[j]);

    // Direction: uniform in the disc, lifted to the hemisphere (Malley), so cosine distributed.
    let radius = u[2].sqrt();
    let (sine, cosine) = libm::sincos(TAU * u[3]);
    let height = (1.0 - u[2]).max(0.0).sqrt();
    let mut direction = DVec3::ZERO;
    direction[i] = radius * cosine;
    direction[j] = radius * sine;
    direction[axis] = if upper { -height } else { height };
    Line::new(origin, direction)
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
        let world = self.world;
        indices.map(move |_| surface_line(&world, uniforms.next4()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::Span;

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
