//! A run of kind `strategies` on one screen.

use std::fmt::Write;

use super::Strategies;
use super::averages::Averages;
use super::findings::{Judgement, judged};
use super::havran;
use super::part::{Measure, Part, REFERENCE};
use super::tables::change;
use crate::report::Run;
use crate::report::number::{counted, percent_above};
use crate::report::screen::{WIDTH, verdicts};
use crate::report::table::{Cell, Column, Table, fold};
use crate::study::records::file_stem;

/// The question, Havran's table beside ours for the first stop rule, his findings, the verdicts.
pub fn study(run: &Run, strategies: &Strategies) -> String {
    let parts = strategies.parts();
    let mut text = format!("\n{}\n", fold(&run.summary.question, WIDTH));
    let stops: Vec<&str> = parts.iter().map(|part| part.stop).collect();
    let _ = writeln!(
        text,
        "{} over {}, stop {}, seed {}\n",
        counted(strategies.cells.len() as u64, "tree"),
        counted(
            parts.first().map_or(0, |part| part.scenes.len()) as u64,
            "scene"
        ),
        stops.join(" and "),
        run.summary.seed
    );
    if let Some(part) = parts.first() {
        text += &table(part).to_text(WIDTH);
        text += "\n";
        text += &findings(part);
        let stem = file_stem(part.stop);
        let others = if parts.len() > 1 {
            ", likewise for every stop rule"
        } else {
            ""
        };
        let paths = format!(
            "In the data folder: all averages in tables/times-havran-{stem}.md, all findings with their numbers in \
             tables/times-findings-{stem}.md and tables/findings-cost-{stem}.md{others}."
        );
        text += &(fold(&paths, WIDTH) + "\n");
    }
    text + &verdicts(run)
}

/// Havran's mean, ours by time and by cost.
fn table(part: &Part) -> Table {
    let columns = vec![
        Column::left("strategy", "strategy"),
        Column::right("Havran", "havran_mean_pct"),
        Column::right("mean", "total_mean_pct"),
        Column::right("geometric", "total_geometric_pct"),
        Column::right("worst", "total_worst_pct"),
        Column::right("trace", "trace_geometric_pct"),
        Column::right("C", "c_counted_geometric_pct"),
        Column::right("C of rays", "c_traced_geometric_pct"),
    ];
    let row = |&strategy: &&str| {
        let of = |measure| Averages::of(&part.ratios(measure, strategy, REFERENCE));
        let show =
            |ratio: Option<f64>| ratio.map_or(Cell::Missing, |ratio| change(percent_above(ratio)));
        let total = of(Measure::Total);
        let havran = havran::row(strategy);
        let mut row = vec![
            Cell::Text(strategy.to_owned()),
            havran.map_or(Cell::Missing, |row| Cell::Change(row.avg_percent, 0)),
            show(total.as_ref().map(|a| a.mean)),
            show(total.as_ref().map(|a| a.geometric)),
            show(total.as_ref().map(|a| a.worst.1)),
        ];
        let others = [Measure::Trace, Measure::Counted, Measure::Traced];
        row.extend(others.map(|measure| show(of(measure).map(|a| a.geometric))));
        row
    };
    Table {
        caption: format!(
            "Per cent above (+) or below (−) {REFERENCE}, stop {}: Havran's mean and ours of total time, its geometric mean and \
             worst scene; geometric means of trace time, of C counted on lines, of C of the traced rays.",
            part.stop
        ),
        columns,
        keys: 1,
        rows: part.strategies.iter().map(row).collect(),
    }
}

/// His findings by total time and by cost, a line each.
fn findings(part: &Part) -> String {
    let by = |measure| judged(part, measure);
    let (times, costs) = (by(Measure::Total), by(Measure::Counted));
    let mut text = String::new();
    for cost in costs {
        let time = times.iter().find(|time| time.claim == cost.claim);
        let word = |judgement: Judgement| judgement.name();
        let time = time.map_or(String::new(), |time| {
            format!("by total time {}, ", word(time.judgement))
        });
        let line = format!("{}: {time}by C {}", cost.claim, word(cost.judgement));
        text += &fold(&line, WIDTH);
        text += "\n";
    }
    text
}
