//! The objects of a scene, stored by kind: a scene pays only for the kinds it has.

use glam::DVec3;

use super::{Aabb, Cone, Polygon, Ray, Sphere, Triangle, Vector};

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

    /// Object `number`; it must exist.
    #[inline]
    pub fn get(&self, number: u32) -> Object<'_> {
        let mut i = number as usize;
        if let Some(triangle) = self.triangles.get(i) {
            return Object::Triangle(triangle);
        }
        i -= self.triangles.len();
        if let Some(sphere) = self.spheres.get(i) {
            return Object::Sphere(sphere);
        }
        i -= self.spheres.len();
        if let Some(cone) = self.cones.get(i) {
            return Object::Cone(cone);
        }
        Object::Polygon(&self.polygons[i - self.cones.len()])
    }

    /// The box of every object, in the order of their numbers.
    pub fn bounds(&self) -> Vec<Aabb> {
        (0..self.len() as u32)
            .map(|number| self.get(number).bounds())
            .collect()
    }

    /// The outward normal of object `number` at a point of its surface, not of unit length.
    pub fn normal(&self, number: u32, point: DVec3) -> DVec3 {
        match self.get(number) {
            Object::Triangle(triangle) => triangle.normal(),
            Object::Sphere(sphere) => sphere.normal(point),
            Object::Cone(cone) => cone.normal(point),
            Object::Polygon(polygon) => polygon.normal(),
        }
    }
}

/// Objects that rays are tested against, by number.
pub trait Targets {
    /// Points of their numbers.
    type Vector: Vector;

    /// Parameter of the ray's first hit with object `number`, or `None`.
    fn intersect(
        &self,
        number: u32,
        ray: &Ray<Self::Vector>,
    ) -> Option<<Self::Vector as Vector>::Real>;

    /// Object `number` if it is a triangle: many rays at once can be tested against its edges.
    fn triangle(&self, number: u32) -> Option<&Triangle<Self::Vector>>;
}

impl Targets for Objects {
    type Vector = DVec3;

    #[inline]
    fn intersect(&self, number: u32, ray: &Ray) -> Option<f64> {
        match self.get(number) {
            Object::Triangle(triangle) => triangle.intersect(ray),
            Object::Sphere(sphere) => sphere.intersect(ray),
            Object::Cone(cone) => cone.intersect(ray),
            Object::Polygon(polygon) => polygon.intersect(ray),
        }
    }

    #[inline]
    fn triangle(&self, number: u32) -> Option<&Triangle> {
        self.triangles.get(number as usize)
    }
}

impl<V: Vector> Targets for [Triangle<V>] {
    type Vector = V;

    #[inline]
    fn intersect(&self, number: u32, ray: &Ray<V>) -> Option<V::Real> {
        self[number as usize].intersect(ray)
    }

    #[inline]
    fn triangle(&self, number: u32) -> Option<&Triangle<V>> {
        Some(&self[number as usize])
    }
}

/// One object of any kind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Object<'a> {
    /// A triangle.
    Triangle(&'a Triangle),
    /// A sphere.
    Sphere(&'a Sphere),
    /// A cone frustum or cylinder.
    Cone(&'a Cone),
    /// A planar polygon.
    Polygon(&'a Polygon),
}

impl Object<'_> {
    /// The smallest box around it.
    pub fn bounds(self) -> Aabb {
        match self {
            Self::Triangle(triangle) => triangle.bounds(),
            Self::Sphere(sphere) => sphere.bounds(),
            Self::Cone(cone) => cone.bounds(),
            Self::Polygon(polygon) => polygon.bounds(),
        }
    }
}
