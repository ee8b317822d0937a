//! Plane searches: how dear their trees are, and how long they take to build.

use crate::kd::{Rules, Strategy, predict};
use crate::study::Watcher;
use crate::study::hits::cell::plant;
use crate::study::identity::digest;
use crate::study::records::{PassTiming, PlaneRecord, Verdict};
use crate::study::timing::{Timing, build_times};

use super::asked::{PlaneBound, Planes, SpeedVsError};
use super::{Found, Piece};

/// Units of progress of a scene: every tree is built once for its cost, and once for its seconds.
pub fn units(asked: &Planes) -> u64 {
    2 * (asked.strategies.len() * asked.clipped.len()) as u64
}

/// Build, audit and time the tree of every search over a scene.
///
/// # Errors
/// If a tree fails its audit.
pub fn measure(asked: &Planes, piece: &Piece<'_>, watcher: &impl Watcher) -> Result<Found, String> {
    let under = |&clipped: &bool| {
        asked.strategies.iter().map(move |&strategy| Rules {
            strategy,
            clipped,
            ..piece.rules
        })
    };
    let rules: Vec<Rules> = asked.clipped.iter().flat_map(under).collect();
    let mut planes = Vec::new();
    for rules in &rules {
        planes.push(row(piece, rules)?);
        watcher.done(1);
    }
    hold_against_the_exact(&mut planes);
    let timing = Timing {
        rounds: asked.builds,
        builds: asked.builds,
        // Nothing is sampled.
        pass_s: 0.0,
    };
    let seconds = build_times(piece.scene, &rules, timing, piece.seed);
    watcher.done(rules.len() as u64);
    let named = |(row, seconds): (&PlaneRecord, PassTiming)| PassTiming {
        cell: row.cell.clone(),
        strategy: row.strategy.clone(),
        ..piece.named(seconds)
    };
    Ok(Found {
        timings: planes.iter().zip(seconds).map(named).collect(),
        planes,
        ..Found::default()
    })
}

/// The row of one search, its C not yet held against the exact ones.
fn row(piece: &Piece<'_>, rules: &Rules) -> Result<PlaneRecord, String> {
    let (tree, _) = plant(piece.scene, rules).map_err(|fault| {
        let clipped = if rules.clipped { ", clipped" } else { "" };
        format!("{}{clipped}: {fault}", rules.strategy)
    })?;
    let expected = predict(&tree);
    let inner = tree.nodes.len() as u64 / 2;
    Ok(PlaneRecord {
        cell: digest(format!("{} {rules:?}", piece.id).as_bytes()),
        scene: piece.scene.name.clone(),
        objects: piece.scene.bounds.len() as u64,
        strategy: rules.strategy.name(),
        clipped: rules.clipped,
        c: rules.cost.cost(expected.n_k, expected.n_b, expected.n_t),
        above: 0.0,
        above_unclipped: 0.0,
        depth: tree.depth as u64,
        inner_nodes: inner,
        leaves: inner + 1,
        references: tree.references.len() as u64,
    })
}

/// Tell of every tree of a scene by how much its C is above the exact search's, with the same clipping and without any.
fn hold_against_the_exact(rows: &mut [PlaneRecord]) {
    let exact = [false, true].map(|clipped| {
        let of =
            |row: &&PlaneRecord| row.strategy == Strategy::Sah.name() && row.clipped == clipped;
        rows.iter().find(of).map(|row| row.c)
    });
    for row in rows {
        // The experiment asks for the exact search, without clipping and wherever it asks for any.
        let above = |exact: Option<f64>| exact.map_or(f64::NAN, |exact| row.c / exact - 1.0);
        (row.above, row.above_unclipped) =
            (above(exact[usize::from(row.clipped)]), above(exact[0]));
    }
}

/// What came of the expectations.
pub fn verdicts(asked: &SpeedVsError, found: &[Found]) -> Vec<Verdict> {
    let rows = || found.iter().flat_map(|f| &f.planes);
    let bound = asked
        .expect
        .planes
        .as_ref()
        .filter(|_| asked.planes.is_some());
    bound
        .map(|bound| near_exact(bound, rows()))
        .into_iter()
        .collect()
}

