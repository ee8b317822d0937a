//! Shares of runs in which an interval covers, a test rejects, the stopping rule keeps its word: a row a check.

use plotters::style::text_anchor::{HPos, VPos};

use super::SpeedVsError;
use crate::report::Figure;
use crate::report::axis::{Axis, extent};
use crate::report::figure::{LEFT, Pen, WIDTH};
use crate::report::grid::page;
use crate::report::legend::Key;
use crate::report::number::{grouped, significant};
use crate::report::palette::{BLUE, GRID as THIN, INK, Look, Marker, SKY, VERMILLION, faded};
use crate::report::panel::{Frame, Panel};
use crate::report::series::distinct;
use crate::report::text::{MEDIUM, fit, text_width};
use crate::study::records::{CoverageRecord, Summary};

const TITLE: &str =
    "Do intervals cover, do tests keep their level, does the stopping rule keep its word?";
/// Height of a row.
const ROW: f64 = 11.0;
/// Above the first panel, and between two.
const ABOVE: f64 = 24.0;
const BETWEEN: f64 = 46.0;
const WIDEST: f64 = 230.0;
/// Least width of a band, of the axis's.
const THINNEST: f64 = 0.03;
const BAND: plotters::style::RGBAColor = faded(SKY, 0.4);

/// Checks of the same kind share a scale.
#[derive(Clone, Copy, PartialEq)]
pub enum Family {
    /// An interval holds the truth.
    Interval,
    /// A test rejects what is true.
    Test,
    /// The error is within the one asked for.
    Stop,
}

impl Family {
    const ALL: [Self; 3] = [Self::Interval, Self::Test, Self::Stop];

    /// Of a check.
    pub fn of(check: &str) -> Self {
        match check {
            "error" => Self::Stop,
            test if test.contains("p-") => Self::Test,
            _ => Self::Interval,
        }
    }

    /// Its heading.
    pub fn words(self) -> &'static str {
        match self {
            Self::Interval => "intervals that hold the truth",
            Self::Test => "tests that reject the truth",
            Self::Stop => "runs within the error asked for",
        }
    }
}

/// Whether as many runs count as are expected to.
pub fn kept(row: &CoverageRecord) -> bool {
    (row.least..=row.most).contains(&row.counted)
}

/// The figure; `None` where nothing was checked.
pub fn figure(run: &SpeedVsError, summary: &Summary) -> Option<Figure> {
    let of = |family: Family| -> (Family, Vec<&CoverageRecord>) {
        let own = run.coverage.iter();
        let own = own.filter(|row| row.runs > 0 && Family::of(&row.check) == family);
        (family, own.collect())
    };
    let mut families: Vec<_> = Family::ALL.into_iter().map(of).collect();
    families.retain(|(_, rows)| !rows.is_empty());
    let checks: usize = families.iter().map(|(_, rows)| rows.len()).sum();
    if checks == 0 {
        return None;
    }
    let rows = families.iter().flat_map(|(_, rows)| rows);
    let widest = rows.map(|row| text_width(&name(row), MEDIUM));
    let left = LEFT + widest.fold(0.0, f64::max) + 7.0;
    let gaps = BETWEEN * (families.len() - 1) as f64;
    let high = ABOVE + ROW * checks as f64 + gaps;
    let scenes = distinct(run.coverage.iter().map(|row| row.scene.as_str()));
    let runs = distinct_runs(&run.coverage);
    let caption = format!(
        "Share of the independent runs that count ({runs} of a check, on {}). Band: where that share lies if the check is right, as \
         the run's expectations have it; triangle: the level that is wanted. Behind a check its level (of the stopping rule: the error asked for), the sampler and the lines of a run. Checks of uniform p-values are one test each of all runs: the band is 0, drawn wider to be seen. Seed {}.",
        scenes.join(", "),
        summary.seed
    );
    let mark = |colour| {
        Key::Mark(Look {
            colour,
            ..Look::of(0)
        })
    };
    let keys = [
        (mark(BLUE), "share within its band".to_owned()),
        (Key::Mark(OUTSIDE), "outside".to_owned()),
        (Key::Area(BAND), "band".to_owned()),
        (Key::Mark(LEVEL), "level".to_owned()),
    ];
    let draw = |pen: &Pen, top: f64| {
        let mut top = top + ABOVE;
        for (family, rows) in &families {
            let frame = Frame {
                left,
                top,
                right: WIDTH - LEFT - 8.0,
                bottom: top + ROW * rows.len() as f64,
            };
            panel(pen, *family, rows, frame);
            top = frame.bottom + BETWEEN;
        }
    };
    Some(page((TITLE, caption), &keys, high, summary, draw))
}

