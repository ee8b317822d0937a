//! A run on one screen.

use std::fmt::Write;

use super::number::{counted, grouped, significant};
use super::table::fold;
use super::{Run, tables};
use crate::study::records::CellRecord;

/// Columns of the screen.
const WIDTH: usize = 100;

/// The summary of a study: its question, the cost of every strategy, the verdicts.
pub fn study(run: &Run) -> String {
    let lines: u64 = run.cells.iter().map(|c| c.lines).sum();
    let mut text = format!("\n{}\n", run.summary.question);
    let first = &run.cells[0];
    let _ = writeln!(
        text,
        "{} cells, stop {}, costs {}:{}:{}, seed {}, {} lines in all\n",
        run.cells.len(),
        first.stop,
        first.c_k,
        first.c_b,
        first.c_t,
        run.summary.seed,
        grouped(lines)
    );
    let costs = tables::costs(&run.cells);
    let table = if costs.fits(WIDTH) {
        costs
    } else {
        tables::extremes(&run.cells)
    };
    text + &table.to_text(WIDTH) + &verdicts(run)
}

/// The summary of one scene: its trees, their costs, and which to take.
pub fn scene(run: &Run) -> String {
    let first = &run.cells[0];
    let mut text = format!(
        "\n{}: {}, stop {}\n\n",
        first.scene,
        counted(first.objects, "object"),
        first.stop
    );
    text += &tables::of_scene(&run.cells).to_text(WIDTH);
    text += &advice(&run.cells);
    text + &verdicts(run)
}

/// The strategy to take: the least cost counted, and how far the others are.
fn advice(cells: &[CellRecord]) -> String {
    let mut by_cost: Vec<&CellRecord> = cells.iter().collect();
    by_cost.sort_by(|a, b| a.c_counted.total_cmp(&b.c_counted));
    let (best, last) = (by_cost[0], by_cost[by_cost.len() - 1]);
    let more = |cell: &CellRecord| 100.0 * (cell.c_counted / best.c_counted - 1.0);
    if more(last) < LEAST_GAIN {
        return "\nEvery strategy gives a tree of the same cost.\n".to_owned();
    }
    let mut text = format!(
        "\nTake {}: its lines cost {} each, counted.",
        best.strategy,
        significant(best.c_counted, 4)
    );
    if let Some(next) = by_cost.get(1) {
        let _ = write!(
            text,
            " {} costs {} % more, the worst, {}, {} % more.",
            next.strategy,
            significant(more(next), 2),
            last.strategy,
            significant(more(last), 2)
        );
    }
    let predicted = cells
        .iter()
        .min_by(|a, b| a.c_predicted.total_cmp(&b.c_predicted))
        .map_or("", |cell| &cell.strategy);
    let _ = writeln!(
        text,
        "\nSurface areas alone would have picked {predicted}. All this is for lines that never stop."
    );
    text
}

/// Per cent of cost below which trees count as equal.
const LEAST_GAIN: f64 = 0.005;

/// A verdict and its figures each, folded beside their name.
fn verdicts(run: &Run) -> String {
    const MARGIN: usize = 22;
    let mut text = String::from("\n");
    for v in &run.summary.verdicts {
        let mark = if v.held { "held" } else { "MISSED" };
        let message = fold(&v.message, WIDTH - MARGIN).replace('\n', &format!("\n{:MARGIN$}", ""));
        let _ = writeln!(text, "{mark:6}  {:14}{message}", v.name);
    }
    if run.summary.quick {
        text += "quick form: fewer lines, smaller scenes; no figure of it is to be published\n";
    }
    text
}

/// How fast it went, from `timings.csv`.
pub fn speed(run: &Run) -> String {
    let Some(timings) = run.timings.as_ref().filter(|t| !t.is_empty()) else {
        return String::new();
    };
    let sum = |part: fn(&crate::study::records::TimingRecord) -> f64| {
        timings.iter().map(part).sum::<f64>()
    };
    let (build, count) = (sum(|t| t.build_s), sum(|t| t.count_s));
    let visits: u64 = timings.iter().map(|t| t.visits).sum();
    format!(
        "speed  {} visits in {} s of counting ({} a second, {} threads), trees built in {} s\n",
        significant(visits as f64, 3),
        significant(count, 3),
        significant(visits as f64 / count, 3),
        timings[0].threads,
        significant(build, 3)
    )
}