/// Whether a search is nearly as good as the exact one on every scene.
fn near_exact<'a>(bound: &PlaneBound, rows: impl Iterator<Item = &'a PlaneRecord>) -> Verdict {
    let name = bound.strategy.name();
    let own: Vec<&PlaneRecord> = rows
        .filter(|row| row.strategy == name && !row.clipped)
        .collect();
    let near = own.iter().filter(|row| row.above <= bound.above).count();
    let worst = own.iter().max_by(|a, b| a.above.total_cmp(&b.above));
    let told = worst.map_or_else(String::new, |row| {
        format!("; most: {:+.2} % on {}", 100.0 * row.above, row.scene)
    });
    Verdict {
        name: "planes-near-exact".into(),
        held: !own.is_empty() && near == own.len(),
        message: format!(
            "C of {name} is at most {} % above the exact search's on {near} of {} scenes{told}",
            100.0 * bound.above,
            own.len()
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cost::CostModel;
    use crate::scene::Scene;

    fn found(strategies: &[&str], clipped: &[bool], stop: &str) -> Found {
        let asked = Planes {
            scenes: vec!["simple:soup:60".into()],
            strategies: strategies.iter().map(|s| s.parse().expect(s)).collect(),
            clipped: clipped.to_vec(),
            builds: 2,
        };
        let scene = Scene::load("simple:soup:60").expect("a procedural scene");
        let piece = Piece {
            scene: &scene,
            rules: Rules {
                strategy: Strategy::Sah,
                stop: stop.parse().expect(stop),
                cost: CostModel::WALD_HAVRAN,
                clipped: false,
            },
            seed: 1,
            id: "piece".into(),
        };
        measure(&asked, &piece, &()).expect("the trees pass their audits")
    }

    #[test]
    fn every_search_has_its_row_and_its_seconds() {
        let found = found(
            &["sah", "sah-samples:4", "sah-bins:8"],
            &[false, true],
            "objects:2:16",
        );
        assert_eq!((found.planes.len(), found.timings.len()), (6, 6));
        for (row, seconds) in found.planes.iter().zip(&found.timings) {
            let exact = |clipped: bool| &found.planes[3 * usize::from(clipped)];
            assert_eq!(row.above, row.c / exact(row.clipped).c - 1.0);
            assert_eq!(row.above_unclipped, row.c / exact(false).c - 1.0);
            assert_eq!(
                (&row.cell, &row.strategy),
                (&seconds.cell, &seconds.strategy)
            );
            assert!(seconds.seconds > 0.0 && seconds.what == "build");
            assert!(row.leaves == row.inner_nodes + 1 && row.references >= row.objects);
        }
        assert_eq!((found.planes[0].above, found.planes[3].above), (0.0, 0.0));
        let mut cells: Vec<&String> = found.planes.iter().map(|row| &row.cell).collect();
        cells.sort();
        cells.dedup();
        assert_eq!(cells.len(), 6);
    }

    /// Of whole trees nothing follows from better planes. Of one node it does: the cost is linear between object bounds, and
    /// from a face to the next bound it falls, so no plane is cheaper than the cheapest bound; and a search that looks at more
    /// planes finds one at least as cheap.
    #[test]
    fn one_cut_costs_no_less_by_fewer_planes() {
        for family in ["sah-bins", "sah-samples"] {
            let numbers = if family == "sah-bins" {
                [2, 4, 8, 64]
            } else {
                [1, 3, 7, 63]
            };
            let names = numbers.map(|n| format!("{family}:{n}"));
            let all: Vec<&str> = names.iter().map(String::as_str).chain(["sah"]).collect();
            let found = found(&all, &[false], "objects:1:1");
            let costs: Vec<f64> = found.planes.iter().map(|row| row.c).collect();
            assert!(found.planes.iter().all(|row| row.inner_nodes == 1));
            let [dearest, .., exact] = costs[..] else {
                panic!("five searches")
            };
            // Each looks at the planes of the one before; the exact search at others, but for rounding.
            assert!(
                costs[..4].windows(2).all(|pair| pair[1] <= pair[0]),
                "{costs:?}"
            );
            assert!(
                costs.iter().all(|&c| exact <= c * (1.0 + 1e-12)),
                "{costs:?}"
            );
            assert!(dearest > 1.001 * exact, "{costs:?}");
        }
    }

    #[test]
    fn the_bound_is_judged_on_the_worst_scene() {
        let mut rows = found(&["sah", "sah-bins:2"], &[false], "objects:2:16").planes;
        rows[1].above = 0.02;
        let bound = |above: f64| PlaneBound {
            strategy: Strategy::SahBins(2),
            above,
        };
        assert!(near_exact(&bound(0.03), rows.iter()).held);
        let failed = near_exact(&bound(0.01), rows.iter());
        assert!(
            !failed.held && failed.message.contains("+2.00 % on simple:soup:60"),
            "{}",
            failed.message
        );
        // A search that was not made is not near.
        assert!(!near_exact(&bound(0.03), rows[..1].iter()).held);
    }
}
