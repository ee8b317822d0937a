//! Which strategy to take for which rays, by areas and by counts.

use crate::stats::{Taken, kendall_tau_b, take_least};

use super::records::{StrategyChoiceRecord, WorkRecord};

/// A row for each scene, stop rule and set of rays, in the order they come in. Of trees of the same cost the first is taken.
pub fn choices(work: &[WorkRecord]) -> Vec<StrategyChoiceRecord> {
    let key = |row: &WorkRecord| (row.scene.clone(), row.stop.clone(), row.rays.clone());
    let mut groups: Vec<Vec<&WorkRecord>> = Vec::new();
    for row in work {
        match groups.iter_mut().find(|group| key(group[0]) == key(row)) {
            Some(group) => group.push(row),
            None => groups.push(vec![row]),
        }
    }
    groups.iter().filter_map(|group| choice(group)).collect()
}

fn choice(trees: &[&WorkRecord]) -> Option<StrategyChoiceRecord> {
    let predicted: Vec<f64> = trees.iter().map(|tree| tree.c_predicted).collect();
    let counted: Vec<f64> = trees.iter().map(|tree| tree.c_counted).collect();
    let Taken {
        taken, cheapest, ..
    } = take_least(&predicted, &counted)?;
    let (chosen, best) = (trees[taken], trees[cheapest]);
    Some(StrategyChoiceRecord {
        scene: chosen.scene.clone(),
        stop: chosen.stop.clone(),
        rays: chosen.rays.clone(),
        ask: chosen.ask.clone(),
        cast: chosen.cast,
        strategies: trees.len() as u64,
        kendall_tau: kendall_tau_b(&predicted, &counted),
        predicted: chosen.strategy.clone(),
        predicted_c_predicted: chosen.c_predicted,
        predicted_c_counted: chosen.c_counted,
        least: best.strategy.clone(),
        least_c_predicted: best.c_predicted,
        least_c_counted: best.c_counted,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tree(rays: &str, strategy: &str, c_predicted: f64, c_counted: f64) -> WorkRecord {
        WorkRecord {
            cell: String::new(),
            scene: "s".into(),
            objects: 1,
            strategy: strategy.into(),
            stop: "cost-gain".into(),
            rays: rays.into(),
            ask: "nearest".into(),
            cast: 10,
            entered: 10,
            complete: true,
            hits: 0,
            inner_visits: 0,
            leaf_visits: 0,
            object_tests: 0,
            n_k_predicted: 0.0,
            n_k_counted: 0.0,
            n_k_se: None,
            n_b_predicted: 0.0,
            n_b_counted: 0.0,
            n_b_se: None,
            n_t_predicted: 0.0,
            n_t_counted: 0.0,
            n_t_se: None,
            c_predicted,
            c_counted,
            c_se: None,
        }
    }

    #[test]
    fn each_set_of_rays_has_its_choice() {
        let rows = [
            tree("lines", "a", 2.0, 2.0),
            tree("own", "a", 2.0, 1.0),
            tree("lines", "b", 1.0, 1.0),
            tree("own", "b", 1.0, 1.5),
            tree("lines", "c", 3.0, 3.0),
            tree("own", "c", 3.0, 3.5),
        ];
        let [lines, own] = &choices(&rows)[..] else {
            panic!("two sets");
        };
        assert_eq!(
            (lines.rays.as_str(), lines.kendall_tau),
            ("lines", Some(1.0))
        );
        assert_eq!((lines.predicted.as_str(), lines.least.as_str()), ("b", "b"));
        assert_eq!((own.predicted.as_str(), own.least.as_str()), ("b", "a"));
        assert_eq!((own.predicted_c_counted, own.least_c_counted), (1.5, 1.0));
        assert_eq!((own.least_c_predicted, own.strategies), (2.0, 3));
        // Two pairs of three agree.
        assert!((own.kendall_tau.expect("ordered") - 1.0 / 3.0).abs() < 1e-15);
    }
}
