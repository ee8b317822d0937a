//! Cost of a tree above the exact search's against the seconds it takes to build, a panel a scene.

use super::SpeedVsError;
use super::times::Of;
use crate::report::Figure;
use crate::report::axis::{Axis, extent};
use crate::report::figure::Pen;
use crate::report::grid::{Grid, page_name, part};
use crate::report::legend::Key;
use crate::report::number::grouped;
use crate::report::palette::{INK, Look, faded};
use crate::report::panel::{Frame, Panel};
use crate::report::series::distinct;
use crate::report::text::{MEDIUM, SMALL, fit, text_width};
use crate::study::records::{PlaneRecord, Summary};
use plotters::style::text_anchor::{HPos, VPos};

const TITLE: &str = "Which plane search is enough? Cost of its tree against the time of its build";
const PANELS: usize = 6;
const GRID: Grid = Grid {
    columns: 2,
    left: 44.0,
    above: 20.0,
    size: (208.0, 116.0),
    pitch: (252.0, 150.0),
};
/// Height of a panel that is the only one.
const ALONE: f64 = 200.0;
const RADIUS: f64 = 2.4;
/// What is dominated stands back.
const BEHIND: f64 = 0.35;

/// The name of a search without its number of candidates: one curve.
pub fn family(strategy: &str) -> &str {
    strategy.split(':').next().unwrap_or(strategy)
}

/// A search of which both is known, what its tree costs and how long it takes.
#[derive(Clone, Copy)]
pub struct Timed<'r> {
    /// The search.
    pub row: &'r PlaneRecord,
    /// Seconds of the build.
    pub seconds: f64,
}

impl<'r> Timed<'r> {
    /// Those of a scene.
    pub fn all(run: &'r SpeedVsError, scene: &str) -> Vec<Self> {
        let own = run.planes.iter().filter(|row| row.scene == scene);
        let timed = own.filter_map(|row| {
            let seconds = run.build_seconds(row)?;
            Some(Timed { row, seconds })
        });
        timed.collect()
    }

