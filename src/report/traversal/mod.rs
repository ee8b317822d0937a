//! What a run of kind `traversal` left behind, and what is made of it.
//!
//! Seconds are found only in figures and tables whose names begin with `times-`.

mod against;
mod dots;
mod figures;
mod findings;
#[cfg(test)]
mod fixture;
mod saved;
mod screen;
mod tables;
#[cfg(test)]
mod tests;

use std::path::Path;

use super::read::{optional_rows, rows_of};
use super::table::Table;
use super::{Figure, ReportError};
use crate::study::records::{LinkRecord, PassTiming, Summary, TraversalRecord};

/// The files of a run of kind `traversal`.
#[derive(Clone, Debug)]
pub struct Traversal {
    /// `traversal.csv`.
    pub walks: Vec<TraversalRecord>,
    /// `link-memory.csv`.
    pub links: Vec<LinkRecord>,
    /// `timings.csv`.
    pub timings: Vec<PassTiming>,
}

impl Traversal {
    /// Reads the files of a directory.
    pub(super) fn read(dir: &Path) -> Result<Self, ReportError> {
        Ok(Self {
            walks: rows_of(&dir.join("traversal.csv"))?,
            links: rows_of(&dir.join("link-memory.csv"))?,
            timings: optional_rows(&dir.join("timings.csv"))?.unwrap_or_default(),
        })
    }

    /// `traversal`: inner nodes and memory beside the stack's; where something was timed `times-traversal`, seconds likewise, both
    /// on as many pages as they take, and `times-traversal-saved`, seconds against inner nodes.
    pub(super) fn figures(&self, summary: &Summary) -> Vec<(String, Figure)> {
        let mut all = figures::steps(self, summary);
        all.extend(figures::seconds(self, summary));
        let saved = saved::figure(self, summary);
        all.extend(saved.map(|figure| ("times-traversal-saved".to_owned(), figure)));
        all
    }

    /// The tables; those named `times-*` where something was timed.
    pub(super) fn tables(&self, summary: &Summary) -> Vec<(&'static str, Table)> {
        let mut all = vec![
            ("verdicts", super::tables::verdicts(summary)),
            ("traversal", tables::steps(self)),
            ("traversal-summary", tables::steps_summary(self)),
            ("link-memory", tables::memory(self)),
            ("link-memory-summary", tables::memory_summary(self)),
        ];
        if !self.timings.is_empty() {
            all.extend([
                ("times-traversal", tables::times(self)),
                ("times-traversal-summary", tables::times_summary(self)),
                ("times-pays", tables::times_pays(self)),
                ("times-precision", tables::times_precision(self)),
                ("times-links", tables::times_links(self)),
            ]);
        }
        all
    }

    /// The findings in words, as Markdown.
    pub(super) fn texts(&self) -> Vec<(String, String)> {
        vec![("times-findings".to_owned(), findings::text(self))]
    }

    /// The tables of the screen.
    pub(super) fn screen(&self, width: usize) -> String {
        screen::tables(self, width)
    }
}
