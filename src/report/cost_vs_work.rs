//! What a run of kind `cost-vs-work` left behind, and what is made of it.

use std::path::Path;

use super::read::{optional_rows, rows_of};
use super::table::Table;
use super::{Figure, ReportError, tables};
use crate::study::records::{
    CellRecord, ChoiceRecord, ConstantRecord, ModelRecord, OrderOfTimesRecord, PredictionRecord,
    Summary, TimeVerdicts, WorkRecord,
};

/// The files of a run of kind `cost-vs-work`.
#[derive(Clone, Debug)]
pub struct CostVsWork {
    /// `cells.csv`.
    pub cells: Vec<CellRecord>,
    /// `work.csv`.
    pub work: Vec<WorkRecord>,
    /// `times-models.csv`, and so on: empty where the times are not there.
    pub models: Vec<ModelRecord>,
    /// `times-constants.csv`.
    pub constants: Vec<ConstantRecord>,
    /// `times-choice.csv`.
    pub choices: Vec<ChoiceRecord>,
    /// `times-predictions.csv`.
    pub predictions: Vec<PredictionRecord>,
    /// `times-order.csv`.
    pub orders: Vec<OrderOfTimesRecord>,
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
            models: optional_rows(&some("times-models.csv"))?.unwrap_or_default(),
            constants: optional_rows(&some("times-constants.csv"))?.unwrap_or_default(),
            choices: optional_rows(&some("times-choice.csv"))?.unwrap_or_default(),
            predictions: optional_rows(&some("times-predictions.csv"))?.unwrap_or_default(),
            orders: optional_rows(&some("times-order.csv"))?.unwrap_or_default(),
            time_verdicts,
        })
    }

    pub(super) fn figures(&self, _: &Summary) -> Vec<(String, Figure)> {
        Vec::new()
    }

    pub(super) fn tables(&self, summary: &Summary) -> Vec<(&'static str, Table)> {
        vec![("verdicts", tables::verdicts(summary))]
    }

    /// What goes to the screen.
    pub(super) fn screen(&self, _: usize) -> String {
        String::new()
    }
}
