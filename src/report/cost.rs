//! Predicted against counted cost: the heuristic's own claim, one mark for every scene and strategy.

use plotters::style::text_anchor::{HPos, VPos};

use super::ReportError;
use super::axis::{Axis, extent};
use super::figure::{Figure, LEFT, Pen, WIDTH};
use super::glyphs::SUB;
use super::legend::{Key, LEGEND_LEADING, legend, legend_rows};
use super::number::{Z99, decimals_for, digits_for, significant};
use super::palette::{INK, MUTED, faded};
use super::panel::{Frame, Panel};
use super::series::{Series, constants, provenance};
use super::text::{LEADING, MEDIUM, SMALL, caption_lines, text_width};
use crate::study::records::CellRecord;

const TITLE: &str = "Does the cost the heuristic predicts equal the cost counted?";
/// Left edge of the first panel of deviations.
const FIRST: f64 = 284.0;

/// Per cent by which rounding may set a count that theory fixes exactly apart from its prediction.
const ROUNDING: f64 = 1e-9;

/// The vertical axes reach at least so many per cent.
const LEAST_REACH: f64 = 0.01;

/// A predicted count or cost beside the counted one and its standard error.
#[derive(Clone, Copy)]
pub struct Pair {
    /// From areas.
    pub predicted: f64,
    /// From lines.
    pub counted: f64,
    /// Of `counted`, where the pilot can tell it.
    pub se: Option<f64>,
}

/// counted/predicted - 1 and half of its 99 % interval, in per cent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Deviation {
    /// counted/predicted - 1.
    pub percent: f64,
    /// Half of the interval, where there is one.
    pub half: Option<f64>,
}

impl Pair {
    /// The four pairs of a cell: n_K, n_B, n_t, C.
    pub fn all(cell: &CellRecord) -> [Pair; 4] {
        let pair = |predicted, counted, se| Pair {
            predicted,
            counted,
            se,
        };
        [
            pair(cell.n_k_predicted, cell.n_k_counted, cell.n_k_se),
            pair(cell.n_b_predicted, cell.n_b_counted, cell.n_b_se),
            pair(cell.n_t_predicted, cell.n_t_counted, cell.n_t_se),
            pair(cell.c_predicted, cell.c_counted, cell.c_se),
        ]
    }

    /// Two counts of the same lines together. Both grow with the same lines, so the errors may add up.
    pub fn plus(self, other: Pair) -> Pair {
        Pair {
            predicted: self.predicted + other.predicted,
            counted: self.counted + other.counted,
            se: self.se.zip(other.se).map(|(a, b)| a + b),
        }
    }

    /// The tree cost C of a cell.
    pub fn cost(cell: &CellRecord) -> Pair {
        let [.., cost] = Pair::all(cell);
        cost
    }

    /// Half of the 99 % interval of `counted`.
    pub fn half(&self) -> Option<f64> {
        self.se.map(|se| Z99 * se).filter(|half| half.is_finite())
    }

    /// Decimals both numbers are shown with: two digits of the error, or four of an unknown error's number.
    pub fn decimals(&self) -> usize {
        self.half()
            .map_or_else(|| digits_for(self.counted, 4), decimals_for)
    }

    /// How far counted is from predicted; None where nothing is predicted.
    pub fn deviation(&self) -> Option<Deviation> {
        let scale = 100.0 / self.predicted;
        let percent = scale * (self.counted - self.predicted);
        let half = self.half().map(|half| scale * half);
        (self.predicted > 0.0 && percent.is_finite()).then_some(Deviation { percent, half })
    }
}

impl Deviation {
    /// Whether the interval holds 0. Where theory fixes a count exactly there is no scatter, only rounding.
    fn holds_zero(&self) -> Option<bool> {
        self.half.map(|half| self.percent.abs() <= half + ROUNDING)
    }

    /// The furthest the bar, or else the mark, is from 0.
    fn reach(&self) -> f64 {
        self.percent.abs() + self.half.unwrap_or(0.0)
    }
}

/// Half of the vertical axis: every bar, and never so little that its ticks show rounding.
fn reach(cells: &[CellRecord]) -> f64 {
    let deviations = cells
        .iter()
        .flat_map(Pair::all)
        .filter_map(|p| p.deviation());
    let most = extent(deviations.map(|deviation| deviation.reach()));
    (1.08 * most.map_or(1.0, |(_, most)| most)).max(LEAST_REACH)
}

/// The figure of all cells.
pub fn figure(cells: &[CellRecord], quick: bool) -> Result<Figure, ReportError> {
    let series = Series::to_draw(cells)?;
    let caption = caption_lines(caption(cells), WIDTH - 2.0 * LEFT, quick);
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
    Ok(Figure::draw(
        TITLE,
        (&caption, bottom + 36.0),
        WIDTH,
        height,
        |pen| {
            legend(pen, (LEFT, WIDTH - LEFT), 31.0, &keys);
            costs(
                pen,
                cells,
                &series,
                Frame {
                    left: 44.0,
                    top,
                    right: 226.0,
                    bottom,
                },
            );
            let reach = reach(cells);
            let y = Axis::linear("", -reach, reach, 5);
            let labels = y.ticks.iter().map(|tick| text_width(&tick.label, SMALL));
            // Beside the widest tick label.
            let side = FIRST - 7.5 - labels.fold(0.0, f64::max);
            let middle = (side, (top + bottom) / 2.0);
            let label = "counted / predicted − 1, per cent";
            pen.upright(label, middle, MEDIUM, INK, (HPos::Center, VPos::Bottom));
            for quantity in 0..4 {
                let (column, row) = (f64::from(quantity % 2), f64::from(quantity / 2));
                let frame = Frame {
                    left: FIRST + 122.0 * column,
                    top: top + 106.0 * row,
                    right: FIRST + 106.0 + 122.0 * column,
                    bottom: top + 78.0 + 106.0 * row,
                };
                deviation(pen, cells, &series, quantity as usize, frame, y.clone());
            }
        },
    ))
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
    panel.heading("(a) C", frame.left, 4.0);
    panel.note("line: counted = predicted", true);
}

