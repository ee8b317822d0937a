//! The surface area metric beside those that give up an assumption: cost counted over expected, before and after.

mod fit;

use plotters::style::text_anchor::{HPos, VPos};

use super::Assumptions;
use super::rows::{HEADINGS, Rows};
use super::tables::value;
use crate::report::axis::{Axis, extent};
use crate::report::figure::{Figure, LEFT, WIDTH};
use crate::report::legend::{Key, legend};
use crate::report::means::arithmetic;
use crate::report::number::fixed;
use crate::report::palette::{AXIS, INK, Look, MUTED, Marker, VERMILLION, faded};
use crate::report::panel::{Frame, Panel};
use crate::report::series::distinct;
use crate::report::table::{Cell, Column, Table};
use crate::report::text::{LEADING, SMALL, caption_lines};
use crate::study::records::Summary;
pub use fit::AREA;
use fit::{Fit, suited};

const TITLE: &str = "Do metrics that give up an assumption predict such rays better?";
/// What the names of metrics mean, for captions.
const METRICS: &str = "Metrics expect the counts of: interior, rays from anywhere inside the root's box; occlusion, isotropic lines, \
                       stopped at their first hit; interior-occlusion, rays from inside, stopped; surface, rays from the objects' \
                       surfaces, stopped.";

const BEFORE: Look = Look {
    colour: AXIS,
    marker: Marker::Disc,
};
const AFTER: Look = Look {
    colour: VERMILLION,
    marker: Marker::Diamond,
};
/// Room for what stands at the right, and where its columns end.
const NOTES: f64 = 186.0;
const COLUMNS: [f64; 3] = [118.0, 59.0, 2.0];

/// The figure of all sets.
pub fn figure(run: &Assumptions, summary: &Summary) -> Figure {
    let caption = format!(
        "Tree cost C, counted over expected, per ray that hits the root's box: range over all trees (scenes by strategies, stop \
         {}), mark at the geometric mean. Grey: the surface area metric. Red: the metric whose rays begin and end most like these, \
         named at the right; no other is offered where nothing is stopped or begins inside. {} Error: the factor by which it errs \
         in the mean (exp of the mean of |ln ratio|), before → after; ↑: it errs more than the surface area metric. τ: Kendall's rank correlation of the strategies' costs, mean over \
         the scenes. Blue dots: assumptions that the rays break. Seed {}.",
        summary.stop.as_deref().unwrap_or("unknown"),
        METRICS,
        summary.seed
    );
    let caption = caption_lines(caption, WIDTH - 2.0 * LEFT, summary.quick);
    let keys = [
        (Key::Mark(BEFORE), "surface area metric".to_owned()),
        (
            Key::Mark(AFTER),
            "metric of the same beginning and end".to_owned(),
        ),
    ];
    let top = 38.0 + HEADINGS;
    let rows = Rows::of(run, top);
    let bottom = rows.bottom();
    let height = bottom + 36.0 + LEADING * (caption.len() - 1) as f64 + 6.0;
    Figure::draw(TITLE, (&caption, bottom + 36.0), WIDTH, height, |pen| {
        legend(pen, (LEFT, WIDTH - LEFT), 31.0, &keys);
        let edge = WIDTH - LEFT;
        rows.draw(pen, edge);
        let frame = Frame {
            left: rows.right,
            top,
            right: edge - NOTES,
            bottom,
        };
        let ratios = run
            .metrics
            .iter()
            .filter(|row| row.suited || row.metric == AREA);
        let ratios = ratios.filter_map(|row| row.ratio).filter(|r| *r > 0.0);
        let (low, high) = extent(ratios.chain([1.0])).unwrap_or((0.5, 2.0));
        let room = (high / low).powf(0.04).max(1.02);
        let x = Axis::log("C counted / expected", low / room, high * room, 6);
        // Downwards, in points.
        let y = Axis {
            ticks: Vec::new(),
            ..Axis::linear("", -frame.bottom, -frame.top, 1)
        };
        let mut panel = Panel::new(pen, frame, x, y);
        panel.line(&[(1.0, -frame.top), (1.0, -frame.bottom)], INK, 0.7);
        let note = |text: &str, column: usize, y: f64, lift: VPos| {
            let at = (edge - COLUMNS[column], y);
            pen.text(text, at, SMALL, MUTED, (HPos::Right, lift));
        };
        for (column, text) in ["metric", "error ×/÷", "τ"].iter().enumerate() {
            note(text, column, top - 4.0, VPos::Bottom);
        }
        for (i, set) in rows.sets.iter().enumerate() {
            let before = Fit::of(run, set, AREA);
            let other = Some(suited(run, set)).filter(|metric| *metric != AREA);
            let after = other.map(|metric| Fit::of(run, set, metric));
            let mut draw = |fit: &Fit, look: Look, lift: f64| {
                let y = -rows.middle(i) + lift;
                if let Some([least, mean, largest]) = fit.range() {
                    panel.line(&[(least, y), (largest, y)], faded(look.colour, 0.75), 0.9);
                    panel.mark((mean, y), look.marker, 1.9, look.colour);
                }
            };
            let apart = if after.is_some() { 2.5 } else { 0.0 };
            draw(&before, BEFORE, apart);
            let both = |of: fn(&Fit) -> Option<f64>, decimals: usize| {
                let show = |fit: &Fit| of(fit).map(|value| fixed(value, decimals));
                let all = [show(&before), after.as_ref().and_then(show)];
                all.into_iter().flatten().collect::<Vec<_>>().join(" → ")
            };
            let y = rows.middle(i);
            let errs_more = after
                .as_ref()
                .is_some_and(|after| after.error() > before.error());
            let mark = if errs_more { "↑ " } else { "" };
            let errors = both(|fit| fit.error(), 2);
            note(&format!("{mark}{errors}"), 1, y, VPos::Center);
            note(&both(|fit| arithmetic(&fit.taus), 2), 2, y, VPos::Center);
            if let Some(after) = &after {
                draw(after, AFTER, -apart);
                note(after.metric, 0, y, VPos::Center);
            }
        }
    })
}

