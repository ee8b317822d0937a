//! The quick pass over starts and ends finds what the pass that takes positions one by one finds.

use glam::DVec3;
use proptest::prelude::*;

use super::*;
use crate::cost::CostModel;

proptest! {
    /// On a grid, so that bounds coincide and lie in the node's faces; the node is a part of the world, so that events are
    /// missing as they are below a cut.
    #[test]
    fn the_quick_pass_finds_the_first_of_the_cheapest_planes(
        boxes in prop::collection::vec((0_i32..12, 1_i32..8), 1..60),
        (lo, length) in (0_i32..10, 1_i32..12),
        c_b in 0.0..30.0,
    ) {
        let hi = lo + length;
        let bounds: Vec<Aabb> = boxes
            .into_iter()
            .map(|(from, length)| (from, from + length))
            .filter(|&(from, to)| from < hi && to > lo)
            .map(|(from, to)| {
                let corner = |x| DVec3::new(f64::from(x) / 7.0, 0.0, 0.0);
                Aabb::new(corner(from), corner(to) + DVec3::new(0.0, 1.0, 1.0))
            })
            .collect();
        let node = Aabb::new(
            DVec3::new(f64::from(lo) / 7.0, 0.0, 0.0),
            DVec3::new(f64::from(hi) / 7.0, 1.0, 1.0),
        );
        let (from, to) = (node.lo.x, node.hi.x);
        let mut events = sorted_events(&bounds, 0);
        events.retain(|e| (from..=to).contains(&e.position()));
        let cost = CostModel { c_b, ..CostModel::WALD_HAVRAN };
        let n = bounds.len();
        let sweep = Sweep { events: &events, n };
        for keep_useless in [false, true] {
            let coster = Coster::new(0, &node, n, &cost, keep_useless);
            let mut first = None;
            sweep.each(Some((from, to)), &[], |s, left, planar, right| {
                coster.offer(&mut first, s, left, planar, right);
            });
            prop_assert_eq!(sweep.cheapest_bound(&coster, starting(&events)), first);
        }
    }
}
