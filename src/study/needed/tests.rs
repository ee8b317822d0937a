//! The stopping rule on costs of known variance, and on scenes of rare clusters.

use super::*;
use crate::geom::{Objects, Span, Triangle};
use crate::kd::traverse::traverse_line;
use crate::kd::{Rules, StopRule, Strategy, Work, build_objects, predict};
use crate::rays::SurfaceLines;
use crate::scene::Scene;
use glam::DVec3;

const NONE: Rare = Rare { nodes: Vec::new() };

/// Costs of known mean 1 and variance.
fn two_valued(i: u64, rare: u64) -> Option<f64> {
    let r = rare as f64;
    // A hash, so that any stretch of lines is as good as random.
    let hash = i.wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(29);
    let hash = hash.wrapping_mul(0xbf58_476d_1ce4_e5b9) >> 32;
    Some(if hash.is_multiple_of(rare) { r } else { 0.0 })
}

#[test]
fn the_number_follows_variance_and_error() {
    // Mean 1, variance rare - 1.
    for (rare, error) in [(2, 0.01), (2, 0.1), (10, 0.01), (50, 0.02)] {
        let exact = normal_quantile(CONFIDENCE).powi(2) * (rare - 1) as f64 / (error * error);
        let n = needed(error, [1, 1 << 30], &NONE, |i, _| two_valued(i, rare)) as f64;
        let most = if exact < 4096.0 { 2.5 } else { 1.5 };
        assert!(exact < n && n < most * exact, "{n} for {exact}");
    }
}

#[test]
fn lines_that_miss_are_made_up_for() {
    let all = needed(0.001, [1, 1 << 30], &NONE, |i, _| two_valued(i, 2)) as f64;
    let half = needed(0.001, [1, 1 << 30], &NONE, |i, _| {
        two_valued(i / 2, 2).filter(|_| i.is_multiple_of(2))
    });
    let ratio = half as f64 / all;
    assert!((1.8..2.2).contains(&ratio), "{ratio}");
}

#[test]
fn bounds_hold_and_nothing_to_know_takes_what_there_is() {
    assert_eq!(needed(0.01, [100, 1000], &NONE, |_, _| Some(7.0)), 100);
    assert_eq!(needed(0.01, [100, 1000], &NONE, |_, _| Some(0.0)), 100);
    assert_eq!(needed(0.01, [100, 1000], &NONE, |_, _| None), 1000);
    assert_eq!(
        needed(1e-6, [100, 1000], &NONE, |i, _| Some((i % 2) as f64)),
        1000
    );
}

#[test]
fn the_number_does_not_depend_on_the_threads() {
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    let one = one.expect("a pool");
    let cost = |i, _: &mut Stack| two_valued(i, 7).map(|c| c + 0.1);
    let alone = one.install(|| needed(0.003, [1, 1 << 30], &NONE, cost));
    assert_eq!(needed(0.003, [1, 1 << 30], &NONE, cost), alone);
}

/// Two large triangles and a tiny dense cluster, which hardly a trial line meets and which makes the variance.
#[test]
fn what_the_trial_cannot_have_met_is_reckoned_with() {
    let p = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
    let mut triangles = vec![
        Triangle([p(0.0, 0.0, 0.0), p(1.0, 0.0, 0.1), p(0.0, 1.0, 0.2)]),
        Triangle([p(1.0, 1.0, 1.0), p(0.0, 1.0, 0.9), p(1.0, 0.0, 0.8)]),
    ];
    for i in 0..400 {
        let at = |k: i32| 0.5 + 0.004 * f64::from(i * k % 97) / 97.0;
        let corner = p(at(7), at(31), at(57));
        let near = |x, y, z| corner + 4e-4 * p(x, y, z);
        triangles.push(Triangle([corner, near(1.0, 0.3, 0.2), near(0.1, 1.0, 0.7)]));
    }
    let objects = Objects {
        triangles,
        ..Objects::default()
    };
    let bounds = objects.bounds();
    let world = bounds
        .iter()
        .fold(crate::geom::Aabb::EMPTY, |w, b| w.union(*b));
    let rules = Rules {
        strategy: Strategy::SpatialMedianLongest,
        stop: StopRule::CostGain { depth: None },
        cost: CostModel::WALD_HAVRAN,
        clipped: false,
    };
    let tree = build_objects(&objects, &bounds, world, &rules);
    let prediction = predict(&tree);
    let truth = rules
        .cost
        .cost(prediction.n_k, prediction.n_b, prediction.n_t);
    let rare = Rare::of(&tree, &prediction, rules.cost);
    let lines = |seed| SurfaceLines { world, seed };
    let cost = |seed, i: u64, stack: &mut Stack| {
        let mut work = Work::default();
        for line in lines(seed).range(i..i + 1) {
            traverse_line(&tree, &line, Span::FULL, stack, &mut work);
        }
        work.cost(rules.cost)
    };
    let mut kept = 0;
    for seed in 0..40 {
        let n = needed(0.02, [1024, 1 << 30], &rare, |i, stack| {
            Some(cost(seed, i, stack))
        });
        let mut stack = Stack::default();
        let sum: f64 = (0..n).map(|i| cost(seed, i, &mut stack)).sum();
        kept += u32::from((sum / n as f64 / truth - 1.0).abs() <= 0.02);
    }
    // At 95 % each, fewer than 34 of 40 come with a chance below 1 %.
    assert!(kept >= 34, "{kept} of 40");
    // A usual scene loses nothing by it.
    let soup = Scene::load("simple:soup:500").expect("a scene");
    let tree = build_objects(&soup.objects, &soup.bounds, soup.world, &rules);
    let usual = Rare::of(&tree, &predict(&tree), rules.cost);
    let c = rules.cost.cost(predict(&tree).n_k, 0.0, predict(&tree).n_t);
    assert!(usual.variance(16_384.0) < 0.02 * c * c);
}
