//! Panels of equal size beside and below each other, between the legend and the caption of a figure.

use super::figure::{Figure, LEFT, Pen, WIDTH};
use super::legend::{Key, LEGEND_LEADING, legend, rows_of};
use super::panel::Frame;
use super::text::{LEADING, caption_lines};
use crate::study::records::Summary;

/// Where the panels of a figure stand; all lengths in points.
#[derive(Clone, Copy, Debug)]
pub struct Grid {
    /// Panels beside each other.
    pub columns: usize,
    /// Left edge of the first.
    pub left: f64,
    /// Room above the first row, for headings.
    pub above: f64,
    /// Width and height of a panel's data area.
    pub size: (f64, f64),
    /// From one panel to the next, across and down.
    pub pitch: (f64, f64),
}

impl Grid {
    /// The same with panels so wide that a row of them fills the page, of fewer panels too.
    pub fn filled(self, panels: usize) -> Self {
        let columns = self.columns.min(panels.max(1));
        let gap = self.pitch.0 - self.size.0;
        let pitch = (WIDTH - LEFT - self.left + gap) / columns as f64;
        Self {
            columns,
            size: (pitch - gap, self.size.1),
            pitch: (pitch, self.pitch.1),
            ..self
        }
    }

    /// A figure of so many panels; `draw` gets the number and the place of each.
    pub fn figure(
        &self,
        text: (&str, String),
        keys: &[(Key, String)],
        panels: usize,
        summary: &Summary,
        draw: impl Fn(&Pen, usize, Frame),
    ) -> Figure {
        let rows = panels.div_ceil(self.columns).max(1);
        let high = self.above + self.pitch.1 * (rows - 1) as f64 + self.size.1;
        page(text, keys, high, summary, |pen, top| {
            for number in 0..panels {
                let (column, row) = (number % self.columns, number / self.columns);
                let left = self.left + self.pitch.0 * column as f64;
                let top = top + self.above + self.pitch.1 * row as f64;
                let frame = Frame {
                    left,
                    top,
                    right: left + self.size.0,
                    bottom: top + self.size.1,
                };
                draw(pen, number, frame);
            }
        })
    }

    /// Whether a panel has no other below it, of so many.
    pub fn is_lowest(&self, number: usize, panels: usize) -> bool {
        number + self.columns >= panels
    }
}

/// A figure of a title, a legend, what `draw` fills so high a room with from the top edge that it gets, and a caption.
pub fn page(
    (title, caption): (&str, String),
    keys: &[(Key, String)],
    high: f64,
    summary: &Summary,
    draw: impl Fn(&Pen, f64),
) -> Figure {
    let room = WIDTH - 2.0 * LEFT;
    let caption = caption_lines(caption, room, summary.quick);
    let top = 33.0 + LEGEND_LEADING * (rows_of(room, keys) - 1) as f64;
    let baseline = top + high + 36.0;
    let height = baseline + LEADING * (caption.len() - 1) as f64 + 6.0;
    Figure::draw(title, (&caption, baseline), WIDTH, height, |pen| {
        legend(pen, (LEFT, WIDTH - LEFT), 31.0, keys);
        draw(pen, top);
    })
}

/// Name of the i-th page of a figure: `name`, `name-2`, `name-3`, ...
pub fn page_name(name: &str, page: usize) -> String {
    match page {
        0 => name.to_owned(),
        _ => format!("{name}-{}", page + 1),
    }
}

/// What a caption says of its page, where there are several.
pub fn part(page: usize, pages: usize) -> String {
    if pages > 1 {
        format!(" Part {} of {pages}.", page + 1)
    } else {
        String::new()
    }
}
