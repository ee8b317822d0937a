//! Havran's figure: the split cost across a node, its minimum, both medians, the samples between them, the straddlers.

use super::CurveNodeRecord as Node;
use crate::report::axis::Axis;
use crate::report::figure::{Figure, LEFT, Pen, WIDTH};
use crate::report::legend::{Key, LEGEND_LEADING, legend};
use crate::report::number::counted;
use crate::report::palette::{AXIS, BLUE, GREEN, INK, Look, Marker, SKY, VERMILLION, faded};
use crate::report::panel::{Frame, Panel};
use crate::report::series::distinct;
use crate::report::text::{LEADING, MEDIUM, caption_lines, fit};
use crate::study::records::{CurveRecord, Summary};

const TITLE: &str = "Where is the cheapest plane? The split cost across a node";
/// Size of a panel, and how far apart panels begin.
const SIZE: (f64, f64) = (214.0, 118.0);
const PITCH: (f64, f64) = (252.0, 160.0);
const FIRST: f64 = 42.0;
/// Costs above so many times the leaf's are cut off.
const MOST: f64 = 1.6;

/// The figure of all nodes drawn, each on the axis where its cost is least; `None` without nodes.
pub fn figure(nodes: &[Node], points: &[CurveRecord], summary: &Summary) -> Option<Figure> {
    let shown = cheapest_axes(nodes);
    if shown.is_empty() {
        return None;
    }
    let is_drawn = |p: &&CurveRecord| {
        let same = |n: &&&Node| (&n.scene, n.rank, &n.axis) == (&p.scene, p.rank, &p.axis);
        shown
            .iter()
            .find(same)
            .is_some_and(|n| p.f.max(p.f_centres) > MOST * n.objects as f64)
    };
    let cut_off = if points.iter().any(|p| is_drawn(&p)) {
        format!(" Above {MOST} cut off.")
    } else {
        String::new()
    };
    let caption = format!(
        "f(b) = LSA(b) L(b) + RSA(b) R(b), over n SA of the node: tests a line is expected to make, 1 being those of the node \
         left a leaf. Each node on the axis where its least f is least; b from 0 to 1 across it. Straddlers: share of the n \
         objects that the plane cuts. By centres: every object counted once, where its centre lies. Trees of strategy sah, \
         stop {}, seed {}.{cut_off}",
        summary.stop.as_deref().unwrap_or("unknown"),
        summary.seed
    );
    let caption = caption_lines(caption, WIDTH - 2.0 * LEFT, summary.quick);
    let keys = [
        (Key::Line(BLUE), "f"),
        (Key::Dashes(SKY), "f by centres"),
        (Key::Area(faded(GREEN, 0.35)), "straddlers"),
        (Key::Mark(SAMPLE), "samples of strategy 7"),
        (Key::Mark(MINIMUM), "minimum"),
        (Key::Line(INK), "spatial median"),
        (Key::Dashes(VERMILLION), "object median"),
    ];
    let keys = keys.map(|(key, text)| (key, text.to_owned()));
    let top = 46.0 + LEGEND_LEADING;
    let rows = shown.len().div_ceil(2);
    let bottom = top + PITCH.1 * (rows - 1) as f64 + SIZE.1;
    let height = bottom + 36.0 + LEADING * (caption.len() - 1) as f64 + 6.0;
    Some(Figure::draw(
        TITLE,
        (&caption, bottom + 36.0),
        WIDTH,
        height,
        |pen| {
            legend(pen, (LEFT, WIDTH - LEFT), 31.0, &keys);
            for (i, node) in shown.iter().enumerate() {
                let (left, top) = (
                    FIRST + PITCH.0 * (i % 2) as f64,
                    top + PITCH.1 * (i / 2) as f64,
                );
                let frame = Frame {
                    left,
                    top,
                    right: left + SIZE.0,
                    bottom: top + SIZE.1,
                };
                draw(pen, frame, node, points);
            }
        },
    ))
}

const SAMPLE: Look = Look {
    colour: INK,
    marker: Marker::Disc,
};
const MINIMUM: Look = Look {
    colour: VERMILLION,
    marker: Marker::Down,
};

/// Every node on the axis of its least cost, in the order of the scenes.
fn cheapest_axes(nodes: &[Node]) -> Vec<&Node> {
    let mut shown = Vec::new();
    for scene in distinct(nodes.iter().map(|n| n.scene.as_str())) {
        let mut ranks: Vec<u64> = nodes
            .iter()
            .filter(|n| n.scene == scene)
            .map(|n| n.rank)
            .collect();
        ranks.dedup();
        for rank in ranks {
            let axes = nodes.iter().filter(|n| n.scene == scene && n.rank == rank);
            shown.extend(axes.min_by(|a, b| a.minimum_f.total_cmp(&b.minimum_f)));
        }
    }
    shown
}

fn draw(pen: &Pen, frame: Frame, node: &Node, points: &[CurveRecord]) {
    let n = node.objects as f64;
    let own: Vec<&CurveRecord> = points
        .iter()
        .filter(|p| p.scene == node.scene && p.rank == node.rank && p.axis == node.axis)
        .collect();
    let x = Axis::linear(format!("b along {}", node.axis), 0.0, 1.0, 5);
    let costs = own.iter().flat_map(|p| [p.f / n, p.f_centres / n]);
    let most = costs.fold(1.0, f64::max).min(MOST);
    let y = Axis::linear("f / n SA; straddlers / n", 0.0, 1.05 * most, 4);
    let mut panel = Panel::new(pen, frame, x, y);
    let straddlers = |p: &CurveRecord| ((p.left + p.right) as f64 - n) / n;
    let upper: Vec<_> = own.iter().map(|p| (p.b, straddlers(p))).collect();
    let lower: Vec<_> = own.iter().map(|p| (p.b, 0.0)).collect();
    if upper.len() > 1 {
        panel.band(&lower, &upper, faded(GREEN, 0.35));
    }
    panel.line(&[(0.0, 1.0), (1.0, 1.0)], AXIS, 0.5);
    let top = 1.05 * most;
    panel.line(&[(0.5, 0.0), (0.5, top)], INK, 0.7);
    let median = node.object_median;
    panel.dashes(&[(median, 0.0), (median, top)], VERMILLION, 0.8);
    let curve = |value: fn(&CurveRecord) -> f64| -> Vec<(f64, f64)> {
        let all = own.iter().map(|p| (p.b, value(p) / n));
        all.filter(|p| p.1 <= top).collect()
    };
    panel.dashes(&curve(|p| p.f_centres), SKY, 0.8);
    panel.line(&curve(|p| p.f), BLUE, 1.0);
    for p in own.iter().filter(|p| p.sample && p.f / n <= top) {
        panel.mark((p.b, p.f / n), SAMPLE.marker, 1.3, SAMPLE.colour);
    }
    let least = (node.minimum, node.minimum_f / n);
    panel.mark(least, MINIMUM.marker, 2.6, MINIMUM.colour);
    let what = if node.rank == 1 {
        "root".to_owned()
    } else {
        format!("node of rank {}", node.rank)
    };
    let heading = format!(
        "{}: {what}, {}",
        node.scene,
        counted(node.objects, "object")
    );
    panel.heading(&fit(&heading, MEDIUM, SIZE.0), frame.left, 4.0);
}
