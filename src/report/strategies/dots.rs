//! Every scene as a row of dots: trees against the reference's, on log axes, with averages and Havran's own marks below.
//!
//! Two panels, for strategies that take the plane of least cost stay within a fraction of each other while the others may
//! be hundreds of times as slow.

use plotters::style::text_anchor::{HPos, VPos};

use super::averages::Averages;
use super::havran;
use super::part::{Measure, Part, REFERENCE};
use crate::report::axis::{Axis, extent};
use crate::report::figure::{Figure, LEFT, Pen, WIDTH};
use crate::report::legend::{Key, LEGEND_LEADING, legend, legend_rows};
use crate::report::number::significant;
use crate::report::palette::{GRID, INK, Look, MUTED, SKY, faded};
use crate::report::panel::{Frame, Panel};
use crate::report::series::provenance;
use crate::report::text::{LEADING, MEDIUM, SMALL, capitalised, caption_lines, fit, text_width};

/// Height of the row of a scene, and of one strategy within a row of averages.
const ROW: f64 = 8.6;
const PITCH: f64 = 4.4;
/// Share of the width that the panel of the wide range takes.
const WIDE: f64 = 0.56;
/// Between the panels.
const GAP: f64 = 14.0;
/// Longer names of scenes are shortened.
const WIDEST_NAME: f64 = 110.0;
/// Radius of a mark.
const RADIUS: f64 = 1.9;

/// The rows below the scenes, and whether strategies are side by side in them, as their bars need.
const SUMMARY: [(&str, bool); 5] = [
    ("geometric mean", true),
    ("median", false),
    ("arithmetic mean", false),
    ("Havran: mean", false),
    ("Havran: best, worst", true),
];
const GEOMETRIC: usize = 0;
const MEDIAN: usize = 1;
const MEAN: usize = 2;
const HAVRAN_MEAN: usize = 3;
const HAVRAN_ENDS: usize = 4;

/// The figure of one measure; None where no tree has anything to be set against.
pub fn figure(part: &Part, measure: Measure, quick: bool) -> Option<Figure> {
    let series: Vec<Series> = part
        .strategies
        .iter()
        .enumerate()
        .filter_map(|(i, name)| Series::of(part, measure, i, name))
        .collect();
    if series.is_empty() {
        return None;
    }
    let title = title(measure);
    let caption = caption_lines(caption(part, &series, measure), WIDTH - 2.0 * LEFT, quick);
    let keys: Vec<_> = series
        .iter()
        .map(|one| (Key::Mark(one.look), one.name.to_owned()))
        .collect();
    let key_rows = legend_rows(
        WIDTH - 2.0 * LEFT,
        keys.iter().map(|(_, text)| text.as_str()),
    );
    let names: Vec<String> = part
        .scenes
        .iter()
        .map(|scene| fit(scene, MEDIUM, WIDEST_NAME))
        .collect();
    let summary = SUMMARY.map(|(name, _)| name);
    let widest = names
        .iter()
        .map(String::as_str)
        .chain(summary)
        .map(|name| text_width(name, MEDIUM))
        .fold(0.0, f64::max);
    let (alike, others): (Vec<&Series>, Vec<&Series>) =
        series.iter().partition(|one| one.cost_driven());
    let most = |number: fn(&[&Series]) -> usize| number(&alike).max(number(&others));
    let rows = Rows {
        top: 53.0 + LEGEND_LEADING * (key_rows - 1) as f64,
        scenes: names.len(),
        side_by_side: [
            most(|all| all.len()),
            most(|all| all.iter().filter(|one| one.havran().is_some()).count()),
        ],
    };
    let bottom = rows.end();
    let baseline = bottom + 36.0;
    let height = baseline + LEADING * (caption.len() - 1) as f64 + 6.0;
    Some(Figure::draw(
        title,
        (&caption, baseline),
        WIDTH,
        height,
        |pen| {
            legend(pen, (LEFT, WIDTH - LEFT), 31.0, &keys);
            let left = LEFT + widest + 6.0;
            let right = WIDTH - LEFT - 4.0;
            label_rows(pen, &rows, &names, left - 5.0);
            label_groups(pen, part, &rows, (LEFT, right));
            let frame = |left, right| Frame {
                left,
                top: rows.top,
                right,
                bottom,
            };
            let panels = if alike.is_empty() || others.is_empty() {
                vec![("", series.iter().collect(), frame(left, right))]
            } else {
                let between = left + WIDE * (right - left - GAP);
                vec![
                    (
                        "(a) planes placed without cost",
                        others,
                        frame(left, between),
                    ),
                    (
                        "(b) planes of least cost",
                        alike,
                        frame(between + GAP, right),
                    ),
                ]
            };
            for (heading, series, frame) in panels {
                draw(pen, &rows, &series, frame, measure).heading(heading, frame.left, 4.0);
            }
        },
    ))
}

