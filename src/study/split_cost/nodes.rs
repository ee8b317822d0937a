//! All inner nodes of a tree: where the split cost is least on each axis, and what the medians cost.

use crate::geom::{Aabb, Axis};
use crate::kd::curve::{CurvePoint, SplitCurve, for_each_node, split_curve};
use crate::kd::{StopRule, Tree};
use crate::scene::Scene;
use crate::stats::quantile_of_sorted;
use crate::study::AXES;
use crate::study::records::{CurveNodeRecord, CurveRecord, MedianRecord};

use super::asked::SplitCost;

/// What is found at the nodes of a tree.
pub struct AtNodes {
    /// Rows of `medians.csv`.
    pub medians: Vec<MedianRecord>,
    /// Rows of `curve-nodes.csv`.
    pub drawn: Vec<CurveNodeRecord>,
    /// Rows of `curves.csv`.
    pub curves: Vec<CurveRecord>,
}

/// Fewest objects of the classes of nodes by size; the first is of all.
const CLASSES: [(u64, Option<u64>); 5] = [
    (2, None),
    (2, Some(7)),
    (8, Some(63)),
    (64, Some(511)),
    (512, None),
];

/// Look at all inner nodes of at least two objects; keep the curves of those of these ranks by area.
pub fn look(scene: &Scene, tree: &Tree, asked: &SplitCost, ranks: &[u32]) -> AtNodes {
    let wanted = by_rank(tree, ranks);
    let mut seen = Vec::new();
    let (mut drawn, mut curves) = (Vec::new(), Vec::new());
    for_each_node(tree, |node, depth, objects| {
        if tree.nodes[node as usize].is_leaf() || objects.len() < 2 {
            return;
        }
        let cell = &tree.boxes[node as usize];
        let bounds: Vec<Aabb> = objects.iter().map(|&i| scene.bounds[i as usize]).collect();
        for axis in 0..3 {
            if cell.extent()[axis] == 0.0 {
                continue;
            }
            // Where each object counts once, the cost jumps at the centres.
            let clip = |b: &Aabb| Aabb::new(b.lo.max(cell.lo), b.hi.min(cell.hi));
            let centres: Vec<f64> = bounds.iter().map(|b| clip(b).centre()[axis]).collect();
            let curve = split_curve(&bounds, cell, axis, asked.samples, &centres);
            seen.extend(Seen::new(&curve, axis, objects.len() as u64));
            for &(rank, number) in &wanted {
                if number == node {
                    let place = Place {
                        scene: &scene.name,
                        rank,
                        cell,
                        axis,
                    };
                    drawn.extend(place.node(&curve, (node, depth), objects.len()));
                    // Where there are no bounds there are no points: positions a picture needs besides.
                    let grid = (1..GRID).map(|i| f64::from(i) / f64::from(GRID));
                    let (lo, side) = (cell.lo[axis], cell.extent()[axis]);
                    let grid: Vec<f64> = grid.map(|b| lo + b * side).collect();
                    let curve = split_curve(&bounds, cell, axis, asked.samples, &grid);
                    curves.extend(place.points(&curve));
                }
            }
        }
    });
    drawn.sort_by(|a, b| (a.rank, &a.axis).cmp(&(b.rank, &b.axis)));
    curves.sort_by(|a, b| (a.rank, &a.axis).cmp(&(b.rank, &b.axis)));
    AtNodes {
        medians: summarise(&scene.name, asked.stop, &seen),
        drawn,
        curves,
    }
}

/// The numbers of the inner nodes of these ranks by area; ranks beyond the last, of which the user is told, are left out.
fn by_rank(tree: &Tree, ranks: &[u32]) -> Vec<(u32, u32)> {
    let mut inner: Vec<usize> = (0..tree.nodes.len())
        .filter(|&i| !tree.nodes[i].is_leaf())
        .collect();
    let area = |i: usize| tree.boxes[i].surface_area();
    inner.sort_by(|&a, &b| area(b).total_cmp(&area(a)).then(a.cmp(&b)));
    let number = |&rank: &u32| Some((rank, *inner.get(rank as usize - 1)? as u32));
    ranks.iter().filter_map(number).collect()
}

/// What one node shows on one axis, of planes strictly inside it.
struct Seen {
    axis: Axis,
    objects: u64,
    between: bool,
    between_centres: bool,
    between_excess: f64,
    samples_excess: f64,
    /// f(b_om)/f(b_rm) - 1, and whether theory says 0, where both medians are planes inside the node.
    apart: Option<(f64, Theory)>,
}

/// What theory says of the two medians.
#[derive(Clone, Copy, PartialEq)]
enum Theory {
    /// Nothing straddles, half of the objects on either side of the object median: equal.
    Equal,
    /// Nothing straddles, but the object median does not part the objects evenly.
    Uneven,
    /// An object straddles a median.
    Straddled,
}

