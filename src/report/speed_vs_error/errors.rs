//! Error of an estimate against the seconds it takes, a panel for each quantity, scene and question.

use plotters::style::text_anchor::{HPos, VPos};

use super::SpeedVsError;
use super::times::Of;
use crate::report::Figure;
use crate::report::axis::{Axis, extent};
use crate::report::figure::Pen;
use crate::report::grid::{Grid, page_name, part};
use crate::report::legend::Key;
use crate::report::number::{decimals_for, fixed, grouped};
use crate::report::palette::{INK, Look, MUTED};
use crate::report::panel::{Frame, Panel};
use crate::report::series::distinct;
use crate::report::text::{MEDIUM, SMALL, fit};
use crate::study::records::{ErrorRecord, ExponentRecord, Summary};

const TITLE: &str = "How fast does each sampler of lines come near the truth?";
/// What the panels show, in words; of every other quantity the table tells.
const QUANTITIES: [(&str, &str); 2] = [("nodes", "single nodes"), ("C", "tree cost C")];
/// Panels of a page.
const PANELS: usize = 8;
const GRID: Grid = Grid {
    columns: 2,
    left: 44.0,
    above: 20.0,
    size: (150.0, 92.0),
    pitch: (254.0, 120.0),
};
const RADIUS: f64 = 2.0;
/// Distance of two exponents beside a panel.
const LINE: f64 = 10.0;

/// One panel.
struct Part<'r> {
    rays: &'r str,
    scene: &'r str,
    quantity: (&'static str, &'static str),
    rows: Vec<&'r ErrorRecord>,
}

impl<'r> Part<'r> {
    /// Those that have something to draw: by question, scene and quantity.
    fn all(run: &'r SpeedVsError) -> Vec<Self> {
        let scenes = distinct(run.errors.iter().map(|row| row.scene.as_str()));
        let mut parts = Vec::new();
        for rays in distinct(run.errors.iter().map(|row| row.rays.as_str())) {
            for &scene in &scenes {
                for quantity in QUANTITIES {
                    let of = |row: &&ErrorRecord| {
                        (&*row.rays, &*row.scene, &*row.quantity) == (rays, scene, quantity.0)
                    };
                    let rows: Vec<_> = run.errors.iter().filter(of).collect();
                    if rows.iter().any(|row| row.rmse > 0.0) {
                        parts.push(Part {
                            rays,
                            scene,
                            quantity,
                            rows,
                        });
                    }
                }
            }
        }
        parts
    }

    fn exponent(&self, run: &'r SpeedVsError, sampler: &str) -> Option<&'r ExponentRecord> {
        run.exponents.iter().find(|row| {
            (&*row.rays, &*row.scene, &*row.quantity) == (self.rays, self.scene, self.quantity.0)
                && row.sampler == sampler
        })
    }

    /// The largest error of the reference itself.
    fn floor(&self) -> Option<f64> {
        let own = self.rows.iter().filter_map(|row| row.truth_error);
        extent(own.filter(|error| *error > 0.0)).map(|range| range.1)
    }
}

/// The pages.
pub fn figures(run: &SpeedVsError, summary: &Summary) -> Vec<(String, Figure)> {
    let parts = Part::all(run);
    let pages = parts.chunks(PANELS);
    let of = pages.len();
    let page = |(i, parts): (usize, &[Part])| {
        let name = page_name("times-speed-vs-error", i);
        (name, figure(run, parts, &part(i, of), summary))
    };
    pages.enumerate().map(page).collect()
}

fn figure(run: &SpeedVsError, parts: &[Part], which: &str, summary: &Summary) -> Figure {
    let samplers = distinct(run.errors.iter().map(|row| row.sampler.as_str()));
    let timed = run
        .errors
        .iter()
        .any(|r| run.replicate_seconds(r).is_some());
    let floors = parts.iter().any(|part| part.floor().is_some());
    let mut keys: Vec<_> = samplers
        .iter()
        .enumerate()
        .map(|(i, name)| (Key::Mark(Look::of(i)), (*name).to_owned()))
        .collect();
    keys.extend(floors.then(|| (Key::Dashes(MUTED), "the reference's own error".to_owned())));
    let caption = (TITLE, caption(run, timed, floors, which, summary));
    GRID.figure(
        caption,
        &keys,
        parts.len(),
        summary,
        |pen, number, frame| {
            let lowest = GRID.is_lowest(number, parts.len());
            let curves = Curves {
                run,
                part: &parts[number],
                samplers: &samplers,
                timed,
            };
            curves.draw(pen, frame, lowest);
        },
    )
}

fn caption(
    run: &SpeedVsError,
    timed: bool,
    floors: bool,
    which: &str,
    summary: &Summary,
) -> String {
    let range = |of: fn(&ErrorRecord) -> u64| {
        let (lo, hi) = extent(run.errors.iter().map(|row| of(row) as f64)).unwrap_or_default();
        let [lo, hi] = [lo, hi].map(|end| grouped(end as u64));
        if lo == hi {
            lo
        } else {
            format!("{lo} to {hi}")
        }
    };
    let strategies = distinct(run.errors.iter().map(|row| row.strategy.as_str()));
    let across = if timed {
        "seconds of one replicate on one thread, its lines' generation included"
    } else {
        "lines of a replicate, as nothing was timed"
    };
    let disturbed = run.disturbed(Of::Samplers);
    let reference = if floors {
        " Of lines:nearest the truth is a long reference, whose own standard error is the dashed line."
    } else {
        ""
    };
    format!(
        "Relative root mean square error against {across}; {} lines, {} independent replicates; bars: 95 % intervals. Single \
         nodes: square root of the mean over the nodes of MSE/(p(1 − p)), 1/√N for N independent lines. The truth of lines is known \
         from areas.{reference} Beside each panel: the exponent of 1/N fitted to its curve, with its 95 % interval.{disturbed} Strategy {}, stop \
         {}. Seed {}.{which}",
        range(|row| row.lines),
        range(|row| row.replicates),
        strategies.join(", "),
        summary.stop.as_deref().unwrap_or("unknown"),
        summary.seed
    )
}

/// The range, or out to the next powers of ten where fewer than two lie in it: labels of other numbers as small as seconds are
/// too wide for a panel.
fn whole_decades(low: f64, high: f64) -> (f64, f64) {
    let (first, last) = (low.log10().ceil(), high.log10().floor());
    if last > first {
        return (low, high);
    }
    let ends = (low.log10().floor(), high.log10().ceil());
    (10f64.powf(ends.0), 10f64.powf(ends.1))
}

/// What a panel is drawn from.
struct Curves<'r> {
    run: &'r SpeedVsError,
    part: &'r Part<'r>,
    samplers: &'r [&'r str],
    timed: bool,
}

