//! How well the models predict scenes that they were not fitted to.

use super::super::CostVsWork;
use crate::report::number::counted;
use crate::report::shown::{known, percent, tau, text};
use crate::report::table::{Cell, Column, Table};
use crate::study::records::{ModelRecord, OrderOfTimesRecord};

/// What the ordering columns hold.
const ORDER: &str = "tau: Kendall's tau-b between predicted and measured times of a scene's trees, mean over scenes and sets of \
                     rays; pairs right: share of pairs of trees in the right order; regret: time of the tree of least cost over \
                     that of the fastest, minus 1.";

/// Every model that is wanted.
pub fn models(run: &CostVsWork, wanted: impl Fn(&&ModelRecord) -> bool) -> Table {
    let row = |m: &ModelRecord| {
        vec![
            text(&m.model),
            text(&m.left_out),
            Cell::Count(m.constants),
            percent(m.error_median),
            percent(m.error_mean),
            percent(m.error_p90),
            percent(m.error_max),
            known(m.tau, tau),
            known(m.pairs_right, percent),
            known(m.regret_mean, percent),
            known(m.regret_max, percent),
        ]
    };
    let rows = counted(run.models.first().map_or(0, |m| m.rows), "time");
    let groups = groups_differ(&run.models);
    let left_out = if groups {
        "the scene alone, or all its sizes"
    } else {
        "the scene; no two are sizes of one"
    };
    Table {
        caption: format!(
            "The time of a ray predicted from its counts by models fitted without the scene they are judged on (left out: \
             {left_out}; where the terms are chosen, what is left out had no say in that either). Error: \
             |predicted/measured − 1| of {rows} of a set of rays in a tree: median, mean, 90 % quantile, largest. Where a \
             model has one constant, it is the scale of the ratio c_K:c_t that its name gives. {ORDER}"
        ),
        columns: vec![
            Column::left("model", "model"),
            Column::left("left out", "left_out"),
            Column::right("constants", "constants"),
            Column::right("error, median %", "error_median_pct"),
            Column::right("mean %", "error_mean_pct"),
            Column::right("90 %", "error_p90_pct"),
            Column::right("worst %", "error_max_pct"),
            Column::right("tau", "tau"),
            Column::right("pairs right, %", "pairs_right_pct"),
            Column::right("regret, mean %", "regret_mean_pct"),
            Column::right("worst %", "regret_max_pct"),
        ],
        keys: 2,
        rows: run
            .models
            .iter()
            .filter(|m| groups || m.left_out != ModelRecord::GROUP)
            .filter(wanted)
            .map(row)
            .collect(),
    }
}

/// Whether it matters to any model that all sizes of a scene are left out: not where each is a group of its own.
fn groups_differ(models: &[ModelRecord]) -> bool {
    let mut of_group = models.iter().filter(|m| m.left_out == ModelRecord::GROUP);
    of_group.any(|group| {
        let alone = ModelRecord {
            left_out: ModelRecord::SCENE.to_owned(),
            ..group.clone()
        };
        !models.contains(&alone)
    })
}

/// How well costs of every origin put trees into the order of their times, by set of rays.
pub fn order(run: &CostVsWork) -> Table {
    let row = |o: &OrderOfTimesRecord| {
        vec![
            text(&o.rays),
            text(&o.cost),
            Cell::Count(o.scenes),
            tau(o.tau),
            percent(o.pairs_right),
            percent(o.regret_mean),
            percent(o.regret_max),
            known(
                (o.regret_max > 0.0).then_some(o.regret_scene.as_str()),
                text,
            ),
        ]
    };
    Table {
        caption: format!(
            "The order of a scene's trees by cost against the order of their times. Cost: counts that areas predict, or those \
             counted; with the given constants, with c_K and c_t fitted to other scenes, or with chosen terms fitted to other \
             scenes. Of all sets, scenes count once for each set. {ORDER}"
        ),
        columns: vec![
            Column::left("rays", "rays"),
            Column::left("cost", "cost"),
            Column::right("scenes", "scenes"),
            Column::right("tau", "tau"),
            Column::right("pairs right, %", "pairs_right_pct"),
            Column::right("regret, mean %", "regret_mean_pct"),
            Column::right("worst %", "regret_max_pct"),
            Column::left("on", "regret_scene"),
        ],
        keys: 2,
        rows: run.times_order.iter().map(row).collect(),
    }
}
