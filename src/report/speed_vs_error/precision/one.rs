//! One panel of a figure of kernels.

use super::super::SpeedVsError;
use super::{Quantity, offsets};
use crate::report::axis::{Axis, Tick, extent};
use crate::report::figure::Pen;
use crate::report::palette::{Look, SKY, VERMILLION, faded};
use crate::report::panel::{Frame, Panel};
use crate::report::text::{MEDIUM, fit};
use crate::study::records::{PrecisionRecord, REFUSE_BELOW, WARN_BELOW};
use plotters::style::RGBAColor;

const RADIUS: f64 = 2.2;
/// Of what includes ties.
const SMALL: f64 = 1.7;
/// From the marks of one kernel to those of the next.
const BESIDE: f64 = 3.0;
/// Opacity of what includes ties.
pub const FAINT: f64 = 0.5;
const FAMILIES: [&str; 2] = ["random", "aimed"];
/// Offsets at which f32 numbers are warned of.
pub const WARNED: RGBAColor = faded(SKY, 0.28);
/// Offsets at which they are refused.
pub const REFUSED: RGBAColor = faded(VERMILLION, 0.22);
/// Where scenes that were not moved stand on an axis of offsets: a decade before the least.
const BEFORE: f64 = 10.0;

/// One panel.
pub struct One<'r> {
    /// The run.
    pub run: &'r SpeedVsError,
    /// The scene.
    pub scene: &'r str,
    /// All scenes of the page, whose panels of a row share their scale.
    pub scenes: &'r [&'r str],
    /// What is shown.
    pub quantity: &'r Quantity,
    /// All kernels of the run, each with its look.
    pub kernels: &'r [&'r str],
    /// Whether it is shown against time, else against offsets.
    pub timed: bool,
}

