//! What kernels get wrong, against their time and against how far the scene lies from the origin: a column of panels a scene.

mod one;

use super::SpeedVsError;
use super::times::Of;
use crate::report::Figure;
use crate::report::axis::extent;
use crate::report::grid::{Grid, page_name, part};
use crate::report::legend::Key;
use crate::report::number::grouped;
use crate::report::palette::{INK, Look, faded};
use crate::report::series::distinct;
use crate::study::records::{PrecisionRecord, Summary};
use one::{FAINT, One, REFUSED, WARNED};

const TIME: &str = "What does precision cost? Wrong answers of each kernel against its time";
const OFFSET: &str = "How far from the origin does each kernel hold?";
const COLUMNS: usize = 3;
const GRID: Grid = Grid {
    columns: COLUMNS,
    left: 44.0,
    above: 20.0,
    size: (138.0, 84.0),
    pitch: (158.0, 104.0),
};

/// What a panel shows of a row: a number and the ends of its interval.
pub type Shown = fn(&PrecisionRecord) -> Option<[f64; 3]>;

/// What a row of panels shows.
pub struct Quantity {
    /// Label of the axis.
    pub label: &'static str,
    /// What is shown of a row.
    pub of: Shown,
    /// Of a rate of wrong answers, which aimed lines have too: those that are no ties, of how many.
    pub beyond: Option<fn(&PrecisionRecord) -> [u64; 2]>,
}

const VISITS: Quantity = Quantity {
    label: "wrong visits per 10⁹",
    of: |r| {
        Some([
            r.visits_per_1e9?,
            r.visits_per_1e9_lo?,
            r.visits_per_1e9_hi?,
        ])
    },
    beyond: Some(|r| [r.wrong_visits + r.missed_visits, r.visits]),
};
const HITS: Quantity = Quantity {
    label: "wrong hits per 10⁹",
    of: |r| Some([r.hits_per_1e9?, r.hits_per_1e9_lo?, r.hits_per_1e9_hi?]),
    beyond: Some(|r| [r.wrong_hits + r.missed_hits, r.tests]),
};
const LARGEST: Quantity = Quantity {
    label: "max |z|",
    of: |r| r.max_z.map(|z| [z, z, z]),
    beyond: None,
};
const SLOPE: Quantity = Quantity {
    label: "|slope − 1|",
    of: |r| {
        let (error, half) = (r.slope_error?.abs(), 1.96 * r.slope_se.unwrap_or(0.0));
        Some([error, (error - half).max(0.0), error + half])
    },
    beyond: None,
};

/// `precision` and `precision-offset`, three scenes a page; none where nothing is to be drawn.
pub fn figures(run: &SpeedVsError, summary: &Summary) -> Vec<(String, Figure)> {
    let scenes = distinct(run.precision.iter().map(|row| row.scene.as_str()));
    let timed = |scene: &&str| {
        let mut own = run.precision.iter().filter(|row| row.scene == *scene);
        own.any(|row| run.visit_ns(row).is_some())
    };
    let moved = |scene: &&str| offsets(run, scene).len() > 1;
    let of_time = scenes
        .iter()
        .copied()
        .filter(|s| timed(s))
        .collect::<Vec<_>>();
    let of_place = scenes.into_iter().filter(moved).collect::<Vec<_>>();
    let mut all = pages(
        run,
        ("times-precision", &of_time),
        &[VISITS, HITS],
        true,
        summary,
    );
    let rows = [VISITS, HITS, LARGEST, SLOPE];
    all.extend(pages(
        run,
        ("precision-offset", &of_place),
        &rows,
        false,
        summary,
    ));
    all
}

fn pages(
    run: &SpeedVsError,
    (name, scenes): (&str, &[&str]),
    quantities: &[Quantity],
    timed: bool,
    summary: &Summary,
) -> Vec<(String, Figure)> {
    let of = scenes.len().div_ceil(COLUMNS);
    let pages = scenes.chunks(COLUMNS).enumerate();
    let page = |(i, scenes): (usize, &[&str])| {
        let which = part(i, of);
        (
            page_name(name, i),
            figure(run, scenes, quantities, timed, &which, summary),
        )
    };
    pages.map(page).collect()
}

/// Offsets of a scene, ascending.
fn offsets(run: &SpeedVsError, scene: &str) -> Vec<f64> {
    let own = run.precision.iter().filter(|row| row.scene == scene);
    let mut all: Vec<f64> = own.map(|row| row.offset).collect();
    all.sort_by(f64::total_cmp);
    all.dedup();
    all
}

fn figure(
    run: &SpeedVsError,
    scenes: &[&str],
    quantities: &[Quantity],
    timed: bool,
    which: &str,
    summary: &Summary,
) -> Figure {
    let kernels = distinct(run.precision.iter().map(|row| row.kernel.as_str()));
    let mut keys: Vec<_> = kernels
        .iter()
        .enumerate()
        .map(|(i, name)| (Key::Mark(Look::of(i)), (*name).to_owned()))
        .collect();
    let look = Look {
        colour: INK,
        ..Look::of(0)
    };
    let faint = faded(INK, FAINT);
    keys.extend([
        (Key::Mark(look), "random lines".to_owned()),
        (
            Key::Ring(look),
            "lines aimed at edges and corners".to_owned(),
        ),
    ]);
    if !timed {
        keys.push((Key::Line(faint), "ties included, random".to_owned()));
        keys.push((Key::Dashes(faint), "aimed".to_owned()));
        keys.push((Key::Area(WARNED), "f32 warned of".to_owned()));
        keys.push((Key::Area(REFUSED), "f32 refused".to_owned()));
    }
    let lines = extent(run.precision.iter().map(|row| row.lines as f64)).unwrap_or_default();
    let (title, own) = if timed {
        (
            TIME,
            "nanoseconds of a node's visit on one thread, by random lines that nothing stops; scenes not moved",
        )
    } else {
        (
            OFFSET,
            "how far the scene was moved along x, y and z over the longest side of its box; max |z|, slope: of random lines; bars of \
             the slope: 95 % of sampling; shaded where f32's steps are too coarse, as they grow with the offset",
        )
    };
    let disturbed = if timed {
        run.disturbed(Of::Kernels)
    } else {
        String::new()
    };
    let caption = format!(
        "Visits (hits): nodes (triangles) taken for met that the line misses, or missed that it meets, by exact arithmetic on \
         the kernel's own numbers, per 10⁹ nodes met (triangles tested). Marks: by more than 8 ulp; smaller, faint: ties included, with 95 % \
         intervals; on the lower edge: none; marks of kernels stand a little beside each other. f32 is judged on its rounded inputs: what \
         their rounding does shows in slope and max |z| alone. Against {own}. Up to {} lines of each family.{disturbed} Stop {}. Seed {}.{which}",
        grouped(lines.1 as u64),
        summary.stop.as_deref().unwrap_or("unknown"),
        summary.seed
    );
    let panels = scenes.len() * quantities.len();
    GRID.filled(scenes.len()).figure(
        (title, caption),
        &keys,
        panels,
        summary,
        |pen, number, frame| {
            let (column, row) = (number % scenes.len(), number / scenes.len());
            let one = One {
                run,
                scene: scenes[column],
                scenes,
                quantity: &quantities[row],
                kernels: &kernels,
                timed,
            };
            let edges = (row == 0, column == 0, row + 1 == quantities.len());
            one.draw(pen, frame, edges);
        },
    )
}
