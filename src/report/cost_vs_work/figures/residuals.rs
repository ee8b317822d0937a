//! Predicted over measured time, by group of scenes and set of rays, for the model of n_K and n_t and for chosen terms.

use plotters::style::text_anchor::{HPos, VPos};

use super::super::spread::median;
use super::super::{CostVsWork, sets};
use super::{keys, provenance};
use crate::report::axis::{Axis, extent};
use crate::report::figure::{Figure, LEFT, Pen, WIDTH};
use crate::report::glyphs::SUB;
use crate::report::legend::{LEGEND_LEADING, legend, rows_of};
use crate::report::palette::{INK, SKY, faded};
use crate::report::panel::{Frame, Panel};
use crate::report::series::distinct;
use crate::report::text::{LEADING, MEDIUM, caption_lines, fit, text_width};
use crate::study::records::{PredictionRecord, Summary};

const TITLE: &str = "Where is the predicted time of a ray wrong?";
/// Height of the row of a set of rays, and the room between two groups.
const ROW: f64 = 3.9;
const ROOM: f64 = 5.0;
/// Between the panels.
const GAP: f64 = 16.0;
const WIDEST_NAME: f64 = 100.0;
/// The band reaches so far to either side of equality.
const BAND: f64 = 1.1;

/// A prediction of a row.
type Predicted = fn(&PredictionRecord) -> f64;

/// The figure; `None` where nothing was fitted.
pub fn residuals(run: &CostVsWork, summary: &Summary) -> Option<Figure> {
    let ratios = run
        .predictions
        .iter()
        .flat_map(|row| [row.two_ns, row.chosen_ns].map(|predicted| predicted / row.measured_ns));
    let (low, high) = extent(ratios.filter(|&ratio| ratio > 0.0))?;
    let room = (high / low).powf(0.04).max(1.02);
    let ends = [(low / room).min(1.0 / BAND), (high * room).max(BAND)];
    let keys = keys(run);
    let lines = rows_of(WIDTH - 2.0 * LEFT, &keys);
    let caption = format!(
        "Predicted over measured time of a set of rays in a tree, with constants fitted without its scene: a dot is a \
         tree, a bar the median of a set of rays. (a) Counted n{SUB}K and n{SUB}t, a constant each; (b) terms chosen from many. \
         Line: predicted = measured; shaded: within 10 % of it. {}",
        provenance(run, summary.seed)
    );
    let caption = caption_lines(caption, WIDTH - 2.0 * LEFT, summary.quick);
    let groups = distinct(run.predictions.iter().map(|row| row.group.as_str()));
    let names: Vec<String> = groups.iter().map(|g| fit(g, MEDIUM, WIDEST_NAME)).collect();
    let widest = names.iter().map(|name| text_width(name, MEDIUM));
    let left = LEFT + widest.fold(0.0, f64::max) + 7.0;
    let rows = Rows {
        sets: sets::of(run),
        groups,
        top: 54.0 + LEGEND_LEADING * (lines - 1) as f64,
    };
    let bottom = rows.top + rows.pitch() * rows.groups.len() as f64;
    let baseline = bottom + 36.0;
    let height = baseline + LEADING * (caption.len() - 1) as f64 + 6.0;
    Some(Figure::draw(
        TITLE,
        (&caption, baseline),
        WIDTH,
        height,
        |pen| {
            legend(pen, (LEFT, WIDTH - LEFT), 31.0, &keys);
            for (number, name) in names.iter().enumerate() {
                let middle = rows.top + rows.pitch() * (number as f64 + 0.5);
                let right = (HPos::Right, VPos::Center);
                pen.text(name, (left - 5.0, middle), MEDIUM, INK, right);
            }
            let wide = 0.5 * (WIDTH - LEFT - 6.0 - left - GAP);
            let frame = |left: f64| Frame {
                left,
                top: rows.top,
                right: left + wide,
                bottom,
            };
            let panels: [(String, Frame, Predicted); 2] = [
                (
                    format!("(a) counted n{SUB}K, n{SUB}t"),
                    frame(left),
                    |row| row.two_ns,
                ),
                (
                    "(b) chosen terms".to_owned(),
                    frame(left + wide + GAP),
                    |row| row.chosen_ns,
                ),
            ];
            for (heading, frame, predicted) in panels {
                panel(pen, run, &rows, frame, ends, predicted).heading(&heading, frame.left, 4.0);
            }
        },
    ))
}

/// Where a set of rays of a group of scenes stands.
struct Rows<'r> {
    groups: Vec<&'r str>,
    sets: Vec<&'r str>,
    top: f64,
}

impl Rows<'_> {
    /// Height of a group.
    fn pitch(&self) -> f64 {
        ROW * self.sets.len() as f64 + ROOM
    }

    /// Middle of a row, in points from the top of the page.
    fn middle(&self, group: usize, set: usize) -> f64 {
        self.top + self.pitch() * group as f64 + 0.5 * ROOM + ROW * (set as f64 + 0.5)
    }
}

fn panel<'p, 'a>(
    pen: &'p Pen<'a>,
    run: &CostVsWork,
    rows: &Rows,
    frame: Frame,
    [low, high]: [f64; 2],
    predicted: Predicted,
) -> Panel<'p, 'a> {
    // Downwards, in points.
    let y = Axis {
        ticks: Vec::new(),
        ..Axis::linear("", -frame.bottom, -frame.top, 1)
    };
    let x = Axis::log("predicted / measured time", low, high, 6);
    let mut panel = Panel::new(pen, frame, x, y);
    let (top, bottom) = (-frame.top, -frame.bottom);
    panel.rectangle((1.0 / BAND, top), (BAND, bottom), faded(SKY, 0.25));
    for group in 1..rows.groups.len() {
        let between = -(rows.top + rows.pitch() * group as f64);
        panel.line(&[(low, between), (high, between)], faded(INK, 0.25), 0.4);
    }
    panel.line(&[(1.0, top), (1.0, bottom)], INK, 0.7);
    for (i, group) in rows.groups.iter().enumerate() {
        for (j, set) in rows.sets.iter().enumerate() {
            let own = run
                .predictions
                .iter()
                .filter(|row| row.group == *group && row.rays == *set);
            let ratios: Vec<f64> = own.map(|row| predicted(row) / row.measured_ns).collect();
            let (look, at) = (sets::look(&rows.sets, set), -rows.middle(i, j));
            for &ratio in &ratios {
                panel.mark((ratio, at), look.marker, 1.1, faded(look.colour, 0.45));
            }
            if let Some(middle) = median(ratios) {
                let (above, below) = (at + 0.5 * ROW, at - 0.5 * ROW);
                panel.line(&[(middle, above), (middle, below)], INK, 1.1);
            }
        }
    }
    panel
}
