//! A run of this kind on one screen.

use super::Assumptions;
use super::names::Broken;
use super::tables::{OfSet, value};
use crate::report::means::arithmetic;
use crate::report::table::{Cell, Column, Table};

/// The main figures of every set.
pub fn table(run: &Assumptions) -> Table {
    let columns = vec![
        Column::left("rays", "rays"),
        Column::left("breaks", "breaks"),
        Column::right("C", "c"),
        Column::right("nodes ×/÷", "scatter"),
        Column::right("τ", "tau"),
        Column::right("regret, %", "regret"),
    ];
    let row = |of: OfSet| {
        let [_, mean, _] = of.range(|row| row.c);
        vec![
            Cell::Text(of.set.to_owned()),
            Cell::Text(Broken::of(&run.bias, of.set).words()),
            value(mean, 2),
            value(of.scatter(), 2),
            value(arithmetic(&of.taus()), 2),
            value(of.regret().0, 1),
        ]
    };
    Table {
        caption: "Tree cost C counted over predicted: geometric mean over all trees. Nodes ×/÷: scatter of single nodes. \
                  τ: rank correlation of the strategies' costs predicted and counted, mean over the scenes. Regret: what the tree \
                  predicted to be cheapest costs above the cheapest, mean over the scenes."
            .to_owned(),
        columns,
        keys: 1,
        rows: OfSet::all(run).into_iter().map(row).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::records::{BiasRecord, OrderRecord};

    #[test]
    fn the_screen_holds_the_widest_row() {
        let rays = "sphere-hemisphere:nearest".to_owned();
        let cell = "spd:a:1".to_owned();
        let bias = BiasRecord {
            cell: cell.clone(),
            scene: cell.clone(),
            strategy: "sah".into(),
            rays: rays.clone(),
            uniform: false,
            inside: 0.5,
            stopped: 0.5,
            entered: 100,
            visits: Some(100.5),
            n_k: Some(100.5),
            n_b: Some(100.5),
            n_t: Some(100.5),
            c: Some(100.5),
            judged: 3,
            spread: Some(3.0),
            rank_correlation: Some(-0.5),
        };
        let order = OrderRecord {
            scene: cell,
            rays,
            metric: "area".into(),
            trees: 2,
            tau: Some(-1.0),
            right: 0,
            wrong: 1,
            tied: 0,
            predicted_best: "sah".into(),
            counted_best: "object-median".into(),
            regret: Some(20.0),
        };
        let run = Assumptions {
            bias: vec![bias],
            groups: Vec::new(),
            visits: Vec::new(),
            orders: vec![order],
            others: Vec::new(),
            metrics: Vec::new(),
            exact: Vec::new(),
        };
        let table = table(&run);
        assert!(table.fits(100), "{}", table.to_text(100));
        assert!(
            table
                .to_text(100)
                .contains("not uniform + begin inside + stopped")
        );
    }
}
