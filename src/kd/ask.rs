//! What a ray asks of a tree.

use std::fmt;

use crate::geom::{Objects, Ray};

use super::traverse::{all_watched, nearest_watched, occluded_watched};
use super::{Probe, Stack, Tree};

/// What a ray asks, and so how early its traversal ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Ask {
    /// Nothing stops it: every object of every leaf it meets is tested. The metric's own ray (MacDonald & Booth 1990).
    All,
    /// Its nearest hit: it ends where no later leaf can hold a nearer one.
    Nearest,
    /// Any hit: it ends with the first object found, as a shadow ray does.
    Any,
}

impl Ask {
    /// Each of them.
    pub const ALL: [Self; 3] = [Self::All, Self::Nearest, Self::Any];

    /// The name in files and on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::All => "all",
            Self::Nearest => "nearest",
            Self::Any => "any",
        }
    }

    /// Trace a ray; says whether it hits anything within its span.
    #[inline]
    pub fn hits(
        self,
        tree: &Tree,
        objects: &Objects,
        ray: &Ray,
        stack: &mut Stack,
        probe: impl Probe,
    ) -> bool {
        match self {
            Self::All => all_watched(tree, objects, ray, stack, probe) > 0,
            Self::Nearest => nearest_watched(tree, objects, ray, stack, probe).is_some(),
            Self::Any => occluded_watched(tree, objects, ray, stack, probe),
        }
    }
}

impl fmt::Display for Ask {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}
