//! A slice through a scene with the cells of every strategy's tree, side by side.

use plotters::style::RGBAColor;
use plotters::style::text_anchor::{HPos, VPos};

use super::axis::extent;
use super::figure::{Figure, LEFT, Pen, WIDTH};
use super::number::{counted, significant};
use super::palette::{BLUE, INK, MUTED, VERMILLION, faded};
use super::series::distinct;
use super::text::{LEADING, MEDIUM, SMALL, caption_lines, fit};
use crate::study::records::{OutlineRecord, SliceRecord};

const TITLE: &str = "Where strategies cut: a slice through the cells of their trees";
const COLUMNS: usize = 4;
const GAP: f64 = 9.0;
/// Room above a panel for its name.
const NAME: f64 = 20.0;
/// A panel is at most so many times as high as wide.
const TALLEST: f64 = 1.6;
/// Above so many cells or pieces in all a picture would take megabytes.
const MOST: usize = 60_000;

/// The figure of a slice; `None` where it has no cells or too many. Objects are left out where there are too many of them.
pub fn figure(cells: &[SliceRecord], outlines: &[OutlineRecord], quick: bool) -> Option<Figure> {
    let first = cells.first()?;
    let strategies = distinct(cells.iter().map(|cell| cell.strategy.as_str()));
    let window = Window {
        u: part(cells.iter().map(|c| (c.u_lo, c.u_hi)))?,
        v: part(cells.iter().map(|c| (c.v_lo, c.v_hi)))?,
    };
    let (u_lo, v_lo) = (window.u.0, window.v.0);
    let (across, up) = (window.u.1 - u_lo, window.v.1 - v_lo);
    if across <= 0.0 || up <= 0.0 || cells.len() > MOST {
        return None;
    }
    // Rather the cells without the objects than neither.
    let drawn = cells.len() + strategies.len() * outlines.len();
    let outlines = if drawn > MOST { &[] } else { outlines };
    let columns = COLUMNS.min(strategies.len());
    let room = (WIDTH - 2.0 * LEFT + GAP) / columns as f64 - GAP;
    // One scale for both directions.
    let scale = (room / across).min(TALLEST * room / up);
    let height = scale * up;
    let rows = strategies.len().div_ceil(columns);
    let top = 24.0;
    let bottom = top + (NAME + height) * rows as f64 + GAP * (rows - 1) as f64;
    let [u, v] = match first.axis.as_str() {
        "x" => ["y", "z"],
        "y" => ["x", "z"],
        _ => ["x", "y"],
    };
    let most = cells.iter().map(|cell| cell.objects).max().unwrap_or(0);
    let caption = format!(
        "{}, plane {} = {}: {u} to the right from {} to {}, {v} upwards from {} to {}, one scale for both. Cells are leaves, the \
         darker the more objects they hold (white: none; \
         darkest: {}). Red: objects where the plane cuts them. Stop {}.",
        first.scene,
        first.axis,
        significant(first.at, 4),
        significant(u_lo, 3),
        significant(window.u.1, 3),
        significant(v_lo, 3),
        significant(window.v.1, 3),
        counted(most, "object"),
        first.stop
    );
    let caption = caption_lines(caption, WIDTH - 2.0 * LEFT, quick);
    let page = bottom + 18.0 + LEADING * (caption.len() - 1) as f64 + 6.0;
    Some(Figure::draw(
        TITLE,
        (&caption, bottom + 18.0),
        WIDTH,
        page,
        |pen| {
            for (i, strategy) in strategies.iter().enumerate() {
                let left =
                    LEFT + (room + GAP) * (i % columns) as f64 + (room - scale * across) / 2.0;
                let floor =
                    top + (NAME + height) * (i / columns + 1) as f64 + GAP * (i / columns) as f64;
                let place =
                    |u: f64, v: f64| (left + scale * (u - u_lo), floor - scale * (v - v_lo));
                let own: Vec<&SliceRecord> =
                    cells.iter().filter(|c| c.strategy == *strategy).collect();
                heading(
                    pen,
                    strategy,
                    own.len() as u64,
                    (left, floor - height),
                    room,
                );
                for cell in &own {
                    draw(pen, cell, most, &window, place);
                }
                let pieces = outlines.iter().filter_map(|piece| window.clip(piece));
                for ends in pieces {
                    pen.line(&ends.map(|(u, v)| place(u, v)), VERMILLION, 0.35);
                }
            }
        },
    ))
}

fn heading(pen: &Pen, strategy: &str, cells: u64, (left, top): (f64, f64), room: f64) {
    let anchor = (HPos::Left, VPos::Bottom);
    let name = fit(strategy, MEDIUM, room);
    pen.text(&name, (left, top - 10.0), MEDIUM, INK, anchor);
    pen.text(
        &counted(cells, "cell"),
        (left, top - 2.5),
        SMALL,
        MUTED,
        anchor,
    );
}

/// The part of the slice that is drawn.
struct Window {
    u: (f64, f64),
    v: (f64, f64),
}

/// Where all cells but the outermost few are, if that is less than half of the whole; else the whole. Some scenes are small
/// on a large floor.
fn part(spans: impl Iterator<Item = (f64, f64)> + Clone) -> Option<(f64, f64)> {
    let (lo, hi) = extent(spans.clone().flat_map(|(lo, hi)| [lo, hi]))?;
    let mut middles: Vec<f64> = spans.map(|(lo, hi)| 0.5 * (lo + hi)).collect();
    middles.sort_by(f64::total_cmp);
    let outermost = middles.len() / 12;
    let (a, b) = (middles[outermost], middles[middles.len() - 1 - outermost]);
    let room = 0.15 * (b - a);
    if b > a && b - a < 0.5 * (hi - lo) {
        Some(((a - room).max(lo), (b + room).min(hi)))
    } else {
        Some((lo, hi))
    }
}

