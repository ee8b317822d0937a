//! `balls`, the sphereflake: every sphere carries nine of a third of its size; all stand on a large square.

use glam::{DMat3, DVec3};

use crate::geom::{Objects, Polygon, Sphere};

/// The spheres depth first, each before its children, and the floor. Every angle of the construction has a sine and
/// cosine in square roots, so no transcendental function is needed.
pub(super) fn objects(size: usize) -> Objects {
    let floor = [[12.0, 12.0], [-12.0, 12.0], [-12.0, -12.0], [12.0, -12.0]]
        .map(|[x, y]| DVec3::new(x, y, -0.5));
    let mut spheres = Vec::new();
    let root = Sphere {
        centre: DVec3::ZERO,
        radius: 0.5,
    };
    grow(size, root, DVec3::Z, &directions(), &mut spheres);
    Objects {
        spheres,
        polygons: vec![Polygon::new(floor.into()).expect("a square is a polygon")],
        ..Objects::default()
    }
}

/// Where the children of a sphere that points along z are: three above, six around the equator.
fn directions() -> [DVec3; 9] {
    let q = 0.5_f64.sqrt();
    let trio = [[q, q, 0.0], [q, 0.0, -q], [0.0, q, -q]].map(DVec3::from);
    // Carries (1,1,1)/sqrt 3 to z: the turn about (q,-q,0) with sine 2/sqrt 6 and cosine 1/sqrt 3.
    let tilt = turn(
        DVec3::new(q, -q, 0.0),
        2.0 / 6_f64.sqrt(),
        1.0 / 3_f64.sqrt(),
    );
    let third = turn(DVec3::Z, 0.5 * 3_f64.sqrt(), -0.5);
    let first = trio.map(|t| tilt * t);
    let second = first.map(|t| third * t);
    let last = second.map(|t| third * t);
    std::array::from_fn(|i| [first, second, last][i / 3][i % 3])
}

/// Emits a sphere that points along `direction`, and its children `depth` generations on.
fn grow(
    depth: usize,
    sphere: Sphere,
    direction: DVec3,
    directions: &[DVec3; 9],
    spheres: &mut Vec<Sphere>,
) {
    spheres.push(sphere);
    if depth == 0 {
        return;
    }
    let frame = from_z(direction);
    for d in directions {
        let towards = frame * *d;
        let child = Sphere {
            centre: sphere.centre + (4.0 / 3.0) * sphere.radius * towards,
            radius: sphere.radius / 3.0,
        };
        grow(depth - 1, child, towards, directions, spheres);
    }
}

/// The rotation that carries z to the unit vector `d` the shortest way; next to the poles, that of the pole.
fn from_z(d: DVec3) -> DMat3 {
    if d.z >= 0.9999 {
        DMat3::IDENTITY
    } else if d.z <= -0.9999 {
        // Half a turn about y.
        DMat3::from_diagonal(DVec3::new(-1.0, 1.0, -1.0))
    } else {
        // Axis z x d, with sine its length and cosine d_z.
        let sine = (d.x * d.x + d.y * d.y).sqrt();
        turn(DVec3::new(-d.y / sine, d.x / sine, 0.0), sine, d.z)
    }
}

/// Right-handed rotation about a unit axis by the angle with this sine and cosine (Rodrigues).
fn turn(axis: DVec3, sine: f64, cosine: f64) -> DMat3 {
    let column = |e: DVec3| cosine * e + sine * axis.cross(e) + (1.0 - cosine) * axis.dot(e) * axis;
    DMat3::from_cols(column(DVec3::X), column(DVec3::Y), column(DVec3::Z))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn children_touch_their_parent_and_no_sphere_overlaps() {
        let spheres = objects(2).spheres;
        let mut tangent = 0;
        for (i, a) in spheres.iter().enumerate() {
            for b in &spheres[..i] {
                let gap = a.centre.distance(b.centre) - a.radius - b.radius;
                assert!(gap > -1e-14, "overlap {gap}");
                tangent += usize::from(gap < 1e-14);
            }
        }
        assert_eq!(tangent, spheres.len() - 1);
    }

    #[test]
    fn frames_are_rotations() {
        for d in directions() {
            let m = from_z(d);
            assert!((m * DVec3::Z).distance(d) < 1e-15);
            assert!((m.determinant() - 1.0).abs() < 1e-15);
        }
        assert_eq!(from_z(-DVec3::Z) * DVec3::Z, -DVec3::Z);
    }
}
