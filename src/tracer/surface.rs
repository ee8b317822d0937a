//! Where a ray met the scene: point, normal, side and material.

use glam::DVec3;

use super::optics::reflected;
use crate::geom::{Line, Triangle};
use crate::kd::Hit;
use crate::scene::look::Material;
use crate::scene::{Look, Scene};

/// A point of a surface as seen by the ray that hit it.
#[derive(Clone, Copy, Debug)]
pub struct Surface<'a> {
    /// The point.
    pub point: DVec3,
    /// Unit normal for shading and mirroring, on the side the ray came from: surfaces are two-sided.
    pub normal: DVec3,
    /// Whether the ray came from outside: against the object's own normal.
    pub outside: bool,
    /// What it is made of.
    pub material: &'a Material,
}

impl<'a> Surface<'a> {
    /// The surface at a hit of a line of unit direction.
    ///
    /// A triangle with normals at its corners takes the interpolated one, unless that would mirror the ray through the
    /// triangle: then its own, as for everything else.
    pub fn at(scene: &Scene, look: &'a Look, line: &Line, hit: Hit) -> Self {
        let point = line.at(hit.t);
        let own = scene.objects.normal(hit.object, point).normalize_or_zero();
        let outside = own.dot(line.direction) < 0.0;
        let own = if outside { own } else { -own };
        let object = hit.object as usize;
        let corners = look.normals.get(object).copied().flatten();
        let smooth = corners.map(|normals| {
            let smooth = interpolated(&scene.objects.triangles[object], normals, point);
            if smooth.dot(own) < 0.0 {
                -smooth
            } else {
                smooth
            }
        });
        let normal = smooth
            .filter(|&smooth| reflected(line.direction, smooth).dot(own) > 0.0)
            .unwrap_or(own);
        Self {
            point,
            normal,
            outside,
            material: &look.materials[look.material_of[object] as usize],
        }
    }
}

/// The mean of the normals at a triangle's corners, weighted by the point's barycentric coordinates; unit length.
fn interpolated(triangle: &Triangle, normals: [DVec3; 3], point: DVec3) -> DVec3 {
    let across = triangle.normal();
    let [a, b, c] = triangle.0.map(|corner| corner - point);
    // Twice the area opposite to each corner, times the length of `across`.
    let weights = [b.cross(c), c.cross(a), a.cross(b)].map(|part| part.dot(across));
    let [u, v, w] = weights;
    (u * normals[0] + v * normals[1] + w * normals[2]).normalize_or_zero()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normals_are_interpolated_between_corners() {
        let triangle = Triangle([DVec3::ZERO, 2.0 * DVec3::X, 2.0 * DVec3::Y]);
        let normals = [DVec3::Z, DVec3::X, DVec3::Y];
        let at = |x, y| interpolated(&triangle, normals, DVec3::new(x, y, 0.0));
        assert_eq!(at(0.0, 0.0), DVec3::Z);
        assert_eq!(at(2.0, 0.0), DVec3::X);
        let between = DVec3::new(1.0, 2.0, 1.0).normalize();
        assert!(at(0.5, 1.0).distance(between) < 1e-15);
    }
}
