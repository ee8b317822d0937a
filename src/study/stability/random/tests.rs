use super::*;
use crate::cost::CostModel;
use crate::kd::{NodeKind, Rules, StopRule, Strategy, build_objects};

fn scene_and_tree(name: &str) -> (Scene, Tree) {
    let scene = Scene::load(name).unwrap();
    let rules = Rules {
        strategy: Strategy::Sah,
        stop: StopRule::Objects {
            limit: 2,
            depth: Some(12),
        },
        cost: CostModel::WALD_HAVRAN,
        clipped: false,
    };
    let tree = build_objects(&scene.objects, &scene.bounds, scene.world, &rules);
    (scene, tree)
}

/// f64 errs in ties alone, the padded kernel misses nothing, and the unpadded one does: the aim is good.
#[test]
fn a_small_run_is_right() {
    let (scene, tree) = scene_and_tree("spd:tetra:3");
    let bench = Bench {
        scene: &scene,
        tree: &tree,
        strategy: "sah".into(),
        seed: 1,
    };
    let mut missed = 0;
    for against in [Against::Box, Against::Triangle] {
        for aimed in [false, true] {
            let judge = |kernel| bench.judge(kernel, against, aimed, 20_000).unwrap().0;
            let wide = judge(Kernel::F64);
            assert!(wide.cases >= 20_000 && wide.hits > 100, "{wide:?}");
            assert_eq!((wide.wrong, wide.missed), (0, 0), "{wide:?}");
            assert_eq!(wide.ties > 100, aimed, "{wide:?}");
            assert_eq!(judge(Kernel::F64), wide);
            if against == Against::Box {
                let padded = judge(Kernel::F32Padded);
                assert_eq!(padded.missed + padded.tied_missed, 0, "{padded:?}");
                let narrow = judge(Kernel::F32);
                missed += narrow.missed + narrow.tied_missed;
            }
        }
    }
    assert!(missed > 100, "{missed}");
}

/// A tree whose planes were moved after its boxes were made is caught: boxes and planes must agree.
#[test]
fn a_wrong_plane_is_caught() {
    let (scene, mut tree) = scene_and_tree("simple:soup:60");
    if let NodeKind::Inner { axis, split, left } = tree.nodes[0].kind() {
        tree.nodes[0] = crate::kd::Node::inner(axis, split + 0.05, left);
    }
    let bench = Bench {
        scene: &scene,
        tree: &tree,
        strategy: "sah".into(),
        seed: 1,
    };
    let row = bench
        .judge(Kernel::F64, Against::Box, false, 20_000)
        .unwrap()
        .0;
    assert!(row.wrong > 0 && row.missed > 0, "{row:?}");
    // So are the triangles of leaves that it makes the traversal pass by.
    let row = bench
        .judge(Kernel::F64, Against::Triangle, false, 20_000)
        .unwrap()
        .0;
    assert!(row.wrong == 0 && row.missed > 0, "{row:?}");
}
