//! The tables of a run of kind `strategies`: averages over scenes, and scene by scene.

mod rays;
mod times;

use super::averages::Averages;
use super::havran;
use super::part::{Measure, Part, REFERENCE};
use crate::report::number::{counted, digits_for, percent_above};
use crate::report::table::{Cell, Column, Table};

pub use rays::{ray_counts, rays};
pub use times::{Spread, times};

/// A difference in per cent: one decimal of a small one, none of a large one.
pub fn change(percent: f64) -> Cell {
    Cell::Change(percent, usize::from(percent.abs() < 10.0))
}

/// A ratio as such a difference, where it is known.
fn change_of(ratio: Option<f64>) -> Cell {
    ratio.map_or(Cell::Missing, |ratio| change(percent_above(ratio)))
}

/// A number without a known error.
fn four_digits(value: f64) -> Cell {
    Cell::Value(value, digits_for(value, 4))
}

fn text(text: &str) -> Cell {
    Cell::Text(text.to_owned())
}

/// A strategy's name before its number in Havran's table, if it has one.
fn numbered(strategy: &str) -> String {
    match havran::number(strategy) {
        Some(number) => format!("{number} {strategy}"),
        None => strategy.to_owned(),
    }
}

/// Mean, best and worst of Havran's table.
fn havrans(strategy: &str) -> [Cell; 3] {
    havran::row(strategy).map_or([Cell::Missing, Cell::Missing, Cell::Missing], |row| {
        [row.avg_percent, row.best_percent, row.worst_percent]
            .map(|percent| Cell::Change(percent, 0))
    })
}

fn havran_columns() -> [Column; 3] {
    ["mean", "best", "worst"]
        .map(|what| Column::right(&format!("Havran: {what}"), &format!("havran_{what}_pct")))
}

/// What every caption says of the columns that average.
const RELATIVE: &str = "in per cent above (+) or below (−) sah's tree over the same scene";

/// Where Havran's numbers come from.
const SOURCE: &str = "Havran (2000): total run time with building over 30 scenes of the same databases; his mean is arithmetic";

/// Havran's table beside ours, one row a strategy.
pub fn havran(part: &Part) -> Table {
    let mut columns = vec![Column::left("strategy", "strategy")];
    columns.extend(havran_columns());
    let ours = [
        ("mean", "total_mean_pct"),
        ("geometric mean", "total_geometric_pct"),
        ("median", "total_median_pct"),
        ("best", "total_best_pct"),
        ("worst", "total_worst_pct"),
    ];
    columns.extend(ours.map(|(title, key)| Column::right(&format!("total time: {title}"), key)));
    let others = [Measure::Trace, Measure::Counted, Measure::Traced];
    columns.extend(others.map(|measure| {
        let key = format!("{}_geometric_pct", key(measure));
        Column::right(&format!("{}: geometric mean", measure.name()), &key)
    }));
    let row = |&strategy: &&str| {
        let of = |measure| Averages::of(&part.ratios(measure, strategy, REFERENCE));
        let total = of(Measure::Total);
        let total = total.as_ref();
        let mut row = vec![Cell::Text(numbered(strategy))];
        row.extend(havrans(strategy));
        row.extend([
            change_of(total.map(|a| a.mean)),
            change_of(total.map(|a| a.geometric)),
            change_of(total.map(|a| a.median)),
            change_of(total.map(|a| a.best.1)),
            change_of(total.map(|a| a.worst.1)),
        ]);
        row.extend(others.map(|measure| change_of(of(measure).map(|a| a.geometric))));
        row
    };
    Table {
        caption: format!(
            "Havran's table beside ours, {}, stop {}: {RELATIVE}. {SOURCE}. Ours: total time (building and tracing), trace \
             time, tree cost C counted on isotropic lines, and C of the traced rays.",
            scenes_of(part),
            part.stop
        ),
        columns,
        keys: 1,
        rows: part.strategies.iter().map(row).collect(),
    }
}

fn scenes_of(part: &Part) -> String {
    counted(part.scenes.len() as u64, "scene")
}

/// Name of a measure in CSV.
fn key(measure: Measure) -> &'static str {
    match measure {
        Measure::Predicted => "c_predicted",
        Measure::Counted => "c_counted",
        Measure::Traced => "c_traced",
        Measure::Total => "total",
        Measure::Trace => "trace",
        Measure::Build => "build",
    }
}

