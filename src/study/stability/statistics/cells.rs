//! Whole cells (a tree, its lines, every estimate of them) over scenes whose areas leave little to estimate.

use glam::DVec3;
use serde::Serialize;

use super::case;
use crate::cost::CostModel;
use crate::geom::{Objects, Triangle};
use crate::kd::{Rules, StopRule, Strategy};
use crate::scene::Scene;
use crate::study::LineRule;
use crate::study::hits::cell::{CellPlan, CellResult, measure};
use crate::study::lines::FEWEST_LINES;
use crate::study::stability::case::{Case, Finding};

/// The cases of whole cells.
pub(super) fn cases() -> Vec<Case> {
    vec![
        case("tree-of-one-node", "p = 1", || {
            let scene = triangles([(DVec3::ZERO, 1.0)]);
            told(
                &scene,
                OBJECTS_1,
                "1 nodes, 1 take no part; told: nothing; 0 not finite",
            )
        }),
        case("two-nodes-of-equal-area", "no spread of p", || {
            let scene = triangles([(DVec3::ZERO, 1.0), (DVec3::splat(3.0), 1.0)]);
            told(
                &scene,
                StopRule::Depth(1),
                "3 nodes, 1 take no part; told: slope, its error, tail; 0 not finite",
            )
        }),
        case("thousands-of-equal-areas", "ties of p", || {
            let scene = triangles([(DVec3::ZERO, 1.0), (DVec3::splat(3.0), 1.0)]);
            told(
                &scene,
                StopRule::Depth(12),
                "8191 nodes, 1 take no part; told: slope, its error, free line, tail; 0 not finite",
            )
        }),
        case("areas-over-twelve-decades", "weights 1/(p(1-p))", || {
            let nested = (0..=6).map(|decade| (DVec3::ZERO, libm::pow(10.0, -f64::from(decade))));
            told(
                &triangles(nested),
                OBJECTS_1,
                "37 nodes, 1 take no part; told: slope, its error, free line, tail; 0 not finite",
            )
        }),
        case(
            "areas-over-hundreds-of-decades",
            "weights 1/(p(1-p))",
            || {
                let shrinking = [1.0, 1e-30, 1e-60, 1e-90, 1e-120].map(|size| (DVec3::ZERO, size));
                told(
                    &triangles(shrinking),
                    OBJECTS_1,
                    "25 nodes, 2 take no part; told: slope, its error, free line, tail; 0 not finite",
                )
            },
        ),
        case("nodes-of-subnormal-area", "1/p overflows", || {
            let shrinking = [1.0, 1e-156, 1e-157].map(|size| (DVec3::ZERO, size));
            told(
                &triangles(shrinking),
                OBJECTS_1,
                "13 nodes, 9 take no part; told: slope, its error, free line, tail; 0 not finite",
            )
        }),
        case("nodes-of-no-area", "p = 0", || {
            let shrinking = [1.0, 1e-170, 1e-171].map(|size| (DVec3::ZERO, size));
            told(
                &triangles(shrinking),
                OBJECTS_1,
                "13 nodes, 9 take no part; told: slope, its error, free line, tail; 0 not finite",
            )
        }),
        case("flat-world", "volumes of 0", || {
            let flat = (0..64).map(|i| {
                let corner = DVec3::new(f64::from(i % 8), f64::from(i / 8), 0.0);
                Triangle([corner, corner + DVec3::X, corner + DVec3::Y])
            });
            told(
                &scene(flat),
                OBJECTS_1,
                "127 nodes, 1 take no part; told: slope, its error, free line, tail; 0 not finite",
            )
        }),
        case("equal-objects", "no plane", || {
            let same = [(DVec3::ZERO, 1.0); 100];
            told(
                &triangles(same),
                OBJECTS_1,
                "1 nodes, 1 take no part; told: nothing; 0 not finite",
            )
        }),
    ]
}

const OBJECTS_1: StopRule = StopRule::Objects {
    limit: 1,
    depth: Some(40),
};

fn scene(triangles: impl IntoIterator<Item = Triangle>) -> Scene {
    let objects = Objects {
        triangles: triangles.into_iter().collect(),
        ..Objects::default()
    };
    Scene::new("hard", objects, Vec::new()).expect("a scene of ordinary triangles")
}

/// Triangles between the ends of the axes at a corner, of these sizes.
fn triangles(corners: impl IntoIterator<Item = (DVec3, f64)>) -> Scene {
    let axes = [DVec3::X, DVec3::Y, DVec3::Z];
    let triangle = |(corner, size)| Triangle(axes.map(|axis| corner + size * axis));
    scene(corners.into_iter().map(triangle))
}

/// What a cell of the fewest lines tells: of full trees cut at the middles of nodes, else of those cut at objects.
fn told(scene: &Scene, stop: StopRule, expected: &str) -> Finding {
    let rules = Rules {
        strategy: match stop {
            StopRule::Depth(_) => Strategy::SpatialMedian,
            _ => Strategy::Sah,
        },
        stop,
        cost: CostModel::WALD_HAVRAN,
        clipped: false,
    };
    let lines = LineRule::exactly(FEWEST_LINES).expect("enough lines");
    let plans = CellPlan::of_scene(scene, &[rules], 1, lines).into_iter();
    let measured = plans.map(|mut plan| {
        plan.nodes = true;
        measure(&plan, &()).map_or_else(|bug| bug, |(cell, _)| summed_up(&cell))
    });
    Finding::of(expected, measured.collect::<String>())
}

/// How many nodes there are and how many take no part, which estimates there are, and whether all numbers are.
fn summed_up(cell: &CellResult) -> String {
    let record = &cell.record;
    let nodes = cell.nodes.as_deref().unwrap_or_default();
    let untested = nodes.iter().filter(|node| node.tail.is_none()).count();
    let exist = [
        ("slope", record.slope.is_some()),
        ("its error", record.slope_se.is_some()),
        ("free line", record.free_slope.is_some()),
        ("tail", record.smallest_tail.is_some()),
    ];
    let exist: Vec<_> = exist.into_iter().filter(|e| e.1).map(|e| e.0).collect();
    let wrong = not_finite([record]) + not_finite(&cell.bins) + not_finite(nodes);
    format!(
        "{} nodes, {untested} take no part; told: {}; {wrong} not finite",
        nodes.len(),
        if exist.is_empty() {
            "nothing".into()
        } else {
            exist.join(", ")
        },
    )
}

/// Numbers of some rows that are infinite or none.
fn not_finite<T: Serialize>(rows: impl IntoIterator<Item = T>) -> usize {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for row in rows {
        writer.serialize(row).expect("records are flat");
    }
    let bytes = writer.into_inner().expect("writing to memory");
    let text = String::from_utf8_lossy(&bytes);
    let numbers = text
        .split([',', '\n'])
        .filter_map(|field| field.parse::<f64>().ok());
    numbers.filter(|x| !x.is_finite()).count()
}
