//! What a run of kind `termination` left behind: trees of many stop rules, and which setting of each is the best by the
//! metric's own lines, by the rays of the picture, and by the clock.
//!
//! Whatever is made of times has a name that starts with `times-`: all else is the same whenever it is made.

mod figure;
mod table;

use super::series::{distinct, provenance};
use super::strategies::gallery;
use super::strategies::part::{Measure, Tree};
use super::table::Table;
use super::{Figure, ReportError, Strategies, tables};
use crate::study::records::Summary;

/// The files of a run of kind `termination`: those of kind `strategies`.
#[derive(Clone, Debug)]
pub struct Termination(pub Strategies);

/// One tree: a stop rule at one setting.
struct Setting<'r> {
    tree: Tree<'r>,
    /// The rule with a letter for what differs between its settings, e.g. `objects:N`.
    rule: String,
}

impl Setting<'_> {
    /// What a setting may be the best by; only if it is a positive number.
    fn value(&self, measure: Measure) -> Option<f64> {
        self.tree.value(measure).filter(|&value| value > 0.0)
    }
}

/// The setting of the least value.
fn best<'s, 'r: 's>(
    measure: Measure,
    settings: impl IntoIterator<Item = &'s Setting<'r>>,
) -> Option<(&'s Setting<'r>, f64)> {
    let known = settings
        .into_iter()
        .filter_map(|setting| Some((setting, setting.value(measure)?)));
    known.min_by(|a, b| a.1.total_cmp(&b.1))
}

/// A stop rule with a letter in place of what its settings differ in: the last number, or the depth bound it leaves open.
fn rule_of(stop: &str) -> String {
    let parts: Vec<&str> = stop.split(':').collect();
    match parts[..] {
        ["objects", _] => "objects:N".to_owned(),
        ["cost-k", _] => "cost-k:K".to_owned(),
        [rule] => format!("{rule}:D"),
        [ref first @ .., _] => format!("{}:D", first.join(":")),
        [] => String::new(),
    }
}

impl Termination {
    fn settings(&self) -> Vec<Setting<'_>> {
        let setting = |cell| Setting {
            tree: Tree::new(&self.0, cell),
            rule: rule_of(&cell.stop),
        };
        self.0.cells.iter().map(setting).collect()
    }

    /// `termination` and `times-termination`, for each strategy and four scenes each.
    pub(super) fn figures(&self, summary: &Summary) -> Result<Vec<(String, Figure)>, ReportError> {
        let settings = self.settings();
        let scenes = distinct(self.0.cells.iter().map(|cell| cell.scene.as_str()));
        let mut figures = Vec::new();
        let mut number = 0;
        for strategy in distinct(self.0.cells.iter().map(|cell| cell.strategy.as_str())) {
            for scenes in scenes.chunks(figure::COLUMNS) {
                number += 1;
                let behind = if number == 1 {
                    String::new()
                } else {
                    format!("-{number}")
                };
                let drawn = figure::Drawn {
                    strategy,
                    scenes,
                    settings: &settings,
                    provenance: provenance(
                        self.0
                            .cells
                            .iter()
                            .filter(|c| c.strategy == strategy && scenes.contains(&&*c.scene)),
                    ),
                    quick: summary.quick,
                };
                figures.push((format!("termination{behind}"), drawn.costs()));
                let times = drawn.times();
                figures.extend(times.map(|times| (format!("times-termination{behind}"), times)));
            }
        }
        figures.extend(self.0.partition(summary.quick));
        figures.extend(gallery::figures(&self.0, summary)?);
        Ok(figures)
    }

    pub(super) fn tables(&self, summary: &Summary) -> Vec<(&'static str, Table)> {
        let settings = self.settings();
        let mut tables = vec![
            ("settings", table::settings(&settings)),
            ("termination", table::costs(&settings)),
            ("verdicts", tables::verdicts(summary)),
        ];
        if best(Measure::Trace, &settings).is_some() {
            tables.push(("times-termination", table::times(&settings)));
        }
        tables
    }

    /// The best setting of every rule, for the screen.
    pub(super) fn short_table(&self) -> Table {
        table::short(&self.settings())
    }
}