fn title(measure: Measure) -> &'static str {
    match measure {
        Measure::Predicted | Measure::Counted => "What does the tree of another strategy cost?",
        Measure::Traced => "What do the rays of a picture cost in the tree of another strategy?",
        Measure::Total | Measure::Trace | Measure::Build => {
            "How much longer does a picture take with the tree of another strategy?"
        }
    }
}

/// One strategy.
struct Series<'r> {
    name: &'r str,
    look: Look,
    /// Row of a scene, and how many times the reference's value.
    ratios: Vec<(usize, f64)>,
    averages: Averages<'r>,
}

impl<'r> Series<'r> {
    /// A strategy other than the reference, the `i`-th of the run.
    fn of(part: &Part<'r>, measure: Measure, i: usize, name: &'r str) -> Option<Self> {
        if name == REFERENCE {
            return None;
        }
        let rows = part.scenes.iter().enumerate();
        Some(Series {
            name,
            look: Look::of(i),
            ratios: rows
                .filter_map(|(row, scene)| {
                    Some((row, part.ratio(measure, scene, name, REFERENCE)?))
                })
                .collect(),
            averages: Averages::of(&part.ratios(measure, name, REFERENCE))?,
        })
    }

    /// Whether it takes the plane of least cost among some.
    fn cost_driven(&self) -> bool {
        self.name.starts_with(REFERENCE)
    }

    /// Havran's mean, best and worst as ratios.
    fn havran(&self) -> Option<[f64; 3]> {
        let row = havran::row(self.name)?;
        let all = [row.avg_percent, row.best_percent, row.worst_percent];
        Some(all.map(|percent| 1.0 + percent / 100.0))
    }

    /// All that is drawn of it.
    fn values(&self) -> impl Iterator<Item = f64> {
        let ratios = self.ratios.iter().map(|&(_, ratio)| ratio);
        let averages = [self.averages.mean]
            .into_iter()
            .chain(self.averages.interval.into_iter().flatten());
        ratios
            .chain(averages)
            .chain(self.havran().into_iter().flatten())
    }
}

/// Where the rows are.
struct Rows {
    top: f64,
    scenes: usize,
    /// Most strategies of a panel, and most of them that Havran tells of.
    side_by_side: [usize; 2],
}

impl Rows {
    /// Middle of the row of a scene.
    fn of_scene(&self, row: usize) -> f64 {
        self.top + ROW * (row as f64 + 0.5)
    }

    /// Height of a row of averages.
    fn height(&self, row: usize) -> f64 {
        let side_by_side = self.side_by_side[usize::from(row >= HAVRAN_MEAN)].max(1);
        let spread = if SUMMARY[row].1 { side_by_side - 1 } else { 0 };
        ROW + 1.4 + PITCH * spread as f64
    }

    /// Top and middle of a row of averages.
    fn of_summary(&self, row: usize) -> (f64, f64) {
        let above: f64 = (0..row).map(|above| self.height(above)).sum();
        let top = self.top + ROW * self.scenes as f64 + 1.0 + above;
        (top, top + 0.5 * self.height(row))
    }

    /// Bottom of the last row.
    fn end(&self) -> f64 {
        let last = SUMMARY.len() - 1;
        self.of_summary(last).0 + self.height(last)
    }
}

fn label_rows(pen: &Pen, rows: &Rows, names: &[String], right: f64) {
    let label =
        |name: &str, y| pen.text(name, (right, y), MEDIUM, INK, (HPos::Right, VPos::Center));
    for (i, name) in names.iter().enumerate() {
        label(name, rows.of_scene(i));
    }
    for (i, (name, _)) in SUMMARY.iter().enumerate() {
        label(name, rows.of_summary(i).1);
    }
}

