//! What a run of kind `speed-vs-error` left behind, and what is made of it.

use std::path::Path;

use super::read::optional_rows;
use super::table::Table;
use super::{Figure, ReportError, tables};
use crate::study::records::{
    CoverageRecord, EnoughRecord, ErrorRecord, ExponentRecord, PassTiming, PlaneRecord,
    PrecisionRecord, Summary,
};

/// The files of a run of kind `speed-vs-error`.
#[derive(Clone, Debug)]
pub struct SpeedVsError {
    /// `errors.csv`.
    pub errors: Vec<ErrorRecord>,
    /// `exponents.csv`.
    pub exponents: Vec<ExponentRecord>,
    /// `enough.csv`.
    pub enough: Vec<EnoughRecord>,
    /// `precision.csv`.
    pub precision: Vec<PrecisionRecord>,
    /// `planes.csv`.
    pub planes: Vec<PlaneRecord>,
    /// `coverage.csv`.
    pub coverage: Vec<CoverageRecord>,
    /// `timings.csv`.
    pub timings: Vec<PassTiming>,
}

impl SpeedVsError {
    /// Reads the files of a directory.
    pub(super) fn read(dir: &Path) -> Result<Self, ReportError> {
        let some = |name: &str| dir.join(name);
        Ok(Self {
            errors: optional_rows(&some("errors.csv"))?.unwrap_or_default(),
            exponents: optional_rows(&some("exponents.csv"))?.unwrap_or_default(),
            enough: optional_rows(&some("enough.csv"))?.unwrap_or_default(),
            precision: optional_rows(&some("precision.csv"))?.unwrap_or_default(),
            planes: optional_rows(&some("planes.csv"))?.unwrap_or_default(),
            coverage: optional_rows(&some("coverage.csv"))?.unwrap_or_default(),
            timings: optional_rows(&some("timings.csv"))?.unwrap_or_default(),
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
