//! Face trees: for each face that several leaves touch, a two-dimensional kd-tree of just these ("rope trees" of Havran, Bittner & Zara
//! 1998; "neighbour link trees" of Hapala & Havran 2011).

use std::collections::HashMap;

use crate::geom::{Axis, Line, Span, Vector};
use crate::kd::{Mode, NodeKind, Planes, Probe, Stack, Walk};

use super::walk::{Way, follow};
use super::{Faces, LEAF, Links, Target, beside, target};

/// A plane that cuts a face.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct FaceNode<T> {
    split: T,
    pub(super) axis: u32,
    /// What is below and above: a leaf, or another plane.
    pub(super) children: [u32; 2],
}

/// Links of which each leads, through a face tree if need be, to a leaf that touches the face.
///
/// Below a covering node most planes do not cut the face: they are parallel to it, or lie beside it. A face tree has the
/// others only. Equal parts of face trees are stored once.
#[derive(Clone, Debug, PartialEq)]
pub struct FaceTrees<V: Vector> {
    /// The tree's links, those to covering nodes replaced by those to face trees.
    pub(super) links: Links<V>,
    pub(super) nodes: Vec<FaceNode<V::Real>>,
    /// The tree's node that has each plane: what only probes are told.
    origins: Vec<u32>,
    /// Planes of all face trees, those of equal parts each time.
    unshared: usize,
}

/// Plants face trees: gives each part of one a number.
struct Planter<'a, T: Planes> {
    tree: &'a T,
    numbers: &'a [u32],
    nodes: Vec<FaceNode<T::Real>>,
    origins: Vec<u32>,
    unshared: usize,
    /// Parts there are, by the node and what is below and above its plane.
    planted: HashMap<(u32, [u32; 2]), u32>,
}

impl<T: Planes> Planter<'_, T> {
    /// The link to what touches a face of a box at or below a node behind it.
    fn plant(&mut self, node: u32, planes: &Faces<T::Real>, face: (Axis, usize)) -> u32 {
        let NodeKind::Inner { axis, split, left } = self.tree.node(node) else {
            return LEAF | self.numbers[node as usize];
        };
        if let Some(above) = beside(planes, face, axis, split) {
            return self.plant(left + u32::from(above), planes, face);
        }
        let children = [left, left + 1].map(|child| self.plant(child, planes, face));
        self.unshared += 1;
        *self.planted.entry((node, children)).or_insert_with(|| {
            self.nodes.push(FaceNode {
                split,
                axis: axis as u32,
                children,
            });
            self.origins.push(node);
            let count = u32::try_from(self.nodes.len()).expect("fewer than 2^31 planes cut faces");
            assert!(count < LEAF, "fewer than 2^31 planes cut faces");
            count - 1
        })
    }
}

impl<V: Vector> FaceTrees<V> {
    /// The face trees of a tree with these links.
    ///
    /// # Panics
    /// If they have 2^31 planes or more.
    pub fn of<T: Planes<Vector = V, Real = V::Real>>(tree: &T, links: &Links<V>) -> Self {
        let mut links = links.clone();
        let mut planter = Planter {
            tree,
            numbers: &links.numbers,
            nodes: Vec::new(),
            origins: Vec::new(),
            unshared: 0,
            planted: HashMap::new(),
        };
        for leaf in &mut links.leaves {
            for axis in 0..3 {
                for side in 0..2 {
                    let link = &mut leaf.links[axis][side];
                    if let Target::Inner(node) = target(*link) {
                        *link = planter.plant(node, &leaf.planes, (axis, side));
                    }
                }
            }
        }
        let Planter {
            nodes,
            origins,
            unshared,
            ..
        } = planter;
        Self {
            links,
            nodes,
            origins,
            unshared,
        }
    }

    /// Bytes that a walk reads besides the tree itself: links, with leaves and their numbers, and face trees. What only probes are told is
    /// not among them.
    pub fn bytes(&self) -> usize {
        self.links.bytes() + size_of_val(&self.nodes[..])
    }

    /// Planes stored, and planes of all face trees, those of equal parts each time.
    pub fn planes(&self) -> (usize, usize) {
        (self.nodes.len(), self.unshared)
    }

    /// The way through the tree along these links, which must be its own: through another tree it leads anywhere, or panics.
    pub fn walk<'a, T: Planes<Vector = V, Real = V::Real>>(
        &'a self,
        tree: &'a T,
    ) -> FacesLinked<'a, T> {
        FacesLinked { tree, faces: self }
    }
}

/// As [`Linked`](super::Linked), through face trees instead of covering nodes: `inner` tells the tree's node whose plane it is.
pub struct FacesLinked<'a, T: Planes> {
    tree: &'a T,
    faces: &'a FaceTrees<T::Vector>,
}

impl<T: Planes> Walk for FacesLinked<'_, T> {
    type Vector = T::Vector;

    #[inline(always)]
    fn walk<M: Mode, P: Probe>(
        &self,
        line: &Line<T::Vector>,
        span: Span<T::Real>,
        stack: &mut Stack<T::Real>,
        probe: &mut P,
        leaf: impl FnMut(&[u32], &mut P) -> T::Real,
    ) {
        let FaceTrees { nodes, origins, .. } = self.faces;
        let enter = |mut link: u32, way: &Way<T::Vector>, probe: &mut P| {
            while link & LEAF == 0 {
                let plane = &nodes[link as usize];
                // Without a branch, so that nothing is left of it where no probe asks.
                let node = origins.get(link as usize).copied().unwrap_or_default();
                probe.inner(node);
                let (above, turn) = way.above(plane.axis as Axis, plane.split)?;
                probe.turn(node, turn);
                link = plane.children[usize::from(above)];
            }
            Some(link & !LEAF)
        };
        let ways = (self.tree, &self.faces.links);
        follow::<M, T, P>(ways, line, span, stack, probe, leaf, enter);
    }
}
