//! What is in the world: procedural scenes and scenes read from files.

use crate::geom::{Aabb, Objects};

/// A named set of objects. Never empty.
#[derive(Clone, Debug)]
pub struct Scene {
    /// The name one types to get it, e.g. `spd:balls:4` or a path.
    pub name: String,
    /// The objects.
    pub objects: Objects,
    /// Box of each object, in the order of their numbers.
    pub bounds: Vec<Aabb>,
    /// The smallest box around all objects: the root of every tree. Its surface area is positive.
    pub world: Aabb,
    /// What a user should know of how it was read, e.g. degenerate triangles that can never be hit.
    pub notes: Vec<String>,
}