impl<'r> One<'r> {
    fn rows(&self, scene: &str) -> Vec<&'r PrecisionRecord> {
        let first = offsets(self.run, scene).first().copied();
        let drawn = |row: &&PrecisionRecord| {
            row.scene == scene
                && (!self.timed || Some(row.offset) == first)
                && (self.quantity.beyond.is_some() || row.family == "random")
        };
        self.run.precision.iter().filter(drawn).collect()
    }

    /// Ends of the vertical axis.
    fn ends(&self) -> (f64, f64) {
        let rows = self.scenes.iter().flat_map(|scene| self.rows(scene));
        let all = rows.flat_map(|row| self.shown(row).into_iter().flatten());
        let (low, high) = extent(all.filter(|value| *value > 0.0)).unwrap_or((1.0, 10.0));
        (low / 3.0, 2.0 * high.max(1.01 * low))
    }

    /// The horizontal axis, and where an offset of 0 stands.
    fn across(&self, label: &str) -> (Axis, f64) {
        if self.timed {
            let rows = self.scenes.iter().flat_map(|scene| self.rows(scene));
            let all = rows.filter_map(|row| self.run.visit_ns(row));
            let (low, high) = extent(all).unwrap_or((1.0, 10.0));
            let room = (0.1 * (high - low)).max(0.05 * high);
            return (
                Axis::linear(label, (low - room).max(0.0), high + room, 4),
                0.0,
            );
        }
        let all = self
            .scenes
            .iter()
            .flat_map(|scene| offsets(self.run, scene));
        let (low, high) = extent(all.filter(|offset| *offset > 0.0)).unwrap_or((1.0, 10.0));
        let zero = low / BEFORE;
        let mut axis = Axis::log(label, zero / 2.0, 2.0 * high, 5);
        axis.ticks.retain(|tick| tick.at > zero.log10() + 0.5);
        axis.ticks.push(Tick {
            at: zero.log10(),
            label: "0".to_owned(),
        });
        (axis, zero)
    }

    /// Draws it; the edges of the page that it stands at: top, left and bottom.
    pub fn draw(&self, pen: &Pen, frame: Frame, (top, leftmost, lowest): (bool, bool, bool)) {
        let label = match (lowest, self.timed) {
            (false, _) => "",
            (true, true) => "ns per visit",
            (true, false) => "offset / longest side",
        };
        let (x, zero) = self.across(label);
        let (low, high) = self.ends();
        let label = if leftmost { self.quantity.label } else { "" };
        let y = Axis::log(label, low, high, 4);
        let mut panel = Panel::new(pen, frame, x, y);
        if top {
            let heading = fit(self.scene, MEDIUM + 0.6, frame.right - frame.left);
            panel.heading(&heading, frame.left - 2.0, 4.0);
        }
        if !self.timed {
            self.zones(&mut panel, (low, high));
        }
        let curves = self.curves(zero);
        // Faint first: what is no tie stands before it.
        for curve in &curves {
            self.faint(&mut panel, curve, low);
        }
        for curve in &curves {
            self.marks(&mut panel, curve, low);
        }
    }

    /// What is marked of a row, and the ends of its bar; of rates the errors that are no ties, without one.
    fn marked(&self, row: &PrecisionRecord) -> Option<[f64; 3]> {
        match self.quantity.beyond.map(|of| of(row)) {
            None => (self.quantity.of)(row),
            Some([_, 0]) => None,
            Some([wrong, of]) => Some([1e9 * wrong as f64 / of as f64; 3]),
        }
    }

    /// All numbers that are drawn of a row.
    fn shown(&self, row: &PrecisionRecord) -> [Option<f64>; 6] {
        let both = [(self.quantity.of)(row), self.marked(row)];
        let all = both.map(|values| values.map_or([None; 3], |v| v.map(Some)));
        [
            all[0][0], all[0][1], all[0][2], all[1][0], all[1][1], all[1][2],
        ]
    }

    /// The rows of every kernel and family of the scene, each from left to right.
    fn curves(&self, zero: f64) -> Vec<Curve<'r>> {
        let rows = self.rows(self.scene);
        let mut all = Vec::new();
        for (j, family) in FAMILIES.into_iter().enumerate() {
            for (i, kernel) in self.kernels.iter().enumerate() {
                let own = rows
                    .iter()
                    .filter(|row| row.family == family && row.kernel == *kernel);
                let placed = own.filter_map(|row| match self.timed {
                    true => Some((self.run.visit_ns(row)?, *row)),
                    false => Some((row.offset.max(zero), *row)),
                });
                let mut rows: Vec<_> = placed.collect();
                rows.sort_by(|a, b| a.0.total_cmp(&b.0));
                // Against time kernels stand apart by themselves.
                let place = if self.timed { j } else { 2 * i + j };
                let places = if self.timed {
                    2
                } else {
                    2 * self.kernels.len()
                };
                all.push(Curve {
                    rows,
                    look: Look::of(i),
                    aimed: j == 1,
                    beside: BESIDE * (place as f64 - 0.5 * (places - 1) as f64),
                });
            }
        }
        all
    }

    /// A rate with its ties.
    fn faint(&self, panel: &mut Panel, curve: &Curve, low: f64) {
        if self.quantity.beyond.is_none() {
            return;
        }
        let colour = faded(curve.look.colour, FAINT);
        let points = curve.points(panel, self.quantity.of);
        let line: Vec<_> = points.iter().map(|(x, v)| (*x, v[0].max(low))).collect();
        if curve.aimed {
            panel.dashes(&line, colour, 0.7);
        } else {
            panel.line(&line, colour, 0.7);
        }
        for (x, [value, lo, hi]) in points {
            panel.line(&[(x, lo.max(low)), (x, hi.max(low))], colour, 0.7);
            curve.mark(panel, (x, value.max(low)), SMALL, colour);
        }
    }

    /// What is marked, joined by a line.
    fn marks(&self, panel: &mut Panel, curve: &Curve, low: f64) {
        let colour = curve.look.colour;
        let points = curve.points(panel, |row| self.marked(row));
        let line: Vec<_> = points.iter().map(|(x, v)| (*x, v[0].max(low))).collect();
        panel.line(&line, faded(colour, 0.7), 0.8);
        for (x, [value, lo, hi]) in points {
            panel.line(&[(x, lo.max(low)), (x, hi.max(low))], colour, 0.7);
            curve.mark(panel, (x, value.max(low)), RADIUS, colour);
        }
    }

    /// Shades the offsets from which on f32 is warned of, and refused.
    fn zones(&self, panel: &mut Panel, (low, high): (f64, f64)) {
        let end = panel.x.value(1.0);
        let refused = self.crossing(REFUSE_BELOW).unwrap_or(end).min(end);
        let warned = self.crossing(WARN_BELOW).unwrap_or(end).min(end);
        panel.rectangle((warned, low), (refused, high), WARNED);
        panel.rectangle((refused, low), (end, high), REFUSED);
    }

    /// The offset at which `resolution` falls below a limit, from the row that is nearest to it: it falls as 1/offset.
    fn crossing(&self, limit: f64) -> Option<f64> {
        let own = self.run.precision.iter().filter(|r| r.scene == self.scene);
        let known = own.filter_map(|r| Some((r.offset, r.resolution?)));
        let moved = known.filter(|(offset, resolution)| *offset > 0.0 && *resolution > 0.0);
        let far = |resolution: f64| (resolution / limit).ln().abs();
        let nearest = moved.min_by(|a, b| far(a.1).total_cmp(&far(b.1)))?;
        Some(nearest.0 * nearest.1 / limit)
    }
}

/// What is drawn of a kernel and a family of lines.
struct Curve<'r> {
    /// Where each row stands.
    rows: Vec<(f64, &'r PrecisionRecord)>,
    look: Look,
    aimed: bool,
    /// How far to the right of there it is drawn, in points, so that marks of other kernels are seen.
    beside: f64,
}

impl Curve<'_> {
    /// One of its marks, of aimed lines a ring.
    fn mark(&self, panel: &Panel, at: (f64, f64), radius: f64, colour: RGBAColor) {
        if self.aimed {
            panel.ring(at, self.look.marker, radius, colour);
        } else {
            panel.mark(at, self.look.marker, radius, colour);
        }
    }

    /// Where it is drawn, and what is shown of it.
    fn points(
        &self,
        panel: &Panel,
        of: impl Fn(&PrecisionRecord) -> Option<[f64; 3]>,
    ) -> Vec<(f64, [f64; 3])> {
        let width = panel.frame.right - panel.frame.left;
        let place = |x: f64| {
            let at = panel.x.at(x)?;
            let share = (at - panel.x.lo) / (panel.x.hi - panel.x.lo);
            Some(panel.x.value(share + self.beside / width))
        };
        let point = |(x, row): &(f64, &PrecisionRecord)| Some((place(*x)?, of(row)?));
        self.rows.iter().filter_map(point).collect()
    }
}
