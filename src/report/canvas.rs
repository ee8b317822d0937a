//! The plotters backend that records shapes in a [`Figure`].
//!
//! Every method of the trait that plotters would otherwise rasterise into pixels is overridden.

use std::convert::Infallible;

use plotters::element::{Drawable, PointCollection};
use plotters_backend::text_anchor::{HPos, VPos};
use plotters_backend::{
    BackendColor, BackendCoord, BackendStyle, BackendTextStyle, DrawingBackend, DrawingErrorKind,
    FontTransform,
};

use super::bitmap::Bitmap;
use super::figure::{Figure, Form, Segment, Shape};
use super::glyphs;

type Drawn = Result<(), DrawingErrorKind<Infallible>>;

/// A figure being drawn.
pub struct Canvas<'a>(&'a mut Figure);

impl<'a> Canvas<'a> {
    /// Draws on `figure`.
    pub fn new(figure: &'a mut Figure) -> Self {
        Canvas(figure)
    }

    fn push(&mut self, form: Form, colour: BackendColor) -> Drawn {
        let BackendColor { rgb, alpha } = colour;
        let empty = match &form {
            Form::Fill(segments) => segments.is_empty(),
            Form::Stroke(line, _) => line.len() < 2,
            Form::Disc(..) | Form::Picture(..) => false,
        };
        if alpha > 0.0 && !empty {
            self.0.shapes.push(Shape { form, rgb, alpha });
        }
        Ok(())
    }
}

fn point((x, y): BackendCoord) -> [f32; 2] {
    [x as f32, y as f32]
}

fn contour(points: impl IntoIterator<Item = BackendCoord>) -> Vec<Segment> {
    let mut points = points.into_iter().map(point);
    let first = points.next().map(Segment::Move);
    first.into_iter().chain(points.map(Segment::Line)).collect()
}

impl DrawingBackend for Canvas<'_> {
    type ErrorType = Infallible;

    fn get_size(&self) -> (u32, u32) {
        self.0.size
    }

    fn ensure_prepared(&mut self) -> Drawn {
        Ok(())
    }

    fn present(&mut self) -> Drawn {
        Ok(())
    }

    fn draw_pixel(&mut self, (x, y): BackendCoord, colour: BackendColor) -> Drawn {
        self.draw_rect((x, y), (x + 1, y + 1), &colour, true)
    }

    fn draw_line<S: BackendStyle>(
        &mut self,
        from: BackendCoord,
        to: BackendCoord,
        style: &S,
    ) -> Drawn {
        self.draw_path([from, to], style)
    }

    fn draw_rect<S: BackendStyle>(
        &mut self,
        (x0, y0): BackendCoord,
        (x1, y1): BackendCoord,
        style: &S,
        fill: bool,
    ) -> Drawn {
        let corners = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)];
        if fill {
            self.fill_polygon(corners, style)
        } else {
            self.draw_path(corners.into_iter().chain([(x0, y0)]), style)
        }
    }

    fn draw_path<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        path: I,
        style: &S,
    ) -> Drawn {
        let line = path.into_iter().map(point).collect();
        self.push(
            Form::Stroke(line, style.stroke_width() as f32),
            style.color(),
        )
    }

    fn draw_circle<S: BackendStyle>(
        &mut self,
        centre: BackendCoord,
        radius: u32,
        style: &S,
        fill: bool,
    ) -> Drawn {
        debug_assert!(fill, "only discs are drawn");
        self.push(Form::Disc(point(centre), radius as f32), style.color())
    }

    fn fill_polygon<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        corners: I,
        style: &S,
    ) -> Drawn {
        self.push(Form::Fill(contour(corners)), style.color())
    }

    /// One filled shape for the whole line of text. `VPos::Bottom` is the baseline, `VPos::Top` the height of a
    /// capital, so that labels sit by what one sees of them.
    fn draw_text<T: BackendTextStyle>(&mut self, text: &str, style: &T, at: BackendCoord) -> Drawn {
        let size = style.size() as f32;
        let left = match style.anchor().h_pos {
            HPos::Left => 0.0,
            HPos::Center => -0.5,
            HPos::Right => -1.0,
        } * glyphs::width(text, size);
        let baseline = match style.anchor().v_pos {
            VPos::Top => 1.0,
            VPos::Center => 0.5,
            VPos::Bottom => 0.0,
        } * glyphs::CAPITAL
            * size;
        let turn = style.transform();
        let [x, y] = point(at);
        let outline = glyphs::outline(text, size, |u, v| match turn {
            FontTransform::Rotate270 => [x + baseline + v, y - left - u],
            _ => [x + left + u, y + baseline + v],
        });
        self.push(Form::Fill(outline), style.color())
    }
}

/// A picture at its place: the one element that plotters does not have.
pub struct Placed {
    /// Upper left and lower right corner.
    pub corners: [BackendCoord; 2],
    /// What is shown between them.
    pub bitmap: Bitmap,
}

impl<'a> PointCollection<'a, BackendCoord> for &'a Placed {
    type Point = &'a BackendCoord;
    type IntoIter = std::slice::Iter<'a, BackendCoord>;

    fn point_iter(self) -> Self::IntoIter {
        self.corners.iter()
    }
}

impl Drawable<Canvas<'_>> for Placed {
    fn draw<I: Iterator<Item = BackendCoord>>(
        &self,
        corners: I,
        canvas: &mut Canvas,
        _: (u32, u32),
    ) -> Drawn {
        let corners: Vec<_> = corners.map(point).collect();
        let opaque = BackendColor {
            alpha: 1.0,
            rgb: (0, 0, 0),
        };
        let picture = Form::Picture([corners[0], corners[1]], self.bitmap.clone());
        canvas.push(picture, opaque)
    }
}
