//! Whether the metric still ranks the strategies: a row a set of rays, a column a scene.

use plotters::style::text_anchor::{HPos, VPos};

use super::Assumptions;
use super::rows::{HEADINGS, ROW, Rows};
use crate::report::figure::{Figure, LEFT, WIDTH};
use crate::report::legend::{Key, legend};
use crate::report::number::{fixed, percent_above};
use crate::report::palette::{INK, Look, MUTED, Marker, VERMILLION, viridis};
use crate::report::series::distinct;
use crate::report::text::{LEADING, SMALL, caption_lines, fit};
use crate::study::records::{OrderRecord, Summary};
use plotters::style::RGBAColor;

const TITLE: &str =
    "Does the metric still find the cheapest tree, for rays that break its assumptions?";
/// Room for the scenes' names above the matrix, which read upwards.
const NAMES: f64 = 90.0;
/// Widest column.
const WIDEST: f64 = 30.0;
/// A pair of trees the wrong way round.
const WRONG: Look = Look {
    colour: VERMILLION,
    marker: Marker::Disc,
};
const PAPER: RGBAColor = RGBAColor(255, 255, 255, 1.0);

/// The figure of all scenes.
pub fn figure(run: &Assumptions, summary: &Summary) -> Figure {
    let scenes = distinct(run.orders.iter().map(|row| row.scene.as_str()));
    let strategies = distinct(run.bias.iter().map(|row| row.strategy.as_str()));
    let caption = format!(
        "Numbers: by how many per cent the tree that the metric takes for the cheapest is dearer, counted, than the cheapest, of \
         strategies {}, stop {}; 0: the metric's choice is best. Colour: Kendall's τ of their costs predicted and counted, 1: the \
         same order. Red dot: at least one pair of trees is ranked wrongly although the rays tell them apart (99 % intervals of the \
         differences of their costs over the same rays). Empty: the scene has no such rays. Blue dots: assumptions \
         that the rays break. Seed {}.",
        strategies.join(", "),
        summary.stop.as_deref().unwrap_or("unknown"),
        summary.seed
    );
    let caption = caption_lines(caption, WIDTH - 2.0 * LEFT, summary.quick);
    let keys = [
        (Key::Scale("≤ 0", "1"), "τ of the order".to_owned()),
        (Key::Mark(WRONG), "a pair ranked wrongly".to_owned()),
    ];
    let top = 38.0 + NAMES.max(HEADINGS);
    let rows = Rows::of(run, top);
    let bottom = rows.bottom();
    let width = ((WIDTH - LEFT - rows.right - 4.0) / scenes.len() as f64).min(WIDEST);
    let end = rows.right + 4.0 + width * scenes.len() as f64;
    let height = bottom + 14.0 + LEADING * (caption.len() - 1) as f64 + 6.0;
    Figure::draw(TITLE, (&caption, bottom + 14.0), WIDTH, height, |pen| {
        legend(pen, (LEFT, WIDTH - LEFT), 31.0, &keys);
        rows.draw(pen, end);
        for (c, scene) in scenes.iter().enumerate() {
            let left = rows.right + 4.0 + width * c as f64;
            let name = fit(scene, SMALL, NAMES - 2.0);
            let at = (left + 0.5 * width + 2.5, top - 4.0);
            pen.upright(&name, at, SMALL, MUTED, (HPos::Left, VPos::Bottom));
            for (r, set) in rows.sets.iter().enumerate() {
                let is_own = |row: &&OrderRecord| row.scene == *scene && row.rays == *set;
                let Some(row) = run.orders.iter().find(is_own) else {
                    continue;
                };
                let y = rows.middle(r);
                let half = 0.5 * ROW - 0.4;
                let share = row.tau.map(|tau| tau.max(0.0));
                let (fill, ink) = match share {
                    Some(share) if share > 0.55 => (viridis(share), INK),
                    Some(share) => (viridis(share), PAPER),
                    None => (PAPER, INK),
                };
                pen.rectangle((left + 0.4, y - half), (left + width - 0.4, y + half), fill);
                if let Some(regret) = row.regret {
                    let percent = percent_above(1.0 + regret);
                    let decimals = usize::from(percent > 0.0 && percent < 9.95);
                    let text = fixed(percent, decimals);
                    let at = (left + 0.5 * width - 1.5, y);
                    pen.text(&text, at, SMALL, ink, (HPos::Center, VPos::Center));
                }
                if row.wrong > 0 {
                    let at = (left + width - 3.6, y);
                    WRONG.marker.draw(pen, at, 2.3, PAPER);
                    WRONG.marker.draw(pen, at, 1.7, WRONG.colour);
                }
            }
        }
    })
}
