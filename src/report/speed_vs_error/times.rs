//! Seconds of what the other files tell the errors of.

use super::SpeedVsError;
use crate::study::records::{EnoughRecord, ErrorRecord, PassTiming, PlaneRecord, PrecisionRecord};

impl SpeedVsError {
    /// The latest time of one thing done with one tree: rows of earlier runs stand before it.
    fn timing(&self, cell: &str, what: &str) -> Option<&PassTiming> {
        let own = |row: &&PassTiming| row.cell == cell && row.what == what && row.units > 0;
        self.timings.iter().rev().find(own)
    }

    /// CPU seconds of one replicate: its lines made, followed through the tree and counted.
    pub(super) fn replicate_seconds(&self, row: &ErrorRecord) -> Option<f64> {
        let what = format!("{} {} {}", row.sampler, row.rays, row.lines);
        let timing = self.timing(&row.cell, &what)?;
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
        let what = format!("{} {unit} {:e}", row.kernel, row.offset);
        let timing = self.timing(&row.cell, &what)?;
        Some(1e9 * timing.seconds / timing.units as f64)
    }

    /// Nanoseconds of a visit.
    pub(super) fn visit_ns(&self, row: &PrecisionRecord) -> Option<f64> {
        self.kernel_ns(row, "visit")
    }

    /// Seconds of building a tree.
    pub(super) fn build_seconds(&self, row: &PlaneRecord) -> Option<f64> {
        Some(self.timing(&row.cell, "build")?.seconds).filter(|s| *s > 0.0)
    }
}
