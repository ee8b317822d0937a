//! What a run of kind `split-cost` left behind, and what is made of it.

mod curves;
mod medians;

use std::path::Path;

use super::number::Z99;
use super::read::{optional_rows, rows_of};
use super::table::{Cell, Column, Table};
use super::{Figure, ReportError, tables};
use crate::study::records::{CurveNodeRecord, CurveRecord, MedianRecord, OctreeRecord, Summary};

/// The files of a run of kind `split-cost`.
#[derive(Clone, Debug)]
pub struct SplitCost {
    /// `medians.csv`.
    pub medians: Vec<MedianRecord>,
    /// `curve-nodes.csv`.
    pub nodes: Vec<CurveNodeRecord>,
    /// `curves.csv`.
    pub curves: Vec<CurveRecord>,
    /// `octree.csv`.
    pub octrees: Vec<OctreeRecord>,
}

impl SplitCost {
    /// Reads the files of a directory.
    pub(super) fn read(dir: &Path) -> Result<Self, ReportError> {
        let some = |name: &str| dir.join(name);
        Ok(Self {
            medians: rows_of(&some("medians.csv"))?,
            nodes: optional_rows(&some("curve-nodes.csv"))?.unwrap_or_default(),
            curves: optional_rows(&some("curves.csv"))?.unwrap_or_default(),
            octrees: optional_rows(&some("octree.csv"))?.unwrap_or_default(),
        })
    }

    /// `split-cost`, where nodes are drawn, and `medians`.
    pub(super) fn figures(&self, summary: &Summary) -> Vec<(String, Figure)> {
        let mut figures = Vec::new();
        let curves = curves::figure(&self.nodes, &self.curves, summary);
        figures.extend(curves.map(|figure| ("split-cost".to_owned(), figure)));
        let medians = medians::figure(&self.medians, summary);
        figures.push(("medians".to_owned(), medians));
        figures
    }

    pub(super) fn tables(&self, summary: &Summary) -> Vec<(&'static str, Table)> {
        let mut tables = vec![
            ("medians", self.medians()),
            ("verdicts", tables::verdicts(summary)),
        ];
        if !self.octrees.is_empty() {
            tables.push(("octree", self.octree()));
        }
        tables
    }

    /// Where the minimum lies and how far the medians are apart, for every scene and axis.
    pub(super) fn medians(&self) -> Table {
        let columns = vec![
            Column::left("scene", "scene"),
            Column::left("axis", "axis"),
            Column::right("nodes", "nodes"),
            Column::right("minimum between, %", "between_pct"),
            Column::right("by centres, %", "between_centres_pct"),
            Column::right("dearer: between, %", "between_excess_pct"),
            Column::right("dearer: samples, %", "samples_excess_pct"),
            Column::right("even", "even"),
            Column::right("largest difference", "even_apart"),
            Column::right("straddled", "straddled"),
            Column::right("5 %", "apart_q05_pct"),
            Column::right("50 %", "apart_q50_pct"),
            Column::right("95 %", "apart_q95_pct"),
        ];
        let percent = |value: Option<f64>, decimals| {
            value.map_or(Cell::Missing, |v| Cell::Value(100.0 * v, decimals))
        };
        let signed =
            |value: Option<f64>| value.map_or(Cell::Missing, |v| Cell::Change(100.0 * v, 1));
        let row = |r: &MedianRecord| {
            let share = |n: u64| (r.nodes > 0).then(|| n as f64 / r.nodes as f64);
            vec![
                Cell::Text(r.scene.clone()),
                Cell::Text(r.axis.clone()),
                Cell::Count(r.nodes),
                percent(share(r.between), 1),
                percent(share(r.between_centres), 1),
                percent(r.between_excess_mean, 2),
                percent(r.samples_excess_mean, 2),
                Cell::Count(r.even),
                r.even_apart
                    .map_or(Cell::Missing, |v| Cell::Text(scientific(v))),
                Cell::Count(r.straddled),
                signed(r.apart_q05),
                signed(r.apart_q50),
                signed(r.apart_q95),
            ]
        };
        let whole = |r: &&MedianRecord| r.objects_lo == 2 && r.objects_hi.is_none();
        Table {
            caption: "Inner nodes of the trees of strategy sah, a node once for each axis: share whose least split cost f lies \
                      between the medians (both included), with straddlers on both sides and with each object counted once by \
                      its centre; mean by which the cheapest plane between the medians, and the cheapest of strategy 7's \
                      samples, is dearer than the cheapest of all. Even: nothing straddles a median and the object median \
                      parts the objects evenly, so that f(b_om) = f(b_rm); straddled: quantiles of f(b_om)/f(b_rm) − 1 in per \
                      cent."
                .to_owned(),
            columns,
            keys: 2,
            rows: self.medians.iter().filter(whole).map(row).collect(),
        }
    }

    /// Strategy 1 beside the octree of the same cells.
    pub(super) fn octree(&self) -> Table {
        let columns = vec![
            Column::left("scene", "scene"),
            Column::left("stop", "stop"),
            Column::right("leaves", "leaves"),
            Column::right("inner, kd", "kd_inner_nodes"),
            Column::right("inner, octree", "octree_inner_nodes"),
            Column::right("n_B of both", "n_b"),
            Column::right("n_K kd predicted", "kd_n_k_predicted"),
            Column::measured("n_K kd counted", "kd_n_k_counted"),
            Column::right("n_K octree predicted", "octree_n_k_predicted"),
            Column::measured("n_K octree counted", "octree_n_k_counted"),
            Column::right("kd / octree", "ratio"),
        ];
        let row = |r: &OctreeRecord| {
            vec![
                Cell::Text(r.scene.clone()),
                Cell::Text(r.stop.clone()),
                Cell::Count(r.leaves),
                Cell::Count(r.kd_inner_nodes),
                Cell::Count(r.octree_inner_nodes),
                Cell::Value(r.n_b_counted, 2),
                Cell::Value(r.kd_n_k_predicted, 2),
                Cell::Measured(r.kd_n_k_counted, Some(Z99 * r.kd_n_k_se)),
                Cell::Value(r.octree_n_k_predicted, 2),
                Cell::Measured(r.octree_n_k_counted, Some(Z99 * r.octree_n_k_se)),
                Cell::Value(r.kd_n_k_predicted / r.octree_n_k_predicted, 2),
            ]
        };
        Table {
            caption: "Strategy 1, stopped at every third level only, and the octree of the same cells: leaves and the visits of \
                      them (n_B) are equal, inner nodes are not. Visits of inner nodes (n_K) per isotropic line, predicted \
                      from areas and counted with half of the 99 % interval."
                .to_owned(),
            columns,
            keys: 1,
            rows: self.octrees.iter().map(row).collect(),
        }
    }

    /// The tables of the screen.
    pub(super) fn screen(&self, width: usize) -> String {
        let mut medians = self.medians();
        medians
            .rows
            .retain(|row| row[1] == Cell::Text("all".into()));
        let keep = [0, 2, 3, 4, 5, 6, 10, 11, 12];
        let columns = medians.columns.clone();
        medians.columns = keep.iter().map(|&i| columns[i].clone()).collect();
        medians.keys = 1;
        for row in &mut medians.rows {
            *row = keep.iter().map(|&i| row[i].clone()).collect();
        }
        let mut text = medians.to_text(width);
        if !self.octrees.is_empty() {
            text += &format!("\n{}", self.octree().to_text(width));
        }
        text
    }
}

/// A difference of the size of rounding.
fn scientific(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    format!("{value:.1e}")
}
