//! Where the greedy choice loses: the reference takes the best plane at each node, not the best tree.

use super::part::{Measure, Part, REFERENCE};
use super::tables::change;
use crate::report::number::percent_above;
use crate::report::table::{Cell, Column, Table};
pub use crate::report::tables::EQUAL;

/// A tree that is predicted, counted or traced at less cost than the reference's.
pub struct Better<'r> {
    /// Over this scene.
    pub scene: &'r str,
    /// By this strategy.
    pub strategy: &'r str,
    /// Per cent above the reference by each of [`Measure::COSTS`].
    pub percent: [Option<f64>; 3],
}

/// Every tree that costs less than the reference's by some measure, in the order of the run.
pub fn better<'r>(part: &Part<'r>) -> Vec<Better<'r>> {
    let mut found = Vec::new();
    for &scene in &part.scenes {
        for &strategy in &part.strategies {
            let of = |measure| {
                part.ratio(measure, scene, strategy, REFERENCE)
                    .map(percent_above)
            };
            let percent = Measure::COSTS.map(of);
            if percent.iter().flatten().any(|&percent| percent < -EQUAL) {
                found.push(Better {
                    scene,
                    strategy,
                    percent,
                });
            }
        }
    }
    found
}

/// The same as a table.
pub fn table(part: &Part) -> Table {
    let row = |better: &Better| {
        let names = [better.scene, better.strategy].map(|name| Cell::Text(name.to_owned()));
        let costs = better
            .percent
            .map(|percent| percent.map_or(Cell::Missing, change));
        names.into_iter().chain(costs).collect()
    };
    Table {
        caption: format!(
            "Where the best plane at every node does not make the best tree, stop {}: trees of less cost than {REFERENCE}'s, by \
             whichever measure, in per cent above (+) or below (−) it. Predicted from surface areas, counted on isotropic \
             lines, and of the traced rays of the picture.",
            part.stop
        ),
        columns: vec![
            Column::left("scene", "scene"),
            Column::left("strategy", "strategy"),
            Column::right("C predicted", "c_predicted_pct"),
            Column::right("C counted", "c_counted_pct"),
            Column::right("C of traced rays", "c_traced_pct"),
        ],
        keys: 2,
        rows: better(part).iter().map(row).collect(),
    }
}
