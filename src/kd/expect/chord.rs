//! Mean chords of a box, for lines through points and through smaller boxes.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::DVec3;

use crate::geom::{Aabb, Axis};

/// Intervals of the table between a face and the middle of the box.
const CELLS: usize = 16;

/// Widest step by angle that Gauss' rule of two points is used for.
const STEP: f64 = PI / 5.0;

/// Mean chords of a box: a table of the closed form, read by interpolation.
///
/// They have infinite slope at the box's faces. So places count along each side by an angle t from 0 to pi, at the share
/// (1 - cos t)/2 of the side, in which they are smooth.
pub(super) struct Chords {
    world: Aabb,
    /// By axis and place in an eighth of the box, which the others mirror.
    table: Vec<[f64; 3]>,
}

impl Chords {
    /// The table of a box.
    pub fn new(world: &Aabb) -> Self {
        let extent = world.extent();
        let share = |i: usize| 0.5 - 0.5 * libm::cos(i as f64 * (FRAC_PI_2 / CELLS as f64));
        let n = CELLS + 1;
        let table = (0..n * n * n)
            .map(|i| {
                let below = extent * DVec3::new(share(i % n), share(i / n % n), share(i / n / n));
                [0, 1, 2].map(|axis| through_point(below, extent - below, axis))
            })
            .collect();
        Self {
            world: *world,
            table,
        }
    }

    /// Mean chord of the lines that hit `part`, a part of the box.
    ///
    /// Every line that hits `part` crosses its surface twice, so this is the mean over the surface of the mean chord of the lines
    /// through a point of it.
    pub fn through(&self, part: &Aabb) -> f64 {
        let faces = part.face_areas();
        let points = [0, 1, 2].map(|axis| self.points(part, axis));
        let mut sum = 0.0;
        for axis in (0..3).filter(|&axis| faces[axis] > 0.0) {
            let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
            for face in [part.lo, part.hi] {
                let mut angles = [self.angle(face[axis], axis); 3];
                for &(u, u_weight) in &points[i] {
                    for &(v, v_weight) in &points[j] {
                        (angles[i], angles[j]) = (u, v);
                        sum += faces[axis] * u_weight * v_weight * self.at(angles, axis);
                    }
                }
            }
        }
        sum / part.surface_area()
    }

    /// Where a coordinate lies between the box's faces across the axis.
    fn angle(&self, x: f64, axis: Axis) -> f64 {
        let (lo, hi) = (self.world.lo[axis], self.world.hi[axis]);
        libm::acos((1.0 - 2.0 * (x - lo) / (hi - lo)).clamp(-1.0, 1.0))
    }

    /// Angles along a side of a part with their weights, which add up to 1.
    fn points(&self, part: &Aabb, axis: Axis) -> Vec<(f64, f64)> {
        let [from, to] = [part.lo, part.hi].map(|corner| self.angle(corner[axis], axis));
        let steps = 1 + ((to - from) / STEP) as usize;
        let step = (to - from) / steps as f64;
        let mut points: Vec<_> = (0..2 * steps)
            .map(|i| {
                let side = if i % 2 == 0 { -0.5 } else { 0.5 };
                let at = (i / 2) as f64 + 0.5 + side / 3.0_f64.sqrt();
                let angle = from + at * step;
                // A step of the angle is one of its sine along the side.
                (angle, libm::sin(angle))
            })
            .collect();
        // Beside a face all angles may be rounded to it.
        let sum: f64 = points.iter().map(|point| point.1).sum();
        let equal = 1.0 / points.len() as f64;
        for (_, weight) in &mut points {
            *weight = if sum > 0.0 { *weight / sum } else { equal };
        }
        points
    }

