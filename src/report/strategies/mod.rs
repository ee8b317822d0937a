//! What a run of kind `strategies` left behind, and what is made of it: Havran's table (2000) beside ours.
//!
//! Everything is told for each stop rule by itself, of the seconds that the run took as well as of its exact counts.
//! Seconds are found only in figures and tables whose names begin with `times-`: all others depend on counts alone and
//! are the same, byte for byte, in every run.

pub(super) mod averages;
mod dots;
mod findings;
#[cfg(test)]
pub(super) mod fixture;
pub(super) mod gallery;
mod greedy;
mod havran;
mod netpbm;
pub(super) mod part;
mod screen;
mod tables;
#[cfg(test)]
mod tests;

use std::path::{Path, PathBuf};

use super::read::{optional_rows, rows_of};
use super::series::distinct;
use super::table::Table;
use super::{Figure, ReportError, cost, partition};
use crate::study::records::{
    CellRecord, OutlineRecord, PassTiming, RayRecord, SliceRecord, Summary, file_stem,
};
use part::{Measure, Part};

pub(super) use screen::study;

/// The files of a run of kind `strategies`.
#[derive(Clone, Debug)]
pub struct Strategies {
    /// `cells.csv`.
    pub cells: Vec<CellRecord>,
    /// `rays.csv`.
    pub rays: Vec<RayRecord>,
    /// `timings.csv`, where there is one.
    pub timings: Option<Vec<PassTiming>>,
    /// The folder `pictures`, whose files are read when they are drawn.
    pub pictures: PathBuf,
    /// `slices.csv` and `outlines.csv`, where a slice was asked for.
    pub slice: Option<(Vec<SliceRecord>, Vec<OutlineRecord>)>,
}

/// Something with the name of its file.
type Named<T> = (String, T);

impl Strategies {
    /// Reads `cells.csv`, `rays.csv` and, where there is one, `timings.csv` of a directory.
    pub(super) fn read(dir: &Path) -> Result<Self, ReportError> {
        Ok(Self {
            cells: rows_of(&dir.join("cells.csv"))?,
            rays: rows_of(&dir.join("rays.csv"))?,
            timings: optional_rows(&dir.join("timings.csv"))?,
            pictures: dir.join("pictures"),
            slice: {
                let cells = optional_rows(&dir.join("slices.csv"))?;
                cells.zip(optional_rows(&dir.join("outlines.csv"))?)
            },
        })
    }

    /// The trees of each stop rule, in the order of the run.
    fn parts(&self) -> Vec<Part<'_>> {
        let stops = distinct(self.cells.iter().map(|cell| cell.stop.as_str()));
        stops.iter().map(|stop| Part::new(self, stop)).collect()
    }

    /// Of each stop rule: the trees against those of the reference by cost and by time, and predicted against counted
    /// cost. Of the scenes: all pictures together, and each with its cost.
    pub(super) fn figures(&self, summary: &Summary) -> Result<Vec<Named<Figure>>, ReportError> {
        let quick = summary.quick;
        let mut figures = Vec::new();
        for part in self.parts() {
            let stop = file_stem(part.stop);
            for (name, measure) in [
                ("strategies-cost", Measure::Counted),
                ("strategies-rays", Measure::Traced),
                ("times-strategies", Measure::Total),
            ] {
                if let Some(figure) = dots::figure(&part, measure, quick) {
                    figures.push((format!("{name}-{stop}"), figure));
                }
            }
            let name = format!("predicted-vs-measured-{stop}");
            figures.push((name, cost::figure(&part.cells, quick)?));
        }
        figures.extend(gallery::figures(self, summary)?);
        figures.extend(self.partition(quick));
        Ok(figures)
    }

    /// The slice through the trees, where one was asked for.
    pub(super) fn partition(&self, quick: bool) -> Option<Named<Figure>> {
        let (cells, outlines) = self.slice.as_ref()?;
        let figure = partition::figure(cells, outlines, quick)?;
        Some(("partition".to_owned(), figure))
    }

    pub(super) fn tables(&self, summary: &Summary) -> Vec<Named<Table>> {
        let mut all = vec![
            ("verdicts".to_owned(), super::tables::verdicts(summary)),
            ("ray-counts".to_owned(), tables::ray_counts(&self.rays)),
        ];
        for part in self.parts() {
            let of_part = [
                ("havran-cost", tables::averages(&part, &Measure::COSTS)),
                ("scenes-cost", tables::scenes(&part, &Measure::COSTS)),
                ("greedy", greedy::table(&part)),
                ("costs", super::tables::costs(&part.cells)),
                ("trees", super::tables::trees(&part.cells)),
                ("rays", tables::rays(&part)),
                ("times-havran", tables::havran(&part)),
                ("times-averages", tables::averages(&part, &Measure::TIMES)),
                ("times-scenes", tables::scenes(&part, &Measure::TIMES)),
                ("times-cells", tables::times(&part)),
            ];
            let stop = file_stem(part.stop);
            all.extend(of_part.map(|(name, table)| (format!("{name}-{stop}"), table)));
        }
        all
    }

    /// The findings in words, as Markdown.
    pub(super) fn texts(&self) -> Vec<Named<String>> {
        let of_part = |part: &Part| {
            let stop = file_stem(part.stop);
            [
                (format!("findings-cost-{stop}"), findings::by_cost(part)),
                (format!("times-findings-{stop}"), findings::by_time(part)),
            ]
        };
        self.parts().iter().flat_map(of_part).collect()
    }
}
