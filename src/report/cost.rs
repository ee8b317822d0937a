//! Predicted against counted cost: the heuristic's own claim, one mark for every scene and strategy.

use plotters::style::text_anchor::{HPos, VPos};

use super::ReportError;
use super::axis::{Axis, extent};
use super::figure::{Figure, Pen};
use super::glyphs::SUB;
use super::legend::{Key, LEGEND_LEADING, legend, legend_rows};
use super::number::{Z99, significant};
use super::palette::{INK, MUTED, faded};
use super::panel::{Frame, Panel};
use super::series::{Series, provenance};
use super::text::{LEADING, MEDIUM, SMALL, title_and_caption, wrap};
use crate::study::records::CellRecord;

const TITLE: &str = "Does the cost the heuristic predicts equal the cost counted?";
const WIDTH: f64 = 518.4;
const LEFT: f64 = 8.0;

/// A predicted count or cost beside the counted one and its standard error.
#[derive(Clone, Copy)]
pub struct Pair {
    /// From areas.
    pub predicted: f64,
    /// From lines.
    pub counted: f64,
    /// Of `counted`.
    pub se: f64,
}

impl Pair {
    /// The four pairs of a cell: n_K, n_B, n_t, C.
    pub fn all(cell: &CellRecord) -> [Pair; 4] {
        [
            Pair {
                predicted: cell.n_k_predicted,
                counted: cell.n_k_counted,
                se: cell.n_k_se,
            },
            Pair {
                predicted: cell.n_b_predicted,
                counted: cell.n_b_counted,
                se: cell.n_b_se,
            },
            Pair {
                predicted: cell.n_t_predicted,
                counted: cell.n_t_counted,
                se: cell.n_t_se,
            },
            Pair {
                predicted: cell.c_predicted,
                counted: cell.c_counted,
                se: cell.c_se,
            },
        ]
    }

    /// counted/predicted - 1 and half its 99 % interval, in per cent; None where nothing is predicted.
    pub fn deviation(&self) -> Option<(f64, f64)> {
        let percent = 100.0 / self.predicted;
        let deviation = (
            percent * (self.counted - self.predicted),
            percent * Z99 * self.se,
        );
        (self.predicted > 0.0 && deviation.0.is_finite() && deviation.1.is_finite())
            .then_some(deviation)
    }
}

/// The figure of all cells.
pub fn figure(cells: &[CellRecord]) -> Result<Figure, ReportError> {
    let series = Series::to_draw(cells)?;
    let caption = wrap(&caption(cells), WIDTH - 2.0 * LEFT);
    let keys: Vec<_> = series
        .strategies
        .iter()
        .map(|&name| (Key::Mark(series.look(name)), name.to_owned()))
        .collect();
    let rows = legend_rows(
        WIDTH - 2.0 * LEFT,
        keys.iter().map(|(_, text)| text.as_str()),
    );
    let top = 54.0 + LEGEND_LEADING * (rows - 1) as f64;
    let bottom = top + 184.0;
    let height = bottom + 36.0 + LEADING * (caption.len() - 1) as f64 + 6.0;
    Ok(Figure::draw(TITLE, WIDTH, height, |pen| {
        title_and_caption(pen, TITLE, LEFT, &caption, bottom + 36.0);
        legend(pen, (LEFT, WIDTH - LEFT), 31.0, &keys);
        costs(
            pen,
            cells,
            &series,
            Frame {
                left: 44.0,
                top,
                right: 228.0,
                bottom,
            },
        );
        let deviations: Vec<_> = cells
            .iter()
            .flat_map(Pair::all)
            .filter_map(|pair| pair.deviation())
            .collect();
        let reach = extent(
            deviations
                .iter()
                .map(|(percent, half)| percent.abs() + half),
        );
        let reach = 1.08 * reach.map_or(1.0, |(_, most)| most).max(1e-9);
        let middle = (255.0, (top + bottom) / 2.0);
        let label = "counted / predicted − 1, per cent";
        pen.upright(label, middle, MEDIUM, INK, (HPos::Center, VPos::Bottom));
        for quantity in 0..4 {
            let (column, row) = (f64::from(quantity % 2), f64::from(quantity / 2));
            let frame = Frame {
                left: 282.0 + 122.0 * column,
                top: top + 106.0 * row,
                right: 388.0 + 122.0 * column,
                bottom: top + 78.0 + 106.0 * row,
            };
            deviation(pen, cells, &series, quantity as usize, frame, reach);
        }
    }))
}

