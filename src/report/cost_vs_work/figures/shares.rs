//! Where the time of a ray goes by the chosen terms: a bar for each set of rays.

use plotters::style::RGBAColor;
use plotters::style::text_anchor::{HPos, VPos};

use super::super::CostVsWork;
use super::super::spread::median;
use super::super::times::TERMS;
use super::provenance;
use crate::report::axis::Axis;
use crate::report::figure::{Figure, LEFT, WIDTH};
use crate::report::glyphs::SUB;
use crate::report::legend::{Key, LEGEND_LEADING, legend, rows_of};
use crate::report::number::{fixed, significant};
use crate::report::palette::{GRID, INK, Look, faded};
use crate::report::panel::{Frame, Panel};
use crate::report::series::distinct;
use crate::report::text::{LEADING, MEDIUM, SMALL, caption_lines, fit, text_width};
use crate::study::records::Summary;

const TITLE: &str = "Where does the time of a ray go?";
/// Height of a bar and of its row.
const BAR: f64 = 12.0;
const ROW: f64 = 18.0;
/// Terms whose share is below this in every set go together.
const SMALLEST: f64 = 0.02;
/// A smaller part of a bar is not drawn.
const SEEN: f64 = 0.005;
/// Colours that the palette tells apart: later ones are fainter.
const COLOURS: usize = 7;
/// Room for the times right of the bars.
const TIMES: f64 = 62.0;

/// The figure; `None` where nothing was fitted.
pub fn shares(run: &CostVsWork, summary: &Summary) -> Option<Figure> {
    let parts = Parts::of(run)?;
    let caption = format!(
        "Share of each chosen term in the predicted time of a ray, mean over scenes and trees, with constants fitted to all scenes; \
         right: median of the measured times. {TERMS}{} {}",
        parts.remark(),
        provenance(run, summary.seed)
    );
    let caption = caption_lines(caption, WIDTH - 2.0 * LEFT, summary.quick);
    let keys = parts.keys();
    let lines = rows_of(WIDTH - 2.0 * LEFT, &keys);
    let names: Vec<String> = parts
        .sets
        .iter()
        .map(|set| fit(set, MEDIUM, 110.0))
        .collect();
    let widest = names.iter().map(|name| text_width(name, MEDIUM));
    let left = LEFT + widest.fold(0.0, f64::max) + 7.0;
    let top = 44.0 + LEGEND_LEADING * (lines - 1) as f64;
    let bottom = top + ROW * parts.sets.len() as f64;
    let baseline = bottom + 36.0;
    let height = baseline + LEADING * (caption.len() - 1) as f64 + 6.0;
    let right = WIDTH - LEFT - TIMES;
    Some(Figure::draw(
        TITLE,
        (&caption, baseline),
        WIDTH,
        height,
        |pen| {
            legend(pen, (LEFT, WIDTH - LEFT), 31.0, &keys);
            let frame = Frame {
                left,
                top,
                right,
                bottom,
            };
            let y = Axis {
                ticks: Vec::new(),
                ..Axis::linear("", -(parts.sets.len() as f64), 0.0, 1)
            };
            let x = Axis::linear("share of the predicted time, per cent", 0.0, 100.0, 5);
            let mut panel = Panel::new(pen, frame, x, y);
            for (i, (set, name)) in parts.sets.iter().zip(&names).enumerate() {
                let middle = top + ROW * (i as f64 + 0.5);
                let beside = (HPos::Right, VPos::Center);
                pen.text(name, (left - 5.0, middle), MEDIUM, INK, beside);
                let half = 0.5 * BAR / ROW;
                let at = -(i as f64 + 0.5);
                let mut from = 0.0;
                for (number, share) in parts.of_set(run, set).into_iter().enumerate() {
                    let (percent, colour) = (100.0 * share, parts.colour(number));
                    let to = from + percent;
                    panel.rectangle((from, at - half), (to, at + half), colour);
                    let label = fixed(percent, 0);
                    let wide = (right - left) * percent / 100.0;
                    if wide > text_width(&label, SMALL) + 4.0 {
                        let centre = left + (right - left) * (0.5 * (from + to)) / 100.0;
                        let on_it = (HPos::Center, VPos::Center);
                        pen.text(&label, (centre, middle), SMALL, ink_on(colour), on_it);
                    }
                    from = to;
                }
                let own = run.predictions.iter().filter(|row| row.rays == *set);
                if let Some(ns) = median(own.map(|row| row.measured_ns)) {
                    let text = format!("{} ns a ray", significant(ns, 3));
                    let behind = (HPos::Left, VPos::Center);
                    pen.text(&text, (right + 6.0, middle), SMALL, INK, behind);
                }
            }
        },
    ))
}

