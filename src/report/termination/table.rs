//! The best setting of every stop rule.

use super::{Measure, Setting, best};
use crate::report::cost::Pair;
use crate::report::number::{percent_above, signed};
use crate::report::series::distinct;
use crate::report::table::{Cell, Column, Table};

/// The settings of one scene and strategy, and those of one rule among them.
struct Group<'s, 'r> {
    scene: &'s str,
    strategy: &'s str,
    rule: &'s str,
    all: Vec<&'s Setting<'r>>,
    own: Vec<&'s Setting<'r>>,
}

fn groups<'s, 'r>(settings: &'s [Setting<'r>]) -> Vec<Group<'s, 'r>> {
    let mut groups = Vec::new();
    for scene in distinct(settings.iter().map(|s| s.tree.cell.scene.as_str())) {
        for strategy in distinct(settings.iter().map(|s| s.tree.cell.strategy.as_str())) {
            let all = settings
                .iter()
                .filter(|s| s.tree.cell.scene == scene && s.tree.cell.strategy == strategy);
            let all: Vec<&Setting> = all.collect();
            for rule in distinct(all.iter().map(|s| s.rule.as_str())) {
                let own = all.iter().copied().filter(|s| s.rule == rule).collect();
                let all = all.clone();
                groups.push(Group {
                    scene,
                    strategy,
                    rule,
                    all,
                    own,
                });
            }
        }
    }
    groups
}

impl<'s, 'r> Group<'s, 'r> {
    fn names(&self) -> Vec<Cell> {
        let names = [self.scene, self.strategy, self.rule];
        names.map(|name| Cell::Text(name.to_owned())).into()
    }

    /// The rule's best setting, its value, and per cent above the best of all rules.
    fn best(&self, measure: Measure) -> Option<(&'s Setting<'r>, f64, f64)> {
        let (setting, value) = best(measure, self.own.iter().copied())?;
        Some((setting, value, self.above(measure, value)?))
    }

    /// Per cent that a value is above the least of all rules.
    fn above(&self, measure: Measure, value: f64) -> Option<f64> {
        let (_, least) = best(measure, self.all.iter().copied())?;
        Some(percent_above(value / least))
    }

    /// Setting, value and per cent.
    fn cells(&self, measure: Measure, decimals: usize) -> [Cell; 3] {
        let missing = [Cell::Missing, Cell::Missing, Cell::Missing];
        self.best(measure)
            .map_or(missing, |(setting, value, above)| {
                [
                    Cell::Text(setting.tree.cell.stop.clone()),
                    Cell::Value(value, decimals),
                    Cell::Change(above, 1),
                ]
            })
    }

    /// What the setting that one measure picks costs by another, in per cent above the best of all rules.
    fn picked_by(&self, picks: Measure, judges: Measure) -> Cell {
        let above = best(picks, self.own.iter().copied())
            .and_then(|(setting, _)| self.above(judges, setting.value(judges)?));
        above.map_or(Cell::Missing, |above| Cell::Change(above, 1))
    }
}

fn names() -> Vec<Column> {
    vec![
        Column::left("scene", "scene"),
        Column::left("strategy", "strategy"),
        Column::left("rule", "rule"),
    ]
}

/// Every rule: its best setting by the cost of lines and of rays.
pub fn costs(settings: &[Setting]) -> Table {
    let mut columns = names();
    columns.extend([
        Column::right("settings", "settings"),
        Column::left("best for lines", "lines_setting"),
        Column::right("C of lines", "lines_c"),
        Column::right("above the best, %", "lines_above_best_pct"),
        Column::left("best for rays", "rays_setting"),
        Column::right("C of rays", "rays_c"),
        Column::right("above the best, %", "rays_above_best_pct"),
        Column::right("rays, set by lines, %", "rays_set_by_lines_pct"),
    ]);
    let row = |group: &Group| {
        let mut row = group.names();
        row.push(Cell::Count(group.own.len() as u64));
        row.extend(group.cells(Measure::Predicted, 2));
        row.extend(group.cells(Measure::Traced, 2));
        row.push(group.picked_by(Measure::Predicted, Measure::Traced));
        row
    };
    Table {
        caption: "The best setting of every stop rule: by cost C of isotropic lines, predicted from areas, and by the cost of \
                  the rays of the picture, counted completely. Per cent above the best setting of all rules in the scene; the \
                  last column is what the rays cost where the setting is the best for lines."
            .to_owned(),
        columns,
        keys: 3,
        rows: groups(settings).iter().map(row).collect(),
    }
}

