//! The ways through a tree that are compared, and one task done along any of them.

use std::fmt;

use crate::geom::Vector;
use crate::kd::links::{FaceTrees, Links};
use crate::kd::restart::Restart;
use crate::kd::{Planes, Walk};

/// A way through a tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// With a stack: what the others are held against.
    Stack,
    /// From the root again after every leaf (Foley & Sugerman 2005).
    Restart,
    /// Along links to neighbours (MacDonald & Booth 1990; Popov, Guenther, Seidel & Slusallek 2007).
    Links,
    /// Along links, and through a tree of its own where a face has several neighbours (Havran, Bittner & Zara 1998).
    FaceTrees,
}

impl Way {
    /// Each of them, the reference first.
    pub const ALL: [Self; 4] = [Self::Stack, Self::Restart, Self::Links, Self::FaceTrees];

    /// The name in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Stack => "stack",
            Self::Restart => "restart",
            Self::Links => "links",
            Self::FaceTrees => "face-trees",
        }
    }
}

impl fmt::Display for Way {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// Points that threads can share.
pub trait Point: Vector<Real: Send + Sync + 'static> + Send + Sync + 'static {}

impl<V: Vector<Real: Send + Sync + 'static> + Send + Sync + 'static> Point for V {}

/// A tree with what its ways need.
pub struct Walks<'t, T: Planes> {
    /// The tree.
    pub tree: &'t T,
    /// Its links.
    pub links: Links<T::Vector>,
    /// Its links through trees of faces.
    pub face_trees: FaceTrees<T::Vector>,
}

/// What can be done along any way.
pub trait Task<V> {
    /// What comes of it.
    type Done;

    /// Do it.
    fn along<W: Walk<Vector = V> + Sync>(self, walk: &W) -> Self::Done;
}

impl<'t, T: Planes<Vector: Point> + Sync> Walks<'t, T> {
    /// Of a tree.
    pub fn of(tree: &'t T) -> Self {
        let links = Links::of(tree);
        let face_trees = FaceTrees::of(tree, &links);
        Self {
            tree,
            links,
            face_trees,
        }
    }

    /// Do something along one of the ways.
    pub fn take<K: Task<T::Vector>>(&self, way: Way, task: K) -> K::Done {
        match way {
            Way::Stack => task.along(self.tree),
            Way::Restart => task.along(&Restart(self.tree)),
            Way::Links => task.along(&self.links.walk(self.tree)),
            Way::FaceTrees => task.along(&self.face_trees.walk(self.tree)),
        }
    }
}
