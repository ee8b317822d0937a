//! The same tree for any number of threads, wherever nodes begin to be shared.

use proptest::prelude::{ProptestConfig, any, prop_assert_eq, proptest};

use super::*;

const STOPS: [&str; 6] = [
    "cost-gain",
    "automatic",
    "objects:2:12",
    "cost-k:0.5",
    "depth:6",
    "octree:3:6",
];

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, failure_persistence: None, ..ProptestConfig::default() })]
    #[test]
    fn threads_do_not_change_a_tree(
        seed in any::<u64>(),
        n in 1_usize..300,
        copies in 1_usize..4,
        gridded in any::<bool>(),
        clipped in any::<bool>(),
        grain in 1_usize..100,
        stop in 0..STOPS.len(),
    ) {
        let mut objects = Numbers(seed).triangles(n, gridded);
        objects.triangles = objects.triangles.repeat(copies);
        let bounds = objects.bounds();
        let world = world(&bounds);
        let bins = [Strategy::SahBins(16)];
        for strategy in Strategy::ALL.into_iter().chain(bins) {
            let rules = Rules {
                strategy,
                stop: STOPS[stop].parse().expect("a stop rule"),
                cost: CostModel::WALD_HAVRAN,
                clipped,
            };
            let tree = |grain| {
                let clipping = clipped.then(|| Clipping::new(&objects, &world));
                build_over(&bounds, world, &rules, clipping, strategy.sweeps(), grain)
            };
            let serial = tree(usize::MAX);
            for threads in [1, 2, 3, 5] {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
                let shared = pool.build().expect("threads").install(|| tree(grain));
                prop_assert_eq!(&shared, &serial, "{} on {} threads", strategy, threads);
                // Zeros of either sign are equal, but print apart.
                prop_assert_eq!(format!("{shared:?}"), format!("{serial:?}"));
            }
        }
    }
}

/// As users get it: large enough that the pool is asked.
#[test]
fn large_scenes_are_shared_and_equal() {
    let objects = Numbers(7).triangles(3 * GRAIN, false);
    let bounds = objects.bounds();
    for clipped in [false, true] {
        let rules = Rules {
            strategy: Strategy::Sah,
            stop: "cost-gain".parse().expect("a stop rule"),
            cost: CostModel::WALD_HAVRAN,
            clipped,
        };
        let trees = [1, 2, 3].map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            pool.expect("threads").install(|| {
                let shared = grain(bounds.len()) < usize::MAX;
                assert_eq!(shared, threads > 1);
                build_objects(&objects, &bounds, world(&bounds), &rules)
            })
        });
        assert_eq!(trees[0], trees[1]);
        assert_eq!(trees[0], trees[2]);
    }
}
