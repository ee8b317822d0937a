//! Into which order areas put the trees of a scene, and into which order counting puts them.

use crate::stats::{Taken, concordant, kendall_tau_b, take_least};
use crate::study::records::{TreeOrderRecord, WorkRecord};

/// Rows of all stop rules together have this in place of one.
const ALL: &str = "all";

/// The orders of every scene's trees under every set of rays: of each stop rule, and of all together.
pub fn orders(work: &[&WorkRecord]) -> Vec<TreeOrderRecord> {
    let mut records = Vec::new();
    for scene in distinct(work.iter().map(|row| row.scene.as_str())) {
        let own: Vec<&WorkRecord> = work.iter().filter(|r| r.scene == scene).copied().collect();
        let stops = distinct(own.iter().map(|row| row.stop.as_str()));
        for rays in distinct(own.iter().map(|row| row.rays.as_str())) {
            for &stop in stops.iter().chain([&ALL]) {
                let wanted =
                    |row: &&&WorkRecord| row.rays == rays && (stop == ALL || row.stop == stop);
                let trees: Vec<&WorkRecord> = own.iter().filter(wanted).copied().collect();
                records.extend(order(&trees, stop));
            }
        }
    }
    records
}

/// The order of some trees of a scene under a set of rays; `None` without a tree.
fn order(trees: &[&WorkRecord], stop: &str) -> Option<TreeOrderRecord> {
    let predicted: Vec<f64> = trees.iter().map(|row| row.c_predicted).collect();
    let counted: Vec<f64> = trees.iter().map(|row| row.c_counted).collect();
    let pairs = concordant(&predicted, &counted);
    let Taken { taken, regret, .. } = take_least(&predicted, &counted)?;
    let taken = trees[taken];
    Some(TreeOrderRecord {
        scene: taken.scene.clone(),
        rays: taken.rays.clone(),
        stop: stop.into(),
        trees: trees.len() as u64,
        tau: kendall_tau_b(&predicted, &counted),
        pairs: pairs.right + pairs.wrong + pairs.tied,
        pairs_right: pairs.right,
        taken: taken.cell.clone(),
        regret,
    })
}

/// Each name once, in the order of first appearance.
fn distinct<'r>(names: impl Iterator<Item = &'r str>) -> Vec<&'r str> {
    let mut seen = Vec::new();
    for name in names {
        if !seen.contains(&name) {
            seen.push(name);
        }
    }
    seen
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tree(cell: &str, stop: &str, rays: &str, predicted: f64, counted: f64) -> WorkRecord {
        WorkRecord {
            cell: cell.into(),
            scene: "s".into(),
            stop: stop.into(),
            rays: rays.into(),
            c_predicted: predicted,
            c_counted: counted,
            ..WorkRecord::default()
        }
    }

    #[test]
    fn orders_by_hand() {
        let rows = [
            tree("a", "depth:1", "lines", 1.0, 12.0),
            tree("a", "depth:1", "primary", 1.0, 5.0),
            tree("b", "depth:1", "lines", 2.0, 10.0),
            tree("b", "depth:1", "primary", 2.0, 5.0),
            tree("c", "depth:2", "lines", 0.5, 30.0),
            tree("c", "depth:2", "primary", 0.5, 0.0),
        ];
        let found = orders(&rows.iter().collect::<Vec<_>>());
        let told: Vec<_> = found
            .iter()
            .map(|o| {
                (
                    &*o.rays,
                    &*o.stop,
                    o.trees,
                    o.pairs,
                    o.pairs_right,
                    &*o.taken,
                )
            })
            .collect();
        assert_eq!(
            told,
            [
                ("lines", "depth:1", 2, 1, 0, "a"),
                ("lines", "depth:2", 1, 0, 0, "c"),
                ("lines", "all", 3, 3, 0, "c"),
                ("primary", "depth:1", 2, 1, 0, "a"),
                ("primary", "depth:2", 1, 0, 0, "c"),
                ("primary", "all", 3, 3, 2, "c"),
            ]
        );
        let taus: Vec<_> = found.iter().map(|o| o.tau).collect();
        // Two of three pairs are in order and one is tied on one side: 2 / sqrt(3 * 2).
        let tied = 2.0 / 6.0_f64.sqrt();
        assert_eq!(taus, [Some(-1.0), None, Some(-1.0), None, None, Some(tied)]);
        let regrets: Vec<_> = found.iter().filter_map(|o| o.regret).collect();
        let wanted = [12.0 / 10.0 - 1.0, 0.0, 2.0, 0.0, 0.0, 0.0];
        assert_eq!(regrets, wanted);
    }
}