#[cfg(test)]
pub mod tests {
    use super::*;
    use crate::report::fixture;
    use crate::study::records::{CellRecord, PassTiming, RayRecord};

    /// Trees of one scene by stop rule, references, cost of lines, tests of the rays, seconds of building and tracing.
    pub fn run(trees: &[(&str, f64, u64, Option<[f64; 2]>)]) -> Termination {
        let mut run = Strategies {
            cells: Vec::new(),
            rays: Vec::new(),
            timings: Some(Vec::new()),
            pictures: "no/such/pictures".into(),
            slice: None,
        };
        for (i, &(stop, cost, tests, seconds)) in trees.iter().enumerate() {
            let cell = CellRecord {
                cell: stop.into(),
                stop: stop.into(),
                c_predicted: cost,
                c_counted: cost,
                ..fixture::cell("spd:balls:3", "sah", 21 + 100 * i as u64)
            };
            for kind in ["primary", "shadow", "secondary"] {
                run.rays.push(RayRecord {
                    cell: stop.into(),
                    scene: cell.scene.clone(),
                    strategy: cell.strategy.clone(),
                    stop: stop.into(),
                    kind: kind.into(),
                    rays: 50,
                    hits: 10,
                    inner_visits: 0,
                    leaf_visits: 0,
                    object_tests: tests,
                });
            }
            if let Some([build, trace]) = seconds {
                for (what, seconds) in [
                    ("build", build),
                    ("primary", trace),
                    ("shadow", trace),
                    ("secondary", trace),
                ] {
                    run.timings.iter_mut().for_each(|rows| {
                        rows.push(PassTiming {
                            cell: stop.into(),
                            scene: cell.scene.clone(),
                            strategy: cell.strategy.clone(),
                            stop: stop.into(),
                            what: what.into(),
                            units: 50,
                            timed_units: 50,
                            rounds: 2,
                            seconds,
                            sampling_se_s: 0.0,
                            half_a_s: seconds,
                            half_b_s: seconds,
                            disturbed: false,
                            load_average: None,
                            revision: String::new(),
                            pass_s: 0.1,
                        });
                    });
                }
            }
            run.cells.push(cell);
        }
        Termination(run)
    }

    #[test]
    fn settings_of_a_rule_have_one_name() {
        for (stop, rule) in [
            ("objects:2", "objects:N"),
            ("objects:1:16", "objects:1:D"),
            ("cost-k:0.01", "cost-k:K"),
            ("cost-k:0.01:9", "cost-k:0.01:D"),
            ("cost-gain", "cost-gain:D"),
            ("cost-gain:40", "cost-gain:D"),
            ("automatic", "automatic:D"),
            ("depth:4", "depth:D"),
        ] {
            assert_eq!(rule_of(stop), rule, "{stop}");
        }
    }

    #[test]
    fn rays_and_seconds_are_summed_over_their_kinds() {
        let run = run(&[
            ("objects:1", 9.0, 100, Some([1.0, 2.0])),
            ("depth:4", 8.0, 300, None),
        ]);
        let settings = run.settings();
        // c_t = 2: 300 tests of 150 rays. Three kinds of 2 seconds each, and 1 of building.
        let value = |measure| settings[0].value(measure);
        assert_eq!(value(Measure::Traced), Some(4.0));
        assert_eq!(value(Measure::Trace), Some(6.0));
        assert_eq!(value(Measure::Total), Some(7.0));
        assert_eq!(settings[1].value(Measure::Total), None);
        let best = |measure| best(measure, &settings).map(|(s, _)| s.tree.cell.stop.as_str());
        assert_eq!(best(Measure::Predicted), Some("depth:4"));
        assert_eq!(best(Measure::Traced), Some("objects:1"));
        assert_eq!(best(Measure::Total), Some("objects:1"));
    }
}
