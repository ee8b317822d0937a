//! A kd-tree in single precision: the same planes and boxes, rounded to `f32`, in half the memory.
//!
//! Rounding keeps order: a plane stays inside its node's box, a triangle's rounded corners stay inside the rounded boxes of the
//! leaves that hold it. But what lies nearer together than f32 numbers do falls together. [`resolution`] tells how fine they are
//! for a scene, [`fitness`] whether they do: a tree for which they are too coarse, or whose lengths have products beyond their range,
//! is refused. Only triangles have a test in f32.

use glam::{DVec3, Vec3};
use thiserror::Error;

use crate::geom::{Aabb, Axis, Line, Objects, Triangle};

use super::{NodeKind, Planes, Tree};

/// Resolution below which one is warned.
pub const WARN_BELOW: f64 = 16_384.0;

/// Resolution below which a tree is refused.
pub const REFUSE_BELOW: f64 = 256.0;

/// Coordinates above this are refused. The triangle test multiplies two lengths, for t a third: those of 2^40 give up to 2^120, and
/// f32 ends at 2^128.
const FARTHEST: f64 = (1u64 << 40) as f64;

/// Boxes all of whose sides are below this are refused: products of three such lengths are below 2^-120, and the numbers of f32
/// lose their digits below 2^-126.
const SMALLEST: f64 = 1.0 / FARTHEST;

const LEAF: u32 = 3;

/// An inner node's plane and children, or a leaf's references, in 8 bytes.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Node {
    /// The bits of the plane's position; or the number of references.
    data: u32,
    /// Low two bits: axis, or 3 for a leaf; above them the left child or the first reference.
    tag: u32,
}

impl Node {
    fn of(kind: NodeKind) -> Result<Self, Refusal> {
        let (data, low, first) = match kind {
            NodeKind::Inner { axis, split, left } => ((split as f32).to_bits(), axis as u32, left),
            NodeKind::Leaf { first, count } => (count, LEAF, first),
        };
        if first >= 1 << 30 {
            return Err(Refusal::TooLarge(first));
        }
        let tag = low | first << 2;
        Ok(Self { data, tag })
    }

    #[inline(always)]
    fn kind(self) -> NodeKind<f32> {
        let first = self.tag >> 2;
        match self.tag & 3 {
            LEAF => NodeKind::Leaf {
                first,
                count: self.data,
            },
            axis => NodeKind::Inner {
                axis: axis as Axis,
                split: f32::from_bits(self.data),
                left: first,
            },
        }
    }
}

/// A kd-tree in single precision, with the node numbers and references of the tree it was made from.
#[derive(Clone, Debug, PartialEq)]
pub struct NarrowTree {
    nodes: Vec<Node>,
    /// The box of every node, cut from the rounded root by the rounded planes: exact numbers, whose areas make predictions.
    pub boxes: Vec<Aabb>,
    /// Objects of the leaves, one entry an object and leaf.
    pub references: Vec<u32>,
    /// The root's box.
    pub world: Aabb<Vec3>,
}

/// Why there is no tree in single precision.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum Refusal {
    /// Neighbouring f32 numbers are too far apart for the scene.
    #[error(
        "single precision is too coarse here: the longest side of the box is {resolution:.1} steps of f32 at its farthest \
         coordinate, at least {REFUSE_BELOW} are wanted; subtract the centre of the box, {centre}, from all coordinates, or take f64",
        centre = short(centre)
    )]
    TooCoarse {
        /// [`resolution`] of the root's box.
        resolution: f64,
        /// What to subtract.
        centre: DVec3,
    },
    /// Products of the scene's lengths leave the range of f32.
    #[error(
        "products of lengths leave single precision here: the longest side of the box is {longest:e}, its farthest coordinate \
         {farthest:e}, and they must be at least {SMALLEST:e} and at most {FARTHEST:e}; scale the scene by a power of two, or take f64"
    )]
    OutOfRange {
        /// The longest side of the root's box.
        longest: f64,
        /// The largest absolute value of its coordinates.
        farthest: f64,
    },
    /// A coordinate is beyond the range of f32.
    #[error(
        "the coordinate {0:e} is beyond single precision, which ends at {max:e}; scale the scene by a power of two, or take f64",
        max = f32::MAX
    )]
    NotFinite(f64),
    /// Numbers of nodes and references have 30 bits.
    #[error(
        "node or reference number {0} does not fit into 30 bits; build a smaller tree, or take f64"
    )]
    TooLarge(u32),
    /// All parts of a direction are too small for f32.
    #[error(
        "the direction {direction} vanishes in single precision; give it unit length, or take f64",
        direction = short(.0)
    )]
    NoDirection(DVec3),
    /// Only triangles have a test in single precision.
    #[error(
        "{0} of the objects are no triangles, and only triangles have a test in single precision; take f64"
    )]
    NoTriangles(usize),
}

/// A point, in few digits whatever its size.
fn short(p: &DVec3) -> String {
    format!("[{:e}, {:e}, {:e}]", p.x, p.y, p.z)
}

/// Single precision is coarse for the scene, but not refused.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Warning {
    /// [`resolution`] of the root's box.
    pub resolution: f64,
}

impl std::fmt::Display for Warning {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            f,
            "single precision is coarse here: the longest side of the box is {:.0} steps of f32 at its farthest coordinate, \
             {WARN_BELOW} or more leave results clean",
            self.resolution
        )
    }
}

