//! A cell of the matrix of outcomes, and what cells mean.

use plotters::style::RGBAColor;
use plotters::style::text_anchor::{HPos, VPos};

use super::outcomes::Outcome;
use crate::report::figure::{LEFT, Pen};
use crate::report::palette::{GRID, INK, Marker, SKY, VERMILLION, WHITE, faded};
use crate::report::text::{MEDIUM, text_width};

/// What is off by this many units or more has the full shade.
const FULL: f64 = 1e6;
const PASS: RGBAColor = faded(SKY, 0.42);
const ORANGE: RGBAColor = RGBAColor(0xe6, 0x9f, 0x00, 1.0);

/// From a third for up to one unit to 1 for [`FULL`] of them.
pub fn shade(off: Option<f64>) -> f64 {
    let off = off.unwrap_or(FULL).abs().clamp(1.0, FULL);
    1.0 / 3.0 + 2.0 / 3.0 * off.log10() / FULL.log10()
}

/// One cell between two corners: colour and mark tell the outcome.
pub fn cell(
    pen: &Pen,
    outcome: Outcome,
    shade: f64,
    missed: bool,
    ((left, top), (right, bottom)): ((f64, f64), (f64, f64)),
) {
    let fill = match outcome {
        Outcome::Pass => PASS,
        Outcome::Off => faded(ORANGE, shade),
        Outcome::Refused => GRID,
        Outcome::Failed => VERMILLION,
    };
    pen.rectangle((left, top), (right, bottom), fill);
    let (x, y) = (0.5 * (left + right), 0.5 * (top + bottom));
    let reach = 0.32 * (right - left).min(bottom - top);
    match outcome {
        Outcome::Pass => {}
        Outcome::Off => Marker::Diamond.draw(pen, (x, y), 0.6 * reach, INK),
        Outcome::Refused => pen.line(&[(x - reach, y), (x + reach, y)], INK, 1.0),
        Outcome::Failed => {
            for slope in [-1.0, 1.0] {
                let ends = [
                    (x - reach, y - slope * reach),
                    (x + reach, y + slope * reach),
                ];
                pen.line(&ends, WHITE, 1.1);
            }
        }
    }
    if missed {
        let corners = [
            (left, top),
            (right, top),
            (right, bottom),
            (left, bottom),
            (left, top),
        ];
        pen.line(&corners, INK, 0.9);
    }
}

/// What cells mean, on this baseline.
pub fn legend(pen: &Pen, baseline: f64) {
    let mut x = LEFT;
    let mut entry = |outcome, shade, missed, text: &str| {
        let box_ = ((x, baseline - 7.0), (x + 9.0, baseline + 1.0));
        cell(pen, outcome, shade, missed, box_);
        let at = (x + 12.0, baseline);
        pen.text(text, at, MEDIUM, INK, (HPos::Left, VPos::Bottom));
        x += 12.0 + text_width(text, MEDIUM) + 13.0;
    };
    entry(Outcome::Pass, 1.0, false, "passed");
    entry(
        Outcome::Off,
        shade(Some(1.0)),
        false,
        "off by 1 unit or less",
    );
    entry(Outcome::Off, 1.0, false, "by 10⁶ or more");
    entry(Outcome::Refused, 1.0, false, "refused");
    entry(Outcome::Failed, 1.0, false, "failed");
    entry(Outcome::Failed, 1.0, true, "framed: demanded");
}
