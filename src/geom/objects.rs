//! The objects of a scene, stored by kind: a scene pays only for the kinds it has.

use super::{Aabb, Polygon, Ray, Sphere, Triangle};

/// Objects in one numbering: first the triangles, then the spheres, then the polygons.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Objects {
    /// Triangles, numbers 0 to T - 1.
    pub triangles: Vec<Triangle>,
    /// Spheres, numbers T to T + S - 1.
    pub spheres: Vec<Sphere>,
    /// Convex planar polygons, the numbers after.
    pub polygons: Vec<Polygon>,
}

impl Objects {
    /// Number of objects.
    pub fn len(&self) -> usize {
        self.triangles.len() + self.spheres.len() + self.polygons.len()
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
        self.polygons[i - self.spheres.len()].intersect(ray)
    }
}