/// The longest side of a box over the distance of neighbouring f32 numbers at its farthest coordinate.
///
/// A box of side 1 around the origin has 2^24; moved by 1,000 along each axis 2^14, by 10^5 2^7. 0 beyond the range of f32.
pub fn resolution(world: &Aabb) -> f64 {
    let farthest = farthest(world) as f32;
    let step = farthest.next_up() - farthest;
    if !step.is_finite() {
        return 0.0;
    }
    world.extent().max_element() / f64::from(step)
}

/// The largest absolute value of a box's coordinates.
fn farthest(world: &Aabb) -> f64 {
    world.lo.abs().max(world.hi.abs()).max_element()
}

/// Whether single precision does for a scene of this box, be it with a warning; or why it does not.
pub fn fitness(world: &Aabb) -> Result<Option<Warning>, Refusal> {
    let (resolution, longest) = (resolution(world), world.extent().max_element());
    let farthest = farthest(world);
    if farthest > f64::from(f32::MAX) {
        return Err(Refusal::NotFinite(farthest));
    }
    // A tiny box at the origin may be coarse, as f32 numbers get no finer than 2^-149: centring it would not help.
    let tiny = 0.0 < longest && longest < SMALLEST;
    if resolution < REFUSE_BELOW && !tiny {
        let centre = world.centre();
        return Err(Refusal::TooCoarse { resolution, centre });
    }
    if tiny || farthest > FARTHEST {
        return Err(Refusal::OutOfRange { longest, farthest });
    }
    Ok((resolution < WARN_BELOW).then_some(Warning { resolution }))
}

impl NarrowTree {
    /// The tree in single precision, and whether to be wary of it; or why it would be useless.
    pub fn of(tree: &Tree) -> Result<(Self, Option<Warning>), Refusal> {
        let warning = fitness(&tree.world)?;
        Ok((Self::however_coarse(tree)?, warning))
    }

    /// As [`of`](Self::of), for whoever wants to know what would come of it: only what cannot be stored is refused.
    pub fn however_coarse(tree: &Tree) -> Result<Self, Refusal> {
        let world = narrow_box(&tree.world)?;
        let nodes: Vec<Node> = tree
            .nodes
            .iter()
            .map(|node| Node::of(node.kind()))
            .collect::<Result<_, _>>()?;
        let root = Aabb::new(world.lo.as_dvec3(), world.hi.as_dvec3());
        let mut boxes = vec![root; nodes.len()];
        // Children come after their parent in the arena.
        for (i, node) in nodes.iter().enumerate() {
            if let NodeKind::Inner { axis, split, left } = node.kind() {
                let (below, above) = boxes[i].split(axis, f64::from(split));
                boxes[left as usize] = below;
                boxes[left as usize + 1] = above;
            }
        }
        Ok(Self {
            nodes,
            boxes,
            references: tree.references.clone(),
            world,
        })
    }

    /// Bytes that a traversal reads: nodes and references.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.nodes[..]) + size_of_val(&self.references[..])
    }
}

impl Planes for NarrowTree {
    type Vector = Vec3;
    type Real = f32;

    #[inline(always)]
    fn world(&self) -> &Aabb<Vec3> {
        &self.world
    }

    #[inline(always)]
    fn node(&self, number: u32) -> NodeKind<f32> {
        self.nodes[number as usize].kind()
    }

    #[inline(always)]
    fn objects(&self, first: u32, count: u32) -> &[u32] {
        &self.references[first as usize..][..count as usize]
    }
}

/// A point, rounded to single precision.
fn narrow_point(p: DVec3) -> Result<Vec3, Refusal> {
    let narrow = p.as_vec3();
    if narrow.is_finite() {
        Ok(narrow)
    } else {
        Err(Refusal::NotFinite(p.abs().max_element()))
    }
}

/// A box, rounded to single precision.
pub fn narrow_box(b: &Aabb) -> Result<Aabb<Vec3>, Refusal> {
    Ok(Aabb {
        lo: narrow_point(b.lo)?,
        hi: narrow_point(b.hi)?,
    })
}

/// A triangle, rounded to single precision.
pub fn narrow_triangle(Triangle([a, b, c]): &Triangle) -> Result<Triangle<Vec3>, Refusal> {
    Ok(Triangle([
        narrow_point(*a)?,
        narrow_point(*b)?,
        narrow_point(*c)?,
    ]))
}

/// The triangles of a scene, rounded to single precision; it must have no other objects.
pub fn narrow_triangles(objects: &Objects) -> Result<Vec<Triangle<Vec3>>, Refusal> {
    let others = objects.len() - objects.triangles.len();
    if others > 0 {
        return Err(Refusal::NoTriangles(others));
    }
    objects.triangles.iter().map(narrow_triangle).collect()
}

/// A line, rounded to single precision.
pub fn narrow_line(line: &Line) -> Result<Line<Vec3>, Refusal> {
    let origin = narrow_point(line.origin)?;
    let direction = narrow_point(line.direction)?;
    // Parts whose reciprocal overflows become 0: one must be left.
    if !direction.abs().max_element().recip().is_finite() {
        return Err(Refusal::NoDirection(line.direction));
    }
    Ok(Line::new(origin, direction))
}
