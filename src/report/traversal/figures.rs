//! Figures of dots: inner nodes and memory, which follow from counts, and seconds.

use super::Traversal;
use super::against::{Against, BUILD, PRECISIONS, WAYS, memory};
use super::dots::{Dots, Series, figures};
use crate::report::Figure;
use crate::report::axis::extent;
use crate::report::number::{counted, grouped};
use crate::report::series::distinct;
use crate::report::shown;
use crate::study::records::{Summary, TraversalRecord};

/// What a set of rays is, as the heading of its panel.
fn heading(number: usize, rays: &str) -> String {
    format!("({}) {rays}", char::from(b'a' + (number % 26) as u8))
}

/// A series for each way and precision of which there are any ratios.
fn series<'r>(ratios: impl Fn(&str, &str) -> Vec<(&'r str, f64)>) -> Vec<Series<'r>> {
    let mut all = Vec::new();
    for (way, name) in WAYS.iter().enumerate() {
        for (precision, of) in PRECISIONS.iter().enumerate() {
            let ratios = ratios(of, name);
            if !ratios.is_empty() {
                all.push((way, precision, ratios));
            }
        }
    }
    all
}

/// A panel a set of rays.
fn panels<'r>(
    run: &'r Traversal,
    label: &'static str,
    measure: impl Fn(&Against<'r>) -> Option<f64>,
) -> Vec<Dots<'r>> {
    let panel = |(number, rays): (usize, &str)| {
        let ratios = |precision: &str, way: &str| {
            let rows = run.of(rays, precision, way);
            let known = |row: &Against<'r>| Some((row.own.scene.as_str(), measure(row)?));
            rows.iter().filter_map(known).collect()
        };
        Dots {
            heading: heading(number, rays),
            label,
            series: series(ratios),
        }
    };
    let all = run.sets().into_iter().enumerate().map(panel);
    all.filter(|panel| !panel.series.is_empty()).collect()
}

/// What the run is of, for captions.
pub fn provenance(run: &Traversal, summary: &Summary) -> String {
    let trees = run.scenes().len() as u64;
    let first = run.walks.first();
    let tree = first.map_or(String::new(), |row| {
        format!(", strategy {}, stop {}", row.strategy, row.stop)
    });
    let cast = run
        .walks
        .iter()
        .filter(|row| row.random)
        .map(|row| row.cast);
    let rays = cast.max().map_or(String::new(), |cast| {
        format!(", {} rays of each random set", grouped(cast))
    });
    format!(
        "{}{tree}{rays}, seed {}.",
        counted(trees, "tree"),
        summary.seed
    )
}

/// What nothing is said of in f32, where something is left out.
pub fn left_out(run: &Traversal) -> &'static str {
    let missing = |row: &&TraversalRecord| {
        let in_f32 = |other: &TraversalRecord| {
            (&other.cell, &other.rays, other.precision.as_str())
                == (&row.cell, &row.rays, PRECISIONS[1])
        };
        row.precision == PRECISIONS[0] && !run.walks.iter().any(in_f32)
    };
    if run.walks.iter().any(|row| missing(&row)) {
        " Only triangles have a test in f32: of rays that test objects there are only scenes of triangles alone in f32."
    } else {
        ""
    }
}

/// Inner nodes over the stack's, and memory over the tree's alone.
pub fn steps(run: &Traversal, summary: &Summary) -> Vec<(String, Figure)> {
    let mut panels = panels(run, "inner nodes, relative", Against::inner);
    let bytes = |precision: &str, way: &str| {
        let rows = run.links.iter().filter(|row| row.precision == precision);
        let known = |row| Some((row, memory(row, way)?));
        let known = rows.filter_map(known);
        known
            .map(|(row, ratio)| (row.scene.as_str(), ratio))
            .collect()
    };
    panels.push(Dots {
        heading: heading(panels.len(), "memory"),
        label: "bytes, relative",
        series: series(bytes),
    });
    let caption = format!(
        "Inner nodes visited by all rays of a set along links, through face trees, or by restarts from the root, over those with a \
         stack: on 1 nothing is saved. Last panel: bytes of the tree with its links, or with links through face trees, over the tree \
         alone; a restart takes none. Bars, of three kinds of scenes or more: 99 % intervals of geometric means, cut at the edges (Student's t of the logarithms, the sizes of one \
         scene together being one observation).{} {}",
        left_out(run),
        provenance(run, summary)
    );
    let title = "What do links between neighbouring leaves save, and what do they take?";
    figures(
        "traversal",
        (title, caption),
        &run.scenes(),
        &panels,
        summary,
    )
}

/// Seconds over the stack's; none where nothing was timed.
pub fn seconds(run: &Traversal, summary: &Summary) -> Vec<(String, Figure)> {
    let panels = panels(run, "seconds, relative", Against::seconds);
    let caption = format!(
        "Seconds of a ray over those with a stack in the same tree and precision: left of 1 the stack loses. On one thread, all ways \
         interleaved, of each chunk of rays the least of all rounds.{}{} Bars, of three kinds of scenes or more: 99 % intervals of geometric means, cut at the edges.{} {}",
        sample(run),
        disturbed(run),
        left_out(run),
        provenance(run, summary)
    );
    let title = "When are links between neighbouring leaves faster than a stack?";
    figures(
        "times-traversal",
        (title, caption),
        &run.scenes(),
        &panels,
        summary,
    )
}

/// How far a ratio of seconds can be believed.
pub const BELIEF: &str = "half of its interval by the scatter of runs of 512 rays (Student's t, all ratios of the run together 99 %), and the ratios by even and by \
     odd rounds being apart, at least 1 %";

/// How many of the times of rays were disturbed.
pub fn disturbed(run: &Traversal) -> String {
    let times: Vec<_> = run
        .walks
        .iter()
        .filter_map(|row| run.time_of(row))
        .collect();
    shown::disturbed(&times, "time")
}

/// How many of the times of builds were.
pub fn disturbed_builds(run: &Traversal) -> String {
    let cells: Vec<&str> = distinct(run.links.iter().map(|row| row.cell.as_str()));
    let mut what = vec![BUILD.to_owned()];
    for precision in PRECISIONS {
        what.extend(["links", "face-trees"].map(|way| format!("{BUILD} {way} {precision}")));
    }
    let of_tree = |cell| what.iter().filter_map(move |what| run.timing(cell, what));
    let times: Vec<_> = cells.into_iter().flat_map(of_tree).collect();
    shown::disturbed(&times, "build")
}

/// How many rays of a set were timed, where not all were.
pub fn sample(run: &Traversal) -> String {
    let times = || run.walks.iter().filter_map(|row| run.time_of(row));
    let ends = extent(times().map(|time| time.timed_units as f64));
    match ends {
        Some((least, most)) if times().any(|time| time.timed_units < time.units) => {
            let most = grouped(most as u64);
            let range = match grouped(least as u64) {
                least if least == most => most,
                least => format!("{least} to {most}"),
            };
            format!(" Timed: {range} rays of each set, spread over it.")
        }
        _ => String::new(),
    }
}
