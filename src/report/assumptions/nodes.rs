//! Counted over predicted for the nodes of one tree, a panel a set of rays.

use std::collections::BTreeMap;

use super::Assumptions;
use super::names::{Broken, words};
use crate::report::axis::{Axis, extent};
use crate::report::figure::{Figure, LEFT, Pen, WIDTH};
use crate::report::legend::{Key, legend};
use crate::report::number::{fixed, grouped};
use crate::report::palette::{INK, MUTED, SKY, faded, viridis};
use crate::report::panel::{Frame, Panel};
use crate::report::text::{LEADING, MEDIUM, SMALL, caption_lines, fit, text_width};
use crate::study::records::{Summary, VisitRecord};
use plotters::style::RGBAColor;
use plotters::style::text_anchor::{HPos, VPos};

const TITLE: &str = "Where does the metric err? Rays that hit a node, counted over predicted";
const COLUMNS: usize = 3;
/// Size of a panel, and how far apart panels begin.
const SIZE: (f64, f64) = (137.0, 88.0);
const PITCH: (f64, f64) = (164.0, 144.0);
const FIRST: (f64, f64) = (38.0, 75.0);
/// What chance alone does to 95 % of the nodes.
const BAND: RGBAColor = faded(SKY, 0.32);
/// Behind a remark that nodes may reach.
const BACKING: RGBAColor = RGBAColor(255, 255, 255, 0.8);
/// Ratios beyond these are drawn at the edge.
const REACH: (f64, f64) = (1.0 / 50.0, 50.0);

/// The figure of these sets, page i of n.
pub fn figure(
    run: &Assumptions,
    sets: &[&str],
    (page, pages): (usize, usize),
    summary: &Summary,
) -> Figure {
    let scene = summary.figure_scene.as_deref().unwrap_or_default();
    let strategy = summary.figure_strategy.as_deref().unwrap_or_default();
    let caption = format!(
        "Nodes of one tree ({scene}, strategy {strategy}, stop {}), counted over N p, their hits predicted from surface areas: \
         1 where the metric is right. N rays hit the root's box ({}). Nodes with N p ≥ 25, at most 2,000 \
         nodes drawn; marks on the frame lie outside it. Colour: \
         distance of the node's centre from the root's, over half of the root's diagonal. C ×: tree cost counted over predicted; \
         scatter ×/÷: a standard deviation of the nodes' ratios, sampling noise taken out; τ: Kendall's rank correlation of the \
         strategies' costs, predicted and counted. Seed {}.{}",
        summary.stop.as_deref().unwrap_or("unknown"),
        rays_each(run, sets),
        summary.seed,
        if pages > 1 {
            format!(" Part {page} of {pages}.")
        } else {
            String::new()
        }
    );
    let caption = caption_lines(caption, WIDTH - 2.0 * LEFT, summary.quick);
    let axes = Axes::of(run.visits.iter().filter(|row| sets.contains(&&*row.rays)));
    let has_line = |set: &&str| !together(run, set, (scene, strategy), axes.p).is_empty();
    let place = Key::Scale("root's centre", "root's corner");
    let line = (Key::Line(INK), "all nodes of about that p together");
    let mut keys = vec![(place, "place of a node")];
    keys.extend(sets.iter().any(has_line).then_some(line));
    keys.push((Key::Area(BAND), "95 % range of sampling noise"));
    let keys: Vec<_> = keys
        .into_iter()
        .map(|(key, text)| (key, text.to_owned()))
        .collect();
    let lines = sets.len().div_ceil(COLUMNS);
    let bottom = FIRST.1 + PITCH.1 * (lines - 1) as f64 + SIZE.1;
    let height = bottom + 36.0 + LEADING * (caption.len() - 1) as f64 + 6.0;
    Figure::draw(TITLE, (&caption, bottom + 36.0), WIDTH, height, |pen| {
        legend(pen, (LEFT, WIDTH - LEFT), 31.0, &keys);
        for (i, set) in sets.iter().enumerate() {
            let left = FIRST.0 + PITCH.0 * (i % COLUMNS) as f64;
            let top = FIRST.1 + PITCH.1 * (i / COLUMNS) as f64;
            let frame = Frame {
                left,
                top,
                right: left + SIZE.0,
                bottom: top + SIZE.1,
            };
            let outer = (i % COLUMNS == 0, i + COLUMNS >= sets.len());
            draw(pen, run, set, frame, &axes, outer, (scene, strategy));
        }
    })
}

