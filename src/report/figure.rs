//! A figure: a list of shapes, drawn once through plotters, written as SVG and as PNG.
//!
//! plotters places everything on whole units of its backend. [`Canvas`] makes that unit a
//! twentieth of a point, too fine to be seen, and records shapes instead of pixels; text arrives as glyph outlines.
//! Both files are written from that one list, so they show the same, in every viewer, without any installed font.

use plotters::coord::Shift;
use plotters::drawing::{DrawingArea, IntoDrawingArea};
use plotters::element::{Circle, PathElement, Polygon, Rectangle, Text};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color, FontTransform, IntoFont, RGBAColor, ShapeStyle, TextStyle};

use super::bitmap::Bitmap;
use super::canvas::{Canvas, Placed};
use super::text::title_and_caption;
use super::{raster, svg};

/// Width of every figure, in points: 7.2 inches, the text of a page.
pub const WIDTH: f64 = 518.4;
/// Left margin of titles and captions, in points; the right one is as wide.
pub const LEFT: f64 = 8.0;

/// Backend units in a point (1/72 inch).
pub const UNITS: f64 = 20.0;

/// Drawing records into memory, which is why no drawing call of this layer returns an error.
pub const DRAWN: &str = "a shape recorded in memory cannot fail";

/// A piece of an outline, in backend units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Segment {
    /// Begin a contour here.
    Move([f32; 2]),
    /// A straight line to here.
    Line([f32; 2]),
    /// A quadratic curve: control point, end.
    Quad([f32; 2], [f32; 2]),
}

/// What one shape looks like.
#[derive(Clone, Debug, PartialEq)]
pub enum Form {
    /// Filled contours, each closed.
    Fill(Vec<Segment>),
    /// A polyline of this width.
    Stroke(Vec<[f32; 2]>, f32),
    /// A filled disc: centre, radius.
    Disc([f32; 2], f32),
    /// A picture between two corners, in its own colours.
    Picture([[f32; 2]; 2], Bitmap),
}

/// One shape and its colour.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    /// Its form.
    pub form: Form,
    /// Red, green, blue.
    pub rgb: (u8, u8, u8),
    /// 1 is opaque.
    pub alpha: f64,
}

/// A picture in memory.
#[derive(Clone, Debug)]
pub struct Figure {
    /// Width and height in backend units.
    pub size: (u32, u32),
    /// What the picture shows, in words.
    pub title: String,
    /// The text that stands under it.
    pub caption: String,
    /// Everything drawn, in order.
    pub shapes: Vec<Shape>,
    /// How many of the shapes, the first ones, are the title and the caption.
    pub words: usize,
}

impl Figure {
    /// Draws a figure of `width` by `height` points: the title, the caption's lines from this baseline down, then the rest.
    pub fn draw(
        title: &str,
        (caption, baseline): (&[String], f64),
        width: f64,
        height: f64,
        draw: impl FnOnce(&Pen),
    ) -> Self {
        let mut figure = Figure {
            size: (units(width) as u32, units(height) as u32),
            title: title.to_owned(),
            caption: caption.join(" "),
            shapes: Vec::new(),
            words: 0,
        };
        let words = Pen(Canvas::new(&mut figure).into_drawing_area());
        title_and_caption(&words, title, LEFT, caption, baseline);
        drop(words);
        figure.words = figure.shapes.len();
        draw(&Pen(Canvas::new(&mut figure).into_drawing_area()));
        figure
    }

    /// The figure as an SVG document.
    pub fn svg(&self) -> String {
        svg::document(self)
    }

    /// The figure as a PNG of this resolution.
    pub fn png(&self, dots_per_inch: f64) -> Result<Vec<u8>, png::EncodingError> {
        raster::png(self, dots_per_inch)
    }
}

/// Points to backend units.
pub fn units(points: f64) -> i32 {
    (points * UNITS).round() as i32
}

fn unit_pair((x, y): (f64, f64)) -> (i32, i32) {
    (units(x), units(y))
}

/// A line of this colour and width (points).
pub fn stroke(colour: RGBAColor, width: f64) -> ShapeStyle {
    colour.stroke_width(units(width) as u32)
}

