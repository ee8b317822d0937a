//! Measured against predicted time of a ray, for three predictions of scenes that were left out.

use plotters::style::text_anchor::{HPos, VPos};

use super::super::times::Residuals;
use super::super::{CostVsWork, sets};
use super::{keys, provenance};
use crate::report::axis::{Axis, extent};
use crate::report::figure::{Figure, LEFT, Pen, WIDTH};
use crate::report::glyphs::SUB;
use crate::report::legend::{LEGEND_LEADING, legend, rows_of};
use crate::report::number::fixed;
use crate::report::palette::{INK, MUTED, SKY, faded};
use crate::report::panel::{Frame, Panel};
use crate::report::text::{LEADING, SMALL, caption_lines};
use crate::study::records::{PredictionRecord, Summary};

const TITLE: &str = "Can the time of a ray be predicted from what it does?";
/// Size of a panel's data area, its left edge, and between two of them.
const SIDE: f64 = 147.0;
const FIRST: f64 = 44.0;
const ACROSS: f64 = 11.0;
/// The band: |predicted/measured - 1| is at most this.
const WITHIN: f64 = 0.1;

/// Where a prediction comes from.
type Prediction = (&'static str, fn(&PredictionRecord) -> f64);

const PREDICTIONS: [Prediction; 3] = [
    ("(a) areas", |row| row.areas_ns),
    ("(b) counts", |row| row.two_ns),
    ("(c) chosen terms", |row| row.chosen_ns),
];

/// The figure; `None` where nothing was fitted.
pub fn predicted(run: &CostVsWork, summary: &Summary) -> Option<Figure> {
    let all = run.predictions.iter().flat_map(|row| {
        let predicted = PREDICTIONS.map(|(_, of)| of(row));
        predicted.into_iter().chain([row.measured_ns])
    });
    let (low, high) = extent(all.filter(|&ns| ns > 0.0))?;
    let room = (high / low).powf(0.04).max(1.1);
    let ends = [low / room, high * room];
    let keys = keys(run);
    let rows = rows_of(WIDTH - 2.0 * LEFT, &keys);
    let caption = format!(
        "A mark is a set of rays in a tree. Predicted with constants fitted without the tree's scene: (a) of n{SUB}K \
         and n{SUB}t, put to what surface areas predict, the same for all rays; (b) the same, put to the counts of these rays; (c) \
         of terms chosen from many. Line: measured = predicted; shaded: predicted is within 10 % of measured. Above each panel: median of \
         |predicted/measured − 1|. {}",
        provenance(run, summary.seed)
    );
    let caption = caption_lines(caption, WIDTH - 2.0 * LEFT, summary.quick);
    let top = 54.0 + LEGEND_LEADING * (rows - 1) as f64;
    let bottom = top + SIDE;
    let baseline = bottom + 36.0;
    let height = baseline + LEADING * (caption.len() - 1) as f64 + 6.0;
    Some(Figure::draw(
        TITLE,
        (&caption, baseline),
        WIDTH,
        height,
        |pen| {
            legend(pen, (LEFT, WIDTH - LEFT), 31.0, &keys);
            for (number, prediction) in PREDICTIONS.into_iter().enumerate() {
                let left = FIRST + number as f64 * (SIDE + ACROSS);
                let frame = Frame {
                    left,
                    top,
                    right: left + SIDE,
                    bottom,
                };
                panel(pen, run, prediction, frame, ends, number == 0);
            }
        },
    ))
}

fn panel(
    pen: &Pen,
    run: &CostVsWork,
    (name, predicted): Prediction,
    frame: Frame,
    [low, high]: [f64; 2],
    beside: bool,
) {
    let label = if beside { "measured, ns per ray" } else { "" };
    let x = Axis::log("predicted, ns per ray", low, high, 5);
    let mut y = Axis::log(label, low, high, 5);
    if !beside {
        y.ticks.iter_mut().for_each(|tick| tick.label.clear());
    }
    let mut panel = Panel::new(pen, frame, x, y);
    let [lower, upper] = band([low, high]);
    panel.band(&lower, &upper, faded(SKY, 0.7));
    let sets = sets::of(run);
    for row in &run.predictions {
        let look = sets::look(&sets, &row.rays);
        let at = (predicted(row), row.measured_ns);
        panel.mark(at, look.marker, 1.1, faded(look.colour, 0.55));
    }
    panel.line(&[(low, low), (high, high)], INK, 0.5);
    panel.heading(name, frame.left, 4.0);
    let error = Residuals::of(&run.predictions, predicted);
    let error = error.map_or(String::new(), |found| {
        format!("error {} %", fixed(100.0 * found.error, 1))
    });
    let at = (frame.right, frame.top - 4.0);
    pen.text(&error, at, SMALL, MUTED, (HPos::Right, VPos::Bottom));
}

/// Lower and upper edge of the band in a square frame, each as far as the frame: what lies outside would be moved onto it, one
/// coordinate at a time.
fn band([low, high]: [f64; 2]) -> [Vec<(f64, f64)>; 2] {
    let (less, more) = (1.0 + WITHIN, 1.0 - WITHIN);
    [
        vec![
            (low, low),
            (low * less, low),
            (high, high / less),
            (high, high),
        ],
        vec![(low, low / more), (high * more, high)],
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_band_stays_in_its_frame() {
        let (low, high) = (10.0, 1000.0);
        let [lower, upper] = band([low, high]);
        let inside = |at: f64| (low..=high).contains(&at);
        let mut edges = lower.iter().chain(&upper);
        assert!(edges.all(|&(x, y)| inside(x) && inside(y)));
        let error = |(x, y): (f64, f64)| x / y - 1.0;
        for at in &lower[1..3] {
            assert!((error(*at) - WITHIN).abs() < 1e-12, "{at:?}");
        }
        for at in &upper {
            assert!((error(*at) + WITHIN).abs() < 1e-12, "{at:?}");
        }
    }
}
