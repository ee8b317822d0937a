//! Sizes, widths and line breaks of the text in figures.

use plotters::style::text_anchor::{HPos, VPos};

use super::figure::Pen;
use super::glyphs;
use super::palette::{INK, MUTED};

/// Size of tick labels and captions, in points.
pub const SMALL: f64 = 7.0;
/// Size of axis labels and legends, in points.
pub const MEDIUM: f64 = 7.6;
/// Size of titles, in points.
pub const LARGE: f64 = 10.5;

/// Width of a text in points.
pub fn text_width(text: &str, size: f64) -> f64 {
    f64::from(glyphs::width(text, size as f32))
}

/// The text, or its end behind an ellipsis where it is wider than that: the end of a path tells more.
pub fn fit(text: &str, size: f64, width: f64) -> String {
    if text_width(text, size) <= width {
        return text.to_owned();
    }
    let ends = text.char_indices().map(|(i, _)| format!("…{}", &text[i..]));
    ends.skip(1)
        .find(|end| text_width(end, size) <= width)
        .unwrap_or_default()
}

/// The text, or its beginning before an ellipsis where it is wider than that.
pub fn beginning(text: &str, size: f64, width: f64) -> String {
    if text_width(text, size) <= width {
        return text.to_owned();
    }
    let starts = text.char_indices().rev();
    let mut starts = starts.map(|(i, _)| format!("{}…", text[..i].trim_end()));
    starts
        .find(|start| text_width(start, size) <= width)
        .unwrap_or_default()
}

/// The text with its first letter, if it is an ASCII one, made a capital.
pub fn capitalised(text: &str) -> String {
    let mut characters = text.chars();
    let first = characters.next().map(|first| first.to_ascii_uppercase());
    first.into_iter().chain(characters).collect()
}

/// Distance of two lines of a caption.
pub const LEADING: f64 = 9.6;

/// Breaks a text into lines of at most this width, set small.
pub fn wrap(text: &str, width: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split(' ') {
        match lines.last_mut() {
            Some(line) if text_width(&format!("{line} {word}"), SMALL) <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(fit(word, SMALL, width)),
        }
    }
    lines
}

/// The lines of a figure's caption, which ends by saying so where the run was a quick one.
pub fn caption_lines(mut text: String, width: f64, quick: bool) -> Vec<String> {
    if quick {
        text.push_str(" Quick form: not for publication.");
    }
    wrap(&text, width)
}

/// Title above and caption below a figure, both from the left edge; `baseline` is that of the first caption line.
pub fn title_and_caption(pen: &Pen, title: &str, left: f64, caption: &[String], baseline: f64) {
    pen.text(title, (left, 15.0), LARGE, INK, (HPos::Left, VPos::Bottom));
    for (i, line) in caption.iter().enumerate() {
        let at = (left, baseline + LEADING * i as f64);
        pen.text(line, at, SMALL, MUTED, (HPos::Left, VPos::Bottom));
    }
}
