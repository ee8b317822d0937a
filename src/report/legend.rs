//! The legend above the panels of a figure.

use plotters::style::RGBAColor;
use plotters::style::text_anchor::{HPos, VPos};

use super::figure::Pen;
use super::glyphs;
use super::number::grouped;
use super::palette::{INK, Look, MUTED, viridis};
use super::text::{MEDIUM, SMALL, text_width};

/// What a legend entry shows before its text.
pub enum Key {
    /// A mark.
    Mark(Look),
    /// A mark's outline.
    Ring(Look),
    /// A line.
    Line(RGBAColor),
    /// A dashed line.
    Dashes(RGBAColor),
    /// A filled area.
    Area(RGBAColor),
    /// The colours of a density, from 1 to this count and more.
    Density(u64),
    /// The same colours between two texts.
    Scale(&'static str, &'static str),
}

impl Key {
    /// From its left edge to the text.
    fn width(&self) -> f64 {
        match self {
            Key::Mark(_) | Key::Ring(_) => MARK,
            Key::Density(most) => 39.0 + text_width(&at_least(*most), SMALL),
            Key::Scale(from, to) => 39.0 + text_width(from, SMALL) + text_width(to, SMALL),
            _ => 18.0,
        }
    }
}

/// Width of a mark with the room behind it.
const MARK: f64 = 9.0;
/// Between two entries.
const GAP: f64 = 13.0;

/// A legend in rows between two edges, from this baseline downwards. Returns the last baseline.
pub fn legend(
    pen: &Pen,
    (left, right): (f64, f64),
    mut baseline: f64,
    entries: &[(Key, String)],
) -> f64 {
    let mut x = left;
    for (key, text) in entries {
        let symbol = key.width();
        let width = symbol + text_width(text, MEDIUM);
        if x > left && x + width > right {
            (x, baseline) = (left, baseline + LEGEND_LEADING);
        }
        let middle = baseline - 0.5 * f64::from(glyphs::CAPITAL) * MEDIUM;
        draw_key(pen, key, (x, middle));
        pen.text(
            text,
            (x + symbol, baseline),
            MEDIUM,
            INK,
            (HPos::Left, VPos::Bottom),
        );
        x += width + GAP;
    }
    baseline
}

/// Distance of two rows of a legend.
pub const LEGEND_LEADING: f64 = 11.5;

/// Rows `legend` needs for these texts behind marks.
pub fn legend_rows<'t>(width: f64, texts: impl IntoIterator<Item = &'t str>) -> usize {
    rows_for(width, texts.into_iter().map(|text| (MARK, text)))
}

/// Rows `legend` needs for these entries.
pub fn rows_of(width: f64, entries: &[(Key, String)]) -> usize {
    rows_for(
        width,
        entries
            .iter()
            .map(|(key, text)| (key.width(), text.as_str())),
    )
}

fn rows_for<'t>(width: f64, entries: impl Iterator<Item = (f64, &'t str)>) -> usize {
    let (mut rows, mut x) = (1, 0.0);
    for (symbol, text) in entries {
        let entry = symbol + text_width(text, MEDIUM);
        if x > 0.0 && x + entry > width {
            (rows, x) = (rows + 1, 0.0);
        }
        x += entry + GAP;
    }
    rows
}

fn draw_key(pen: &Pen, key: &Key, (x, y): (f64, f64)) {
    match *key {
        Key::Mark(look) => look.marker.draw(pen, (x + 3.0, y), 2.4, look.colour),
        Key::Ring(look) => look.marker.ring(pen, (x + 3.0, y), 2.4, look.colour),
        Key::Line(colour) => pen.line(&[(x, y), (x + 14.0, y)], colour, 1.1),
        Key::Dashes(colour) => pen.dashes(&[(x, y), (x + 14.0, y)], colour, 0.9),
        Key::Area(colour) => pen.rectangle((x, y - 3.0), (x + 14.0, y + 3.0), colour),
        Key::Density(most) => scale(pen, (x, y), "1", &at_least(most)),
        Key::Scale(from, to) => scale(pen, (x, y), from, to),
    }
}

/// The colours from one text to another.
fn scale(pen: &Pen, (x, y): (f64, f64), from: &str, to: &str) {
    const STEPS: usize = 32;
    let (left, width) = (x + 2.0 + text_width(from, SMALL), 28.0 / STEPS as f64);
    pen.text(from, (x, y), SMALL, MUTED, (HPos::Left, VPos::Center));
    for i in 0..STEPS {
        let at = left + width * i as f64;
        let colour = viridis(i as f64 / (STEPS - 1) as f64);
        // Each reaches under the next, so that no seam shows.
        pen.rectangle((at, y - 3.0), (at + 1.3 * width, y + 3.0), colour);
    }
    let end = left + width * STEPS as f64 + 2.0;
    pen.text(to, (end, y), SMALL, MUTED, (HPos::Left, VPos::Center));
}

fn at_least(count: u64) -> String {
    format!("≥ {}", grouped(count))
}
