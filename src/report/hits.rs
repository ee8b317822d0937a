//! What a run of kind `hits-vs-area` left behind, and what is made of it.

use std::path::Path;

use super::read::{optional_rows, rows_of};
use super::table::Table;
use super::{Figure, ReportError, choices, cost, figure3, slopes, tables};
use crate::study::records::{
    BinRecord, CellRecord, NodeRecord, SamplerRecord, StrategyChoiceRecord, Summary, TimingRecord,
};

/// The files of a run of kind `hits-vs-area`.
#[derive(Clone, Debug)]
pub struct Hits {
    /// `cells.csv`.
    pub cells: Vec<CellRecord>,
    /// `nodes.csv`, where the run kept nodes.
    pub nodes: Option<Vec<NodeRecord>>,
    /// `bins.csv`, where the run kept bins.
    pub bins: Option<Vec<BinRecord>>,
    /// `samplers.csv`, where there is one.
    pub samplers: Option<Vec<SamplerRecord>>,
    /// `choices.csv`, where the run traced rays.
    pub choices: Option<Vec<StrategyChoiceRecord>>,
    /// `timings.csv`, where there is one.
    pub timings: Option<Vec<TimingRecord>>,
}

impl Hits {
    /// Reads `cells.csv` and, where there are any, the other files of a directory.
    pub(super) fn read(dir: &Path) -> Result<Self, ReportError> {
        Ok(Self {
            cells: rows_of(&dir.join("cells.csv"))?,
            nodes: optional_rows(&dir.join("nodes.csv"))?,
            bins: optional_rows(&dir.join("bins.csv"))?,
            samplers: optional_rows(&dir.join("samplers.csv"))?,
            choices: optional_rows(&dir.join("choices.csv"))?,
            timings: optional_rows(&dir.join("timings.csv"))?,
        })
    }

    /// The cell whose nodes the main figure shows.
    fn figure_cell(&self, summary: &Summary) -> Result<&CellRecord, ReportError> {
        let (scene, strategy) = (&summary.figure_scene, &summary.figure_strategy);
        let shown = |cell: &&CellRecord| {
            Some(&cell.scene) == scene.as_ref() && Some(&cell.strategy) == strategy.as_ref()
        };
        let missing = || ReportError::Empty {
            what: format!(
                "cells.csv: no cell of scene {} with strategy {}",
                scene.as_deref().unwrap_or("(none)"),
                strategy.as_deref().unwrap_or("(none)")
            ),
        };
        self.cells.iter().find(shown).ok_or_else(missing)
    }

    /// `figure3` needs the nodes of the summary's figure cell and is left out where the run kept no nodes; `slopes` is
    /// left out where no cell has a slope.
    pub(super) fn figures(
        &self,
        summary: &Summary,
    ) -> Result<Vec<(&'static str, Figure)>, ReportError> {
        let quick = summary.quick;
        let mut figures = Vec::new();
        if let Some(nodes) = &self.nodes {
            let cell = self.figure_cell(summary)?;
            let nodes: Vec<_> = nodes
                .iter()
                .filter(|node| node.cell == cell.cell)
                .cloned()
                .collect();
            figures.push(("figure3", figure3::figure(cell, &nodes, quick)?));
        }
        if let Some(within) = summary.slope_within
            && let Some(figure) = slopes::figure(&self.cells, within, quick)
        {
            figures.push(("slopes", figure));
        }
        figures.push(("predicted-vs-measured", cost::figure(&self.cells, quick)?));
        Ok(figures)
    }

    pub(super) fn tables(&self, summary: &Summary) -> Vec<(&'static str, Table)> {
        let mut tables = vec![
            ("cells", tables::cells(&self.cells)),
            ("costs", tables::costs(&self.cells)),
            ("fits", tables::fits(&self.cells)),
            ("strategies", tables::strategies(&self.cells)),
            ("trees", tables::trees(&self.cells)),
            ("verdicts", tables::verdicts(summary)),
        ];
        if let Some(samplers) = &self.samplers {
            tables.push(("samplers", tables::samplers(samplers)));
        }
        if let Some(choices) = self.choices.as_deref().filter(|all| !all.is_empty()) {
            tables.push(("work", choices::table(choices)));
        }
        tables
    }
}
