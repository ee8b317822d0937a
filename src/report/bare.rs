//! A figure without its title and caption, for pages that set both as text of their own.

use super::figure::{Figure, Form, Segment, Shape, UNITS};

/// What is left free above and below, in backend units.
const MARGIN: f32 = 4.0 * UNITS as f32;

impl Figure {
    /// The figure without title and caption, cut to the height of what is left.
    pub fn bare(&self) -> Figure {
        let shapes = &self.shapes[self.words..];
        let ends = shapes.iter().map(|shape| heights(&shape.form));
        let ends = ends.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])]);
        let [top, bottom] = ends.unwrap_or([0.0, self.size.1 as f32]);
        let (top, bottom) = ((top - MARGIN).floor(), (bottom + MARGIN).ceil());
        let lifted = |shape: &Shape| Shape {
            form: lifted(&shape.form, top),
            ..*shape
        };
        Figure {
            size: (self.size.0, (bottom - top) as u32),
            title: self.title.clone(),
            caption: self.caption.clone(),
            shapes: shapes.iter().map(lifted).collect(),
            words: 0,
        }
    }
}

/// The least and the largest y of a form.
fn heights(form: &Form) -> [f32; 2] {
    let extent = |heights: &mut dyn Iterator<Item = f32>| {
        heights.fold([f32::MAX, f32::MIN], |[low, high], y| {
            [low.min(y), high.max(y)]
        })
    };
    let widened = |[low, high]: [f32; 2], by: f32| [low - by, high + by];
    match form {
        Form::Fill(segments) => extent(&mut segments.iter().flat_map(|segment| match *segment {
            Segment::Move(to) | Segment::Line(to) => [to[1], to[1]],
            Segment::Quad(control, to) => [control[1], to[1]],
        })),
        Form::Stroke(line, width) => widened(extent(&mut line.iter().map(|at| at[1])), width / 2.0),
        Form::Disc(centre, radius) => widened([centre[1]; 2], *radius),
        Form::Picture([from, to], _) => [from[1], to[1]],
    }
}

/// The form, this much higher up.
fn lifted(form: &Form, by: f32) -> Form {
    let up = |[x, y]: [f32; 2]| [x, y - by];
    match form {
        Form::Fill(segments) => Form::Fill(
            segments
                .iter()
                .map(|segment| match *segment {
                    Segment::Move(to) => Segment::Move(up(to)),
                    Segment::Line(to) => Segment::Line(up(to)),
                    Segment::Quad(control, to) => Segment::Quad(up(control), up(to)),
                })
                .collect(),
        ),
        Form::Stroke(line, width) => Form::Stroke(line.iter().copied().map(up).collect(), *width),
        Form::Disc(centre, radius) => Form::Disc(up(*centre), *radius),
        Form::Picture(corners, bitmap) => Form::Picture(corners.map(up), bitmap.clone()),
    }
}

#[cfg(test)]
mod tests {
    use plotters::style::RGBAColor;

    use super::*;

    #[test]
    fn words_go_and_the_rest_moves_up() {
        let caption = ["A caption".to_owned(), "of two lines.".to_owned()];
        let ink = RGBAColor(0, 0, 0, 1.0);
        let figure = Figure::draw("Title", (&caption, 90.0), 100.0, 110.0, |pen| {
            pen.rectangle((10.0, 30.0), (90.0, 70.0), ink);
        });
        assert_eq!((figure.words, figure.shapes.len()), (3, 4));
        let bare = figure.bare();
        assert_eq!(bare.caption, "A caption of two lines.");
        assert_eq!((bare.shapes.len(), bare.words), (1, 0));
        // Forty points high, four free above and below.
        assert_eq!(bare.size, (2000, 48 * 20));
        assert_eq!(heights(&bare.shapes[0].form), [80.0, 880.0]);
        let empty = Figure::draw("Title", (&[], 0.0), 100.0, 110.0, |_| {}).bare();
        assert_eq!(empty.shapes.len(), 0);
    }
}