/// Every rule: its best setting by time.
pub fn times(settings: &[Setting]) -> Table {
    let mut columns = names();
    columns.extend([
        Column::left("fastest to trace", "trace_setting"),
        Column::right("tracing, s", "trace_s"),
        Column::right("above the best, %", "trace_above_best_pct"),
        Column::left("fastest with building", "total_setting"),
        Column::right("building and tracing, s", "total_s"),
        Column::right("above the best, %", "total_above_best_pct"),
        Column::right("tracing, set by lines, %", "trace_set_by_lines_pct"),
        Column::right("tracing, set by rays, %", "trace_set_by_rays_pct"),
    ]);
    let row = |group: &Group| {
        let mut row = group.names();
        row.extend(group.cells(Measure::Trace, 4));
        row.extend(group.cells(Measure::Total, 4));
        row.push(group.picked_by(Measure::Predicted, Measure::Trace));
        row.push(group.picked_by(Measure::Traced, Measure::Trace));
        row
    };
    Table {
        caption: "The best setting of every stop rule by seconds, on one thread: of tracing the rays of the picture, and of \
                  building the tree and tracing them. Per cent above the fastest setting of all rules in the scene; the last \
                  two columns are what tracing takes where the setting is the one of the least cost of lines, and of rays."
            .to_owned(),
        columns,
        keys: 3,
        rows: groups(settings).iter().map(row).collect(),
    }
}

/// Every tree.
pub fn settings(settings: &[Setting]) -> Table {
    let columns = vec![
        Column::left("scene", "scene"),
        Column::left("strategy", "strategy"),
        Column::left("stop", "stop"),
        Column::right("nodes", "nodes"),
        Column::right("depth", "depth"),
        Column::right("references per object", "references_per_object"),
        Column::right("C of lines predicted", "lines_c_predicted"),
        Column::measured("C of lines counted", "lines_c_counted"),
        Column::right("C of rays", "rays_c"),
    ];
    let row = |setting: &Setting| {
        let cell = setting.tree.cell;
        let cost = Pair::cost(cell);
        vec![
            Cell::Text(cell.scene.clone()),
            Cell::Text(cell.strategy.clone()),
            Cell::Text(cell.stop.clone()),
            Cell::Count(cell.inner_nodes + cell.leaves),
            Cell::Count(cell.depth),
            Cell::Value(cell.references as f64 / cell.objects as f64, 3),
            Cell::Value(cost.predicted, cost.decimals()),
            Cell::Measured(cost.counted, cost.half()),
            Cell::Value(setting.tree.value(Measure::Traced).unwrap_or(f64::NAN), 2),
        ]
    };
    Table {
        caption: "Every tree: its size, the cost C of isotropic lines, predicted from areas and counted with half of the 99 % \
                  interval, and the cost of a ray of the picture, counted completely."
            .to_owned(),
        columns,
        keys: 3,
        rows: settings.iter().map(row).collect(),
    }
}

/// Every rule in one line: its best settings and how far they are from the best of all.
pub fn short(settings: &[Setting]) -> Table {
    let columns = vec![
        Column::left("scene", "scene"),
        Column::left("rule", "rule"),
        Column::left("best for lines", "lines"),
        Column::left("best for rays", "rays"),
        Column::left("fastest to trace", "trace"),
    ];
    let row = |group: &Group| {
        let best = |measure| match group.best(measure) {
            Some((setting, _, above)) => {
                Cell::Text(format!("{} {} %", setting.tree.cell.stop, signed(above, 1)))
            }
            None => Cell::Missing,
        };
        let mut row = vec![
            Cell::Text(group.scene.to_owned()),
            Cell::Text(group.rule.to_owned()),
        ];
        row.extend([Measure::Predicted, Measure::Traced, Measure::Trace].map(best));
        row
    };
    Table {
        caption: "The best setting of every stop rule, and how far it is above the best of all rules in the scene: by the cost \
                  of isotropic lines, by the cost of the picture's rays, by the clock."
            .to_owned(),
        columns,
        keys: 2,
        rows: groups(settings).iter().map(row).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::run;
    use super::*;

    #[test]
    fn what_one_measure_picks_another_judges() {
        let run = run(&[
            ("objects:1", 10.0, 200, Some([1.0, 1.0])),
            ("objects:4", 12.0, 100, Some([1.0, 3.0])),
            ("depth:4", 8.0, 400, None),
        ]);
        let settings = run.settings();
        let groups = groups(&settings);
        assert_eq!(groups.len(), 2);
        let objects = &groups[0];
        let best = |measure| {
            objects
                .best(measure)
                .map(|(s, v, a)| (s.tree.cell.stop.as_str(), v, a))
        };
        assert_eq!(best(Measure::Predicted), Some(("objects:1", 10.0, 25.0)));
        assert_eq!(best(Measure::Traced), Some(("objects:4", 4.0, 0.0)));
        // Set for lines, twice the cost of rays; set for rays, three times the seconds.
        let picked = objects.picked_by(Measure::Predicted, Measure::Traced);
        assert_eq!(picked, Cell::Change(100.0, 1));
        let picked = objects.picked_by(Measure::Traced, Measure::Trace);
        assert_eq!(picked, Cell::Change(200.0, 1));
        let unknown = groups[1].picked_by(Measure::Traced, Measure::Trace);
        assert_eq!(unknown, Cell::Missing);
    }
}
