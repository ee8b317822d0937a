//! The choice of a node's plane: the stop rule is asked, then the strategy, then the stop rule again.

use crate::geom::{Aabb, Axis};
use crate::kd::Rules;
use crate::kd::events::Event;
use crate::kd::medians::{clipped_centre, object_median, spatial_median};
use crate::kd::planes::{Fractions, Planes};
use crate::kd::split::{Coster, Split};
use crate::kd::strategy::{AxisOrder, Positions};
use crate::kd::sweep::Sweep;
use crate::kd::tally::Tally;

use super::axes::each_axis;
use super::builder::{Frame, Path};

/// A node to be cut or not.
pub(super) struct Candidate<'a> {
    pub frame: &'a Frame<'a>,
    pub bounds: &'a Aabb,
    /// The objects in it.
    pub objects: &'a [u32],
    /// Boxes of objects, by their numbers, where they are read.
    pub boxes: &'a [Aabb],
    /// The events in it by axis, where the strategy sweeps.
    pub events: Option<[&'a [Event]; 3]>,
}

/// What the search for a plane on one axis needs besides the node: scratch.
pub(super) struct Search {
    axis: Axis,
    /// Counts at named planes, where the strategy does not sweep.
    tally: Tally,
    /// Named planes, where it does.
    named: Vec<f64>,
    /// Centres of clipped bounds.
    centres: Vec<f64>,
}

impl Search {
    pub fn new(axis: Axis, fractions: &Fractions) -> Self {
        Self {
            axis,
            tally: Tally::new(fractions),
            named: Vec::new(),
            centres: Vec::new(),
        }
    }
}

impl Candidate<'_> {
    /// The plane to cut with and the patience left below it, or `None` for a leaf.
    pub fn choose(&self, path: Path, searches: &mut [Search; 3]) -> Option<(Split, usize)> {
        let Rules {
            strategy,
            stop,
            cost,
            ..
        } = *self.frame.rules;
        let n = self.objects.len();
        let share = self.bounds.surface_area() / self.frame.root_area;
        if path.depth >= self.frame.depth_bound || stop.stops_at(path.depth, n, share) {
            return None;
        }
        let (order, _) = strategy.parts();
        let split = if order == AxisOrder::All {
            let shared = n >= self.frame.grain;
            let found = each_axis(shared, searches.each_mut(), |search| self.cheapest(search));
            // Of equals the first axis's.
            let cheaper = |a: Split, b: Split| if b.cost < a.cost { b } else { a };
            found.into_iter().flatten().reduce(cheaper)
        } else {
            let mut axes = order.axes(path.depth, self.bounds).into_iter();
            axes.find_map(|axis| self.cheapest(&mut searches[axis]))
        }?;
        let patience = stop.cuts(split.cost, cost.leaf(n as f64), path.patience)?;
        Some((split, patience))
    }

    /// The strategy's cheapest plane on the search's axis.
    fn cheapest(&self, search: &mut Search) -> Option<Split> {
        let axis = search.axis;
        let (_, positions) = self.frame.rules.strategy.parts();
        let ends = self.ends(axis, positions, &mut search.centres)?;
        let planes = Planes::new(ends.0, ends.1, &self.frame.fractions);
        let n = self.objects.len();
        let Rules { stop, cost, .. } = self.frame.rules;
        let coster = Coster::new(axis, self.bounds, n, cost, stop.takes_useless_planes());
        let Some(events) = self.events else {
            for &object in self.objects {
                let b = &self.boxes[object as usize];
                search.tally.add(&planes, b.lo[axis], b.hi[axis]);
            }
            return search.tally.cheapest(&planes, &coster, n);
        };
        // Medians that meet, and planes between nearly equal positions, are one candidate.
        search.named.clear();
        search.named.extend(planes.iter());
        search.named.dedup();
        let window = positions.are_bounds().then_some(ends);
        let events = events[axis];
        Sweep { events, n }.cheapest(&coster, window, &search.named)
    }

    /// Between which positions on an axis the strategy's candidates are.
    fn ends(&self, axis: Axis, positions: Positions, centres: &mut Vec<f64>) -> Option<(f64, f64)> {
        let bounds = self.bounds;
        let spatial = spatial_median(bounds, axis);
        let mut medians = || {
            self.object_median(axis, centres)
                .map(|object| (spatial.min(object), spatial.max(object)))
        };
        match positions {
            Positions::AllBounds | Positions::Bins(_) => Some((bounds.lo[axis], bounds.hi[axis])),
            Positions::SpatialMedian => Some((spatial, spatial)),
            Positions::ObjectMedian => self.object_median(axis, centres).map(|s| (s, s)),
            Positions::MedianMidpoint => medians().map(|(a, b)| {
                let s = 0.5 * a + 0.5 * b;
                (s, s)
            }),
            Positions::BoundsBetweenMedians | Positions::Samples(_) => medians(),
        }
    }

    /// Median of the centres of the objects' bounds clipped to the node.
    fn object_median(&self, axis: Axis, centres: &mut Vec<f64>) -> Option<f64> {
        let centre =
            |&object: &u32| clipped_centre(&self.boxes[object as usize], self.bounds, axis);
        centres.clear();
        centres.extend(self.objects.iter().map(centre));
        object_median(centres)
    }
}