    /// The cheapest of those that are built no slower and cost no more, one of both being less.
    pub fn dominated_by(&self, all: &[Timed<'r>]) -> Option<&'r PlaneRecord> {
        let better = all.iter().filter(|other| {
            let no_worse = other.seconds <= self.seconds && other.row.c <= self.row.c;
            no_worse && (other.seconds < self.seconds || other.row.c < self.row.c)
        });
        better.map(|o| o.row).min_by(|a, b| a.c.total_cmp(&b.c))
    }
}

/// The pages; none where nothing was timed.
pub fn figures(run: &SpeedVsError, summary: &Summary) -> Vec<(String, Figure)> {
    let mut scenes = distinct(run.planes.iter().map(|row| row.scene.as_str()));
    scenes.retain(|scene| !Timed::all(run, scene).is_empty());
    let pages = scenes.chunks(PANELS);
    let of = pages.len();
    let page = |(i, scenes): (usize, &[&str])| {
        let name = page_name("times-plane-search", i);
        (name, figure(run, scenes, &part(i, of), summary))
    };
    pages.enumerate().map(page).collect()
}

fn figure(run: &SpeedVsError, scenes: &[&str], which: &str, summary: &Summary) -> Figure {
    let families = distinct(run.planes.iter().map(|row| family(&row.strategy)));
    let mut keys: Vec<_> = families
        .iter()
        .enumerate()
        .map(|(i, name)| (Key::Mark(Look::of(i)), (*name).to_owned()))
        .collect();
    let clipped = distinct(run.planes.iter().map(|row| told(row.clipped)));
    if clipped.len() > 1 {
        let look = Look {
            colour: INK,
            ..Look::of(0)
        };
        keys.push((Key::Mark(look), told(true).to_owned()));
        keys.push((Key::Ring(look), told(false).to_owned()));
    }
    let only = match clipped[..] {
        [only] => format!(" All trees are of objects {only}."),
        _ => String::new(),
    };
    let disturbed = run.disturbed(Of::Builds);
    let caption = format!(
        "Predicted cost C of a tree above that of the exact search without clipping, against the seconds of its build, the least of \
         several, on one thread. Numbers beside marks, where there is room: candidate planes or bins of an axis. Faded: dominated, as some other search \
         is built no slower and gives a tree no dearer.{only}{disturbed} Stop {}. Seed {}.{which}",
        summary.stop.as_deref().unwrap_or("unknown"),
        summary.seed
    );
    let mut grid = GRID.filled(scenes.len());
    // One panel alone has a page to itself.
    if scenes.len() == 1 {
        grid.size.1 = ALONE;
    }
    grid.figure(
        (TITLE, caption),
        &keys,
        scenes.len(),
        summary,
        |pen, number, frame| {
            let lowest = grid.is_lowest(number, scenes.len());
            let all = Timed::all(run, scenes[number]);
            let edges = (lowest, number % grid.columns == 0);
            draw(pen, &all, &families, frame, edges);
        },
    )
}

/// Whether objects were clipped, in words.
pub fn told(clipped: bool) -> &'static str {
    if clipped { "clipped" } else { "not clipped" }
}

/// One scene.
fn draw(
    pen: &Pen,
    all: &[Timed],
    families: &[&str],
    frame: Frame,
    (lowest, leftmost): (bool, bool),
) {
    let above = |one: &Timed| 100.0 * one.row.above_unclipped;
    let (fast, slow) = extent(all.iter().map(|one| one.seconds)).unwrap_or((0.1, 1.0));
    let (low, high) = extent(all.iter().map(above).chain([0.0])).unwrap_or((0.0, 1.0));
    let room = (0.08 * (high - low)).max(0.05);
    let label = if lowest { "seconds of a build" } else { "" };
    let x = Axis::log(label, fast / 1.3, 1.4 * slow, 5);
    let label = if leftmost { "C above exact, %" } else { "" };
    let y = Axis::linear(label, low - room, high + room, 5);
    let mut panel = Panel::new(pen, frame, x, y);
    if let Some(one) = all.first() {
        let objects = grouped(one.row.objects);
        let heading = format!("{}, {objects} objects", one.row.scene);
        let heading = fit(&heading, MEDIUM + 0.6, frame.right - frame.left);
        panel.heading(&heading, frame.left - 2.0, 4.0);
    }
    panel.line(
        &[(fast / 1.3, 0.0), (1.4 * slow, 0.0)],
        faded(INK, 0.55),
        0.5,
    );
    let mut labels = Vec::new();
    for clipped in [false, true] {
        for (i, name) in families.iter().enumerate() {
            let own = all
                .iter()
                .filter(|one| family(&one.row.strategy) == *name && one.row.clipped == clipped);
            let own: Vec<_> = own.collect();
            let look = Look::of(i);
            let curve: Vec<_> = own.iter().map(|one| (one.seconds, above(one))).collect();
            panel.line(&curve, faded(look.colour, BEHIND), 0.6);
            for one in own {
                let at = (one.seconds, above(one));
                let dominated = one.dominated_by(all).is_some();
                let colour = faded(look.colour, if dominated { BEHIND } else { 1.0 });
                if clipped {
                    panel.mark(at, look.marker, RADIUS, colour);
                } else {
                    panel.ring(at, look.marker, RADIUS, colour);
                }
                if let Some((point, (_, number))) =
                    panel.place(at).zip(one.row.strategy.split_once(':'))
                {
                    labels.push((dominated, point, number));
                }
            }
        }
    }
    // What is not dominated has its number first.
    labels.sort_by_key(|(dominated, _, _)| *dominated);
    number_marks(pen, &labels, frame);
}

/// Size of a number beside a mark.
const NUMBER: f64 = SMALL - 1.5;

/// Writes numbers beside their marks, on a side where no other mark or number is; a mark that has none stays without.
fn number_marks(pen: &Pen, labels: &[(bool, (f64, f64), &str)], frame: Frame) {
    type Box = [f64; 4];
    let marks = labels
        .iter()
        .map(|(_, (x, y), _)| [x - 2.0, y - 2.0, x + 2.0, y + 2.0]);
    let mut taken: Vec<Box> = marks.collect();
    let free = |taken: &[Box], [left, top, right, bottom]: Box| {
        let apart = |b: &Box| b[0] >= right || b[2] <= left || b[1] >= bottom || b[3] <= top;
        right <= frame.right + 8.0 && bottom <= frame.bottom && taken.iter().all(apart)
    };
    for (dominated, (x, y), number) in labels {
        let (wide, high) = (text_width(number, NUMBER), 0.75 * NUMBER);
        let (beside, before) = (x + 3.2, x - 3.2 - wide);
        let places = [
            (beside, y - 2.2),
            (beside, y + 2.2 + high),
            (before, y - 2.2),
            (before, y + 2.2 + high),
        ];
        let boxes = places.map(|(left, base)| [left, base - high, left + wide, base]);
        if let Some(own) = boxes.into_iter().find(|own| free(&taken, *own)) {
            let ink = faded(INK, if *dominated { 0.5 } else { 1.0 });
            pen.text(
                number,
                (own[0], own[3]),
                NUMBER,
                ink,
                (HPos::Left, VPos::Bottom),
            );
            taken.push(own);
        }
    }
}
