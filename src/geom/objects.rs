//! The objects of a scene, stored by kind: a scene pays only for the kinds it has.

use glam::DVec3;

use super::{Aabb, Cone, Polygon, Ray, Sphere, Triangle};

/// Objects in one numbering: triangles, spheres, cones, polygons.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Objects {
    /// Triangles, numbers 0 to T - 1.
    pub triangles: Vec<Triangle>,
    /// Spheres, numbers T to T + S - 1.
    pub spheres: Vec<Sphere>,
    /// Cone frusta and cylinders, the numbers after.
    pub cones: Vec<Cone>,
    /// Planar polygons, the last numbers.
    pub polygons: Vec<Polygon>,
}

impl Objects {
    /// Number of objects.
    pub fn len(&self) -> usize {
        self.triangles.len() + self.spheres.len() + self.cones.len() + self.polygons.len()
    }

    /// Whether there is no object.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The box of every object, in the order of their numbers.
    pub fn bounds(&self) -> Vec<Aabb> {
        let mut all = Vec::with_capacity(self.len());
        all.extend(self.triangles.iter().map(Triangle::bounds));
        all.extend(self.spheres.iter().map(Sphere::bounds));
        all.extend(self.cones.iter().map(Cone::bounds));
        all.extend(self.polygons.iter().map(Polygon::bounds));
        all
    }

    /// Parameter of the ray's first hit with object `number`, or `None`.
    #[inline]
    pub fn intersect(&self, number: u32, ray: &Ray) -> Option<f64> {
        let mut i = number as usize;
        if let Some(triangle) = self.triangles.get(i) {
            return triangle.intersect(ray);
        }
        i -= self.triangles.len();
        if let Some(sphere) = self.spheres.get(i) {
            return sphere.intersect(ray);
        }
        i -= self.spheres.len();
        if let Some(cone) = self.cones.get(i) {
            return cone.intersect(ray);
        }
        self.polygons[i - self.cones.len()].intersect(ray)
    }

    /// The outward normal of object `number` at a point of its surface, not of unit length.
    pub fn normal(&self, number: u32, point: DVec3) -> DVec3 {
        let mut i = number as usize;
        if let Some(triangle) = self.triangles.get(i) {
            return triangle.normal();
        }
        i -= self.triangles.len();
        if let Some(sphere) = self.spheres.get(i) {
            return point - sphere.centre;
        }
        i -= self.spheres.len();
        if let Some(cone) = self.cones.get(i) {
            return cone.normal(point);
        }
        self.polygons[i - self.cones.len()].normal()
    }
}
