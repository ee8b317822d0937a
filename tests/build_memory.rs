//! Memory of a build on one thread: bytes a triangle at its height, and allocations, which are not a node's own.
#![allow(clippy::unwrap_used, missing_docs)]

use allocation_counter::{AllocationInfo, measure};
use sahlab::cost::CostModel;
use sahlab::kd::{Rules, Strategy, Tree, build_objects};
use sahlab::scene::Scene;

/// What building the exact-SAH tree of a soup of n triangles allocates on one thread, above the scene and its boxes. A block that
/// grows counts twice while it is moved.
fn built(n: usize, strategy: Strategy, stop: &str, clipped: bool) -> (Tree, AllocationInfo) {
    let scene = Scene::load(&format!("simple:soup:{n}")).unwrap();
    let rules = Rules {
        strategy,
        stop: stop.parse().unwrap(),
        cost: CostModel::WALD_HAVRAN,
        clipped,
    };
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    one.unwrap().install(|| {
        let mut tree = None;
        let info = measure(|| {
            tree = Some(build_objects(
                &scene.objects,
                &scene.bounds,
                scene.world,
                &rules,
            ));
        });
        (tree.unwrap(), info)
    })
}

fn bytes(tree: &Tree) -> usize {
    tree.bytes() + size_of_val(&tree.boxes[..])
}

#[test]
fn a_build_takes_at_most_250_bytes_a_triangle() {
    for n in [100_000, 1_000_000] {
        for clipped in [false, true] {
            let (tree, info) = built(n, Strategy::Sah, "cost-gain", clipped);
            // The finished tree is in it, and alone it is most of it.
            assert!(info.bytes_max as usize >= bytes(&tree));
            assert_eq!(
                info.bytes_current as usize,
                bytes(&tree),
                "nothing is left over"
            );
            let each = info.bytes_max as f64 / n as f64;
            assert!(each <= 250.0, "{n} {clipped}: {each:.1} bytes a triangle");
        }
    }
}

/// The tree of `automatic` has seven nodes a triangle, which are more than that; building adds little to them.
#[test]
fn a_large_tree_is_most_of_its_build() {
    for clipped in [false, true] {
        let (tree, info) = built(100_000, Strategy::Sah, "automatic", clipped);
        let share = info.bytes_max as f64 / bytes(&tree) as f64;
        assert!(share < 1.1, "{clipped}: {share:.3} times the tree");
    }
}

#[test]
fn nodes_allocate_nothing_of_their_own() {
    let strategies = [
        Strategy::Sah,
        Strategy::SahBetweenMedians,
        Strategy::SahBins(16),
        Strategy::ObjectMedian,
    ];
    for strategy in strategies {
        for clipped in [false, true] {
            let counts = [1_000, 10_000, 100_000].map(|n| {
                let (tree, info) = built(n, strategy, "objects:4:24", clipped);
                assert!(tree.nodes.len() > n / 4, "{} nodes", tree.nodes.len());
                info.count_total
            });
            // A growing list takes 20 steps for a tenfold: it grows by an eighth. There are at most eight of them.
            for (a, b) in counts.iter().zip(&counts[1..]) {
                assert!(
                    b.saturating_sub(*a) <= 160,
                    "{strategy} {clipped}: {counts:?}"
                );
            }
        }
    }
}