/// The surface area metric and the one that suits, where that is another.
pub fn summary(run: &Assumptions) -> Table {
    let columns = vec![
        Column::left("rays", "rays"),
        Column::left("metric that suits", "metric"),
        Column::right("error of areas, ×/÷", "error_area"),
        Column::right("its error, ×/÷", "error"),
        Column::right("τ of areas", "tau_area"),
        Column::right("its τ", "tau"),
        Column::right("regret of areas, %", "regret_area_pct"),
        Column::right("its regret, %", "regret_pct"),
    ];
    let row = |set: &str| {
        let metric = suited(run, set);
        let (before, after) = (Fit::of(run, set, AREA), Fit::of(run, set, metric));
        let regret = |fit: &Fit| value(arithmetic(&fit.regrets).map(|regret| 100.0 * regret), 1);
        (metric != AREA).then(|| {
            vec![
                Cell::Text(set.to_owned()),
                Cell::Text(metric.to_owned()),
                value(before.error(), 2),
                value(after.error(), 2),
                value(arithmetic(&before.taus), 2),
                value(arithmetic(&after.taus), 2),
                regret(&before),
                regret(&after),
            ]
        })
    };
    let sets = distinct(run.metrics.iter().map(|row| row.rays.as_str()));
    Table {
        caption: format!(
            "Tree cost C of rays that break an assumption: the factor by which the surface area metric errs in the mean (exp \
                  of the mean of |ln(counted/expected)| over all trees), and the metric whose rays begin and end most like these; \
                  τ: Kendall's rank correlation of the strategies' costs expected and counted, mean over the scenes; regret: what \
                  the tree expected to be cheapest costs above the cheapest, likewise. {METRICS} Mailbox: lines that test no object twice."
        ),
        columns,
        keys: 2,
        rows: sets.into_iter().filter_map(row).collect(),
    }
}

/// Every metric and every set of rays.
pub fn table(run: &Assumptions) -> Table {
    let columns = vec![
        Column::left("rays", "rays"),
        Column::left("metric", "metric"),
        Column::left("suits", "suited"),
        Column::right("C", "ratio"),
        Column::right("least", "ratio_least"),
        Column::right("largest", "ratio_largest"),
        Column::right("scatter ×/÷", "scatter"),
        Column::right("error ×/÷", "error"),
        Column::right("τ", "tau"),
        Column::right("regret, %", "regret_pct"),
    ];
    let row = |set: &str, metric: &str| {
        let fit = Fit::of(run, set, metric);
        let [least, mean, largest] = match fit.range() {
            Some(range) => range.map(Some),
            None => [None; 3],
        };
        let suits = if suited(run, set) == metric {
            "yes"
        } else {
            ""
        };
        vec![
            Cell::Text(set.to_owned()),
            Cell::Text(metric.to_owned()),
            Cell::Text(suits.to_owned()),
            value(mean, 3),
            value(least, 3),
            value(largest, 3),
            value(fit.scatter(), 2),
            value(fit.error(), 2),
            value(arithmetic(&fit.taus), 2),
            value(arithmetic(&fit.regrets).map(|regret| 100.0 * regret), 2),
        ]
    };
    let sets = distinct(run.metrics.iter().map(|row| row.rays.as_str()));
    let rows = sets.into_iter().flat_map(|set| {
        let own = run.metrics.iter().filter(move |row| row.rays == set);
        let metrics = distinct(own.map(|row| row.metric.as_str()));
        metrics.into_iter().map(move |metric| row(set, metric))
    });
    Table {
        caption: format!(
            "Metrics before and after giving up an assumption: tree cost C counted over expected, per ray that hits the root's box; \
                  geometric mean over all trees, least, largest, and the scatter of the trees about the mean (exp of the standard \
                  deviation of the logarithm); error: the factor by which the metric errs in the mean (exp of the mean of |ln ratio|). \
                  τ: Kendall's rank correlation of the strategies' costs expected and counted, mean over the scenes; regret: what the \
                  tree that the metric expects to be cheapest costs above the cheapest, likewise. Suits: its rays begin and end most \
                  like these. Area: the surface area metric, isotropic lines that never stop. {METRICS} Lines with a mailbox: \
                  the same lines, but objects already tested are not tested again; mailbox: the metric that expects so."
        ),
        columns,
        keys: 2,
        rows: rows.collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::records::MetricRecord;

    #[test]
    fn only_pairs_that_were_compared_are_told() {
        let pair = |rays: &str, metric: &str| MetricRecord {
            scene: "a".into(),
            strategy: "sah".into(),
            rays: rays.into(),
            metric: metric.into(),
            suited: metric == "mailbox",
            n_k: 1.0,
            n_b: 1.0,
            n_t: 1.0,
            c: 2.0,
            c_counted: 4.0,
            ratio: Some(2.0),
        };
        let run = Assumptions {
            bias: Vec::new(),
            groups: Vec::new(),
            visits: Vec::new(),
            orders: Vec::new(),
            others: Vec::new(),
            metrics: vec![
                pair("lines", AREA),
                pair("lines with a mailbox", AREA),
                pair("lines with a mailbox", "mailbox"),
            ],
            exact: Vec::new(),
        };
        let table = table(&run);
        assert_eq!(table.rows.len(), 3);
        assert_eq!(table.rows[2][2], Cell::Text("yes".into()));
        assert_eq!(table.rows[2][3], Cell::Value(2.0, 3));
    }
}