/// Black or white, whichever stands out.
fn ink_on(RGBAColor(r, g, b, alpha): RGBAColor) -> RGBAColor {
    let light = |channel: u8| 255.0 - alpha * (255.0 - f64::from(channel));
    let seen = 0.299 * light(r) + 0.587 * light(g) + 0.114 * light(b);
    if seen > 125.0 {
        INK
    } else {
        RGBAColor(255, 255, 255, 1.0)
    }
}

/// The name of a term, `c_K` in it with a subscript.
fn subscripted(name: &str) -> String {
    name.replace('_', &SUB.to_string())
}

/// Whether the terms that are not among these make a part that can be seen, of any set.
fn others_show(run: &CostVsWork, terms: &[&str]) -> bool {
    let of_set = |set: &str| {
        let own = run.shares.iter().filter(|row| row.rays == set);
        let others = own.filter(|row| !terms.contains(&row.term.as_str()));
        others.map(|row| row.share).sum::<f64>()
    };
    let sets = distinct(run.shares.iter().map(|row| row.rays.as_str()));
    sets.into_iter().any(|set| of_set(set) >= SEEN)
}

/// The parts of the bars.
struct Parts<'r> {
    sets: Vec<&'r str>,
    /// Terms with a part of their own.
    terms: Vec<&'r str>,
    /// Whether the others make a part that can be seen.
    others: bool,
    /// How many terms there are in all.
    all: usize,
}

impl<'r> Parts<'r> {
    fn of(run: &'r CostVsWork) -> Option<Self> {
        let all = distinct(run.shares.iter().map(|row| row.term.as_str()));
        let large = |term: &&str| {
            let own = run.shares.iter().filter(|row| row.term == *term);
            own.map(|row| row.share).fold(0.0, f64::max) >= SMALLEST
        };
        let terms: Vec<&str> = all.iter().copied().filter(large).collect();
        (!terms.is_empty()).then(|| Self {
            sets: distinct(run.shares.iter().map(|row| row.rays.as_str())),
            others: others_show(run, &terms),
            all: all.len(),
            terms,
        })
    }

    /// What became of the smallest terms, for the caption.
    fn remark(&self) -> String {
        if self.terms.len() == self.all {
            return String::new();
        }
        let smallest = fixed(100.0 * SMALLEST, 0);
        let fate = if self.others {
            "are other terms".to_owned()
        } else {
            format!(
                "make less than {} % together and are not drawn",
                fixed(100.0 * SEEN, 1)
            )
        };
        format!(" Terms below {smallest} % everywhere {fate}.")
    }

    /// The shares of a set: of the terms, and of all others together.
    fn of_set(&self, run: &CostVsWork, set: &str) -> Vec<f64> {
        let of = |term: &str| {
            let own = run
                .shares
                .iter()
                .filter(|row| row.rays == set && row.term == term);
            own.map(|row| row.share).sum::<f64>()
        };
        let mut shares: Vec<f64> = self.terms.iter().map(|term| of(term)).collect();
        let others = run
            .shares
            .iter()
            .filter(|row| row.rays == set && !self.terms.contains(&row.term.as_str()));
        let others: f64 = others.map(|row| row.share).sum();
        shares.extend(self.others.then_some(others));
        shares
    }

    fn colour(&self, number: usize) -> RGBAColor {
        if number >= self.terms.len() {
            return GRID;
        }
        let alpha = if number < COLOURS { 1.0 } else { 0.45 };
        faded(Look::of(number).colour, alpha)
    }

    fn keys(&self) -> Vec<(Key, String)> {
        let others = self.others.then_some("other terms");
        let names = self.terms.iter().copied().chain(others).enumerate();
        names
            .map(|(i, name)| (Key::Area(self.colour(i)), subscripted(name)))
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::cost_vs_work::fixture::trees;

    #[test]
    fn parts_that_cannot_be_seen_have_no_key() {
        let mut run = trees();
        let keys = |run: &CostVsWork| {
            let parts = Parts::of(run).unwrap();
            (parts.keys().len(), parts.remark())
        };
        let remark = " Terms below 2 % everywhere are other terms.".to_owned();
        assert_eq!(keys(&run), (3, remark));
        for row in &mut run.shares {
            row.share /= 2.5;
        }
        let (number, remark) = keys(&run);
        assert_eq!(number, 2);
        assert!(remark.ends_with("make less than 0.5 % together and are not drawn."));
    }
}