/// How many rays of each set there are.
fn rays_each(run: &Assumptions, sets: &[&str]) -> String {
    let own = run.visits.iter().filter(|row| sets.contains(&&*row.rays));
    let range = extent(own.map(|row| row.entered as f64)).unwrap_or_default();
    let (least, most) = (grouped(range.0 as u64), grouped(range.1 as u64));
    if least == most {
        format!("{least} of each set")
    } else {
        format!("{least} to {most} of a set")
    }
}

/// The ranges that all panels of a figure share.
struct Axes {
    p: (f64, f64),
    ratio: (f64, f64),
}

impl Axes {
    fn of<'r>(visits: impl Iterator<Item = &'r VisitRecord> + Clone) -> Self {
        let p = extent(visits.clone().map(|row| row.p)).unwrap_or((0.1, 1.0));
        let (lo, hi) = extent(visits.map(ratio)).unwrap_or((0.5, 2.0));
        Axes {
            p: (p.0, 1.0),
            ratio: (
                (lo / 1.1).clamp(REACH.0, 0.5),
                (2.5 * hi).clamp(4.0, REACH.1),
            ),
        }
    }
}

/// Counted over predicted; a node that no ray hit counts half a ray.
fn ratio(row: &VisitRecord) -> f64 {
    (row.hits as f64).max(0.5) / (row.entered as f64 * row.p)
}

fn draw(
    pen: &Pen,
    run: &Assumptions,
    set: &str,
    frame: Frame,
    axes: &Axes,
    (leftmost, lowest): (bool, bool),
    tree: (&str, &str),
) {
    let label = |shown: bool, text: &'static str| if shown { text } else { "" };
    let x = Axis::log(label(lowest, "p = SA(K) / SA(R)"), axes.p.0, axes.p.1, 4);
    let y = Axis::log(
        label(leftmost, "counted / predicted"),
        axes.ratio.0,
        axes.ratio.1,
        5,
    );
    let mut panel = Panel::new(pen, frame, x, y);
    let own: Vec<&VisitRecord> = run.visits.iter().filter(|row| row.rays == set).collect();
    if let Some(n) = own.first().map(|row| row.entered as f64) {
        let steps = (0..=40).map(|i| panel.x.value(f64::from(i) / 40.0));
        let chance: Vec<(f64, f64)> = steps
            .map(|p| (p, 1.96 * ((1.0 - p).max(0.0) / (n * p)).sqrt()))
            .collect();
        let end = |sign: f64| -> Vec<(f64, f64)> {
            let at = |&(p, reach): &(f64, f64)| (p, (1.0 + sign * reach).max(axes.ratio.0));
            chance.iter().map(at).collect()
        };
        panel.band(&end(-1.0), &end(1.0), BAND);
    }
    mosaic(
        pen,
        own.iter()
            .filter_map(|row| Some((panel.place((row.p, ratio(row)))?, row.distance))),
    );
    panel.line(&[(axes.p.0, 1.0), (axes.p.1, 1.0)], faded(INK, 0.55), 0.5);
    panel.line(&together(run, set, tree, axes.p), INK, 1.1);
    let edge = frame.left - 2.0;
    let broken = Broken::of(&run.bias, set).words();
    panel.heading(&fit(&words(set), MEDIUM + 0.6, SIZE.0 + 4.0), edge, 22.0);
    for (text, lift) in [(set, 13.0), (&*broken, 4.0)] {
        let at = (edge, frame.top - lift);
        let text = fit(text, SMALL, SIZE.0 + 4.0);
        pen.text(&text, at, SMALL, MUTED, (HPos::Left, VPos::Bottom));
    }
    let summary = summary_of(run, set, tree);
    let (left, top) = (frame.left + 1.5, frame.top + 1.0);
    let end = left + 4.0 + text_width(&summary, SMALL);
    pen.rectangle((left, top), (end, top + 10.0), BACKING);
    panel.note(&summary, false);
}

