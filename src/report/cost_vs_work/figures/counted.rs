//! C counted on rays of many kinds against C predicted from areas: a panel for each set of rays.

use plotters::style::text_anchor::{HPos, VPos};

use super::super::{CostVsWork, sets, work};
use crate::report::axis::{Axis, extent};
use crate::report::figure::{Figure, LEFT, Pen, WIDTH};
use crate::report::glyphs::SUB;
use crate::report::legend::{Key, LEGEND_LEADING, legend, rows_of};
use crate::report::number::{digits_for, fixed};
use crate::report::palette::{INK, Look, MUTED, faded};
use crate::report::panel::{Frame, Panel};
use crate::report::series::{constants, distinct};
use crate::report::strategies::averages::family;
use crate::report::text::{LEADING, MEDIUM, SMALL, caption_lines, fit, text_width};
use crate::study::records::{Summary, WorkRecord};

const TITLE: &str = "Do surface areas tell what rays cost that are not the metric's own?";
/// Panels beside each other, and of a figure.
const COLUMNS: usize = 3;
const PANELS: usize = 9;
/// Size of a panel's data area, and between two of them.
const SIDE: f64 = 148.0;
const HIGH: f64 = 112.0;
const ACROSS: f64 = 10.0;
const DOWN: f64 = 32.0;
/// Left edge of the first panel.
const FIRST: f64 = 44.0;

/// The figures, of nine sets of rays each.
pub fn counted(run: &CostVsWork, summary: &Summary) -> Vec<(String, Figure)> {
    let sets = sets::of(run);
    let figure = |(number, sets): (usize, &[&str])| {
        let behind = if number == 0 {
            String::new()
        } else {
            format!("-{}", number + 1)
        };
        let name = format!("predicted-vs-counted{behind}");
        (name, figure(run, sets, summary))
    };
    sets.chunks(PANELS).enumerate().map(figure).collect()
}

fn figure(run: &CostVsWork, sets: &[&str], summary: &Summary) -> Figure {
    let groups = distinct(run.work.iter().map(|row| family(&row.scene)));
    let keys: Vec<_> = groups
        .iter()
        .enumerate()
        .map(|(i, group)| (Key::Mark(Look::of(i)), fit(group, MEDIUM, 110.0)))
        .collect();
    let rows = rows_of(WIDTH - 2.0 * LEFT, &keys);
    let caption = caption_lines(caption(run, summary), WIDTH - 2.0 * LEFT, summary.quick);
    let top = 54.0 + LEGEND_LEADING * (rows - 1) as f64;
    let down = sets.len().div_ceil(COLUMNS) as f64;
    let bottom = top + down * HIGH + (down - 1.0) * DOWN;
    let baseline = bottom + 36.0;
    let height = baseline + LEADING * (caption.len() - 1) as f64 + 6.0;
    let costs = run.work.iter().flat_map(|r| [r.c_predicted, r.c_counted]);
    let (low, high) = extent(costs.filter(|&cost| cost > 0.0)).unwrap_or((1.0, 10.0));
    let room = (high / low).powf(0.04).max(1.1);
    let ends = [low / room, high * room];
    Figure::draw(TITLE, (&caption, baseline), WIDTH, height, |pen| {
        legend(pen, (LEFT, WIDTH - LEFT), 31.0, &keys);
        for (number, rays) in sets.iter().enumerate() {
            let (column, row) = (number % COLUMNS, number / COLUMNS);
            let left = FIRST + column as f64 * (SIDE + ACROSS);
            let top = top + row as f64 * (HIGH + DOWN);
            let frame = Frame {
                left,
                top,
                right: left + SIDE,
                bottom: top + HIGH,
            };
            // Labels once: below the last panel of a column, left of the first of a row.
            let labelled = [number + COLUMNS >= sets.len(), column == 0];
            panel(pen, run, rays, &groups, frame, ends, labelled);
        }
    })
}

fn panel(
    pen: &Pen,
    run: &CostVsWork,
    rays: &str,
    groups: &[&str],
    frame: Frame,
    [low, high]: [f64; 2],
    [below, beside]: [bool; 2],
) {
    let label = |wanted: bool, text: &'static str| if wanted { text } else { "" };
    let x = Axis::log(
        label(below, "C predicted from areas, per ray"),
        low,
        high,
        5,
    );
    let mut y = Axis::log(label(beside, "C counted, per ray"), low, high, 5);
    if !beside {
        y.ticks.iter_mut().for_each(|tick| tick.label.clear());
    }
    let mut panel = Panel::new(pen, frame, x, y);
    panel.line(&[(low, low), (high, high)], INK, 0.7);
    let own: Vec<&WorkRecord> = run.work.iter().filter(|row| row.rays == rays).collect();
    for row in &own {
        let group = family(&row.scene);
        let look = Look::of(groups.iter().position(|g| *g == group).unwrap_or_default());
        let at = (row.c_predicted, row.c_counted);
        panel.mark(at, look.marker, 1.4, faded(look.colour, 0.7));
    }
    let ratio = work::cost_ratios(own.iter().copied());
    let ratio = ratio.map_or(String::new(), |s| {
        format!("× {}", fixed(s.geometric, digits_for(s.geometric, 3)))
    });
    let tau = work::agreement(run, rays).and_then(|a| a.tau);
    let tau = tau.map_or(String::new(), |tau| format!(", τ {}", fixed(tau, 2)));
    let found = ratio + &tau;
    let at = (frame.right, frame.top - 4.0);
    pen.text(&found, at, SMALL, MUTED, (HPos::Right, VPos::Bottom));
    let left = SIDE - text_width(&found, SMALL) - 6.0;
    panel.heading(&fit(rays, MEDIUM + 0.6, left), frame.left, 4.0);
}

fn caption(run: &CostVsWork, summary: &Summary) -> String {
    let costs = constants(&run.cells).map_or(String::new(), |[k, b, t]| format!(" ({k}:{b}:{t})"));
    format!(
        "C = c{SUB}K n{SUB}K + c{SUB}B n{SUB}B + c{SUB}t n{SUB}t{costs}. A mark is a tree; line: counted = predicted. Above each \
         panel: geometric mean of counted over predicted, and Kendall's τ between the two over the trees of a scene, mean over \
         scenes. {} {}, seed {}.",
        sets::NAMES,
        work::trees(run),
        summary.seed
    )
}