/// Relative deviation of one quantity against its prediction.
fn deviation(
    pen: &Pen,
    cells: &[CellRecord],
    series: &Series,
    quantity: usize,
    frame: Frame,
    mut y: Axis,
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
    let (mut judged, mut holding) = (0, 0);
    for (pair, look) in pairs {
        let Some(deviation) = pair.deviation() else {
            continue;
        };
        let (x, y) = (pair.predicted, deviation.percent);
        if let Some(half) = deviation.half {
            let bar = [(x, y - half), (x, y + half)];
            panel.line(&bar, faded(look.colour, 0.45), 0.7);
        }
        panel.mark((x, y), look.marker, 1.5, faded(look.colour, 0.85));
        if let Some(holds) = deviation.holds_zero() {
            judged += 1;
            holding += usize::from(holds);
        }
    }
    let name = [
        format!("(b) n{SUB}K"),
        format!("(c) n{SUB}B"),
        format!("(d) n{SUB}t"),
        "(e) C".to_owned(),
    ];
    panel.heading(&name[quantity], frame.left, 4.0);
    let tally = if judged == 0 {
        String::new()
    } else {
        format!("{holding} of {judged}")
    };
    pen.text(
        &tally,
        (frame.right, frame.top - 4.0),
        SMALL,
        MUTED,
        (HPos::Right, VPos::Bottom),
    );
}

fn caption(cells: &[CellRecord]) -> String {
    let costs = cells.iter().map(Pair::cost);
    let worst = costs.filter_map(|cost| Some(cost.deviation()?.percent.abs()));
    let worst = worst.fold(0.0, f64::max);
    let costs = constants(cells).map_or(String::new(), |[k, b, t]| {
        format!(", c{SUB}K = {k}, c{SUB}B = {b}, c{SUB}t = {t}")
    });
    let mut deviations = cells
        .iter()
        .flat_map(Pair::all)
        .filter_map(|p| p.deviation());
    let bare = if deviations.any(|deviation| deviation.half.is_none()) {
        " (none where the pilot cannot tell it)"
    } else {
        ""
    };
    format!(
        "C = c{SUB}K n{SUB}K + c{SUB}B n{SUB}B + c{SUB}t n{SUB}t{costs}. Theory: counted and predicted are equal in \
         expectation. (b) to (e): inner nodes n{SUB}K, leaves n{SUB}B, object tests n{SUB}t and C; bars are 99 % \
         intervals{bare}, and the numbers say how many of them hold 0. Largest deviation of C: {} %. {}",
        significant(worst, 2),
        provenance(cells),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::fixture;

    #[test]
    fn an_exact_count_holds_its_prediction() {
        let exact = |counted| Pair {
            predicted: 3.0,
            counted,
            se: Some(0.0),
        };
        let holds = |pair: Pair| pair.deviation().unwrap().holds_zero();
        assert_eq!(holds(exact(3.0 * (1.0 + 1e-15))), Some(true), "rounding");
        assert_eq!(holds(exact(3.0001)), Some(false));
        let unknown = Pair {
            se: None,
            ..exact(3.0001)
        };
        assert_eq!(holds(unknown), None);
        let nothing = Pair {
            predicted: 0.0,
            ..exact(0.0)
        };
        assert_eq!(nothing.deviation(), None);
    }

    #[test]
    fn the_axis_never_shows_rounding() {
        let mut cell = fixture::cell("a", "sah", 1);
        let one = |predicted: &mut f64, counted: &mut f64, se: &mut Option<f64>| {
            (*predicted, *counted, *se) = (1.0, 1.0 + 1e-15, Some(0.0));
        };
        one(
            &mut cell.n_k_predicted,
            &mut cell.n_k_counted,
            &mut cell.n_k_se,
        );
        one(
            &mut cell.n_b_predicted,
            &mut cell.n_b_counted,
            &mut cell.n_b_se,
        );
        one(
            &mut cell.n_t_predicted,
            &mut cell.n_t_counted,
            &mut cell.n_t_se,
        );
        one(&mut cell.c_predicted, &mut cell.c_counted, &mut cell.c_se);
        assert_eq!(reach(&[cell.clone()]), LEAST_REACH);
        cell.n_k_counted = 1.01;
        assert!(reach(&[cell]) > 1.0);
    }

    #[test]
    fn an_unknown_error_leaves_four_digits() {
        let pair = Pair {
            predicted: 41.9,
            counted: 41.987_65,
            se: None,
        };
        assert_eq!(pair.decimals(), 2);
    }

    #[test]
    fn the_caption_ends_with_what_was_counted() {
        let mut cells = fixture::cells(2, 2);
        assert!(!caption(&cells).contains("none where"));
        cells[1].n_t_se = None;
        let caption = caption(&cells);
        assert!(
            caption.contains("intervals (none where the pilot"),
            "{caption}"
        );
        assert!(
            caption.contains("4 cells, 1,048,576 lines each"),
            "{caption}"
        );
    }
}
