//! A tree and its triangles in the numbers of a kernel.

use glam::Vec3;

use crate::geom::{Aabb, Triangle};
use crate::kd::{NarrowTree, Planes, Tree};

use super::Exact;

/// What a kernel is given besides lines.
pub struct Subject<'a, T: Planes> {
    /// The tree.
    pub tree: &'a T,
    /// The box of every node, exact.
    pub boxes: &'a [Aabb],
    /// The scene's triangles, whose numbers come before those of other objects.
    pub triangles: &'a [Triangle<T::Vector>],
}

impl<'a> Subject<'a, Tree> {
    /// A tree as it was built.
    pub fn new(tree: &'a Tree, triangles: &'a [Triangle]) -> Self {
        Self {
            tree,
            boxes: &tree.boxes,
            triangles,
        }
    }
}

/// A tree and its triangles, rounded to single precision.
pub struct Narrow {
    tree: NarrowTree,
    triangles: Vec<Triangle<Vec3>>,
}

impl Narrow {
    /// A tree that single precision can hold, and so its triangles.
    pub fn new(tree: NarrowTree, triangles: &[Triangle]) -> Self {
        let rounded = |t: &Triangle| Triangle(t.0.map(Vec3::rounded));
        let triangles = triangles.iter().map(rounded).collect();
        Self { tree, triangles }
    }

    /// What a kernel in single precision is given.
    pub fn subject(&self) -> Subject<'_, NarrowTree> {
        Subject {
            tree: &self.tree,
            boxes: &self.tree.boxes,
            triangles: &self.triangles,
        }
    }
}
