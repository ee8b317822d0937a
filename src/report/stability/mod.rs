//! What a run of kind `stability` left behind, and what is made of it.

mod cell;
#[cfg(test)]
mod fixture;
mod matrix;
mod outcomes;
mod screen;
mod tables;
#[cfg(test)]
mod tests;

use std::path::Path;

use super::read::optional_rows;
use super::table::Table;
use super::{Figure, ReportError};
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

    /// `stability`, on as many pages as the cases take.
    pub(super) fn figures(&self, summary: &Summary) -> Vec<(String, Figure)> {
        matrix::figures(self, summary)
    }

    /// The tables of what the run has.
    pub(super) fn tables(&self, summary: &Summary) -> Vec<(&'static str, Table)> {
        let mut all = vec![("verdicts", super::tables::verdicts(summary))];
        if !self.cases.is_empty() {
            all.push(("cases", tables::cases(self)));
        }
        if !self.random.is_empty() {
            all.push(("random", tables::random(self)));
            all.push(("random-scenes", tables::random_by_scene(self)));
            // Without a tie judged wrongly, which is a result, the table is empty.
            all.push(("ties", tables::ties(self)));
        }
        if !self.metamorphic.is_empty() {
            all.push(("metamorphic", tables::metamorphic(self)));
        }
        all
    }

    /// The tables of the screen.
    pub(super) fn screen(&self, width: usize) -> String {
        screen::tables(self, width)
    }
}
