//! How far predicted times are from measured ones: by scene, by strategy, by set of rays.

use super::super::CostVsWork;
use super::super::spread::median;
use crate::report::series::distinct;
use crate::report::shown::{change, known, percent, text};
use crate::report::table::{Cell, Column, Table};
use crate::study::records::PredictionRecord;

/// By what times are put together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Key {
    /// By scene.
    Scene,
    /// By strategy, all stop rules together.
    Strategy,
    /// By set of rays.
    Rays,
}

impl Key {
    /// Every way.
    pub const ALL: [Self; 3] = [Self::Scene, Self::Strategy, Self::Rays];

    /// In words.
    pub fn name(self) -> &'static str {
        match self {
            Self::Scene => "scene",
            Self::Strategy => "strategy",
            Self::Rays => "rays",
        }
    }

    /// What a time belongs to.
    pub fn of(self, row: &PredictionRecord) -> &str {
        match self {
            Self::Scene => &row.scene,
            Self::Strategy => &row.strategy,
            Self::Rays => &row.rays,
        }
    }

    /// All that times belong to, in the order of first appearance.
    pub fn names(self, run: &CostVsWork) -> Vec<&str> {
        distinct(run.predictions.iter().map(|row| self.of(row)))
    }
}

/// predicted/measured - 1 of several times.
#[derive(Clone, Debug, PartialEq)]
pub struct Residuals<'r> {
    /// Median.
    pub middle: f64,
    /// Median of the absolute value.
    pub error: f64,
    /// The furthest from 0, and where.
    pub worst: (f64, &'r PredictionRecord),
}

impl<'r> Residuals<'r> {
    /// Of some times by one prediction; `None` without any.
    pub fn of(
        rows: impl IntoIterator<Item = &'r PredictionRecord>,
        predicted: fn(&PredictionRecord) -> f64,
    ) -> Option<Self> {
        let of = |row: &'r PredictionRecord| (predicted(row) / row.measured_ns - 1.0, row);
        let all: Vec<_> = rows.into_iter().map(of).collect();
        let furthest = |a: &&(f64, _), b: &&(f64, _)| a.0.abs().total_cmp(&b.0.abs());
        Some(Self {
            middle: median(all.iter().map(|(residual, _)| *residual))?,
            error: median(all.iter().map(|(residual, _)| residual.abs()))?,
            worst: *all.iter().max_by(furthest)?,
        })
    }
}

/// Every scene, strategy or set of rays: how far predicted times are from measured ones, for both models.
pub fn residuals(run: &CostVsWork, key: Key) -> Table {
    let row = |name: &str| {
        let own = || run.predictions.iter().filter(|row| key.of(row) == name);
        let mut cells = vec![text(name), Cell::Count(own().count() as u64)];
        let both = [
            Residuals::of(own(), |row| row.chosen_ns),
            Residuals::of(own(), |row| row.two_ns),
        ];
        for found in &both {
            cells.extend([
                known(found.as_ref().map(|r| r.middle), change),
                known(found.as_ref().map(|r| r.error), percent),
                known(found.as_ref().map(|r| r.worst.0), change),
            ]);
        }
        let worst = both[0].as_ref().map(|r| r.worst.1);
        let others = Key::ALL.into_iter().filter(|other| *other != key);
        cells.extend(others.map(|other| known(worst, |row| text(other.of(row)))));
        cells
    };
    let mut columns = vec![
        Column::left(key.name(), key.name()),
        Column::right("times", "times"),
    ];
    for (model, name) in [("chosen terms", "chosen"), ("n_K, n_t", "two")] {
        columns.extend([
            Column::right(&format!("{model}: median"), &format!("{name}_median_pct")),
            Column::right("error", &format!("{name}_error_pct")),
            Column::right("worst", &format!("{name}_worst_pct")),
        ]);
    }
    let others = Key::ALL.into_iter().filter(|other| *other != key);
    columns.extend(others.map(|other| {
        let name = other.name();
        Column::left(&format!("worst {name}"), &format!("worst_{name}"))
    }));
    Table {
        caption: format!(
            "Predicted over measured time of a ray, minus 1, in per cent, by {}: median, median of the absolute value (error), and \
             the value furthest from 0, for chosen terms and for n_K and n_t alone, both fitted without the scene at \
             hand. Last: where the chosen terms are worst.",
            match key {
                Key::Rays => "set of rays",
                other => other.name(),
            }
        ),
        columns,
        keys: 1,
        rows: key.names(run).into_iter().map(row).collect(),
    }
}