/// C counted against C predicted, with y = x.
fn costs(pen: &Pen, cells: &[CellRecord], series: &Series, frame: Frame) {
    let positive = cells
        .iter()
        .flat_map(|cell| [cell.c_predicted, cell.c_counted])
        .filter(|&c| c > 0.0);
    let (low, high) = extent(positive).unwrap_or((1.0, 10.0));
    // A tenth of the range more at either end.
    let room = (high / low).powf(0.1).max(1.15);
    let (low, high) = (low / room, high * room);
    let x = Axis::log("tree cost C predicted from areas, per line", low, high, 6);
    let y = Axis::log("tree cost C counted, per line", low, high, 6);
    let mut panel = Panel::new(pen, frame, x, y);
    panel.line(&[(low, low), (high, high)], INK, 0.7);
    for cell in cells {
        let look = series.look(&cell.strategy);
        panel.mark(
            (cell.c_predicted, cell.c_counted),
            look.marker,
            2.3,
            faded(look.colour, 0.8),
        );
    }
    panel.note("line: counted = predicted", true);
}

/// Relative deviation of one quantity against its prediction.
fn deviation(
    pen: &Pen,
    cells: &[CellRecord],
    series: &Series,
    quantity: usize,
    frame: Frame,
    reach: f64,
) {
    let pairs: Vec<_> = cells
        .iter()
        .map(|cell| (Pair::all(cell)[quantity], series.look(&cell.strategy)))
        .collect();
    let predicted = pairs
        .iter()
        .filter(|(pair, _)| pair.deviation().is_some())
        .map(|(pair, _)| pair.predicted);
    let (low, high) = extent(predicted).unwrap_or((1.0, 10.0));
    let first_column = quantity.is_multiple_of(2);
    let x_label = if quantity < 2 {
        ""
    } else {
        "predicted, per line"
    };
    let mut y = Axis::linear("", -reach, reach, 4);
    if !first_column {
        y.ticks.iter_mut().for_each(|tick| tick.label.clear());
    }
    let room = (high / low).powf(0.08).max(1.15);
    let mut panel = Panel::new(
        pen,
        frame,
        Axis::log(x_label, low / room, high * room, 4),
        y,
    );
    panel.line(
        &[(panel.x.value(0.0), 0.0), (panel.x.value(1.0), 0.0)],
        INK,
        0.7,
    );
    let (mut shown, mut holding) = (0, 0);
    for (pair, look) in pairs {
        let Some((percent, half)) = pair.deviation() else {
            continue;
        };
        let (x, y) = (pair.predicted, percent);
        panel.line(
            &[(x, y - half), (x, y + half)],
            faded(look.colour, 0.45),
            0.7,
        );
        panel.mark((x, y), look.marker, 1.5, faded(look.colour, 0.85));
        shown += 1;
        holding += usize::from(percent.abs() <= half);
    }
    let name = [
        format!("n{SUB}K  inner nodes"),
        format!("n{SUB}B  leaves"),
        format!("n{SUB}t  tests"),
        "C".to_owned(),
    ];
    panel.heading(&name[quantity], frame.left, 4.0);
    let tally = format!("{holding} of {shown}");
    pen.text(
        &tally,
        (frame.right, frame.top - 4.0),
        SMALL,
        MUTED,
        (HPos::Right, VPos::Bottom),
    );
}

fn caption(cells: &[CellRecord]) -> String {
    let worst = cells
        .iter()
        .filter_map(|cell| Pair::all(cell)[3].deviation());
    let worst = worst.map(|(percent, _)| percent.abs()).fold(0.0, f64::max);
    let constants = |cell: &CellRecord| (cell.c_k, cell.c_b, cell.c_t);
    let costs = match cells {
        [first, rest @ ..] if rest.iter().all(|cell| constants(cell) == constants(first)) => {
            format!(
                ", c{SUB}K = {}, c{SUB}B = {}, c{SUB}t = {}",
                first.c_k, first.c_b, first.c_t
            )
        }
        _ => String::new(),
    };
    format!(
        "C = c{SUB}K n{SUB}K + c{SUB}B n{SUB}B + c{SUB}t n{SUB}t{costs}. Theory: counted and predicted are equal in \
         expectation. Right: bars are 99 % intervals, and the numbers say how many of them hold 0. Largest deviation of \
         C: {} %. {}",
        significant(worst, 2),
        provenance(cells),
    )
}
