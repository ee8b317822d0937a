//! The cells of a run as scenes and strategies, in the order of their first appearance.

use super::ReportError;
use super::number::{counted, grouped};
use super::palette::Look;
use crate::study::records::CellRecord;

/// Which scenes and strategies a run has. A strategy looks the same in every figure of the run.
pub struct Series<'r> {
    /// Scenes.
    pub scenes: Vec<&'r str>,
    /// Strategies.
    pub strategies: Vec<&'r str>,
}

impl<'r> Series<'r> {
    /// The scenes and strategies of these cells.
    pub fn of(cells: &'r [CellRecord]) -> Self {
        Series {
            scenes: distinct(cells.iter().map(|cell| cell.scene.as_str())),
            strategies: distinct(cells.iter().map(|cell| cell.strategy.as_str())),
        }
    }

    /// The same, where a figure needs at least one cell.
    pub fn to_draw(cells: &'r [CellRecord]) -> Result<Self, ReportError> {
        if cells.is_empty() {
            return Err(ReportError::Empty {
                what: "no cells to draw".to_owned(),
            });
        }
        Ok(Series::of(cells))
    }

    /// The look of a strategy.
    pub fn look(&self, strategy: &str) -> Look {
        Look::of(
            self.strategies
                .iter()
                .position(|&known| known == strategy)
                .unwrap_or_default(),
        )
    }
}

/// Each name once, in the order of first appearance.
pub fn distinct<'r>(names: impl Iterator<Item = &'r str>) -> Vec<&'r str> {
    let mut seen = Vec::new();
    for name in names {
        if !seen.contains(&name) {
            seen.push(name);
        }
    }
    seen
}

/// Costs c_K, c_B and c_t, where all cells share them.
pub fn constants(cells: &[CellRecord]) -> Option<[f64; 3]> {
    let of = |cell: &CellRecord| [cell.c_k, cell.c_b, cell.c_t];
    let first = of(cells.first()?);
    cells.iter().all(|cell| of(cell) == first).then_some(first)
}

/// What the cells share, for a caption: number of cells, lines and seeds.
pub fn provenance<'r>(cells: impl IntoIterator<Item = &'r CellRecord>) -> String {
    let cells: Vec<&CellRecord> = cells.into_iter().collect();
    let range = |values: Vec<u64>, show: fn(u64) -> String| match (
        values.iter().min(),
        values.iter().max(),
    ) {
        (Some(&low), Some(&high)) if low != high => format!("{} to {}", show(low), show(high)),
        (Some(&low), _) => show(low),
        _ => String::new(),
    };
    let lines = range(cells.iter().map(|cell| cell.lines).collect(), grouped);
    let mut seeds: Vec<_> = cells.iter().map(|cell| cell.seed).collect();
    seeds.sort_unstable();
    seeds.dedup();
    let seeds = match seeds[..] {
        [seed] => format!("seed {seed}"),
        _ => format!("{} seeds", seeds.len()),
    };
    let stops = distinct(cells.iter().map(|cell| cell.stop.as_str()));
    let stops = match stops[..] {
        [stop] => format!("stop {stop}"),
        _ => format!("{} stop rules", stops.len()),
    };
    let each = if cells.len() == 1 { "" } else { " each" };
    format!(
        "{}, {lines} lines{each}, {seeds}, {stops}.",
        counted(cells.len() as u64, "cell")
    )
}
