//! Text as outlines of the embedded font (DejaVu Sans), and its width.

use std::sync::LazyLock;

use ttf_parser::{Face, OutlineBuilder};

use super::figure::Segment;

/// Height of a capital letter, in ems.
pub const CAPITAL: f32 = 0.729;

/// Put before a character to set it as a subscript (a private code point, so no scene name holds it).
pub const SUB: char = '\u{e000}';

const SUB_SIZE: f32 = 0.72;
const SUB_DROP: f32 = 0.16;

static FACE: LazyLock<Face<'static>> = LazyLock::new(|| {
    Face::parse(include_bytes!("font/DejaVuSans.ttf"), 0)
        .expect("the embedded font is a valid font file")
});

/// Width of a line of text in the unit of `size`.
pub fn width(text: &str, size: f32) -> f32 {
    let mut end = 0.0;
    set(text, size, |_, scale, _, advance| end += advance * scale);
    end
}

/// The outline of a line of text; `place` maps (right of the start, below the baseline) to the canvas.
pub fn outline(text: &str, size: f32, place: impl Fn(f32, f32) -> [f32; 2]) -> Vec<Segment> {
    let mut segments = Vec::new();
    let mut pen = 0.0;
    set(text, size, |glyph, scale, drop, advance| {
        let at = |x: f32, y: f32| place(pen + x * scale, drop - y * scale);
        FACE.outline_glyph(
            glyph,
            &mut Tracer {
                segments: &mut segments,
                at,
            },
        );
        pen += advance * scale;
    });
    segments
}

/// Calls `each` with every glyph, its scale, how far below the baseline it sits, and its advance (font units).
fn set(text: &str, size: f32, mut each: impl FnMut(ttf_parser::GlyphId, f32, f32, f32)) {
    let em = size / f32::from(FACE.units_per_em());
    let mut subscript = false;
    for character in text.chars() {
        if character == SUB {
            subscript = true;
            continue;
        }
        // A character the font lacks shows as the font's box, never as nothing.
        let glyph = FACE.glyph_index(character).unwrap_or_default();
        let advance = f32::from(FACE.glyph_hor_advance(glyph).unwrap_or_default());
        let (scale, drop) = if subscript {
            (em * SUB_SIZE, size * SUB_DROP)
        } else {
            (em, 0.0)
        };
        each(glyph, scale, drop, advance);
        subscript = false;
    }
}

struct Tracer<'a, F> {
    segments: &'a mut Vec<Segment>,
    at: F,
}

impl<F: Fn(f32, f32) -> [f32; 2]> OutlineBuilder for Tracer<'_, F> {
    fn move_to(&mut self, x: f32, y: f32) {
        self.segments.push(Segment::Move((self.at)(x, y)));
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.segments.push(Segment::Line((self.at)(x, y)));
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        self.segments
            .push(Segment::Quad((self.at)(x1, y1), (self.at)(x, y)));
    }

    fn curve_to(&mut self, _: f32, _: f32, _: f32, _: f32, _: f32, _: f32) {
        unreachable!("TrueType outlines are quadratic");
    }

    fn close(&mut self) {}
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_font_has_every_special_character_of_the_figures() {
        for character in "⁰¹²³⁴⁵⁶⁷⁸⁹⁻−±·×≤≥σ²–√".chars() {
            assert!(FACE.glyph_index(character).is_some(), "{character}");
        }
    }

    #[test]
    fn a_subscript_is_narrower_than_its_letter() {
        assert_eq!(width("K", 10.0) * SUB_SIZE, width(&format!("{SUB}K"), 10.0));
        assert!((width("KK", 10.0) - 2.0 * width("K", 10.0)).abs() < 1e-5);
    }

    #[test]
    fn a_capital_is_as_high_as_stated() {
        let units = f32::from(FACE.units_per_em());
        let letter = FACE.glyph_index('H').unwrap();
        let top = f32::from(FACE.glyph_bounding_box(letter).unwrap().y_max);
        assert!((top / units - CAPITAL).abs() < 1e-3, "{}", top / units);
    }
}