impl Window {
    /// The part of a piece inside (Liang & Barsky 1984).
    fn clip(&self, piece: &OutlineRecord) -> Option<[(f64, f64); 2]> {
        let (mut t0, mut t1) = (0f64, 1f64);
        for (from, to, (lo, hi)) in [(piece.u0, piece.u1, self.u), (piece.v0, piece.v1, self.v)] {
            let step = to - from;
            if step == 0.0 {
                if !(lo..=hi).contains(&from) {
                    return None;
                }
                continue;
            }
            let (a, b) = ((lo - from) / step, (hi - from) / step);
            t0 = t0.max(a.min(b));
            t1 = t1.min(a.max(b));
        }
        let at = |t: f64| {
            (
                piece.u0 + t * (piece.u1 - piece.u0),
                piece.v0 + t * (piece.v1 - piece.v0),
            )
        };
        (t0 < t1).then(|| [at(t0), at(t1)])
    }
}

/// The part of a cell in the window, filled by its objects.
fn draw(
    pen: &Pen,
    cell: &SliceRecord,
    most: u64,
    window: &Window,
    place: impl Fn(f64, f64) -> (f64, f64),
) {
    let (u, v) = (
        (cell.u_lo.max(window.u.0), cell.u_hi.min(window.u.1)),
        (cell.v_lo.max(window.v.0), cell.v_hi.min(window.v.1)),
    );
    if u.0 > u.1 || v.0 > v.1 {
        return;
    }
    let (a, b) = (place(u.0, v.0), place(u.1, v.1));
    if cell.objects > 0 {
        pen.rectangle(a, b, shade(cell.objects, most));
    }
    let ring = [a, (b.0, a.1), b, (a.0, b.1), a];
    pen.line(&ring, faded(INK, 0.55), 0.25);
}

/// From light to darker with the logarithm of the number of objects.
fn shade(objects: u64, most: u64) -> RGBAColor {
    let share = (1.0 + objects as f64).ln() / (1.0 + most as f64).ln();
    faded(BLUE, 0.08 + 0.5 * share)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cell(strategy: &str, lo: [f64; 2], hi: [f64; 2], objects: u64) -> SliceRecord {
        SliceRecord {
            scene: "spd:balls:3".into(),
            strategy: strategy.into(),
            stop: "objects:2".into(),
            axis: "y".into(),
            at: 0.25,
            u_lo: lo[0],
            v_lo: lo[1],
            u_hi: hi[0],
            v_hi: hi[1],
            depth: 1,
            objects,
        }
    }

    #[test]
    fn every_cell_is_drawn_and_full_ones_are_filled() {
        let cells = [
            cell("a", [0.0, 0.0], [1.0, 2.0], 0),
            cell("a", [1.0, 0.0], [3.0, 2.0], 4),
            cell("b", [0.0, 0.0], [3.0, 2.0], 1),
        ];
        let outlines = [OutlineRecord {
            scene: "spd:balls:3".into(),
            object: 0,
            u0: 0.5,
            v0: 0.5,
            u1: 1.5,
            v1: 1.5,
        }];
        let shapes = |outlines: &[OutlineRecord]| {
            let figure = figure(&cells, outlines, false).expect("cells");
            figure.shapes.len()
        };
        let bare = shapes(&[]);
        assert_eq!(shapes(&outlines), bare + 2, "one piece in each panel");
        assert!(figure(&[], &outlines, false).is_none());
        let flat = [cell("a", [0.0, 0.0], [1.0, 0.0], 1)];
        assert!(figure(&flat, &[], false).is_none());
    }

    #[test]
    fn a_small_part_of_the_whole_is_drawn_large() {
        let few = [(0.0, 100.0), (0.0, 50.0), (50.0, 100.0)];
        assert_eq!(part(few.into_iter()), Some((0.0, 100.0)));
        // Twenty cells of length 1 in the middle: 40 to 60, without the outermost.
        let mut many: Vec<(f64, f64)> =
            (40..60).map(|i| (f64::from(i), f64::from(i + 1))).collect();
        many.extend([(0.0, 40.0), (60.0, 100.0)]);
        let (lo, hi) = part(many.into_iter()).expect("cells");
        assert!(
            30.0 < lo && lo < 42.0 && 58.0 < hi && hi < 70.0,
            "{lo} {hi}"
        );
        let window = Window {
            u: (0.0, 2.0),
            v: (0.0, 1.0),
        };
        let piece = |u0, v0, u1, v1| OutlineRecord {
            scene: String::new(),
            object: 0,
            u0,
            v0,
            u1,
            v1,
        };
        let across = window.clip(&piece(-1.0, 0.5, 3.0, 0.5));
        assert_eq!(across, Some([(0.0, 0.5), (2.0, 0.5)]));
        assert_eq!(window.clip(&piece(-1.0, 2.0, 3.0, 2.0)), None);
        assert_eq!(window.clip(&piece(1.0, -2.0, 1.0, -1.0)), None);
    }

    #[test]
    fn more_objects_are_darker() {
        assert!(shade(1, 9).3 < shade(3, 9).3 && shade(9, 9).3 < 0.6);
    }
}
