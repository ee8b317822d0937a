//! What a run of kind `assumptions` left behind, and what is made of it.

mod classes;
mod metrics;
mod names;
mod nodes;
mod order;
mod rows;
mod screen;
mod tables;
mod totals;

use std::path::Path;

use super::read::{optional_rows, rows_of};
use super::series::distinct;
use super::table::Table;
use super::{Figure, ReportError};
use crate::study::records::{
    BiasRecord, ExactRecord, GroupRecord, MetricRecord, OrderRecord, Summary, VisitRecord,
};

/// The files of a run of kind `assumptions`.
#[derive(Clone, Debug)]
pub struct Assumptions {
    /// `bias.csv`.
    pub bias: Vec<BiasRecord>,
    /// `nodes-by.csv`.
    pub groups: Vec<GroupRecord>,
    /// `visits.csv`.
    pub visits: Vec<VisitRecord>,
    /// `order.csv`: the rows of the surface area metric.
    pub orders: Vec<OrderRecord>,
    /// Those of the other metrics.
    pub others: Vec<OrderRecord>,
    /// `metrics.csv`.
    pub metrics: Vec<MetricRecord>,
    /// `exact.csv`.
    pub exact: Vec<ExactRecord>,
}

/// Panels of a figure of nodes.
const PANELS: usize = 9;

impl Assumptions {
    /// Reads the files of a directory.
    pub(super) fn read(dir: &Path) -> Result<Self, ReportError> {
        let some = |name: &str| dir.join(name);
        let (orders, others) = rows_of(&some("order.csv"))?
            .into_iter()
            .partition(|row: &OrderRecord| row.metric == metrics::AREA);
        Ok(Self {
            bias: rows_of(&some("bias.csv"))?,
            groups: rows_of(&some("nodes-by.csv"))?,
            visits: optional_rows(&some("visits.csv"))?.unwrap_or_default(),
            orders,
            others,
            metrics: rows_of(&some("metrics.csv"))?,
            exact: optional_rows(&some("exact.csv"))?.unwrap_or_default(),
        })
    }

    /// The sets of rays, in the order of the experiment.
    fn sets(&self) -> Vec<&str> {
        distinct(self.orders.iter().map(|row| row.rays.as_str()))
    }

    /// `assumptions`, `assumptions-2`, ... for the nodes of one tree, a panel a set of rays; `assumptions-totals`;
    /// `assumptions-order`; `assumptions-metrics`.
    pub(super) fn figures(&self, summary: &Summary) -> Vec<(String, Figure)> {
        let drawn = distinct(self.visits.iter().map(|row| row.rays.as_str()));
        let pages = drawn.chunks(PANELS).enumerate();
        let page = |(i, sets): (usize, &[&str])| {
            let name = match i {
                0 => "assumptions".to_owned(),
                _ => format!("assumptions-{}", i + 1),
            };
            let of = (i + 1, drawn.len().div_ceil(PANELS));
            (name, nodes::figure(self, sets, of, summary))
        };
        let mut figures: Vec<_> = pages.map(page).collect();
        figures.push((
            "assumptions-totals".to_owned(),
            totals::figure(self, summary),
        ));
        figures.push(("assumptions-order".to_owned(), order::figure(self, summary)));
        figures.push((
            "assumptions-metrics".to_owned(),
            metrics::figure(self, summary),
        ));
        figures
    }

    pub(super) fn tables(&self, summary: &Summary) -> Vec<(&'static str, Table)> {
        let mut tables = vec![
            ("totals", tables::totals(self)),
            ("bias", classes::table(self)),
            ("order", tables::order(self)),
            ("metrics", metrics::table(self)),
            ("metrics-summary", metrics::summary(self)),
            ("verdicts", super::tables::verdicts(summary)),
        ];
        if !self.exact.is_empty() {
            tables.push(("exact", tables::exact(self)));
        }
        tables
    }

    /// The tables of the screen.
    pub(super) fn screen(&self, width: usize) -> String {
        screen::table(self).to_text(width)
    }
}