/// A line wherever another group of the databases begins, and its name.
fn label_groups(pen: &Pen, part: &Part, rows: &Rows, (left, right): (f64, f64)) {
    let mut before = None;
    for (i, scene) in part.scenes.iter().enumerate() {
        let group = havran::group(scene);
        if i == 0 || group != before {
            let y = rows.of_scene(i) - 0.5 * ROW;
            if i > 0 {
                pen.line(&[(left, y), (right, y)], faded(INK, 0.3), 0.4);
            }
            let at = (left, y + 0.5 * ROW);
            pen.text(
                group.unwrap_or(""),
                at,
                SMALL,
                MUTED,
                (HPos::Left, VPos::Center),
            );
        }
        before = group;
    }
    for row in [GEOMETRIC, HAVRAN_MEAN] {
        let y = rows.of_summary(row).0;
        pen.line(&[(left, y), (right, y)], faded(INK, 0.6), 0.5);
    }
}

fn draw<'p, 'a>(
    pen: &'p Pen<'a>,
    rows: &Rows,
    series: &[&Series],
    frame: Frame,
    measure: Measure,
) -> Panel<'p, 'a> {
    let values = series.iter().flat_map(|one| one.values()).chain([1.0]);
    let (low, high) = extent(values.filter(|&value| value > 0.0)).unwrap_or((1.0, 1.0));
    let room = (high / low).powf(0.04).max(1.02);
    let label = format!("{} over that of {REFERENCE}", measure.name());
    let x = Axis::log(label, low / room, high * room, 6);
    // Downwards, in points.
    let y = Axis {
        ticks: Vec::new(),
        ..Axis::linear("", -frame.bottom, -frame.top, 1)
    };
    let top_of_havran = -rows.of_summary(HAVRAN_MEAN).0;
    let mut panel = Panel::new(pen, frame, x, y);
    let (from, to) = (panel.x.value(0.0), panel.x.value(1.0));
    panel.rectangle((from, top_of_havran), (to, -frame.bottom), faded(SKY, 0.14));
    for row in 0..rows.scenes {
        let y = -rows.of_scene(row);
        panel.line(&[(from, y), (to, y)], GRID, 0.3);
    }
    panel.line(&[(1.0, -frame.top), (1.0, -frame.bottom)], INK, 0.7);
    let havrans = series.iter().filter(|one| one.havran().is_some()).count();
    let (mut place, mut havran_place) = (0, 0);
    for one in series {
        let mark = |panel: &Panel, ratio, y: f64| {
            panel.mark(
                (ratio, -y),
                one.look.marker,
                RADIUS,
                faded(one.look.colour, 0.85),
            );
        };
        let bar = |panel: &mut Panel, [lo, hi]: [f64; 2], y: f64| {
            panel.line(&[(lo, -y), (hi, -y)], faded(one.look.colour, 0.75), 0.9);
        };
        let middle = |row: usize| rows.of_summary(row).1;
        for &(row, ratio) in &one.ratios {
            mark(&panel, ratio, rows.of_scene(row));
        }
        let at = middle(GEOMETRIC) + beside(place, series.len());
        if let Some(interval) = one.averages.interval {
            bar(&mut panel, interval, at);
        }
        mark(&panel, one.averages.geometric, at);
        mark(&panel, one.averages.median, middle(MEDIAN));
        mark(&panel, one.averages.mean, middle(MEAN));
        place += 1;
        if let Some([mean, best, worst]) = one.havran() {
            mark(&panel, mean, middle(HAVRAN_MEAN));
            let at = middle(HAVRAN_ENDS) + beside(havran_place, havrans);
            bar(&mut panel, [best, worst], at);
            mark(&panel, best, at);
            mark(&panel, worst, at);
            havran_place += 1;
        }
    }
    panel
}

/// How far below the middle of a row the `i`-th of so many strategies is.
fn beside(i: usize, number: usize) -> f64 {
    (i as f64 - 0.5 * (number - 1) as f64) * PITCH
}

fn caption(part: &Part, series: &[Series], measure: Measure) -> String {
    let driven = series.iter().filter(|one| one.cost_driven()).count();
    let two_panels = if driven > 0 && driven < series.len() {
        " (b), on an axis of its own: strategies that take the plane of least cost among some."
    } else {
        ""
    };
    let worst = series.iter().map(|one| one.averages.worst);
    let worst = worst.max_by(|a, b| a.1.total_cmp(&b.1));
    let worst = worst.map_or(String::new(), |(scene, ratio)| {
        format!(" Largest: {} times, on {scene}.", significant(ratio, 3))
    });
    format!(
        "{}, as a multiple of {REFERENCE}'s.{two_panels} Bars at geometric means: 99 % intervals (Student's t of the \
         logarithms, the sizes of one scene together being one observation). Shaded: Havran (2000), total time over 30 scenes of the same \
         databases.{worst} {}",
        capitalised(measure.meaning()),
        provenance(&part.cells)
    )
}