/// Draws on a figure; all lengths in points, y downwards.
pub struct Pen<'a>(DrawingArea<Canvas<'a>, Shift>);

impl<'a> Pen<'a> {
    /// The plotters area of the whole figure.
    pub fn area(&self) -> &DrawingArea<Canvas<'a>, Shift> {
        &self.0
    }

    /// A polyline.
    pub fn line(&self, points: &[(f64, f64)], colour: RGBAColor, width: f64) {
        let path: Vec<_> = points.iter().map(|&point| unit_pair(point)).collect();
        self.0
            .draw(&PathElement::new(path, stroke(colour, width)))
            .expect(DRAWN);
    }

    /// A dashed polyline.
    pub fn dashes(&self, path: &[(f64, f64)], colour: RGBAColor, width: f64) {
        const DASH: f64 = 3.0;
        const GAP: f64 = 2.0;
        // Distance along the path, modulo one dash and one gap.
        let mut phase = 0.0;
        for ends in path.windows(2) {
            let ((x0, y0), (x1, y1)) = (ends[0], ends[1]);
            let length = (x1 - x0).hypot(y1 - y0);
            let at = |s: f64| (x0 + (x1 - x0) * s / length, y0 + (y1 - y0) * s / length);
            let mut done = 0.0;
            while done < length {
                let (left, inked) = if phase < DASH {
                    (DASH - phase, true)
                } else {
                    (DASH + GAP - phase, false)
                };
                let step = left.min(length - done);
                if inked {
                    self.line(&[at(done), at(done + step)], colour, width);
                }
                done += step;
                phase = if step < left {
                    phase + step
                } else if inked {
                    DASH
                } else {
                    0.0
                };
            }
        }
    }

    /// A filled polygon.
    pub fn polygon(&self, points: &[(f64, f64)], colour: RGBAColor) {
        let path: Vec<_> = points.iter().map(|&point| unit_pair(point)).collect();
        self.0
            .draw(&Polygon::new(path, colour.filled()))
            .expect(DRAWN);
    }

    /// A filled rectangle between two corners.
    pub fn rectangle(&self, a: (f64, f64), b: (f64, f64), colour: RGBAColor) {
        let corners = [unit_pair(a), unit_pair(b)];
        self.0
            .draw(&Rectangle::new(corners, colour.filled()))
            .expect(DRAWN);
    }

    /// A filled disc.
    pub fn disc(&self, centre: (f64, f64), radius: f64, colour: RGBAColor) {
        let disc = Circle::new(unit_pair(centre), units(radius), colour.filled());
        self.0.draw(&disc).expect(DRAWN);
    }

    /// A picture between its upper left and lower right corners.
    pub fn picture(&self, a: (f64, f64), b: (f64, f64), bitmap: Bitmap) {
        let corners = [unit_pair(a), unit_pair(b)];
        self.0.draw(&Placed { corners, bitmap }).expect(DRAWN);
    }

    /// A line of text of this size, anchored at a point.
    pub fn text(
        &self,
        text: &str,
        at: (f64, f64),
        size: f64,
        ink: RGBAColor,
        anchor: (HPos, VPos),
    ) {
        self.place(text, at, size, ink, anchor, FontTransform::None);
    }

    /// A line of text that reads upwards.
    pub fn upright(
        &self,
        text: &str,
        at: (f64, f64),
        size: f64,
        ink: RGBAColor,
        anchor: (HPos, VPos),
    ) {
        self.place(text, at, size, ink, anchor, FontTransform::Rotate270);
    }

    fn place(
        &self,
        text: &str,
        at: (f64, f64),
        size: f64,
        ink: RGBAColor,
        (h, v): (HPos, VPos),
        turn: FontTransform,
    ) {
        let font = ("sans-serif", size * UNITS).into_font().transform(turn);
        let style = TextStyle::from(font).color(&ink).pos(Pos::new(h, v));
        self.0
            .draw(&Text::new(text, unit_pair(at), style))
            .expect(DRAWN);
    }
}
