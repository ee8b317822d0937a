//! The split cost across one node, f(b) = LSA(b) L(b) + RSA(b) R(b), for a look at where its minimum lies.

use std::ops::RangeInclusive;

use crate::cost::CostModel;
use crate::geom::{Aabb, Axis};

use super::medians::{clipped_centre, object_median, spatial_median};
use super::planes::{Fractions, Planes};
use super::split::Coster;
use super::sweep::{Sweep, sorted_events};
use super::{NodeKind, Tree};

/// f over SA(node), so that it is the number of tests that a line through the node is expected to make.
const TESTS: CostModel = CostModel {
    c_k: 0.0,
    c_b: 0.0,
    c_t: 1.0,
};

/// The split cost on one axis of one node.
#[derive(Clone, Debug, PartialEq)]
pub struct SplitCurve {
    /// Where the node begins and ends.
    pub ends: [f64; 2],
    /// Middle of the node, b_rm.
    pub spatial_median: f64,
    /// Median of the centres of the objects' boxes clipped to the node, b_om; `None` without objects.
    pub object_median: Option<f64>,
    /// What strategy 7 looks at: the medians and the planes between them.
    pub samples: Vec<f64>,
    /// Least f over the object bounds strictly inside the node (the lowest of equals): what strategies 3 and 5 take.
    pub minimum: Option<CurvePoint>,
    /// All object bounds and the positions asked for, ascending.
    pub points: Vec<CurvePoint>,
}

/// The split cost at one position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvePoint {
    /// Where the plane stands.
    pub position: f64,
    /// L: objects on the left, straddlers included; those in the plane are on the cheaper side.
    pub left: usize,
    /// R: objects on the right, straddlers included. L + R = n + straddlers.
    pub right: usize,
    /// f over SA(node): expected tests.
    pub f: f64,
    /// The same with each object counted once, where its centre lies, so that L + R = n.
    pub f_centres: f64,
}

impl SplitCurve {
    /// From one median to the other, both included; `None` without objects.
    pub fn medians(&self) -> Option<RangeInclusive<f64>> {
        let (spatial, object) = (self.spatial_median, self.object_median?);
        Some(spatial.min(object)..=spatial.max(object))
    }

    /// The points strictly inside the node: planes that part it. A plane in one of its faces is never taken.
    pub fn inside(&self) -> impl Iterator<Item = &CurvePoint> {
        let [lo, hi] = self.ends;
        let inside = move |p: &&CurvePoint| lo < p.position && p.position < hi;
        self.points.iter().filter(inside)
    }
}

/// The split cost on one axis of a node with these objects, at their bounds, at strategy 7's `count` samples with the
/// medians, and at the positions `asked` (inside or on the node).
pub fn split_curve(
    objects: &[Aabb],
    node: &Aabb,
    axis: Axis,
    count: u16,
    asked: &[f64],
) -> SplitCurve {
    let clip = |b: &Aabb| Aabb::new(b.lo.max(node.lo), b.hi.min(node.hi));
    let clipped: Vec<Aabb> = objects.iter().map(clip).collect();
    let events = sorted_events(&clipped, axis);
    let n = objects.len();
    let sweep = Sweep { events: &events, n };
    let coster = Coster::new(axis, node, n, &TESTS, true);

    let mut centres: Vec<f64> = clipped
        .iter()
        .map(|b| clipped_centre(b, node, axis))
        .collect();
    let spatial_median = spatial_median(node, axis);
    let object_median = object_median(&mut centres);
    centres.sort_unstable_by(f64::total_cmp);
    let fractions = Fractions::samples(count);
    let samples = object_median.map_or(vec![], |object| {
        let (a, b) = (spatial_median.min(object), spatial_median.max(object));
        Planes::new(a, b, &fractions).iter().collect()
    });

    let point = |s: f64, left: usize, planar: usize, right: usize| {
        let split = coster.split(s, left, planar, right)?;
        let below = centres.partition_point(|&c| c < s);
        let not_above = centres.partition_point(|&c| c <= s);
        let by_centres = coster.split(s, below, not_above - below, centres.len() - not_above)?;
        let (in_left, in_right) = if split.planar_left {
            (planar, 0)
        } else {
            (0, planar)
        };
        Some(CurvePoint {
            position: s,
            left: left + in_left,
            right: right + in_right,
            f: split.cost,
            f_centres: by_centres.cost,
        })
    };
    let ends = [node.lo[axis], node.hi[axis]];
    let whole = Some((ends[0], ends[1]));
    let mut extra = [asked, &samples].concat();
    extra.sort_unstable_by(f64::total_cmp);
    extra.dedup();
    let mut points = Vec::new();
    sweep.each(whole, &extra, |s, left, planar, right| {
        points.extend(point(s, left, planar, right));
    });
    let least = sweep
        .cheapest(&coster, whole, &[])
        .map(|split| split.position);
    let minimum = points.iter().find(|p| Some(p.position) == least).copied();
    SplitCurve {
        ends,
        spatial_median,
        object_median,
        samples,
        minimum,
        points,
    }
}

/// Call `visit` for every node with its number, depth and objects (ascending), children before parents.
///
/// A node's objects are those of the leaves below it, which are all that the builder knew there.
pub fn for_each_node(tree: &Tree, mut visit: impl FnMut(u32, u32, &[u32])) {
    walk(tree, 0, 0, &mut visit);
}

fn walk(tree: &Tree, node: u32, depth: u32, visit: &mut impl FnMut(u32, u32, &[u32])) -> Vec<u32> {
    let mut objects = match tree.nodes[node as usize].kind() {
        NodeKind::Leaf { first, count } => tree.objects(first, count).to_vec(),
        NodeKind::Inner { left, .. } => {
            let mut objects = walk(tree, left, depth + 1, visit);
            objects.extend(walk(tree, left + 1, depth + 1, visit));
            objects
        }
    };
    // Two sorted runs: this sort merges.
    objects.sort();
    objects.dedup();
    visit(node, depth, &objects);
    objects
}
