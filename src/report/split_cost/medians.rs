//! All inner nodes: how often the minimum lies between the medians, and how far apart the medians' costs are.

use plotters::style::RGBAColor;
use plotters::style::text_anchor::{HPos, VPos};

use crate::report::axis::{Axis, Tick, extent};
use crate::report::figure::{Figure, LEFT, WIDTH};
use crate::report::legend::{Key, LEGEND_LEADING, legend, legend_rows};
use crate::report::number::{counted, grouped};
use crate::report::palette::{INK, Look, faded};
use crate::report::panel::{Frame, Panel};
use crate::report::series::distinct;
use crate::report::text::{LEADING, MEDIUM, caption_lines, fit, text_width};
use crate::study::records::{MedianRecord, Summary};

const TITLE: &str = "Does the cheapest plane lie between the medians, and do they cost the same?";
const DOWN: f64 = 150.0;
/// Where each object counts once: the scenes' lines lie on top of each other.
const CENTRES: RGBAColor = faded(INK, 0.8);

/// The figure of all scenes.
pub fn figure(rows: &[MedianRecord], summary: &Summary) -> Figure {
    let scenes = distinct(rows.iter().map(|r| r.scene.as_str()));
    let whole_rows = rows.iter().filter(|r| r.axis == "all" && is_whole(r));
    let looked_at = counted(whole_rows.map(|r| r.nodes).sum(), "case");
    let caption = format!(
        "Inner nodes of the trees of strategy sah, stop {}, each once an axis. (a) Share of nodes whose least f lies between \
         the two medians, by objects in the node: straddlers counted on both sides (lines), each object once, by its centre \
         (dashes). (b) f at the object median over f at the spatial one, where something straddles either: median, middle half \
         (thick), 5 to 95 % (thin) of the nodes. Where nothing straddles and the object median parts the objects evenly it is 0. {looked_at}, seed {}.",
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
    let lines = legend_rows(WIDTH - 2.0 * LEFT, texts);
    let top = 56.0 + LEGEND_LEADING * (lines - 1) as f64;
    let bottom = top + DOWN;
    let height = bottom + 36.0 + LEADING * (caption.len() - 1) as f64 + 6.0;
    Figure::draw(TITLE, (&caption, bottom + 36.0), WIDTH, height, |pen| {
        legend(pen, (LEFT, WIDTH - LEFT), 31.0, &keys);
        let frame = |left: f64, right: f64| Frame {
            left,
            top,
            right,
            bottom,
        };
        let mut shares = Panel::new(pen, frame(44.0, 236.0), sizes(rows), {
            Axis::linear("least f between medians, %", 0.0, 100.0, 5)
        });
        shares.heading("(a)", 44.0, 4.0);
        let all = |r: &&MedianRecord| r.axis == "all";
        for (i, scene) in scenes.iter().enumerate() {
            let look = Look::of(i);
            let own: Vec<&MedianRecord> = rows
                .iter()
                .filter(all)
                .filter(|r| r.scene == *scene && r.nodes > 0 && !is_whole(r))
                .collect();
            let curve = |count: fn(&MedianRecord) -> u64| -> Vec<(f64, f64)> {
                let share = |r: &&MedianRecord| 100.0 * count(r) as f64 / r.nodes as f64;
                own.iter().map(|r| (class(rows, r), share(r))).collect()
            };
            let straddling = curve(|r| r.between);
            shares.dashes(&curve(|r| r.between_centres), CENTRES, 0.8);
            shares.line(&straddling, look.colour, 0.9);
            for at in straddling {
                shares.mark(at, look.marker, 1.9, look.colour);
            }
        }

        let whole: Vec<&MedianRecord> = rows.iter().filter(all).filter(|r| is_whole(r)).collect();
        let names: Vec<String> = whole.iter().map(|r| fit(&r.scene, MEDIUM, 110.0)).collect();
        let widest = names.iter().map(|name| text_width(name, MEDIUM));
        let left = 262.0 + widest.fold(0.0, f64::max);
        let ends = whole.iter().flat_map(|r| [r.apart_q05, r.apart_q95]);
        let (low, high) = extent(ends.flatten().map(|v| 100.0 * v)).unwrap_or((-1.0, 1.0));
        let (low, high) = (low.min(0.0), high.max(0.0));
        let room = 0.06 * (high - low).max(0.1);
        let x = Axis::linear(
            "object over spatial median − 1, per cent",
            low - room,
            high + room,
            5,
        );
        let y = Axis {
            ticks: Vec::new(),
            ..Axis::linear("", -(whole.len() as f64), 0.0, 1)
        };
        let mut apart = Panel::new(pen, frame(left, WIDTH - LEFT - 4.0), x, y);
        apart.heading("(b)", left, 4.0);
        apart.line(&[(0.0, apart.y.lo), (0.0, 0.0)], INK, 0.7);
        for (i, (row, name)) in whole.iter().zip(&names).enumerate() {
            let at = -(i as f64 + 0.5);
            let middle = top + DOWN * (i as f64 + 0.5) / whole.len() as f64;
            let right = (HPos::Right, VPos::Center);
            pen.text(name, (left - 6.0, middle), MEDIUM, INK, right);
            let place = scenes.iter().position(|scene| *scene == row.scene);
            let look = Look::of(place.unwrap_or_default());
            let mut bar = |lo: Option<f64>, hi: Option<f64>, width: f64| {
                if let Some((lo, hi)) = lo.zip(hi) {
                    apart.line(&[(100.0 * lo, at), (100.0 * hi, at)], look.colour, width);
                }
            };
            bar(row.apart_q05, row.apart_q95, 0.7);
            bar(row.apart_q25, row.apart_q75, 2.6);
            if let Some(median) = row.apart_q50 {
                apart.mark((100.0 * median, at), look.marker, 2.4, look.colour);
            }
        }
    })
}

/// Whether a row is of nodes of all sizes.
fn is_whole(row: &MedianRecord) -> bool {
    row.objects_lo == 2 && row.objects_hi.is_none()
}

/// The classes of nodes by size, from their fewest objects up.
fn classes(rows: &[MedianRecord]) -> Vec<(u64, Option<u64>)> {
    let mut classes: Vec<_> = rows
        .iter()
        .filter(|row| !is_whole(row))
        .map(|row| (row.objects_lo, row.objects_hi))
        .collect();
    classes.sort_unstable();
    classes.dedup();
    classes
}

fn class(rows: &[MedianRecord], row: &MedianRecord) -> f64 {
    let of = (row.objects_lo, row.objects_hi);
    let place = classes(rows).iter().position(|class| *class == of);
    place.unwrap_or_default() as f64
}

/// An axis with a tick for every class.
fn sizes(rows: &[MedianRecord]) -> Axis {
    let classes = classes(rows);
    let tick = |(i, &(lo, hi)): (usize, &(u64, Option<u64>))| Tick {
        at: i as f64,
        label: match hi {
            Some(hi) => format!("{}–{}", grouped(lo), grouped(hi)),
            None => format!("≥ {}", grouped(lo)),
        },
    };
    Axis {
        ticks: classes.iter().enumerate().map(tick).collect(),
        minor: Vec::new(),
        ..Axis::linear("objects in the node", -0.4, classes.len() as f64 - 0.6, 1)
    }
}