/// Costs this near are equal.
const ROUNDING: f64 = 1e-12;

impl Seen {
    fn new(curve: &SplitCurve, axis: Axis, objects: u64) -> Option<Self> {
        let medians = curve.medians()?;
        let least = |value: fn(&CurvePoint) -> f64, taken: &dyn Fn(f64) -> bool| {
            let taken = curve.inside().filter(|p| taken(p.position));
            taken.map(value).min_by(f64::total_cmp)
        };
        let f = |p: &CurvePoint| p.f;
        let by_centres = |p: &CurvePoint| p.f_centres;
        let (best, best_centres) = (least(f, &|_| true)?, least(by_centres, &|_| true)?);
        let excess = |found: Option<f64>| found.map_or(f64::INFINITY, |found| found / best - 1.0);
        let between = |s: f64| medians.contains(&s);
        let between_excess = excess(least(f, &between));
        let centres_excess =
            least(by_centres, &between).map_or(f64::INFINITY, |found| found / best_centres - 1.0);
        Some(Self {
            axis,
            objects,
            between: between_excess <= ROUNDING,
            between_centres: centres_excess <= ROUNDING,
            between_excess,
            samples_excess: excess(least(f, &|s| curve.samples.contains(&s))),
            apart: apart(curve, objects as usize),
        })
    }
}

/// How far apart the costs of the medians are.
fn apart(curve: &SplitCurve, n: usize) -> Option<(f64, Theory)> {
    let at = |s: f64| curve.inside().find(|p| p.position == s);
    let (spatial, object) = (at(curve.spatial_median)?, at(curve.object_median?)?);
    let straddlers = |p: &CurvePoint| p.left + p.right - n;
    let theory = if straddlers(spatial) + straddlers(object) > 0 {
        Theory::Straddled
    } else if object.left == object.right {
        Theory::Equal
    } else {
        Theory::Uneven
    };
    Some((object.f / spatial.f - 1.0, theory))
}

fn summarise(scene: &str, stop: StopRule, seen: &[Seen]) -> Vec<MedianRecord> {
    let axes = (0..3)
        .map(|axis| (AXES[axis], Some(axis)))
        .chain([("all", None)]);
    let mut rows = Vec::new();
    for (name, axis) in axes {
        for (lo, hi) in CLASSES {
            let sized = |s: &&Seen| lo <= s.objects && hi.is_none_or(|hi| s.objects <= hi);
            let own: Vec<&Seen> = seen
                .iter()
                .filter(|s| axis.is_none_or(|axis| axis == s.axis))
                .filter(sized)
                .collect();
            let count = |test: fn(&Seen) -> bool| own.iter().filter(|s| test(s)).count() as u64;
            let mean = |value: fn(&Seen) -> f64| {
                let finite: Vec<f64> = own
                    .iter()
                    .map(|s| value(s))
                    .filter(|v| v.is_finite())
                    .collect();
                (!finite.is_empty()).then(|| finite.iter().sum::<f64>() / finite.len() as f64)
            };
            let apart = |wanted: Theory| {
                let known = own.iter().filter_map(|s| s.apart);
                let mut known: Vec<f64> = known.filter(|a| a.1 == wanted).map(|a| a.0).collect();
                known.sort_by(f64::total_cmp);
                known
            };
            let (even, straddled) = (apart(Theory::Equal), apart(Theory::Straddled));
            let q = |share: f64| quantile_of_sorted(&straddled, share);
            rows.push(MedianRecord {
                scene: scene.into(),
                stop: stop.to_string(),
                axis: name.into(),
                objects_lo: lo,
                objects_hi: hi,
                nodes: own.len() as u64,
                between: count(|s| s.between),
                between_centres: count(|s| s.between_centres),
                between_excess_mean: mean(|s| s.between_excess),
                samples_excess_mean: mean(|s| s.samples_excess),
                even: even.len() as u64,
                even_apart: even.iter().map(|a| a.abs()).reduce(f64::max),
                straddled: straddled.len() as u64,
                apart_q05: q(0.05),
                apart_q25: q(0.25),
                apart_q50: q(0.5),
                apart_q75: q(0.75),
                apart_q95: q(0.95),
            });
        }
    }
    rows
}

/// One axis of one node that is drawn.
struct Place<'p> {
    scene: &'p str,
    rank: u32,
    cell: &'p Aabb,
    axis: Axis,
}

/// Points of a curve that are kept, about.
const POINTS: usize = 2000;

/// Equal parts of a node at whose ends there are points in any case.
const GRID: u32 = 256;

