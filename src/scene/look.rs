//! How a scene is looked at and what its surfaces are made of: all that a picture needs besides the objects.

use glam::DVec3;

/// Camera, lights and materials of a scene, after the Neutral File Format of the Standard Procedural Databases.
#[derive(Clone, Debug, PartialEq)]
pub struct Look {
    /// Camera, lights and background.
    pub stage: Stage,
    /// The materials: records `f` of a file.
    pub materials: Vec<Material>,
    /// Material of every object, in the order of their numbers.
    pub material_of: Vec<u32>,
    /// Normals at the corners of each triangle that has them, in the order of the triangles; empty if none has.
    pub normals: Vec<Option<[DVec3; 3]>>,
}

/// Camera, lights and background.
#[derive(Clone, Debug, PartialEq)]
pub struct Stage {
    /// Colour where a ray meets nothing: red, green, blue, 0 to 1.
    pub background: DVec3,
    /// The camera.
    pub view: View,
    /// Positions of the point lights.
    pub lights: Vec<DVec3>,
}

/// A pinhole camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// The eye.
    pub from: DVec3,
    /// A point in the middle of the picture.
    pub at: DVec3,
    /// A direction that is up in the picture.
    pub up: DVec3,
    /// Full angle of view in degrees, across and up.
    pub angle: f64,
    /// Distance of the near plane; only kept.
    pub hither: f64,
    /// Pixels across and up; only kept.
    pub resolution: [u32; 2],
}

/// What a surface does with light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Red, green, blue, 0 to 1.
    pub colour: DVec3,
    /// Diffuse share Kd.
    pub diffuse: f64,
    /// Specular share Ks: highlights and reflection.
    pub specular: f64,
    /// Phong exponent of the highlight.
    pub shine: f64,
    /// Transmitted share T.
    pub transmittance: f64,
    /// Index of refraction; 0 or 1 for what is opaque.
    pub index: f64,
}
