//! A tree in one precision with its ways, its rays and what they are tested against.

use crate::geom::{Ray, Targets};
use crate::kd::links::{FaceTrees, Links};
use crate::kd::{Ask, Planes};
use crate::study::timing::BUILD;

use super::seconds::Pass;
use super::trail::Set;
use super::way::{Point, Walks, Way};

/// What a row of `link-memory.csv` tells of a tree in one precision.
pub struct Memory {
    /// Bytes of nodes and references.
    pub bytes: u64,
    /// Which nodes are leaves so thin that their planes are not told apart.
    pub thin: Vec<bool>,
}

/// A tree in one precision, its rays, and what they are tested against, if that has a test there.
pub struct Side<'a, T: Planes, O: ?Sized> {
    /// `f64` or `f32`.
    pub precision: &'static str,
    /// The tree with its ways.
    pub walks: Walks<'a, T>,
    /// What is to be told of the tree.
    pub memory: Memory,
    objects: Option<&'a O>,
    /// By set.
    rays: Vec<Vec<Ray<T::Vector>>>,
}

impl<'a, T: Planes<Vector: Point> + Sync, O: Targets<Vector = T::Vector> + Sync + ?Sized>
    Side<'a, T, O>
{
    /// All of it.
    pub fn new(
        precision: &'static str,
        tree: &'a T,
        memory: Memory,
        objects: Option<&'a O>,
        rays: Vec<Vec<Ray<T::Vector>>>,
    ) -> Self {
        Self {
            precision,
            walks: Walks::of(tree),
            memory,
            objects,
            rays,
        }
    }

    /// A set of rays; `None` where they are to be tested and nothing has a test.
    pub fn set(&self, number: usize, ask: Ask) -> Option<Set<'_, T::Vector, O>> {
        let objects = match ask {
            Ask::All => None,
            _ => Some(self.objects?),
        };
        let rays = &self.rays[number];
        Some(Set { rays, objects })
    }

    /// What is built besides the tree.
    pub fn builds(&self) -> [Pass<'_>; 2] {
        let Walks { tree, links, .. } = &self.walks;
        let name = |what: &str| format!("{BUILD} {what} {}", self.precision);
        [
            Pass::build(name(Way::Links.name()), || Links::of(*tree)),
            Pass::build(name(Way::FaceTrees.name()), || FaceTrees::of(*tree, links)),
        ]
    }
}
