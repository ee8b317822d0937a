//! What a run of kind `speed-vs-error` left behind, and what is made of it.

mod coverage;
mod errors;
#[cfg(test)]
mod fixture;
mod planes;
mod precision;
mod screen;
mod tables;
#[cfg(test)]
mod tests;
mod times;

use std::path::Path;

use super::read::optional_rows;
use super::table::Table;
use super::{Figure, ReportError};
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

    /// `times-speed-vs-error`, `times-precision`, `precision-offset` and `times-plane-search`, each on as many pages as it takes, and `coverage`:
    /// those of the parts that the run has.
    pub(super) fn figures(&self, summary: &Summary) -> Vec<(String, Figure)> {
        let mut all = errors::figures(self, summary);
        all.extend(precision::figures(self, summary));
        all.extend(planes::figures(self, summary));
        all.extend(coverage::figure(self, summary).map(|figure| ("coverage".to_owned(), figure)));
        all
    }

    /// The tables of the parts that the run has; those named `times-*` where something was timed.
    pub(super) fn tables(&self, summary: &Summary) -> Vec<(&'static str, Table)> {
        let mut all = vec![("verdicts", super::tables::verdicts(summary))];
        if !self.errors.is_empty() {
            all.push(("samplers", tables::samplers(self)));
        }
        if !self.enough.is_empty() {
            all.push(("enough", tables::enough(self)));
        }
        if !self.precision.is_empty() {
            all.push(("precision", tables::precision(self)));
        }
        if !self.planes.is_empty() {
            all.push(("planes", tables::planes(self)));
        }
        if !self.coverage.is_empty() {
            all.push(("coverage", tables::coverage(self)));
        }
        let timed = [
            ("times-samplers", tables::times_samplers(self)),
            ("times-enough", tables::times_enough(self)),
            ("times-precision", tables::times_precision(self)),
            ("times-planes", tables::times_planes(self)),
        ];
        let timed = timed.into_iter();
        all.extend(timed.filter_map(|(name, table)| Some((name, table?))));
        if !self.timings.is_empty() {
            let summaries = [
                (!self.errors.is_empty())
                    .then(|| ("times-samplers-summary", screen::samplers(self))),
                (!self.precision.is_empty())
                    .then(|| ("times-precision-summary", screen::precision(self))),
                screen::searches(self, usize::MAX).map(|table| ("times-planes-summary", table)),
            ];
            all.extend(summaries.into_iter().flatten());
        }
        all
    }

    /// The tables of the screen.
    pub(super) fn screen(&self, width: usize) -> String {
        screen::tables(self, width)
    }
}
