//! Slopes of all cells: one row a scene, one mark a strategy, each with its 99 % interval.

use plotters::style::text_anchor::{HPos, VPos};

use super::axis::{Axis, extent};
use super::figure::{Figure, LEFT, WIDTH};
use super::legend::{Key, LEGEND_LEADING, legend, legend_rows};
use super::number::Z99;
use super::palette::{INK, SKY, faded};
use super::panel::{Frame, Panel};
use super::series::{Series, distinct, provenance};
use super::text::{LEADING, MEDIUM, caption_lines, fit, text_width};
use crate::study::records::CellRecord;

const TITLE: &str = "Do hits grow in proportion to surface area, for every scene and strategy?";
/// Room for one strategy, and what a row has besides, in points.
const PITCH: f64 = 5.4;
const ROW: f64 = 9.0;
/// Longer names of scenes are shortened.
const WIDEST_NAME: f64 = 140.0;

/// The figure of all cells that have a slope and its error; None where no cell has. Slopes within 1 +- `target` are what
/// the run aims to show.
pub fn figure(cells: &[CellRecord], target: f64, quick: bool) -> Option<Figure> {
    let target = 100.0 * target;
    let drawn = drawn(cells);
    if drawn.is_empty() {
        return None;
    }
    // Rows for the scenes drawn; strategies from all cells, so that each looks the same in every figure.
    let series = Series {
        scenes: distinct(drawn.iter().map(|cell| cell.scene.as_str())),
        ..Series::of(cells)
    };
    let estimates: Vec<Estimate> = drawn
        .iter()
        .filter_map(|cell| Estimate::new(cell, &series))
        .collect();
    let caption = caption(&drawn, cells.len() - drawn.len(), &estimates, target);
    let caption = caption_lines(caption, WIDTH - 2.0 * LEFT, quick);
    let row = PITCH * series.strategies.len() as f64 + ROW;
    let keys: Vec<_> = keys(&series);
    let rows = legend_rows(
        WIDTH - 2.0 * LEFT,
        keys.iter().map(|(_, text)| text.as_str()),
    );
    let names = series
        .scenes
        .iter()
        .map(|scene| fit(scene, MEDIUM, WIDEST_NAME));
    let names: Vec<String> = names.collect();
    let widest = names
        .iter()
        .map(|name| text_width(name, MEDIUM))
        .fold(0.0, f64::max);
    let top = 42.0 + LEGEND_LEADING * (rows - 1) as f64;
    let bottom = top + row * series.scenes.len() as f64;
    let frame = Frame {
        left: LEFT + widest + 8.0,
        top,
        right: WIDTH - LEFT - 4.0,
        bottom,
    };
    let height = bottom + 36.0 + LEADING * (caption.len() - 1) as f64 + 6.0;
    Some(Figure::draw(
        TITLE,
        (&caption, bottom + 36.0),
        WIDTH,
        height,
        |pen| {
            legend(pen, (LEFT, WIDTH - LEFT), 31.0, &keys);
            let ends = estimates
                .iter()
                .flat_map(|e| [e.percent - e.half, e.percent, e.percent + e.half]);
            let reach = extent(ends.map(f64::abs))
                .map_or(0.0, |(_, most)| most)
                .max(1.25 * target)
                * 1.05;
            let x = Axis::linear("slope − 1, per cent", -reach, reach, 8);
            // Downwards, in rows; the scenes' names take the place of ticks.
            let y = Axis {
                ticks: Vec::new(),
                ..Axis::linear("", -(series.scenes.len() as f64), 0.0, 1)
            };
            let mut panel = Panel::new(pen, frame, x, y);
            panel.rectangle((-target, panel.y.lo), (target, 0.0), faded(SKY, 0.25));
            for (i, name) in names.iter().enumerate() {
                let middle = top + row * (i as f64 + 0.5);
                pen.text(
                    name,
                    (frame.left - 6.0, middle),
                    MEDIUM,
                    INK,
                    (HPos::Right, VPos::Center),
                );
                if i > 0 {
                    let separator = -(i as f64);
                    panel.line(
                        &[(-reach, separator), (reach, separator)],
                        faded(INK, 0.25),
                        0.4,
                    );
                }
            }
            panel.line(&[(0.0, panel.y.lo), (0.0, 0.0)], INK, 0.7);
            for e in &estimates {
                let down = (e.strategy as f64 + 0.5) * PITCH + 0.5 * ROW;
                let y = -(e.scene as f64 + down / row);
                panel.line(
                    &[(e.percent - e.half, y), (e.percent + e.half, y)],
                    faded(e.look.colour, 0.75),
                    1.0,
                );
                panel.mark((e.percent, y), e.look.marker, 1.9, e.look.colour);
            }
        },
    ))
}

