//! What a run of kind `termination` left behind: trees of many stop rules, and which setting of each is the best by the
//! metric's own lines, by the rays of the picture, and by the clock.
//!
//! Whatever is made of times has a name that starts with `times-`: all else is the same whenever it is made.

mod figure;
mod table;

use std::path::Path;

use super::read::{optional_rows, rows_of};
use super::series::{distinct, provenance};
use super::table::Table;
use super::{Figure, ReportError, tables};
use crate::cost::CostModel;
use crate::study::records::{CellRecord, PassTiming, RayRecord, Summary};

/// The files of a run of kind `termination`.
#[derive(Clone, Debug)]
pub struct Termination {
    /// `cells.csv`.
    pub cells: Vec<CellRecord>,
    /// `rays.csv`.
    pub rays: Vec<RayRecord>,
    /// `timings.csv`, where there is one.
    pub timings: Option<Vec<PassTiming>>,
}

/// One tree: a stop rule at one setting.
#[derive(Clone, Debug)]
struct Setting<'r> {
    cell: &'r CellRecord,
    /// The rule with a letter for what differs between its settings, e.g. `objects:N`.
    rule: String,
    /// Cost of the picture's rays, for each of them.
    traced: f64,
    /// Seconds: of tracing them all, and with the building before it.
    seconds: Option<[f64; 2]>,
}

/// What a setting may be the best by.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Measure {
    /// C of isotropic lines, from areas.
    Lines,
    /// C of the rays of the picture, counted.
    Rays,
    /// Seconds to trace them.
    Trace,
    /// Seconds to build the tree and trace them.
    Total,
}

impl Measure {
    fn of(self, setting: &Setting) -> Option<f64> {
        let value = match self {
            Self::Lines => setting.cell.c_predicted,
            Self::Rays => setting.traced,
            Self::Trace => setting.seconds?[0],
            Self::Total => setting.seconds?[1],
        };
        (value > 0.0).then_some(value)
    }

    /// The setting of the least value.
    fn best<'s, 'r>(
        self,
        settings: impl IntoIterator<Item = &'s Setting<'r>>,
    ) -> Option<(&'s Setting<'r>, f64)>
    where
        'r: 's,
    {
        let known = settings
            .into_iter()
            .filter_map(|setting| Some((setting, self.of(setting)?)));
        known.min_by(|a, b| a.1.total_cmp(&b.1))
    }
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
    /// Reads the files of a directory.
    pub(super) fn read(dir: &Path) -> Result<Self, ReportError> {
        Ok(Self {
            cells: rows_of(&dir.join("cells.csv"))?,
            rays: rows_of(&dir.join("rays.csv"))?,
            timings: optional_rows(&dir.join("timings.csv"))?,
        })
    }

    fn settings(&self) -> Vec<Setting<'_>> {
        self.cells.iter().map(|cell| self.setting(cell)).collect()
    }

    fn setting<'r>(&'r self, cell: &'r CellRecord) -> Setting<'r> {
        let rays = || self.rays.iter().filter(|row| row.cell == cell.cell);
        let sum = |part: fn(&RayRecord) -> u64| rays().map(part).sum::<u64>() as f64;
        let cost = CostModel {
            c_k: cell.c_k,
            c_b: cell.c_b,
            c_t: cell.c_t,
        };
        let all = cost.cost(
            sum(|row| row.inner_visits),
            sum(|row| row.leaf_visits),
            sum(|row| row.object_tests),
        );
        let mut times = self.timings.iter().flatten();
        let times = times.by_ref().filter(|row| row.cell == cell.cell);
        let (build, trace): (Vec<_>, Vec<_>) = times.partition(|row| row.what == "build");
        let total = |rows: &[&PassTiming]| rows.iter().map(|row| row.seconds).sum::<f64>();
        let (build_s, trace_s) = (total(&build), total(&trace));
        Setting {
            cell,
            rule: rule_of(&cell.stop),
            traced: all / sum(|row| row.rays),
            seconds: (!trace.is_empty()).then_some([trace_s, build_s + trace_s]),
        }
    }

    /// `termination` and `times-termination`, for each strategy and four scenes each.
    pub(super) fn figures(&self, summary: &Summary) -> Vec<(String, Figure)> {
        let settings = self.settings();
        let scenes = distinct(self.cells.iter().map(|cell| cell.scene.as_str()));
        let mut figures = Vec::new();
        let mut number = 0;
        for strategy in distinct(self.cells.iter().map(|cell| cell.strategy.as_str())) {
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
                        self.cells
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
        figures
    }

    pub(super) fn tables(&self, summary: &Summary) -> Vec<(&'static str, Table)> {
        let settings = self.settings();
        let mut tables = vec![
            ("settings", table::settings(&settings)),
            ("termination", table::costs(&settings)),
            ("verdicts", tables::verdicts(summary)),
        ];
        if settings.iter().any(|setting| setting.seconds.is_some()) {
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

    /// Trees of one scene by stop rule, references, cost of lines, tests of the rays, seconds of building and tracing.
    pub fn run(trees: &[(&str, f64, u64, Option<[f64; 2]>)]) -> Termination {
        let mut run = Termination {
            cells: Vec::new(),
            rays: Vec::new(),
            timings: Some(Vec::new()),
        };
        for (i, &(stop, cost, tests, seconds)) in trees.iter().enumerate() {
            let cell = CellRecord {
                cell: stop.into(),
                stop: stop.into(),
                c_predicted: cost,
                c_counted: cost,
                ..fixture::cell("spd:balls:3", "sah", 21 + 100 * i as u64)
            };
            for kind in ["primary", "shadow"] {
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
                for (what, seconds) in [("build", build), ("primary", trace), ("shadow", trace)] {
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
                        });
                    });
                }
            }
            run.cells.push(cell);
        }
        run
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
        // c_t = 20: 200 tests of 100 rays.
        assert_eq!(settings[0].traced, 40.0);
        assert_eq!(settings[0].seconds, Some([4.0, 5.0]));
        assert_eq!(settings[1].seconds, None);
        let best = |measure: Measure| measure.best(&settings).map(|(s, _)| s.cell.stop.as_str());
        assert_eq!(best(Measure::Lines), Some("depth:4"));
        assert_eq!(best(Measure::Rays), Some("objects:1"));
        assert_eq!(best(Measure::Total), Some("objects:1"));
    }
}
