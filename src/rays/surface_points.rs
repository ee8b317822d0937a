//! Uniform points of the surfaces of a scene's objects.

use std::f64::consts::TAU;

use glam::DVec3;
use rand::Rng;
use rand::distr::Distribution;
use rand_distr::UnitSphere;

use crate::geom::{Cone, Line, Object, Polygon, Ray, Span, Sphere, Triangle};
use crate::scene::Scene;

use super::address::uniform;

/// Draws points of the objects' surfaces by area, open surfaces counted once.
pub struct SurfacePoints<'a> {
    scene: &'a Scene,
    /// Area of the objects up to and with each.
    sums: Vec<f64>,
}

impl<'a> SurfacePoints<'a> {
    /// Of all objects of a scene.
    ///
    /// # Errors
    /// If no object has an area.
    pub fn new(scene: &'a Scene) -> Result<Self, String> {
        let mut sum = 0.0;
        let areas = (0..scene.objects.len() as u32).map(|i| {
            sum += scene.objects.get(i).area();
            sum
        });
        let sums: Vec<f64> = areas.collect();
        if sum > 0.0 && sum.is_finite() {
            Ok(Self { scene, sums })
        } else {
            Err(format!(
                "{}: its objects have no area, so no ray starts on them",
                scene.name
            ))
        }
    }

    /// A uniform point with its unit normal, to the object's outside.
    pub fn draw(&self, rng: &mut impl Rng) -> (DVec3, DVec3) {
        let all = self.sums.last().copied().unwrap_or(0.0);
        let at = all * uniform(rng);
        let number = self.sums.partition_point(|&sum| sum <= at);
        // Rounding may step behind the last.
        let number = number.min(self.sums.len() - 1) as u32;
        let point = match self.scene.objects.get(number) {
            Object::Triangle(triangle) => on_triangle(triangle, rng),
            Object::Sphere(sphere) => on_sphere(sphere, rng),
            Object::Cone(cone) => on_cone(cone, rng),
            Object::Polygon(polygon) => on_polygon(polygon, rng),
        };
        let normal = self.scene.objects.normal(number, point);
        (point, normal.normalize_or(DVec3::Z))
    }
}

fn on_triangle(&Triangle([a, b, c]): &Triangle, rng: &mut impl Rng) -> DVec3 {
    let root = uniform(rng).sqrt();
    let share = uniform(rng);
    a + root * ((1.0 - share) * (b - a) + share * (c - a))
}

fn on_sphere(sphere: &Sphere, rng: &mut impl Rng) -> DVec3 {
    sphere.centre + sphere.radius * DVec3::from_array(UnitSphere.sample(rng))
}

/// The height's density is proportional to the radius there, which is linear in it.
fn on_cone(cone: &Cone, rng: &mut impl Rng) -> DVec3 {
    let (a, b) = (cone.base_radius, cone.apex_radius);
    let radius = (a * a + uniform(rng) * (b * b - a * a)).sqrt();
    let height = if a == b {
        uniform(rng)
    } else {
        (radius - a) / (b - a)
    };
    let axis = cone.apex - cone.base;
    let (x, y) = axis.normalize().any_orthonormal_pair();
    let (sine, cosine) = libm::sincos(TAU * uniform(rng));
    cone.base + height * axis + radius * (cosine * x + sine * y)
}

/// A uniform point of the corners' rectangle in their plane, kept if it lies in the polygon.
fn on_polygon(polygon: &Polygon, rng: &mut impl Rng) -> DVec3 {
    let first = polygon.corners()[0];
    let normal = polygon.normal().normalize();
    let (x, y) = normal.any_orthonormal_pair();
    let (mut lo, mut hi) = (DVec3::ZERO, DVec3::ZERO);
    for corner in polygon.corners() {
        let at = corner - first;
        let at = DVec3::new(at.dot(x), at.dot(y), 0.0);
        (lo, hi) = (lo.min(at), hi.max(at));
    }
    let reach = (hi - lo).length();
    loop {
        let (u, v) = (uniform(rng), uniform(rng));
        let point = first + (lo.x + u * (hi.x - lo.x)) * x + (lo.y + v * (hi.y - lo.y)) * y;
        let from = Line::new(point - reach * normal, normal);
        let all = Span {
            t0: 0.0,
            t1: 2.0 * reach,
        };
        if polygon.intersect(&Ray::new(from, all)).is_some() {
            return point;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::Targets;
    use crate::rays::{Purpose, generator};

    /// Of many points the share in each half of the box is that of the area there.
    #[test]
    fn points_are_uniform_by_area() {
        // A cone of radii 1 and 0: of its lateral area three quarters lie in the lower half.
        let mut rng = generator(5, Purpose::Sources);
        let cone = Cone {
            base: DVec3::ZERO,
            base_radius: 1.0,
            apex: DVec3::Z,
            apex_radius: 0.0,
        };
        let n = 40_000;
        let low = (0..n).filter(|_| on_cone(&cone, &mut rng).z < 0.5).count();
        // Five standard errors.
        assert!((low as f64 / n as f64 - 0.75).abs() < 5.0 * (0.1875 / n as f64).sqrt());
        // An L of three unit squares.
        let corners = [[0, 0], [2, 0], [2, 1], [1, 1], [1, 2], [0, 2]];
        let corners = corners.map(|[x, y]| DVec3::new(f64::from(x), 1.0, f64::from(y)));
        let l = Polygon::new(corners.into()).expect("a polygon");
        let right = (0..n).filter(|_| on_polygon(&l, &mut rng).x > 1.0).count();
        assert!((right as f64 / n as f64 - 1.0 / 3.0).abs() < 5.0 * (2.0 / 9.0 / n as f64).sqrt());
    }

    #[test]
    fn points_lie_on_their_objects() {
        for name in ["spd:gears:1", "spd:jacks:1", "spd:balls:1", "spd:teapot:2"] {
            let scene = Scene::load(name).expect("a scene");
            let points = SurfacePoints::new(&scene).expect("surfaces");
            let mut rng = generator(3, Purpose::Sources);
            for _ in 0..200 {
                let (point, normal) = points.draw(&mut rng);
                let reach = 1e-6 * scene.world.extent().length();
                let ray = Ray::new(
                    Line::new(point - reach * normal, normal),
                    Span {
                        t0: 0.0,
                        t1: 2.0 * reach,
                    },
                );
                let hit = (0..scene.objects.len() as u32)
                    .any(|i| scene.objects.intersect(i, &ray).is_some());
                assert!(hit, "{name}: {point}");
            }
        }
    }
}