/// The cells that have a slope and its error.
fn drawn(cells: &[CellRecord]) -> Vec<&CellRecord> {
    let known = |value: Option<f64>| value.is_some_and(f64::is_finite);
    cells
        .iter()
        .filter(|cell| known(cell.slope) && known(cell.slope_se))
        .collect()
}

struct Estimate {
    scene: usize,
    strategy: usize,
    look: super::palette::Look,
    percent: f64,
    half: f64,
}

impl Estimate {
    fn new(cell: &CellRecord, series: &Series) -> Option<Self> {
        let place = |names: &[&str], name: &str| {
            names
                .iter()
                .position(|&known| known == name)
                .unwrap_or_default()
        };
        Some(Estimate {
            scene: place(&series.scenes, &cell.scene),
            strategy: place(&series.strategies, &cell.strategy),
            look: series.look(&cell.strategy),
            percent: 100.0 * (cell.slope? - 1.0),
            half: 100.0 * Z99 * cell.slope_se?,
        })
    }
}

fn keys(series: &Series) -> Vec<(Key, String)> {
    series
        .strategies
        .iter()
        .map(|&name| (Key::Mark(series.look(name)), name.to_owned()))
        .collect()
}

/// The caption for the cells drawn, besides which `others` have no slope.
fn caption(drawn: &[&CellRecord], others: usize, estimates: &[Estimate], target: f64) -> String {
    let others = match others {
        0 => String::new(),
        1 => " 1 cell has no slope (no node but the root, or too rare events).".to_owned(),
        n => format!(" {n} cells have no slope (no node but the root, or too rare events)."),
    };
    let holding = estimates
        .iter()
        .filter(|e| e.percent.abs() <= e.half)
        .count();
    let inside = estimates
        .iter()
        .filter(|e| e.percent.abs() + e.half <= target)
        .count();
    format!(
        "Slope of hits against N p through the origin, weights 1/(p(1 − p)); theory says 1. Bars: 99 % interval of each \
         cell; {holding} of {n} hold 0. Shaded: the target ±{target} %; {inside} of {n} intervals lie inside. {}{others}",
        provenance(drawn.iter().copied()),
        n = estimates.len(),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::fixture;

    #[test]
    fn only_cells_with_a_slope_are_counted() {
        let mut cells = fixture::cells(2, 2);
        cells[0].slope_se = None;
        let series = Series::of(&cells);
        let text = |cells: &[CellRecord]| {
            let drawn = drawn(cells);
            let estimates: Vec<_> = drawn
                .iter()
                .filter_map(|cell| Estimate::new(cell, &series))
                .collect();
            caption(&drawn, cells.len() - drawn.len(), &estimates, 0.2)
        };
        let one = text(&cells);
        assert!(one.contains("2 of 3 hold 0"), "{one}");
        assert!(one.contains(" 3 cells, "), "{one}");
        assert!(one.ends_with(" 1 cell has no slope (no node but the root, or too rare events)."));
        assert!(figure(&cells, 0.002, false).is_some());
        cells.iter_mut().for_each(|cell| cell.slope = None);
        assert!(figure(&cells, 0.002, false).is_none());
    }
}