const OUTSIDE: Look = Look {
    colour: VERMILLION,
    marker: Marker::Square,
};
const LEVEL: Look = Look {
    colour: INK,
    marker: Marker::Down,
};

/// How many runs a check has: one number, or the least and the most.
fn distinct_runs(rows: &[CoverageRecord]) -> String {
    let (lo, hi) = extent(rows.iter().map(|row| row.runs as f64)).unwrap_or_default();
    let [lo, hi] = [lo, hi].map(|end| grouped(end as u64));
    if lo == hi {
        lo
    } else {
        format!("{lo} to {hi}")
    }
}

/// What names a row.
fn name(row: &CoverageRecord) -> String {
    let check = row.check.strip_prefix("p-").unwrap_or(&row.check);
    let level = significant(100.0 * row.nominal, 1);
    let text = format!(
        "{check} at {level} %, {}, {}",
        row.sampler,
        grouped(row.lines)
    );
    fit(&text, MEDIUM, WIDEST)
}

fn panel(pen: &Pen, family: Family, rows: &[&CoverageRecord], frame: Frame) {
    let shares = |row: &CoverageRecord| {
        [row.counted, row.least, row.most].map(|n| n as f64 / row.runs as f64)
    };
    // The level of the stopping rule is an error, not a share.
    let level = |row: &CoverageRecord| (family != Family::Stop).then_some(row.nominal);
    let all = rows
        .iter()
        .flat_map(|row| shares(row).into_iter().chain(level(row)));
    let (low, high) = extent(all).unwrap_or((0.0, 1.0));
    let room = (0.05 * (high - low)).max(0.002);
    let x = Axis::linear(
        "share of runs",
        (low - room).max(-0.01),
        (high + room).min(1.01),
        6,
    );
    let y = Axis {
        ticks: Vec::new(),
        ..Axis::linear("", -(rows.len() as f64), 0.0, 1)
    };
    let (low, high) = (x.lo, x.hi);
    let mut panel = Panel::new(pen, frame, x, y);
    panel.heading(family.words(), frame.left - 2.0, 8.0);
    for (i, row) in rows.iter().enumerate() {
        let middle = -(i as f64 + 0.5);
        let [share, least, most] = shares(row);
        // A band of a single share, as of one test of all runs, is still seen.
        let seen = (0.5 * (THINNEST * (high - low) - (most - least))).max(0.0);
        let (left, right) = ((least - seen).max(low), (most + seen).min(high));
        panel.rectangle((left, middle - 0.38), (right, middle + 0.38), BAND);
        panel.line(&[(low, middle - 0.5), (high, middle - 0.5)], THIN, 0.4);
        if let Some(level) = level(row) {
            panel.mark((level, middle + 0.42), LEVEL.marker, 1.7, LEVEL.colour);
        }
        let look = if kept(row) {
            Look {
                colour: BLUE,
                ..Look::of(0)
            }
        } else {
            OUTSIDE
        };
        panel.mark((share, middle), look.marker, 2.3, look.colour);
        if let Some((_, y)) = panel.place((low, middle)) {
            pen.text(
                &name(row),
                (frame.left - 5.0, y),
                MEDIUM,
                INK,
                (HPos::Right, VPos::Center),
            );
        }
    }
}