/// Counted over predicted of all nodes of about the same p together, as far as the frame: each group stands at the mean p of
/// its nodes. Empty where that makes no line.
fn together(
    run: &Assumptions,
    set: &str,
    tree: (&str, &str),
    (least, most): (f64, f64),
) -> Vec<(f64, f64)> {
    let own = run
        .groups
        .iter()
        .filter(|row| (&*row.scene, &*row.strategy) == tree && row.rays == set && row.by == "area");
    let mut all: Vec<(f64, f64)> = own
        .filter_map(|row| Some((row.p_sum / row.nodes as f64, row.ratio?)))
        .filter(|(p, ratio)| *p > 0.0 && *p <= most && *ratio > 0.0)
        .collect();
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    let beyond = all.partition_point(|(p, _)| *p < least);
    if let ([.., before], Some(after)) = (&all[..beyond], all.get(beyond)) {
        // Where the line enters the frame, whose axes are logarithmic.
        let share = (least / before.0).ln() / (after.0 / before.0).ln();
        let enters = before.1 * (after.1 / before.1).powf(share);
        all[beyond - 1] = (least, enters);
        all.drain(..beyond - 1);
    } else {
        all.drain(..beyond);
    }
    if all.len() > 1 { all } else { Vec::new() }
}

/// How much in total, per node, and for the order of the strategies.
fn summary_of(run: &Assumptions, set: &str, tree: (&str, &str)) -> String {
    let row = run
        .bias
        .iter()
        .find(|row| (&*row.scene, &*row.strategy) == tree && row.rays == set);
    let order = run
        .orders
        .iter()
        .find(|row| row.scene == tree.0 && row.rays == set);
    let parts = [
        row.and_then(|row| row.c)
            .map(|c| format!("C × {}", fixed(c, 2))),
        row.and_then(|row| row.spread)
            .map(|s| format!("scatter ×/÷ {}", fixed(s.exp(), 2))),
        order
            .and_then(|row| row.tau)
            .map(|tau| format!("τ {}", fixed(tau, 1))),
    ];
    parts.into_iter().flatten().collect::<Vec<_>>().join(", ")
}

/// Side of a square of the mosaic, in points, and how far it reaches over its neighbours, so that no seam shows.
const SIDE: f64 = 1.5;
const OVERLAP: f64 = 0.25;
/// Colours told apart: few, so that squares of one colour share a group in the SVG.
const SHADES: f64 = 24.0;

/// Squares coloured by the mean of what lies on them.
fn mosaic(pen: &Pen, points: impl Iterator<Item = ((f64, f64), f64)>) {
    let mut squares: BTreeMap<(i32, i32), (f64, f64)> = BTreeMap::new();
    for ((x, y), value) in points {
        let square = ((x / SIDE).floor() as i32, (y / SIDE).floor() as i32);
        let (sum, n) = squares.entry(square).or_default();
        (*sum, *n) = (*sum + value, *n + 1.0);
    }
    let mut shaded: Vec<(i32, (i32, i32))> = squares
        .into_iter()
        .map(|(place, (sum, n))| ((SHADES * sum / n).round() as i32, place))
        .collect();
    shaded.sort_unstable();
    for (shade, (i, j)) in shaded {
        let (x, y) = (f64::from(i) * SIDE, f64::from(j) * SIDE);
        let corner = (x + SIDE + OVERLAP, y + SIDE + OVERLAP);
        pen.rectangle((x, y), corner, viridis(f64::from(shade) / SHADES));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::records::GroupRecord;

    #[test]
    fn the_line_of_groups_begins_where_it_enters_the_frame() {
        let group = |p: f64, ratio: f64| GroupRecord {
            scene: "a".into(),
            strategy: "sah".into(),
            rays: "lines".into(),
            by: "area".into(),
            lo: p.log10().floor(),
            hi: p.log10().floor() + 1.0,
            nodes: 4,
            p_sum: 4.0 * p,
            hits: 1,
            entered: 1,
            ratio: Some(ratio),
            spread: None,
        };
        let mut run = Assumptions {
            bias: Vec::new(),
            // The middle between the first two, by logarithms, is p = 0.01 and a ratio of 2.
            groups: vec![group(0.1, 1.0), group(0.001, 4.0), group(0.0001, 9.0)],
            visits: Vec::new(),
            orders: Vec::new(),
            others: Vec::new(),
            metrics: Vec::new(),
            exact: Vec::new(),
        };
        let line = |run: &Assumptions| together(run, "lines", ("a", "sah"), (0.01, 1.0));
        let found = line(&run);
        assert_eq!(found.len(), 2);
        assert_eq!((found[0].0, found[1]), (0.01, (0.1, 1.0)));
        assert!((found[0].1 - 2.0).abs() < 1e-12, "{found:?}");
        // One group alone makes no line.
        run.groups.truncate(1);
        assert!(line(&run).is_empty());
    }
}
