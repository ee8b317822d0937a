//! Cost counted over predicted, and how far single nodes scatter: a row a set of rays, a mark a scene.

use plotters::style::text_anchor::{HPos, VPos};

use super::Assumptions;
use super::rows::{HEADINGS, ROW, Rows};
use crate::report::axis::{Axis, extent};
use crate::report::figure::{Figure, LEFT, Pen, WIDTH};
use crate::report::legend::{Key, LEGEND_LEADING, legend, legend_rows};
use crate::report::number::fixed;
use crate::report::palette::{INK, Look, MUTED, faded};
use crate::report::panel::{Frame, Panel};
use crate::report::series::distinct;
use crate::report::text::{LEADING, SMALL, caption_lines};
use crate::study::records::{BiasRecord, Summary};

const TITLE: &str =
    "By how much is the predicted cost off, for rays that break the metric's assumptions?";
/// Share of the width that the first panel takes, the gap between both, and the room for numbers at the right of each.
const FIRST: f64 = 0.6;
const GAP: f64 = 8.0;
const NUMBERS: f64 = 24.0;
/// Radius of a mark.
const RADIUS: f64 = 1.8;

/// The figure of all scenes.
pub fn figure(run: &Assumptions, summary: &Summary) -> Figure {
    let strategy = summary.figure_strategy.as_deref().unwrap_or_default();
    let own: Vec<&BiasRecord> = run.bias.iter().filter(|r| r.strategy == strategy).collect();
    let scenes = distinct(own.iter().map(|row| row.scene.as_str()));
    let caption = format!(
        "Trees of strategy {strategy}, stop {}; blue dots: assumptions that the rays break. (a) Tree cost C counted over predicted, \
         per ray that hits the root's box; 1 where the metric is right. (b) Scatter of the single nodes about their common \
         factor: a standard deviation of their counted over predicted hits, nodes weighted by predicted hits, sampling noise \
         taken out; a node that no ray hit counts half a ray. Bars and numbers: geometric means over the scenes. The beam's \
         direction and the point outside are drawn once a scene. Seed {}.",
        summary.stop.as_deref().unwrap_or("unknown"),
        summary.seed
    );
    let caption = caption_lines(caption, WIDTH - 2.0 * LEFT, summary.quick);
    let keys: Vec<_> = scenes
        .iter()
        .enumerate()
        .map(|(i, scene)| (Key::Mark(Look::of(i)), (*scene).to_owned()))
        .collect();
    let texts = keys.iter().map(|(_, text)| text.as_str());
    let legends = legend_rows(WIDTH - 2.0 * LEFT, texts);
    let top = 34.0 + LEGEND_LEADING * (legends - 1) as f64 + HEADINGS;
    let rows = Rows::of(run, top);
    let bottom = rows.bottom();
    let height = bottom + 36.0 + LEADING * (caption.len() - 1) as f64 + 6.0;
    Figure::draw(TITLE, (&caption, bottom + 36.0), WIDTH, height, |pen| {
        legend(pen, (LEFT, WIDTH - LEFT), 31.0, &keys);
        let edge = WIDTH - LEFT;
        rows.draw(pen, edge);
        let room = edge - rows.right - GAP - 2.0 * NUMBERS;
        let between = rows.right + FIRST * room;
        let frame = |left, right| Frame {
            left,
            top,
            right,
            bottom,
        };
        let first = Part {
            heading: "(a) total",
            label: "C counted / predicted",
            show: |value| fixed(value, 2),
            value: |row| row.c,
        };
        first.draw(pen, &rows, &own, &scenes, frame(rows.right, between));
        let second = Part {
            heading: "(b) single nodes",
            label: "scatter, a factor",
            show: |value| fixed(value, 2),
            value: |row| row.spread.map(f64::exp),
        };
        let left = between + NUMBERS + GAP;
        second.draw(pen, &rows, &own, &scenes, frame(left, edge - NUMBERS));
    })
}

/// One panel.
struct Part {
    heading: &'static str,
    label: &'static str,
    show: fn(f64) -> String,
    value: fn(&BiasRecord) -> Option<f64>,
}

impl Part {
    fn draw(&self, pen: &Pen, rows: &Rows, own: &[&BiasRecord], scenes: &[&str], frame: Frame) {
        let drawable = |row: &&BiasRecord| (self.value)(row).filter(|v| *v > 0.0);
        let values = own.iter().filter_map(drawable).chain([1.0]);
        let (low, high) = extent(values).unwrap_or((0.5, 2.0));
        let room = (high / low).powf(0.04).max(1.02);
        let x = Axis::log(self.label, low / room, high * room, 6);
        // Downwards, in points.
        let y = Axis {
            ticks: Vec::new(),
            ..Axis::linear("", -frame.bottom, -frame.top, 1)
        };
        let mut panel = Panel::new(pen, frame, x, y);
        panel.heading(self.heading, frame.left, 4.0);
        panel.line(&[(1.0, -frame.top), (1.0, -frame.bottom)], INK, 0.7);
        for (i, set) in rows.sets.iter().enumerate() {
            let y = -rows.middle(i);
            let of_set: Vec<(usize, f64)> = own
                .iter()
                .filter(|row| row.rays == *set)
                .filter_map(|row| {
                    let scene = scenes.iter().position(|scene| *scene == row.scene)?;
                    Some((scene, drawable(row)?))
                })
                .collect();
            let values: Vec<f64> = of_set.iter().map(|one| one.1).collect();
            if let Some(mean) = crate::report::means::geometric(&values) {
                let reach = 0.42 * ROW;
                panel.line(&[(mean, y - reach), (mean, y + reach)], INK, 1.6);
                let at = (frame.right + 3.0, rows.middle(i));
                let text = (self.show)(mean);
                pen.text(&text, at, SMALL, MUTED, (HPos::Left, VPos::Center));
            }
            for (scene, value) in of_set {
                let look = Look::of(scene);
                panel.mark((value, y), look.marker, RADIUS, faded(look.colour, 0.8));
            }
        }
    }
}
