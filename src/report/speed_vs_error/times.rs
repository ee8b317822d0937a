//! Seconds of what the other files tell the errors of.

use super::SpeedVsError;
use crate::report::shown::disturbed;
use crate::study::records::{EnoughRecord, ErrorRecord, PassTiming, PlaneRecord, PrecisionRecord};

/// What was timed.
#[derive(Clone, Copy, Debug)]
pub enum Of {
    /// Sets of lines.
    Samplers,
    /// Kernels.
    Kernels,
    /// Builds of plane searches.
    Builds,
}

impl SpeedVsError {
    /// The latest time of one thing done with one tree: rows of earlier runs stand before it.
    fn timing(&self, cell: &str, what: &str) -> Option<&PassTiming> {
        let own = |row: &&PassTiming| row.cell == cell && row.what == what && row.units > 0;
        self.timings.iter().rev().find(own)
    }

    fn replicate_timing(&self, row: &ErrorRecord) -> Option<&PassTiming> {
        let what = format!("{} {} {}", row.sampler, row.rays, row.lines);
        self.timing(&row.cell, &what)
    }

    fn kernel_timing(&self, row: &PrecisionRecord, unit: &str) -> Option<&PassTiming> {
        let what = format!("{} {unit} {:e}", row.kernel, row.offset);
        self.timing(&row.cell, &what)
    }

    fn build_timing(&self, row: &PlaneRecord) -> Option<&PassTiming> {
        self.timing(&row.cell, "build")
    }

    /// How many times of a part were disturbed, as a sentence of a caption; empty where nothing was timed.
    pub(super) fn disturbed(&self, of: Of) -> String {
        let timings: Vec<&PassTiming> = match of {
            Of::Samplers => {
                let rows = self.errors.iter();
                // Every quantity of a replicate comes from the same lines.
                let same =
                    |a: &PassTiming, b: &PassTiming| (&a.cell, &a.what) == (&b.cell, &b.what);
                let mut all: Vec<_> = rows.filter_map(|row| self.replicate_timing(row)).collect();
                all.sort_by(|a, b| (&a.cell, &a.what).cmp(&(&b.cell, &b.what)));
                all.dedup_by(|a, b| same(a, b));
                all
            }
            Of::Kernels => {
                let rows = self.precision.iter().filter(|row| row.family == "random");
                let both = |row| ["visit", "ray"].map(|unit| self.kernel_timing(row, unit));
                rows.flat_map(both).flatten().collect()
            }
            Of::Builds => {
                let rows = self.planes.iter();
                rows.filter_map(|row| self.build_timing(row)).collect()
            }
        };
        disturbed(&timings, "time")
    }

    /// Seconds of one replicate on one thread: its lines made, followed through the tree and counted.
    pub(super) fn replicate_seconds(&self, row: &ErrorRecord) -> Option<f64> {
        let timing = self.replicate_timing(row)?;
        Some(timing.seconds / timing.units as f64 * row.lines as f64).filter(|s| *s > 0.0)
    }

    /// Seconds of a line, from the largest replicates that were timed.
    pub(super) fn line_seconds(&self, scene: &str, sampler: &str, rays: &str) -> Option<f64> {
        let own = self
            .errors
            .iter()
            .filter(|row| row.scene == scene && row.sampler == sampler && row.rays == rays);
        let timed = own
            .filter_map(|row| Some((row.lines, self.replicate_seconds(row)? / row.lines as f64)));
        timed.max_by_key(|(lines, _)| *lines).map(|(_, s)| s)
    }

    /// Seconds of the lines that are enough.
    pub(super) fn enough_seconds(&self, row: &EnoughRecord) -> Option<f64> {
        let line = self.line_seconds(&row.scene, &row.sampler, &row.rays)?;
        Some(line * row.lines as f64)
    }

    /// Nanoseconds of a `visit` of a node by lines that nothing stops, or of a `ray` up to its nearest hit, by a kernel.
    pub(super) fn kernel_ns(&self, row: &PrecisionRecord, unit: &str) -> Option<f64> {
        let timing = self.kernel_timing(row, unit)?;
        Some(1e9 * timing.seconds / timing.units as f64)
    }

    /// Nanoseconds of a visit.
    pub(super) fn visit_ns(&self, row: &PrecisionRecord) -> Option<f64> {
        self.kernel_ns(row, "visit")
    }

    /// Seconds of building a tree.
    pub(super) fn build_seconds(&self, row: &PlaneRecord) -> Option<f64> {
        Some(self.build_timing(row)?.seconds).filter(|s| *s > 0.0)
    }
}
