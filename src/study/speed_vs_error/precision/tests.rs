//! What padding is for, on a small scene.

use super::verdicts::padded;
use super::*;
use crate::cost::CostModel;
use crate::kd::{Rules, Strategy};
use crate::scene::Scene;

/// Rows of a kernel over a soup of 300 triangles.
fn rows(kernel: Kernel) -> Vec<PrecisionRecord> {
    let scene = Scene::load("simple:soup:300").expect("a scene");
    let piece = Piece {
        scene: &scene,
        rules: Rules {
            strategy: Strategy::Sah,
            stop: "objects:2:16".parse().expect("a stop rule"),
            cost: CostModel::WALD_HAVRAN,
            clipped: false,
        },
        seed: 3,
        id: "piece".into(),
    };
    let asked = Precision {
        scenes: vec![scene.name.clone()],
        kernels: vec![kernel],
        offsets: vec![0.0, 30.0],
        lines: 2048,
        rounds: 2,
    };
    measure(&asked, &piece, &()).precision
}

#[test]
fn only_a_padded_kernel_misses_nothing_ties_included() {
    let own = rows(Kernel::F32Padded);
    assert!(padded(&own.iter().collect::<Vec<_>>()).held, "{own:?}");
    // The kernel without padding under the same name: nearly all that it misses is at ties.
    let plain = rows(Kernel::F32).into_iter().map(|row| PrecisionRecord {
        kernel: Kernel::F32Padded.name().into(),
        ..row
    });
    let plain: Vec<_> = plain.collect();
    let verdict = padded(&plain.iter().collect::<Vec<_>>());
    assert!(!verdict.held, "{}", verdict.message);
    let missed = |of: fn(&PrecisionRecord) -> u64| plain.iter().map(of).sum::<u64>();
    let tied = missed(|r| r.tied_missed_visits);
    assert!(tied > 100 && tied < missed(|r| r.tied_visits), "{tied}");
    assert!(10 * missed(|r| r.missed_visits) < tied);
}
