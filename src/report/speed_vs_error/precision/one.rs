//! One panel of a figure of kernels.

use super::super::SpeedVsError;
use super::{Quantity, offsets};
use crate::report::axis::{Axis, Tick, extent};
use crate::report::figure::Pen;
use crate::report::palette::{Look, SKY, VERMILLION, faded};
use crate::report::panel::{Frame, Panel};
use crate::report::series::distinct;
use crate::report::text::{MEDIUM, fit};
use crate::study::records::PrecisionRecord;
use plotters::style::RGBAColor;

const RADIUS: f64 = 2.4;
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
                && (self.quantity.rate || row.family == "random")
        };
        self.run.precision.iter().filter(drawn).collect()
    }

    /// Ends of the vertical axis.
    fn ends(&self) -> (f64, f64) {
        let rows = self.scenes.iter().flat_map(|scene| self.rows(scene));
        let all = rows.filter_map(self.quantity.of).flatten();
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
            self.zones(&mut panel, zero, (low, high));
        }
        let rows = self.rows(self.scene);
        for family in distinct(rows.iter().map(|row| row.family.as_str())) {
            for (i, kernel) in self.kernels.iter().enumerate() {
                let own = rows
                    .iter()
                    .filter(|row| row.family == family && row.kernel == *kernel);
                let mut points: Vec<_> = own
                    .filter_map(|row| {
                        let across = match self.timed {
                            true => self.run.visit_ns(row)?,
                            false => row.offset.max(zero),
                        };
                        Some((across, (self.quantity.of)(row)?))
                    })
                    .collect();
                points.sort_by(|a, b| a.0.total_cmp(&b.0));
                let look = Look::of(i);
                let curve: Vec<_> = points.iter().map(|(x, v)| (*x, v[0].max(low))).collect();
                let faint = faded(look.colour, 0.7);
                match family {
                    "random" => panel.line(&curve, faint, 0.8),
                    _ => panel.dashes(&curve, faint, 0.7),
                }
                for (x, [value, lo, hi]) in points {
                    panel.line(&[(x, lo.max(low)), (x, hi.max(low))], look.colour, 0.7);
                    let at = (x, value.max(low));
                    match family {
                        "random" => panel.mark(at, look.marker, RADIUS, look.colour),
                        _ => panel.ring(at, look.marker, RADIUS, look.colour),
                    }
                }
            }
        }
    }

    /// Shades the offsets at which f32 numbers are warned of or refused, as far as half way to the next.
    fn zones(&self, panel: &mut Panel, zero: f64, (low, high): (f64, f64)) {
        let all: Vec<f64> = offsets(self.run, self.scene);
        let place = |i: usize| all[i].max(zero);
        let between = |i: usize, j: usize| (place(i) * place(j)).sqrt();
        for (i, offset) in all.iter().enumerate() {
            let mut own = self.run.precision.iter();
            let verdict = own.find(|r| {
                r.scene == self.scene && r.offset == *offset && r.kernel.starts_with("f32")
            });
            let colour = match verdict.map(|row| row.verdict.as_str()) {
                Some("warned") => WARNED,
                Some("refused") => REFUSED,
                _ => continue,
            };
            let from = if i == 0 {
                zero / 2.0
            } else {
                between(i - 1, i)
            };
            let to = if i + 1 == all.len() {
                2.0 * place(i)
            } else {
                between(i, i + 1)
            };
            panel.rectangle((from, low), (to, high), colour);
        }
    }
}
