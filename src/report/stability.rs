//! What a run of kind `stability` left behind, and what is made of it.

use std::path::Path;

use super::read::optional_rows;
use super::table::Table;
use super::{Figure, ReportError, tables};
use crate::study::records::{CaseRecord, MetamorphicRecord, RandomRecord, Summary, TieRecord};

/// The files of a run of kind `stability`.
#[derive(Clone, Debug)]
pub struct Stability {
    /// `cases.csv`.
    pub cases: Vec<CaseRecord>,
    /// `random.csv`.
    pub random: Vec<RandomRecord>,
    /// `ties.csv`.
    pub ties: Vec<TieRecord>,
    /// `metamorphic.csv`.
    pub metamorphic: Vec<MetamorphicRecord>,
}

impl Stability {
    /// Reads the files of a directory.
    pub(super) fn read(dir: &Path) -> Result<Self, ReportError> {
        let some = |name: &str| dir.join(name);
        Ok(Self {
            cases: optional_rows(&some("cases.csv"))?.unwrap_or_default(),
            random: optional_rows(&some("random.csv"))?.unwrap_or_default(),
            ties: optional_rows(&some("ties.csv"))?.unwrap_or_default(),
            metamorphic: optional_rows(&some("metamorphic.csv"))?.unwrap_or_default(),
        })
    }

    pub(super) fn figures(&self, _summary: &Summary) -> Vec<(String, Figure)> {
        Vec::new()
    }

    pub(super) fn tables(&self, summary: &Summary) -> Vec<(&'static str, Table)> {
        vec![("verdicts", tables::verdicts(summary))]
    }

    /// The tables of the screen.
    pub(super) fn screen(&self, _width: usize) -> String {
        String::new()
    }
}
