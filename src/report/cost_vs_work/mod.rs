//! What a run of kind `cost-vs-work` left behind, and what is made of it: what areas predict against what is counted, and what
//! is counted against seconds.
//!
//! Whatever is made of seconds has a name that starts with `times-`: all else is the same whenever it is made.

mod agreement;
mod figures;
mod findings;
#[cfg(test)]
mod fixture;
mod screen;
mod sets;
mod spread;
#[cfg(test)]
mod tests;
mod times;
mod work;

use std::path::Path;

use super::read::{optional_rows, rows_of};
use super::table::Table;
use super::{Figure, ReportError, tables};
use crate::study::records::{
    CellRecord, ChoiceRecord, ConstantRecord, ModelRecord, OrderOfTimesRecord, PredictionRecord,
    ShareRecord, Summary, TimeVerdicts, TreeOrderRecord, WorkRecord,
};
pub(super) use sets::NAMES as SETS;
use times::Key;

/// The files of a run of kind `cost-vs-work`.
#[derive(Clone, Debug)]
pub struct CostVsWork {
    /// `cells.csv`.
    pub cells: Vec<CellRecord>,
    /// `work.csv`.
    pub work: Vec<WorkRecord>,
    /// `tree-order.csv`.
    pub orders: Vec<TreeOrderRecord>,
    /// `times-models.csv`, and so on: empty where the times are not there.
    pub models: Vec<ModelRecord>,
    /// `times-constants.csv`.
    pub constants: Vec<ConstantRecord>,
    /// `times-choice.csv`.
    pub choices: Vec<ChoiceRecord>,
    /// `times-predictions.csv`.
    pub predictions: Vec<PredictionRecord>,
    /// `times-order.csv`.
    pub times_order: Vec<OrderOfTimesRecord>,
    /// `times-shares.csv`.
    pub shares: Vec<ShareRecord>,
    /// `times-verdicts.json`.
    pub time_verdicts: TimeVerdicts,
}

impl CostVsWork {
    /// Reads the files of a directory.
    pub(super) fn read(dir: &Path) -> Result<Self, ReportError> {
        let some = |name: &str| dir.join(name);
        let verdicts = some("times-verdicts.json");
        let time_verdicts = match std::fs::read(&verdicts) {
            Ok(bytes) => serde_json::from_slice(&bytes).map_err(|source| ReportError::Json {
                path: verdicts,
                source,
            })?,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => TimeVerdicts::default(),
            Err(source) => {
                return Err(ReportError::Read {
                    path: verdicts,
                    source,
                });
            }
        };
        Ok(Self {
            cells: rows_of(&some("cells.csv"))?,
            work: rows_of(&some("work.csv"))?,
            orders: rows_of(&some("tree-order.csv"))?,
            models: optional_rows(&some("times-models.csv"))?.unwrap_or_default(),
            constants: optional_rows(&some("times-constants.csv"))?.unwrap_or_default(),
            choices: optional_rows(&some("times-choice.csv"))?.unwrap_or_default(),
            predictions: optional_rows(&some("times-predictions.csv"))?.unwrap_or_default(),
            times_order: optional_rows(&some("times-order.csv"))?.unwrap_or_default(),
            shares: optional_rows(&some("times-shares.csv"))?.unwrap_or_default(),
            time_verdicts,
        })
    }

    /// `predicted-vs-counted`, nine sets of rays each, and, where constants were fitted, `times-predicted`,
    /// `times-residuals` and `times-shares`.
    pub(super) fn figures(&self, summary: &Summary) -> Vec<(String, Figure)> {
        let mut figures = figures::counted(self, summary);
        let of_times = [
            ("times-predicted", figures::predicted(self, summary)),
            ("times-residuals", figures::residuals(self, summary)),
            ("times-shares", figures::shares(self, summary)),
        ];
        let drawn = of_times.into_iter();
        figures.extend(drawn.filter_map(|(name, figure)| Some((name.to_owned(), figure?))));
        figures
    }

    pub(super) fn tables(&self, summary: &Summary) -> Vec<(&'static str, Table)> {
        let mut all = vec![
            ("verdicts", tables::verdicts(summary)),
            ("work", work::by_set(self)),
            ("work-traced-summary", work::summary(self)),
        ];
        all.extend(work::traced(self).map(|table| ("work-traced", table)));
        if !self.models.is_empty() {
            let residuals = |key| times::residuals(self, key);
            let verdicts = &self.time_verdicts.verdicts;
            all.extend([
                ("times-models", times::models(self, |_| true)),
                ("times-constants", times::constants(self, |_| true)),
                ("times-choice", times::choice(self)),
                ("times-order", times::order(self)),
                ("times-residuals-scenes", residuals(Key::Scene)),
                ("times-residuals-strategies", residuals(Key::Strategy)),
                ("times-residuals-rays", residuals(Key::Rays)),
            ]);
            if !verdicts.is_empty() {
                let table = tables::judged(&summary.question, verdicts);
                all.push(("times-verdicts", table));
            }
        }
        all
    }

    /// The findings in words, as Markdown.
    pub(super) fn texts(&self) -> Vec<(String, String)> {
        vec![("times-findings".to_owned(), findings::findings(self))]
    }

    /// What goes to the screen.
    pub(super) fn screen(&self, width: usize) -> String {
        screen::tables(self, width)
    }
}