    /// The mean chord at a place, for lines counted by the area that they cross across `axis`.
    fn at(&self, angles: [f64; 3], axis: Axis) -> f64 {
        let places =
            angles.map(|angle| angle.min(PI - angle).max(0.0) * (CELLS as f64 / FRAC_PI_2));
        let low = places.map(|place| (place as usize).min(CELLS - 1));
        let mut sum = 0.0;
        for corner in 0..8 {
            let up = [corner & 1, corner >> 1 & 1, corner >> 2];
            let weight = |k: usize| {
                let share = places[k] - low[k] as f64;
                if up[k] == 1 { share } else { 1.0 - share }
            };
            let [x, y, z] = [0, 1, 2].map(|k| low[k] + up[k]);
            let n = CELLS + 1;
            sum += weight(0) * weight(1) * weight(2) * self.table[x + n * (y + n * z)][axis];
        }
        sum
    }
}

/// Mean chord of the lines through a point, their density proportional to |w_axis|, as that of isotropic lines is which cross
/// a small area across the axis. The point has the distances `below` and `above` from the box's faces.
///
/// The integral of |w_axis| r over all directions w, r being the distance to the box's surface, over pi: face by face, in
/// each of the eight parts into which planes through the point cut the box.
fn through_point(below: DVec3, above: DVec3, axis: Axis) -> f64 {
    let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
    let mut sum = 0.0;
    for a in [below[i], above[i]] {
        for b in [below[j], above[j]] {
            for c in [below[axis], above[axis]] {
                sum += across(a, b, c) + along(a, b, c) + along(b, a, c);
            }
        }
    }
    sum / PI
}

/// The face at distance `c` across the axis, a by b from its foot: c times its solid angle.
fn across(a: f64, b: f64, c: f64) -> f64 {
    c * libm::atan2(a * b, c * (a * a + b * b + c * c).sqrt())
}

/// A face along the axis at distance `a`, b by c from its foot, c along the axis: a times the integral of z / r^3 over it.
fn along(a: f64, b: f64, c: f64) -> f64 {
    if a == 0.0 {
        return 0.0;
    }
    a * (libm::asinh(b / a) - libm::asinh(b / libm::hypot(a, c)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Cell averages of the closed form over the surface, against the mean chord 4V/SA of the lines that hit the box.
    #[test]
    fn chords_through_the_surface_are_those_of_the_box() {
        let extent = DVec3::new(1.0, 0.5, 0.2);
        let world = Aabb::new(DVec3::ZERO, extent);
        let n = 200;
        let mut sum = 0.0;
        for axis in 0..3 {
            let face = world.face_areas()[axis] / f64::from(n * n);
            for cell in 0..n * n {
                let mut below = DVec3::ZERO;
                below[(axis + 1) % 3] = (f64::from(cell % n) + 0.5) / f64::from(n);
                below[(axis + 2) % 3] = (f64::from(cell / n) + 0.5) / f64::from(n);
                below *= extent;
                sum += 2.0 * face * through_point(below, extent - below, axis);
            }
        }
        let mean = sum / world.surface_area();
        let wanted = 4.0 * world.volume() / world.surface_area();
        assert!((mean / wanted - 1.0).abs() < 1e-4, "{mean}, not {wanted}");
    }

    /// The table against the closed form at places between its own.
    #[test]
    fn the_table_is_close_to_the_closed_form() {
        for extent in [DVec3::ONE, DVec3::new(1.0, 0.5, 0.02)] {
            let world = Aabb::new(DVec3::ZERO, extent);
            let chords = Chords::new(&world);
            let mut worst: f64 = 0.0;
            for i in 0..1000 {
                let share = DVec3::new(
                    f64::from(i % 10),
                    f64::from(i / 10 % 10),
                    f64::from(i / 100),
                );
                let below = extent * (share + 0.37) / 10.0;
                let angles = [0, 1, 2].map(|k| chords.angle(below[k], k));
                for axis in 0..3 {
                    let exact = through_point(below, extent - below, axis);
                    worst = worst.max((chords.at(angles, axis) / exact - 1.0).abs());
                }
            }
            assert!(worst < 3e-3, "{extent}: {worst}");
        }
    }
}