impl Curves<'_> {
    /// Seconds or lines of a replicate, error, and the ends of its interval.
    fn point(&self, row: &ErrorRecord) -> Option<[f64; 4]> {
        let across = match self.timed {
            true => self.run.replicate_seconds(row)?,
            false => row.lines as f64,
        };
        (row.rmse > 0.0).then_some([across, row.rmse, row.rmse_lo, row.rmse_hi])
    }

    fn draw(&self, pen: &Pen, frame: Frame, lowest: bool) {
        let part = self.part;
        let points: Vec<_> = part.rows.iter().filter_map(|row| self.point(row)).collect();
        let positive = |value: &f64| *value > 0.0;
        let (left, right) = extent(points.iter().map(|p| p[0])).unwrap_or((1e-3, 1.0));
        let errors = points.iter().flat_map(|p| [p[1], p[2], p[3]]);
        let all = errors.chain(part.floor()).filter(positive);
        let (low, high) = extent(all).unwrap_or((1e-3, 1.0));
        let label = match (lowest, self.timed) {
            (false, _) => "",
            (true, true) => "seconds of a replicate, one thread",
            (true, false) => "lines of a replicate",
        };
        let (left, right) = whole_decades(left / 1.3, 1.3 * right);
        let x = Axis::log(label, left, right, 5);
        let y = Axis::log("relative RMSE", low / 1.3, 1.3 * high, 5);
        let mut panel = Panel::new(pen, frame, x, y);
        let heading = format!("{} of {}, {}", part.quantity.1, part.rays, part.scene);
        panel.heading(&fit(&heading, MEDIUM + 0.6, 214.0), frame.left - 2.0, 4.0);
        if let Some(floor) = part.floor() {
            panel.dashes(&[(left, floor), (right, floor)], MUTED, 0.8);
        }
        for (i, sampler) in self.samplers.iter().enumerate() {
            let look = Look::of(i);
            let own = part.rows.iter().filter(|row| row.sampler == *sampler);
            let mut curve: Vec<_> = own.filter_map(|row| self.point(row)).collect();
            curve.sort_by(|a, b| a[0].total_cmp(&b[0]));
            let middles: Vec<_> = curve.iter().map(|p| (p[0], p[1])).collect();
            panel.line(&middles, look.colour, 0.8);
            for [x, y, lo, hi] in curve {
                panel.line(&[(x, lo), (x, hi)], look.colour, 0.7);
                panel.mark((x, y), look.marker, RADIUS, look.colour);
            }
        }
        self.exponents(pen, frame);
    }

    /// The exponents, beside the panel.
    fn exponents(&self, pen: &Pen, frame: Frame) {
        let left = frame.right + 8.0;
        let fitted = self.samplers.iter().enumerate();
        let fitted = fitted.filter_map(|(i, name)| Some((i, self.part.exponent(self.run, name)?)));
        let mut y = frame.top + 5.0;
        for (i, row) in fitted {
            if y == frame.top + 5.0 {
                pen.text(
                    "exponent",
                    (left, y),
                    SMALL,
                    MUTED,
                    (HPos::Left, VPos::Center),
                );
                y += LINE;
            }
            let look = Look::of(i);
            look.marker.draw(pen, (left + 2.0, y), RADIUS, look.colour);
            let half = 0.5 * (row.exponent_hi - row.exponent_lo);
            let decimals = decimals_for(half).clamp(2, 3);
            let text = format!(
                "{} ± {}",
                fixed(row.exponent, decimals),
                fixed(half, decimals)
            );
            pen.text(
                &text,
                (left + 7.0, y),
                SMALL,
                INK,
                (HPos::Left, VPos::Center),
            );
            y += LINE;
        }
    }
}
