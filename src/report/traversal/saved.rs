//! Seconds over the stack's against inner nodes over the stack's, and against the size of the tree with its links: does a step that
//! is saved save time, and what does it cost that links are read from memory instead?

use super::Traversal;
use super::against::{Against, PRECISIONS, STACK, WAYS, bytes};
use super::dots::{keys, look};
use super::figures::{disturbed, left_out, provenance, sample};
use crate::report::Figure;
use crate::report::axis::{Axis, extent};
use crate::report::figure::Pen;
use crate::report::grid::Grid;
use crate::report::palette::{INK, Look, faded};
use crate::report::panel::{Frame, Panel};
use crate::study::records::Summary;

const GRID: Grid = Grid {
    columns: 3,
    left: 40.0,
    above: 14.0,
    size: (126.0, 116.0),
    pitch: (162.0, 166.0),
};

/// One tree along one way.
struct Point {
    way: usize,
    precision: usize,
    /// Inner nodes over the stack's.
    inner: f64,
    /// Bytes of the tree and what the way needs beside it.
    bytes: f64,
    /// Seconds over the stack's.
    seconds: f64,
}

fn points(run: &Traversal, rays: &str) -> Vec<Point> {
    let mut points = Vec::new();
    for (way, name) in WAYS.iter().enumerate() {
        for (precision, of) in PRECISIONS.iter().enumerate() {
            let at = |row: &Against| {
                Some(Point {
                    way,
                    precision,
                    inner: row.inner()?,
                    bytes: bytes(run.tree(row.own)?, name) as f64,
                    seconds: row.seconds()?,
                })
            };
            points.extend(run.of(rays, of, name).iter().filter_map(at));
        }
    }
    points
}

/// What lies along the horizontal axis of a row of panels.
#[derive(Clone, Copy)]
struct Across {
    label: &'static str,
    of: fn(&Point) -> f64,
    /// Whether 1 means nothing saved.
    relative: bool,
}

const ACROSS: [Across; 2] = [
    Across {
        label: "inner nodes, relative",
        of: |point| point.inner,
        relative: true,
    },
    Across {
        label: "bytes of tree and links",
        of: |point| point.bytes,
        relative: false,
    },
];

/// The range of what is known, with some room; it holds 1 where that is told.
fn range(values: impl Iterator<Item = f64>, one: bool) -> Option<(f64, f64)> {
    let (low, high) = extent(values.chain(one.then_some(1.0)))?;
    let room = (high / low).powf(0.05).max(1.02);
    Some((low / room, high * room))
}

/// The figure, a column a set of rays; `None` where nothing was timed.
pub fn figure(run: &Traversal, summary: &Summary) -> Option<Figure> {
    let sets = run.sets().into_iter().map(|rays| (rays, points(run, rays)));
    let sets: Vec<(&str, Vec<Point>)> = sets.filter(|(_, points)| !points.is_empty()).collect();
    let all = || sets.iter().flat_map(|(_, points)| points);
    let seconds =
        range(all().map(|point| point.seconds), true).filter(|_| all().next().is_some())?;
    let used = |number: &usize| all().any(|point| point.precision == *number);
    let used: Vec<usize> = (0..PRECISIONS.len()).filter(used).collect();
    let panels: Vec<(Across, &str, &[Point])> = ACROSS
        .iter()
        .flat_map(|across| sets.iter().map(|(rays, own)| (*across, *rays, &own[..])))
        .collect();
    let caption = format!(
        "Each mark a tree: seconds of a ray over those with a {STACK}, against inner nodes over those with a {STACK}, and against the bytes \
         of the tree and what the way needs beside it. Dashed: seconds in proportion to inner nodes. Below 1 time is saved, left of 1 inner \
         nodes are.{}{}{} {}",
        sample(run),
        disturbed(run),
        left_out(run),
        provenance(run, summary)
    );
    let columns = sets.len().min(GRID.columns);
    let grid = Grid { columns, ..GRID }.filled(columns);
    let draw = |pen: &Pen, number: usize, frame: Frame| {
        let (across, rays, points) = &panels[number];
        let Some((low, high)) = range(all().map(across.of), across.relative) else {
            return;
        };
        let x = Axis::log(across.label, low, high, 4);
        let y = Axis::log("seconds, relative", seconds.0, seconds.1, 4);
        let mut panel = Panel::new(pen, frame, x, y);
        let ink = faded(INK, 0.7);
        panel.line(&[(low, 1.0), (high, 1.0)], ink, 0.6);
        if across.relative {
            panel.line(&[(1.0, seconds.0), (1.0, seconds.1)], ink, 0.6);
            let (from, to) = (low.max(seconds.0), high.min(seconds.1));
            panel.dashes(&[(from, from), (to, to)], ink, 0.6);
        }
        for point in *points {
            let Look { colour, marker } = look(point.way);
            let at = ((across.of)(point), point.seconds);
            match point.precision {
                0 => panel.mark(at, marker, 1.9, faded(colour, 0.85)),
                _ => panel.ring(at, marker, 1.9, colour),
            }
        }
        let letter = char::from(b'a' + (number % 26) as u8);
        panel.heading(&format!("({letter}) {rays}"), frame.left, 4.0);
    };
    let title = "Do inner nodes that are saved save time?";
    let keys = keys(&[0, 1, 2], &used);
    Some(grid.figure((title, caption), &keys, panels.len(), summary, draw))
}
