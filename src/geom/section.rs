//! Where a plane across an axis cuts objects: outlines for pictures. Round objects become polygons of many sides.

use std::f64::consts::TAU;

use glam::DVec3;

use super::{Axis, Cone, Object, Sphere};

/// Sides of what is round.
const SIDES: u32 = 48;

/// A straight piece of an outline.
pub type Piece = [DVec3; 2];

impl Object<'_> {
    /// The pieces of the object's surface in the plane at `at` across an axis; none where it only touches the plane.
    pub fn section(self, axis: Axis, at: f64) -> Vec<Piece> {
        match self {
            Self::Triangle(triangle) => section(&triangle.0, axis, at),
            Self::Polygon(polygon) => section(polygon.corners(), axis, at),
            Self::Sphere(sphere) => circle(sphere, axis, at),
            Self::Cone(cone) => strips(cone, axis, at),
        }
    }
}

/// The pieces of a planar polygon: its edges' crossings along their line, pair by pair (the even-odd rule).
fn section(corners: &[DVec3], axis: Axis, at: f64) -> Vec<Piece> {
    let mut crossings = Vec::new();
    for (i, &a) in corners.iter().enumerate() {
        let b = corners[(i + 1) % corners.len()];
        // A corner in the plane belongs above, so that the crossings are even in number.
        if (a[axis] < at) != (b[axis] < at) {
            let mut point = a + (b - a) * ((at - a[axis]) / (b[axis] - a[axis]));
            point[axis] = at;
            crossings.push(point);
        }
    }
    let by_place = |p: &DVec3, q: &DVec3| {
        let [p, q] = [p, q].map(|p| p.to_array());
        p.partial_cmp(&q).unwrap_or(std::cmp::Ordering::Equal)
    };
    crossings.sort_by(by_place);
    crossings.chunks_exact(2).map(|c| [c[0], c[1]]).collect()
}

/// Points around a circle, the first one again at the end.
fn around(centre: DVec3, u: DVec3, v: DVec3) -> impl Iterator<Item = DVec3> {
    (0..=SIDES).map(move |i| {
        let angle = TAU * f64::from(i % SIDES) / f64::from(SIDES);
        centre + libm::cos(angle) * u + libm::sin(angle) * v
    })
}

fn circle(sphere: &Sphere, axis: Axis, at: f64) -> Vec<Piece> {
    let off = at - sphere.centre[axis];
    let squared = sphere.radius * sphere.radius - off * off;
    if squared <= 0.0 {
        return Vec::new();
    }
    let mut centre = sphere.centre;
    centre[axis] = at;
    let radius = squared.sqrt();
    let unit = |k: usize| DVec3::AXES[(axis + k) % 3] * radius;
    let points: Vec<DVec3> = around(centre, unit(1), unit(2)).collect();
    points.windows(2).map(|p| [p[0], p[1]]).collect()
}

/// A cone as strips between its two circles.
fn strips(cone: &Cone, axis: Axis, at: f64) -> Vec<Piece> {
    let (u, v) = ((cone.apex - cone.base).normalize()).any_orthonormal_pair();
    let below: Vec<DVec3> = around(cone.base, cone.base_radius * u, cone.base_radius * v).collect();
    let above: Vec<DVec3> = around(cone.apex, cone.apex_radius * u, cone.apex_radius * v).collect();
    let strip = |i: usize| section(&[below[i], below[i + 1], above[i + 1], above[i]], axis, at);
    (0..SIDES as usize).flat_map(strip).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::{Polygon, Triangle};

    fn v(x: f64, y: f64, z: f64) -> DVec3 {
        DVec3::new(x, y, z)
    }

    fn length(pieces: &[Piece]) -> f64 {
        pieces.iter().map(|[a, b]| a.distance(*b)).sum()
    }

    #[test]
    fn flat_objects_give_segments() {
        let triangle = Triangle([v(0.0, 0.0, 0.0), v(4.0, 0.0, 0.0), v(0.0, 0.0, 4.0)]);
        let cut = Object::Triangle(&triangle).section(2, 1.0);
        assert_eq!(cut, [[v(0.0, 0.0, 1.0), v(3.0, 0.0, 1.0)]]);
        assert!(Object::Triangle(&triangle).section(2, 5.0).is_empty());
        // In the plane: no piece.
        assert!(Object::Triangle(&triangle).section(1, 0.0).is_empty());
        // A U is cut twice.
        let corners = [
            (0.0, 0.0),
            (3.0, 0.0),
            (3.0, 2.0),
            (2.0, 2.0),
            (2.0, 1.0),
            (1.0, 1.0),
            (1.0, 2.0),
            (0.0, 2.0),
        ];
        let polygon = Polygon::new(corners.map(|(x, z)| v(x, 5.0, z)).into()).expect("a polygon");
        let cut = Object::Polygon(&polygon).section(2, 1.5);
        let expected = [
            [v(0.0, 5.0, 1.5), v(1.0, 5.0, 1.5)],
            [v(2.0, 5.0, 1.5), v(3.0, 5.0, 1.5)],
        ];
        assert_eq!(cut, expected);
    }

    #[test]
    fn round_objects_give_rings() {
        let sphere = Sphere {
            centre: v(1.0, 2.0, 3.0),
            radius: 5.0,
        };
        // A circle of radius 4; a polygon of n sides is shorter by about pi^2/6n^2.
        let ring = Object::Sphere(&sphere).section(1, 5.0);
        assert!((length(&ring) / (TAU * 4.0) - 1.0).abs() < 1e-3);
        assert!(ring.iter().flatten().all(|p| p.y == 5.0));
        assert!(Object::Sphere(&sphere).section(1, 7.0).is_empty());
        let cone = Cone {
            base: v(0.0, 0.0, 0.0),
            base_radius: 2.0,
            apex: v(0.0, 0.0, 4.0),
            apex_radius: 0.0,
        };
        // Halfway up a circle of radius 1; through the axis two slants.
        let ring = Object::Cone(&cone).section(2, 2.0);
        assert!((length(&ring) / TAU - 1.0).abs() < 1e-3);
        let slants = Object::Cone(&cone).section(0, 0.1);
        assert!((length(&slants) / (2.0 * 20f64.sqrt()) - 1.0).abs() < 0.1);
    }
}