/// Every strategy by every one of these measures: all averages, with the scenes of the ends.
pub fn averages(part: &Part, measures: &[Measure]) -> Table {
    let mut columns = vec![
        Column::left("strategy", "strategy"),
        Column::left("by", "by"),
    ];
    columns.extend([
        Column::right("scenes", "scenes"),
        Column::right("mean", "mean_pct"),
        Column::right("geometric mean", "geometric_pct"),
        Column::right("from", "geometric_lo99_pct"),
        Column::right("to", "geometric_hi99_pct"),
        Column::right("median", "median_pct"),
        Column::right("best", "best_pct"),
        Column::left("best scene", "best_scene"),
        Column::right("worst", "worst_pct"),
        Column::left("worst scene", "worst_scene"),
    ]);
    // His averages are of the total time, so they are rows of their own.
    let havrans_row = |strategy: &str| {
        let [mean, best, worst] = havrans(strategy);
        let missing = || Cell::Missing;
        vec![
            Cell::Text(numbered(strategy)),
            text("Havran's total time"),
            Cell::Count(havran::SCENES),
            mean,
            missing(),
            missing(),
            missing(),
            missing(),
            best,
            missing(),
            worst,
            missing(),
        ]
    };
    let row = |strategy: &str, measure: Measure| {
        let mut row = vec![Cell::Text(numbered(strategy)), text(measure.name())];
        // Against itself the reference is nowhere better or worse.
        let scene = |name: &str| {
            if strategy == REFERENCE {
                Cell::Missing
            } else {
                text(name)
            }
        };
        match Averages::of(&part.ratios(measure, strategy, REFERENCE)) {
            None => row.extend((0..10).map(|_| Cell::Missing)),
            Some(a) => row.extend([
                Cell::Count(a.scenes as u64),
                change_of(Some(a.mean)),
                change_of(Some(a.geometric)),
                change_of(a.interval.map(|[lo, _]| lo)),
                change_of(a.interval.map(|[_, hi]| hi)),
                change_of(Some(a.median)),
                change_of(Some(a.best.1)),
                scene(a.best.0),
                change_of(Some(a.worst.1)),
                scene(a.worst.0),
            ]),
        }
        row
    };
    let mut rows = Vec::new();
    for strategy in &part.strategies {
        rows.extend(measures.iter().map(|&measure| row(strategy, measure)));
        if havran::row(strategy).is_some() {
            rows.push(havrans_row(strategy));
        }
    }
    Table {
        caption: format!(
            "Strategies over {}, stop {}: {RELATIVE}. {SOURCE}. Ours: {}. From, to: 99 % interval of the geometric mean \
             (Student's t of the logarithms, the sizes of one scene together being one observation).",
            scenes_of(part),
            part.stop,
            meanings(measures)
        ),
        columns,
        keys: 2,
        rows,
    }
}

fn meanings(measures: &[Measure]) -> String {
    let meanings: Vec<_> = measures.iter().map(|measure| measure.meaning()).collect();
    meanings.join("; ")
}

/// Every scene by every one of these measures: the reference, and every other strategy relative to it.
pub fn scenes(part: &Part, measures: &[Measure]) -> Table {
    let others = || {
        part.strategies
            .iter()
            .filter(|&&strategy| strategy != REFERENCE)
    };
    let mut columns = vec![
        Column::left("scene", "scene"),
        Column::left("by", "by"),
        Column::right(REFERENCE, "reference"),
    ];
    columns.extend(others().map(|strategy| Column::right(strategy, strategy)));
    let row = |scene: &str, measure: Measure| {
        let reference = part.value(measure, scene, REFERENCE);
        let mut row = vec![text(scene), text(measure.name())];
        row.push(reference.map_or(Cell::Missing, four_digits));
        row.extend(
            others().map(|strategy| change_of(part.ratio(measure, scene, strategy, REFERENCE))),
        );
        row
    };
    let rows = part
        .scenes
        .iter()
        .flat_map(|&scene| measures.iter().map(move |&m| (scene, m)));
    Table {
        caption: format!(
            "Every scene, stop {}: {REFERENCE}'s tree, and all others {RELATIVE}. {}.",
            part.stop,
            meanings(measures)
        ),
        columns,
        keys: 2,
        rows: rows.map(|(scene, measure)| row(scene, measure)).collect(),
    }
}
