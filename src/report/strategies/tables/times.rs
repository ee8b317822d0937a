//! Seconds of trees, and how far they can be believed.

use super::{four_digits, text};
use crate::report::number::Z99;
use crate::report::strategies::part::{BUILD, KINDS, Measure, Part, Tree};
use crate::report::table::{Cell, Column, Table};
use crate::study::records::PassTiming;

/// Every tree: its seconds, and how far they can be believed.
pub fn times(part: &Part) -> Table {
    let columns = vec![
        Column::left("scene", "scene"),
        Column::left("strategy", "strategy"),
        Column::right("build, s", "build_s"),
        Column::right("primary, s", "primary_s"),
        Column::right("shadow, s", "shadow_s"),
        Column::right("secondary, s", "secondary_s"),
        Column::measured("total, s", "total_s"),
        Column::right("rays timed, %", "timed_pct"),
        Column::right("halves apart, %", "halves_apart_pct"),
        Column::left("disturbed", "disturbed"),
        Column::right("load average", "load_average"),
    ];
    let row = |tree: &Tree| {
        let spread = Spread::of(tree);
        let seconds = |what| {
            tree.time(what)
                .map_or(Cell::Missing, |time| four_digits(time.seconds))
        };
        let mut row = vec![text(&tree.cell.scene), text(&tree.cell.strategy)];
        row.extend([BUILD, KINDS[0], KINDS[1], KINDS[2]].map(seconds));
        row.push(tree.value(Measure::Total).map_or(Cell::Missing, |total| {
            Cell::Measured(
                total,
                Some(Z99 * spread.sampling_se_s).filter(|&half| half > 0.0),
            )
        }));
        row.push(
            spread
                .timed_share
                .map_or(Cell::Missing, |share| Cell::Value(100.0 * share, 1)),
        );
        row.push(
            spread
                .apart
                .map_or(Cell::Missing, |apart| Cell::Value(100.0 * apart, 2)),
        );
        row.push(Cell::Text(spread.disturbed.join(", ")));
        row.push(
            spread
                .load_average
                .map_or(Cell::Missing, |load| Cell::Value(load, 2)),
        );
        row
    };
    Table {
        caption: format!(
            "Seconds on one thread, stop {}: of each chunk of rays the least of all rounds. ± is half of the 99 % interval \
             for the choice of the rays that were timed, where not all were. Halves: how far the even and the odd rounds' \
             totals are apart; disturbed: what is more than 3 % apart by itself.",
            part.stop
        ),
        columns,
        keys: 2,
        rows: part.trees.iter().map(row).collect(),
    }
}

/// How far the total seconds of a tree can be believed.
pub struct Spread<'r> {
    /// Standard error of the total from the choice of the rays timed.
    pub sampling_se_s: f64,
    /// Rays timed over all rays.
    pub timed_share: Option<f64>,
    /// Difference of the totals of the two halves of rounds, over the smaller.
    pub apart: Option<f64>,
    /// What was disturbed.
    pub disturbed: Vec<&'r str>,
    /// Load average of the machine.
    pub load_average: Option<f64>,
}

impl<'r> Spread<'r> {
    /// From all rows of the tree.
    pub fn of(tree: &Tree<'r>) -> Self {
        let times = &tree.times;
        let sum = |part: fn(&PassTiming) -> f64| times.iter().map(|time| part(time)).sum::<f64>();
        let rays = || times.iter().filter(|time| time.what != BUILD);
        let all: u64 = rays().map(|time| time.units).sum();
        let timed: u64 = rays().map(|time| time.timed_units).sum();
        let (a, b) = (sum(|time| time.half_a_s), sum(|time| time.half_b_s));
        let disturbed = times.iter().filter(|time| time.disturbed);
        Spread {
            sampling_se_s: sum(|time| time.sampling_se_s * time.sampling_se_s).sqrt(),
            timed_share: (all > 0).then(|| timed as f64 / all as f64),
            apart: (a > 0.0 && b > 0.0).then(|| (a - b).abs() / a.min(b)),
            disturbed: disturbed.map(|time| time.what.as_str()).collect(),
            load_average: rays().find_map(|time| time.load_average),
        }
    }
}
