//! A scene in the making: objects added one by one, each of the material named last.

use glam::DVec3;

use super::look::{Look, Material, Stage};
use crate::geom::{Cone, Objects, Polygon, Sphere, Triangle};

/// Objects, and their look if they have one.
#[derive(Default)]
pub(super) struct Draft {
    objects: Objects,
    stage: Option<Stage>,
    materials: Vec<Material>,
    /// Materials of the triangles, spheres, cones and polygons.
    material_of: [Vec<u32>; 4],
    normals: Vec<Option<[DVec3; 3]>>,
}

impl Draft {
    /// Nothing yet, to be seen on a stage.
    pub(super) fn new(stage: Stage) -> Self {
        Self {
            stage: Some(stage),
            ..Self::default()
        }
    }

    /// What it is to be seen on.
    pub(super) fn stage(&mut self, stage: Stage) {
        self.stage = Some(stage);
    }

    /// The material of what is added from here on.
    pub(super) fn material(&mut self, material: Material) {
        self.materials.push(material);
    }

    /// The number of the current material, to be kept for an object.
    fn current(&self) -> u32 {
        self.materials.len().saturating_sub(1) as u32
    }

    /// Adds a triangle.
    pub(super) fn triangle(&mut self, corners: [DVec3; 3]) {
        self.material_of[0].push(self.current());
        self.objects.triangles.push(Triangle(corners));
        if !self.normals.is_empty() {
            self.normals.push(None);
        }
    }

    /// Adds a triangle with a normal at each corner.
    pub(super) fn patch(&mut self, corners: [DVec3; 3], normals: [DVec3; 3]) {
        self.normals.resize(self.objects.triangles.len(), None);
        self.normals.push(Some(normals));
        self.material_of[0].push(self.current());
        self.objects.triangles.push(Triangle(corners));
    }

    /// Adds a sphere.
    pub(super) fn sphere(&mut self, centre: DVec3, radius: f64) {
        self.material_of[1].push(self.current());
        self.objects.spheres.push(Sphere { centre, radius });
    }

    /// Adds an open cone or cylinder.
    pub(super) fn cone(&mut self, cone: Cone) {
        self.material_of[2].push(self.current());
        self.objects.cones.push(cone);
    }

    /// Adds a polygon.
    pub(super) fn polygon(&mut self, polygon: Polygon) {
        self.material_of[3].push(self.current());
        self.objects.polygons.push(polygon);
    }

    /// The objects, and their look if there is a stage.
    pub(super) fn into_parts(self) -> (Objects, Option<Look>) {
        let look = self.stage.map(|stage| Look {
            stage,
            materials: self.materials,
            material_of: self.material_of.concat(),
            normals: self.normals,
        });
        (self.objects, look)
    }
}

impl From<Objects> for Draft {
    fn from(objects: Objects) -> Self {
        Self {
            objects,
            ..Self::default()
        }
    }
}
