//! Metrics that give up an assumption, beside the surface area metric: is it they that the counts agree with?

use crate::cost::CostModel;
use crate::kd::expect::{Expected, Metric, Parts};
use crate::kd::{Ask, Tree};
use crate::rays::{LineLaw, Source};
use crate::study::hits::cell::CellPlan;
use crate::study::ray_sets::{Rays, RaysOf};
use crate::study::records::MetricRecord;
use crate::tracer::RayKind;

use super::visits::Visits;

/// The metrics that are compared, the surface area's own first; rays that remember what they tested are
/// [`mailbox`](super::mailbox)'s.
pub const METRICS: [Metric; 5] = [
    Metric::Area,
    Metric::Occlusion,
    Metric::Interior,
    Metric::InteriorOcclusion,
    Metric::Surface,
];

/// The metric whose rays begin and end most like these.
pub fn suited(rays: RaysOf) -> Metric {
    let inside = |stopped: bool| {
        if stopped {
            Metric::InteriorOcclusion
        } else {
            Metric::Interior
        }
    };
    let stopped = rays.ask() != Ask::All;
    match rays {
        RaysOf::Traced(RayKind::Shadow | RayKind::Secondary) => Metric::Surface,
        RaysOf::Source(Source::Objects, _) if stopped => Metric::Surface,
        RaysOf::Source(
            Source::Objects | Source::Law(LineLaw::VolumeRay | LineLaw::VolumeSegment),
            _,
        ) => inside(stopped),
        _ if stopped => Metric::Occlusion,
        _ => Metric::Area,
    }
}

/// What each metric expects of a ray in a tree, in the order of [`METRICS`].
pub fn expected(tree: &Tree, parts: &Parts) -> Vec<Expected> {
    let of = |metric: &Metric| metric.expected(tree, parts);
    METRICS.iter().map(of).collect()
}

/// Tree cost of what is expected.
pub fn cost(model: CostModel, e: Expected) -> f64 {
    model.cost(e.n_k, e.n_b, e.n_t)
}

/// The rows of `metrics.csv` of a tree and a set of rays; none where no ray enters the root.
pub fn records(
    plan: &CellPlan<'_>,
    rays: &Rays,
    visits: &Visits,
    expected: &[Expected],
) -> Vec<MetricRecord> {
    let entered = visits.entered() as f64;
    if entered == 0.0 {
        return Vec::new();
    }
    let c_counted = visits.costs.iter().sum::<f64>() / entered;
    let row = |(&metric, &e): (&Metric, &Expected)| {
        let c = cost(plan.rules.cost, e);
        MetricRecord {
            scene: plan.scene.name.clone(),
            strategy: plan.rules.strategy.name(),
            rays: rays.of.to_string(),
            metric: metric.name().into(),
            suited: suited(rays.of) == metric,
            n_k: e.n_k,
            n_b: e.n_b,
            n_t: e.n_t,
            c,
            c_counted,
            ratio: (c > 0.0).then(|| c_counted / c),
        }
    };
    METRICS.iter().zip(expected).map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_metric_that_suits_begins_and_ends_as_the_rays_do() {
        for (rays, metric) in [
            ("lines", Metric::Area),
            ("beam", Metric::Area),
            ("eye:nearest", Metric::Occlusion),
            ("primary", Metric::Occlusion),
            ("volume-ray", Metric::Interior),
            ("objects", Metric::Interior),
            ("volume-segment:any", Metric::InteriorOcclusion),
            ("objects:nearest", Metric::Surface),
            ("shadow", Metric::Surface),
        ] {
            assert_eq!(suited(rays.parse().expect(rays)), metric, "{rays}");
        }
    }
}
