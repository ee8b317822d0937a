//! The bounds of an object's part inside a box, never too small: what clipped ("perfect") splits put into a node.
//!
//! Polygons are cut by the box's six planes one after the other (Sutherland & Hodgman 1974). A cut misplaces a corner by
//! a few units in the last place of the largest coordinate, the six together by less than 64; so the box is taken larger
//! by a slack of a thousand and the result is widened by it. What is told to be empty is empty, and a ray that hits the
//! object near an edge, where its own rounding decides, still finds it there.

use glam::DVec3;

use super::{Aabb, Axis, Object, Objects};

/// The slack for objects in `world`, 2^-42 of its largest coordinate. The part beyond the clipping's own error is for
/// rays: it covers origins up to some hundred times that far away.
pub fn clip_slack(world: &Aabb) -> f64 {
    let largest = world.lo.abs().max(world.hi.abs()).max_element();
    // Never zero, however small the world.
    largest * libm::ldexp(1.0, -42) + f64::MIN_POSITIVE
}

/// Cuts polygons; kept between calls to spare allocations.
#[derive(Debug, Default)]
pub struct Clipper {
    corners: Vec<DVec3>,
    /// Corners after the next cut.
    next: Vec<DVec3>,
}

impl Clipper {
    /// Bounds of the polygon's part inside `region`, wider by `slack` but inside `region`; `None` if the polygon stays
    /// more than `slack` away from it.
    fn clip(&mut self, corners: &[DVec3], region: &Aabb, slack: f64) -> Option<Aabb> {
        if !Aabb::around(corners.iter().copied()).extent().is_finite() {
            // Differences of its coordinates overflow: nothing can be told.
            return Some(*region);
        }
        self.cut(corners, region, slack);
        if self.corners.is_empty() {
            return None;
        }
        let part = Aabb::around(self.corners.iter().copied());
        Some(Aabb {
            lo: (part.lo - slack).clamp(region.lo, region.hi),
            hi: (part.hi + slack).clamp(region.lo, region.hi),
        })
    }

    /// Area of the polygon's part inside `region`, by corners that are not widened. Parts that go round in opposite directions
    /// cancel, so a notched polygon cut into several pieces keeps its area.
    pub(super) fn area(&mut self, corners: &[DVec3], region: &Aabb) -> f64 {
        self.cut(corners, region, 0.0);
        let Some(&last) = self.corners.last() else {
            return 0.0;
        };
        let mut twice = DVec3::ZERO;
        let mut from = DVec3::ZERO;
        for &corner in &self.corners {
            let to = corner - last;
            twice += from.cross(to);
            from = to;
        }
        0.5 * twice.length()
    }

    /// Leave in `self.corners` the polygon's part inside `region` widened by `slack`.
    fn cut(&mut self, corners: &[DVec3], region: &Aabb, slack: f64) {
        self.corners.clear();
        self.corners.extend_from_slice(corners);
        for axis in 0..3 {
            self.keep(axis, 1.0, region.lo[axis] - slack);
            self.keep(axis, -1.0, -(region.hi[axis] + slack));
        }
    }

    /// Keep what lies where `sign * x[axis] >= limit`.
    fn keep(&mut self, axis: Axis, sign: f64, limit: f64) {
        let inside = |p: &DVec3| sign * p[axis] >= limit;
        if self.corners.iter().all(inside) {
            return;
        }
        self.next.clear();
        let Some(&last) = self.corners.last() else {
            return;
        };
        let mut from = last;
        for &to in &self.corners {
            if inside(&from) != inside(&to) {
                let share = (sign * limit - from[axis]) / (to[axis] - from[axis]);
                let mut crossing = from + share * (to - from);
                crossing[axis] = sign * limit;
                self.next.push(crossing);
            }
            if inside(&to) {
                self.next.push(to);
            }
            from = to;
        }
        std::mem::swap(&mut self.corners, &mut self.next);
    }
}