impl Place<'_> {
    /// A position as b, 0 to 1 across the node.
    fn b(&self, position: f64) -> f64 {
        (position - self.cell.lo[self.axis]) / self.cell.extent()[self.axis]
    }

    fn node(
        &self,
        curve: &SplitCurve,
        (node, depth): (u32, u32),
        n: usize,
    ) -> Option<CurveNodeRecord> {
        let least = curve.inside().min_by(|a, b| a.f.total_cmp(&b.f))?;
        Some(CurveNodeRecord {
            scene: self.scene.into(),
            rank: self.rank.into(),
            node: node.into(),
            depth: depth.into(),
            axis: AXES[self.axis].into(),
            objects: n as u64,
            object_median: self.b(curve.object_median?),
            minimum: self.b(least.position),
            minimum_f: least.f,
        })
    }

    fn points(&self, curve: &SplitCurve) -> Vec<CurveRecord> {
        let stride = curve.points.len().div_ceil(POINTS).max(1);
        let sample = |p: &CurvePoint| curve.samples.contains(&p.position);
        let kept = curve.points.iter().enumerate();
        let kept = kept.filter(|(i, p)| i % stride == 0 || sample(p));
        kept.map(|(_, p)| CurveRecord {
            scene: self.scene.into(),
            rank: self.rank.into(),
            axis: AXES[self.axis].into(),
            b: self.b(p.position),
            left: p.left as u64,
            right: p.right as u64,
            f: p.f,
            f_centres: p.f_centres,
            sample: sample(p),
        })
        .collect()
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    /// Boxes in the unit cube, from lo to hi on x.
    fn slabs(spans: &[(f64, f64)]) -> Vec<Aabb> {
        let slab = |&(lo, hi): &(f64, f64)| Aabb::new([lo, 0.0, 0.0].into(), [hi, 1.0, 1.0].into());
        spans.iter().map(slab).collect()
    }

    const CUBE: Aabb = Aabb::new(DVec3::ZERO, DVec3::ONE);

    fn curve(spans: &[(f64, f64)]) -> SplitCurve {
        let slabs = slabs(spans);
        let centres: Vec<f64> = slabs.iter().map(|b| b.centre().x).collect();
        split_curve(&slabs, &CUBE, 0, 3, &centres)
    }

    fn seen(spans: &[(f64, f64)]) -> Seen {
        Seen::new(&curve(spans), 0, spans.len() as u64).expect("objects")
    }

    #[test]
    fn medians_are_equal_where_nothing_straddles() {
        // b_om = 0.2 lies in a gap, two on either side; so does 1/2.
        let even = seen(&[(0.0, 0.1), (0.1, 0.15), (0.25, 0.3), (0.6, 0.7)]);
        let (apart, theory) = even.apart.expect("both inside");
        assert!(theory == Theory::Equal && apart.abs() < 1e-15, "{apart}");
        // Three: the middle one straddles its own centre.
        let odd = seen(&[(0.0, 0.1), (0.2, 0.3), (0.8, 0.9)]);
        assert!(odd.apart.expect("both inside").1 == Theory::Straddled);
        // Flat: it does not, but lies on one side.
        let flat = seen(&[(0.0, 0.1), (0.2, 0.2), (0.8, 0.9)]);
        assert!(flat.apart.expect("both inside").1 == Theory::Uneven);
    }

    #[test]
    fn straddlers_may_put_the_minimum_outside_the_medians() {
        // Both objects are cut between the medians 0.45 and 1/2; least is the plane that cuts off what is empty, at 0.8.
        let crossed = seen(&[(0.0, 0.6), (0.4, 0.8)]);
        assert!(!crossed.between);
        // SA parts of a cube: (1 + 2b)/3. At 1/2: 2 * 2 * 2/3; at 0.8: 2 * 2.6/3.
        let expected = (8.0 / 3.0) / (5.2 / 3.0) - 1.0;
        let excess = crossed.between_excess;
        assert!((excess - expected).abs() < 1e-12, "{excess} {expected}");
        assert!(seen(&[(0.0, 0.1), (0.1, 0.2), (0.3, 0.4), (0.8, 0.9)]).between);
    }

    #[test]
    fn planes_in_the_faces_are_no_minimum() {
        // A flat object in the node's face at 0, cut off there at 1/3 + 1 tests; f = (1 + 2b) 2/3 + (3 - 2b)/3 inside.
        let spans = [(0.0, 0.0), (0.0, 1.0)];
        let curve = curve(&spans);
        assert_eq!(curve.points[0].position, 0.0);
        assert!((curve.points[0].f - 4.0 / 3.0).abs() < 1e-12);
        let found = seen(&spans);
        assert!(found.between && found.between_centres);
        assert_eq!((found.between_excess, found.samples_excess), (0.0, 0.0));
        let place = Place {
            scene: "x",
            rank: 1,
            cell: &CUBE,
            axis: 0,
        };
        // The object median, (0 + 1/2)/2.
        let drawn = place.node(&curve, (0, 0), 2).expect("planes inside");
        assert_eq!(drawn.minimum, 0.25);
        assert!((drawn.minimum_f - 11.0 / 6.0).abs() < 1e-12);
    }
}
