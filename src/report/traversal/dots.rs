//! Every scene as a row of dots on log axes, a panel a set of rays, with geometric means below.

use plotters::style::text_anchor::{HPos, VPos};

use super::against::{PRECISIONS, WAYS};
use crate::report::axis::{Axis, extent};
use crate::report::figure::{Figure, LEFT, Pen, WIDTH};
use crate::report::grid::{page, page_name, part};
use crate::report::legend::Key;
use crate::report::palette::{GRID, INK, Look, faded};
use crate::report::panel::{Frame, Panel};
use crate::report::strategies::averages::{Averages, family};
use crate::report::text::{MEDIUM, fit, text_width};
use crate::study::records::Summary;

/// Height of the row of a scene, and of one series within the geometric means.
const ROW: f64 = 8.8;
const PITCH: f64 = 5.2;
/// Between the series of a scene, so that equal ones are seen.
const APART: f64 = 1.5;
/// Between panels.
const GAP: f64 = 16.0;
/// Longer names of scenes are shortened.
const WIDEST_NAME: f64 = 110.0;
/// Radius of a mark.
const RADIUS: f64 = 1.8;

/// A way and a precision, by their numbers, with the ratio of every scene.
pub type Series<'r> = (usize, usize, Vec<(&'r str, f64)>);

/// What is drawn in a panel.
pub struct Dots<'r> {
    /// Its heading.
    pub heading: String,
    /// What is shown and over what.
    pub label: &'static str,
    /// Its marks.
    pub series: Vec<Series<'r>>,
}

/// A way looks the same in every figure.
pub fn look(way: usize) -> Look {
    Look::of(way)
}

/// What the marks of these ways mean; those of f32 are hollow.
pub fn keys(ways: &[usize], precisions: &[usize]) -> Vec<(Key, String)> {
    let key = |way: usize, precision: usize| {
        let key = match precision {
            0 => Key::Mark(look(way)),
            _ => Key::Ring(look(way)),
        };
        (key, format!("{}, {}", WAYS[way], PRECISIONS[precision]))
    };
    let of_way = |&way: &usize| precisions.iter().map(move |&precision| key(way, precision));
    ways.iter().flat_map(of_way).collect()
}

/// Panels of a page.
const BESIDE: usize = 4;

/// The figure of these panels, on as many pages as it takes; none if there is nothing in them.
pub fn figures(
    name: &str,
    (title, caption): (&str, String),
    scenes: &[&str],
    panels: &[Dots],
    summary: &Summary,
) -> Vec<(String, Figure)> {
    let pages = panels.len().div_ceil(BESIDE);
    let page = |(number, panels): (usize, &[Dots])| {
        let caption = format!("{caption}{}", part(number, pages));
        let figure = figure((title, caption), scenes, panels, summary)?;
        Some((page_name(name, number), figure))
    };
    panels.chunks(BESIDE).enumerate().filter_map(page).collect()
}

/// One page.
fn figure(
    text: (&str, String),
    scenes: &[&str],
    panels: &[Dots],
    summary: &Summary,
) -> Option<Figure> {
    let all = || panels.iter().flat_map(|panel| &panel.series);
    let used = |number: fn(&Series) -> usize| {
        let mut used: Vec<usize> = all().map(number).collect();
        used.sort_unstable();
        used.dedup();
        used
    };
    let (ways, precisions) = (used(|series| series.0), used(|series| series.1));
    if ways.is_empty() {
        return None;
    }
    let most = panels.iter().map(|panel| panel.series.len()).max()?;
    let means = ROW + PITCH * most.saturating_sub(1) as f64 + 4.0;
    let high = 16.0 + ROW * scenes.len() as f64 + means;
    let names: Vec<String> = scenes.iter().map(|s| fit(s, MEDIUM, WIDEST_NAME)).collect();
    let widths = names.iter().map(String::as_str).chain([MEAN]);
    let widths = widths.map(|name| text_width(name, MEDIUM));
    let left = LEFT + widths.fold(0.0, f64::max) + 6.0;
    let pitch = (WIDTH - LEFT - 4.0 - left + GAP) / panels.len() as f64;
    let draw = |pen: &Pen, top: f64| {
        let top = top + 16.0;
        let rows = Rows { top, scenes };
        rows.label(pen, &names, left - 5.0, means);
        for (number, dots) in panels.iter().enumerate() {
            let left = left + pitch * number as f64;
            let frame = Frame {
                left,
                top,
                right: left + pitch - GAP,
                bottom: rows.bottom() + means,
            };
            rows.draw(pen, dots, frame);
        }
    };
    Some(page(text, &keys(&ways, &precisions), high, summary, draw))
}