impl Objects {
    /// Bounds of the part of object `number` inside `region`, a part of its own box: not too small (see the module), but
    /// inside `region`; `None` if it has no part there. Spheres, cones and polygons that are not quite planar are not cut: their
    /// part is the region.
    ///
    /// `slack` is [`clip_slack`] of the objects' world.
    pub fn clipped_bounds(
        &self,
        number: u32,
        region: &Aabb,
        slack: f64,
        clipper: &mut Clipper,
    ) -> Option<Aabb> {
        match self.get(number) {
            Object::Triangle(triangle) => clipper.clip(&triangle.0, region, slack),
            Object::Polygon(polygon) => match polygon.unevenness() {
                Some(unevenness) => clipper.clip(polygon.corners(), region, slack + unevenness),
                None => Some(*region),
            },
            Object::Sphere(_) | Object::Cone(_) => Some(*region),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::{Polygon, Sphere, Triangle};

    const SLACK: f64 = 1e-12;

    fn clip(corners: &[[f64; 3]], lo: [f64; 3], hi: [f64; 3]) -> Option<Aabb> {
        let corners: Vec<DVec3> = corners.iter().map(|&c| c.into()).collect();
        Clipper::default().clip(&corners, &Aabb::new(lo.into(), hi.into()), SLACK)
    }

    fn near(part: Option<Aabb>, lo: [f64; 3], hi: [f64; 3]) {
        let part = part.expect("a part");
        let (lo, hi) = (DVec3::from(lo), DVec3::from(hi));
        assert!((part.lo - lo).abs().max_element() < 2.0 * SLACK, "{part:?}");
        assert!((part.hi - hi).abs().max_element() < 2.0 * SLACK, "{part:?}");
        assert!(
            part.lo.cmple(lo).all() && part.hi.cmpge(hi).all(),
            "{part:?}"
        );
    }

    #[test]
    fn parts_known_by_hand() {
        // The triangle below the diagonal x + y = 1, in the plane z = 0.
        let half = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let box_of =
            |lo: [f64; 2], hi: [f64; 2]| clip(&half, [lo[0], lo[1], -1.0], [hi[0], hi[1], 1.0]);
        near(
            box_of([0.75, 0.0], [1.0, 1.0]),
            [0.75, 0.0, 0.0],
            [1.0, 0.25, 0.0],
        );
        near(
            box_of([0.25, 0.5], [1.0, 1.0]),
            [0.25, 0.5, 0.0],
            [0.5, 0.75, 0.0],
        );
        // Its own box reaches this corner, it does not.
        assert_eq!(box_of([0.5, 0.75], [1.0, 1.0]), None);
        // It touches this one in a point.
        near(
            box_of([0.5, 0.5], [1.0, 1.0]),
            [0.5, 0.5, 0.0],
            [0.5, 0.5, 0.0],
        );
        // All inside: the part is the whole, and stays in the region.
        near(box_of([0.0, 0.0], [1.0, 1.0]), [0.0; 3], [1.0, 1.0, 0.0]);
        assert!(box_of([0.0, 0.0], [1.0, 1.0]).is_some_and(|b| b.lo.x == 0.0 && b.hi.x == 1.0));
        // Flat regions stay flat.
        let flat = clip(&half, [0.5, 0.0, 0.0], [1.0, 1.0, 0.0]).expect("a part");
        assert_eq!((flat.lo.z, flat.hi.z), (0.0, 0.0));
    }

    #[test]
    fn a_dart_is_cut_through_both_its_arms() {
        // Arms up to (-1, 2) and (1, 2), notch at (0, 1): between the arms there is nothing above y = 1.5.
        let dart = [
            [0.0, 0.0, 0.0],
            [1.0, 2.0, 0.0],
            [0.0, 1.0, 0.0],
            [-1.0, 2.0, 0.0],
        ];
        let above = clip(&dart, [-1.0, 1.5, 0.0], [1.0, 2.0, 0.0]);
        near(above, [-1.0, 1.5, 0.0], [1.0, 2.0, 0.0]);
        let right = clip(&dart, [0.25, 1.5, 0.0], [1.0, 2.0, 0.0]);
        near(right, [0.5, 1.5, 0.0], [1.0, 2.0, 0.0]);
    }

    /// Points of a triangle, found without clipping: each lies in the part of every region that has it.
    #[test]
    fn no_point_is_lost() {
        let corners = [
            DVec3::new(0.1, 0.7, -0.3),
            DVec3::new(1.3, -0.2, 0.4),
            DVec3::new(-0.6, 0.05, 1.1),
        ];
        let objects = Objects {
            triangles: vec![Triangle(corners)],
            ..Objects::default()
        };
        let whole = Triangle(corners).bounds();
        let slack = clip_slack(&whole);
        let mut clipper = Clipper::default();
        let mut parts = 0;
        let n = 8;
        for cell in 0..n * n * n {
            let at = [cell % n, cell / n % n, cell / n / n].map(f64::from);
            let size = whole.extent() / f64::from(n);
            let lo = whole.lo + DVec3::from(at) * size;
            let region = Aabb::new(lo, lo + size);
            let part = objects.clipped_bounds(0, &region, slack, &mut clipper);
            parts += i32::from(part.is_some());
            for i in 0..=200 {
                for j in 0..=200 - i {
                    let (u, v) = (f64::from(i) / 200.0, f64::from(j) / 200.0);
                    let p = corners[0] * (1.0 - u - v) + corners[1] * u + corners[2] * v;
                    let point = Aabb::new(p, p);
                    if region.contains(&point) {
                        assert!(
                            part.is_some_and(|b| b.contains(&point)),
                            "{p} in {region:?}"
                        );
                    }
                }
            }
        }
        assert!((50..200).contains(&parts), "{parts} of 512 cells");
    }

    #[test]
    fn what_cannot_be_cut_keeps_the_region() {
        let sphere = Sphere {
            centre: DVec3::ZERO,
            radius: 1.0,
        };
        // A saddle of a millionth: far from the region by its corners, as is the same quad made flat.
        let quad = |height: f64| {
            let corner = |x: f64, y: f64, z: f64| DVec3::new(x, y, z * height);
            let corners = [
                (0.0, 0.0, 0.0),
                (1.0, 0.0, 1.0),
                (1.0, 1.0, 0.0),
                (0.0, 1.0, 1.0),
            ];
            Polygon::new(corners.map(|(x, y, z)| corner(x, y, z)).into()).expect("a quad")
        };
        let bent = quad(1e-6);
        let huge = Triangle([DVec3::splat(-1e308), DVec3::splat(1e308), DVec3::X]);
        let objects = Objects {
            triangles: vec![huge],
            spheres: vec![sphere],
            polygons: vec![bent],
            ..Objects::default()
        };
        let region = Aabb::new(DVec3::splat(0.9), DVec3::ONE);
        for number in 0..3 {
            let part = objects.clipped_bounds(number, &region, SLACK, &mut Clipper::default());
            assert_eq!(part, Some(region));
        }
        let flat = Objects {
            polygons: vec![quad(0.0)],
            ..Objects::default()
        };
        let part = flat.clipped_bounds(0, &region, SLACK, &mut Clipper::default());
        assert_eq!(part, None);
    }
}
