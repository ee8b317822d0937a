//! Rows a correct program could have left behind, for the tests of figures and tables.

use statrs::distribution::Binomial;

use super::figure3::quantile;

use super::{Content, Hits, Run};
use crate::study::records::{CellRecord, NodeRecord, StrategyChoiceRecord, Summary};

pub const LINES: u64 = 1 << 20;

/// A cell whose numbers are easy to check by eye.
pub fn cell(scene: &str, strategy: &str, nodes: u64) -> CellRecord {
    CellRecord {
        cell: format!("{scene}-{strategy}"),
        scene: scene.to_owned(),
        objects: 1000,
        strategy: strategy.to_owned(),
        stop: "objects:2:16".to_owned(),
        clipped: false,
        seed: 7,
        lines: LINES,
        pilot_lines: 1 << 16,
        c_k: 1.0,
        c_b: 1.0,
        c_t: 2.0,
        depth: 16,
        inner_nodes: nodes / 2,
        leaves: nodes / 2 + 1,
        empty_leaves: 0,
        references: 2000,
        bytes: 16 * nodes + 8000,
        zero_area_nodes: 0,
        unhit_nodes: 0,
        inner_visits: 10 * LINES,
        leaf_visits: 5 * LINES,
        object_tests: 3 * LINES,
        n_k_predicted: 10.0,
        n_k_counted: 10.002,
        n_k_se: Some(0.004),
        n_b_predicted: 5.0,
        n_b_counted: 4.999,
        n_b_se: Some(0.002),
        n_t_predicted: 3.0,
        n_t_counted: 3.001,
        n_t_se: Some(0.003),
        c_predicted: 21.0,
        c_counted: 21.003,
        c_se: Some(0.01),
        slope: Some(1.0004),
        slope_se: Some(0.0005),
        slope_ols: Some(1.0001),
        slope_ols_se: Some(0.0004),
        free_intercept: Some(0.0),
        free_intercept_se: Some(1e-6),
        free_slope: Some(1.0),
        free_slope_se: Some(5e-4),
        free_p: Some(0.5),
        unexplained: Some(4.2e-6),
        unexplained_expected: Some(4.4e-6),
        max_abs_z: Some(3.2),
        smallest_tail: Some(1e-3),
        slope_p: Some(0.42),
        tail_p: Some(1.0),
        hotelling_p: Some(0.0),
        contrasts: 10,
    }
}

/// Every pairing of so many scenes and strategies.
pub fn cells(scenes: usize, strategies: usize) -> Vec<CellRecord> {
    let name = |j| {
        if j == 0 {
            "sah".to_owned()
        } else {
            format!("some-strategy-{j}")
        }
    };
    let pairs = (0..scenes).flat_map(|i| (0..strategies).map(move |j| (i, j)));
    pairs
        .map(|(i, j)| {
            let mut cell = cell(&format!("spd:scene:{i}"), &name(j), 601);
            cell.slope = Some(1.0004 + 1e-4 * ((7 * i + 3 * j) % 11) as f64);
            cell.c_predicted *= (1 + i + j) as f64;
            cell.c_counted *= (1 + i + j) as f64;
            cell
        })
        .collect()
}

/// The nodes of `cell`: p runs from 1 down to `least`, hits through the quantiles of their law.
pub fn nodes(cell: &CellRecord, count: u64, least: f64) -> Vec<NodeRecord> {
    let lines = cell.lines as f64;
    let node = |i: u64| {
        let p = least.powf(i as f64 / (count - 1).max(1) as f64);
        let share = (0.5 + 0.618_033_988_75 * i as f64).fract();
        let hits = quantile(&Binomial::new(p, cell.lines).unwrap(), cell.lines, share);
        let z = (hits as f64 / lines - p) / (p * (1.0 - p) / lines).sqrt();
        NodeRecord {
            cell: cell.cell.clone(),
            scene: cell.scene.clone(),
            strategy: cell.strategy.clone(),
            node: i,
            depth: 0,
            kind: if i % 2 == 1 { "leaf" } else { "inner" }.to_owned(),
            area: 6.0 * p,
            p,
            hits,
            lines: cell.lines,
            z: (p < 1.0).then_some(z),
            tail: (p < 1.0).then_some(share.min(1.0 - share) * 2.0),
        }
    };
    (0..count).map(node).collect()
}

/// A summary whose figure shows the cell of `scene` and `sah`.
pub fn summary(scene: &str) -> Summary {
    Summary {
        schema: crate::study::records::SCHEMA,
        experiment: "test".to_owned(),
        kind: "hits-vs-area".to_owned(),
        question: "a question".to_owned(),
        seed: 7,
        command: "validate run test.toml".to_owned(),
        stop: Some("objects:2:16".to_owned()),
        interval_level: 0.99,
        family_level: Some(0.99),
        quick: false,
        slope_within: Some(0.002),
        figure_scene: Some(scene.to_owned()),
        figure_strategy: Some("sah".to_owned()),
        verdicts: Vec::new(),
        estimates: Vec::new(),
    }
}

/// What rays of this name make of three strategies: `sah` is predicted the best, `sah-cyclic` is.
pub fn choice(rays: &str) -> StrategyChoiceRecord {
    let (_, ask) = rays.split_once(':').unwrap_or((rays, "all"));
    StrategyChoiceRecord {
        scene: "spd:scene:0".into(),
        stop: "objects:2:16".into(),
        rays: rays.into(),
        ask: ask.into(),
        cast: 1000,
        strategies: 3,
        kendall_tau: Some(0.5),
        predicted: "sah".into(),
        predicted_c_predicted: 100.0,
        predicted_c_counted: 60.0,
        least: "sah-cyclic".into(),
        least_c_predicted: 120.0,
        least_c_counted: 50.0,
    }
}

/// A run of these cells, nothing else of it kept.
pub fn run(cells: Vec<CellRecord>) -> Run {
    Run {
        dir: "data/test".into(),
        summary: summary(&cells[0].scene),
        content: Content::Hits(Hits {
            cells,
            nodes: None,
            bins: None,
            samplers: None,
            choices: None,
            timings: None,
        }),
    }
}