/// The last row.
const MEAN: &str = "geometric mean";

/// Where the rows are.
struct Rows<'r> {
    top: f64,
    scenes: &'r [&'r str],
}

impl Rows<'_> {
    fn middle(&self, row: usize) -> f64 {
        self.top + ROW * (row as f64 + 0.5)
    }

    /// Of the scenes.
    fn bottom(&self) -> f64 {
        self.top + ROW * self.scenes.len() as f64
    }

    fn label(&self, pen: &Pen, names: &[String], right: f64, means: f64) {
        let label = |name: &str, y: f64| {
            pen.text(name, (right, y), MEDIUM, INK, (HPos::Right, VPos::Center));
        };
        for (row, name) in names.iter().enumerate() {
            label(name, self.middle(row));
        }
        label(MEAN, self.bottom() + 0.5 * means);
    }

    fn draw(&self, pen: &Pen, dots: &Dots, frame: Frame) {
        let averages = |ratios: &Vec<(_, f64)>| Averages::of(ratios);
        let averages: Vec<_> = dots.series.iter().map(|s| averages(&s.2)).collect();
        let ratios = dots.series.iter().flat_map(|s| &s.2).map(|r| r.1);
        // Bars of few scenes may be so long that nothing else could be seen: they end at the edge.
        let (low, high) = extent(ratios.chain([1.0])).unwrap_or((1.0, 1.0));
        let room = (high / low).powf(0.05).max(1.02);
        let x = Axis::log(dots.label, low / room, high * room, 4);
        // Downwards, in points.
        let y = Axis {
            ticks: Vec::new(),
            ..Axis::linear("", -frame.bottom, -frame.top, 1)
        };
        let mut panel = Panel::new(pen, frame, x, y);
        let (from, to) = (panel.x.value(0.0), panel.x.value(1.0));
        for row in 0..self.scenes.len() {
            let y = -self.middle(row);
            panel.line(&[(from, y), (to, y)], GRID, 0.3);
        }
        // A line wherever the next round of the same kinds of scenes begins.
        for row in 1..self.scenes.len() {
            if family(self.scenes[row]) == family(self.scenes[0]) {
                let y = -self.top - ROW * row as f64;
                panel.line(&[(from, y), (to, y)], faded(INK, 0.3), 0.4);
            }
        }
        let y = -self.bottom();
        panel.line(&[(from, y), (to, y)], faded(INK, 0.6), 0.5);
        panel.line(&[(1.0, -frame.top), (1.0, -frame.bottom)], INK, 0.7);
        let number = dots.series.len() as f64;
        for (place, ((way, precision, ratios), averages)) in
            dots.series.iter().zip(averages).enumerate()
        {
            let Look { colour, marker } = look(*way);
            let mark = |panel: &Panel, ratio: f64, y: f64| match precision {
                0 => panel.mark((ratio, -y), marker, RADIUS, faded(colour, 0.9)),
                _ => panel.ring((ratio, -y), marker, RADIUS, colour),
            };
            let beside = place as f64 - 0.5 * (number - 1.0);
            for (scene, ratio) in ratios {
                if let Some(row) = self.scenes.iter().position(|s| s == scene) {
                    // Of precisions side by side; ways lie apart by themselves.
                    let lift = if *precision == 0 { -APART } else { APART };
                    mark(&panel, *ratio, self.middle(row) + 0.5 * lift);
                }
            }
            let Some(averages) = averages else { continue };
            let middle = 0.5 * (self.bottom() + frame.bottom) + PITCH * beside;
            if let Some([lo, hi]) = averages.interval {
                panel.line(&[(lo, -middle), (hi, -middle)], faded(colour, 0.75), 0.9);
            }
            mark(&panel, averages.geometric, middle);
        }
        panel.heading(&dots.heading, frame.left, 4.0);
    }
}
