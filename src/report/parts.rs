//! What a run is reported in: figures, tables and findings in words, each with the name of its file.

use super::{Content, Figure, ReportError, Run, Table};

impl Run {
    /// Every figure, drawn.
    pub(in crate::report) fn figures(&self) -> Result<Vec<(String, Figure)>, ReportError> {
        let summary = &self.summary;
        Ok(match &self.content {
            Content::Hits(hits) => named(hits.figures(summary)?),
            Content::Strategies(strategies) => strategies.figures(summary)?,
            Content::Termination(trees) => trees.figures(summary)?,
            Content::SplitCost(nodes) => nodes.figures(summary),
            Content::CostVsWork(trees) => trees.figures(summary),
            Content::Assumptions(rays) => rays.figures(summary),
            Content::SpeedVsError(parts) => parts.figures(summary),
            Content::Stability(cases) => cases.figures(summary),
            Content::Traversal(walks) => walks.figures(summary),
        })
    }

    /// Every table.
    pub(in crate::report) fn tables(&self) -> Vec<(String, Table)> {
        let summary = &self.summary;
        match &self.content {
            Content::Hits(hits) => named(hits.tables(summary)),
            Content::Strategies(strategies) => strategies.tables(summary),
            Content::Termination(trees) => named(trees.tables(summary)),
            Content::SplitCost(nodes) => named(nodes.tables(summary)),
            Content::CostVsWork(trees) => named(trees.tables(summary)),
            Content::Assumptions(rays) => named(rays.tables(summary)),
            Content::SpeedVsError(parts) => named(parts.tables(summary)),
            Content::Stability(cases) => named(cases.tables(summary)),
            Content::Traversal(walks) => named(walks.tables(summary)),
        }
    }

    /// The findings in words, as Markdown; most kinds have none.
    pub(in crate::report) fn texts(&self) -> Vec<(String, String)> {
        match &self.content {
            Content::Strategies(strategies) => strategies.texts(),
            Content::CostVsWork(trees) => trees.texts(),
            Content::Traversal(walks) => walks.texts(),
            _ => Vec::new(),
        }
    }
}

/// Names of files that are known beforehand.
fn named<T>(all: Vec<(&str, T)>) -> Vec<(String, T)> {
    let named = all.into_iter().map(|(name, one)| (name.to_owned(), one));
    named.collect()
}
