//! A figure as SVG: whole coordinates in 1/200 point, neighbours of one paint in one group.

use std::fmt::Write;

use super::bitmap::base64;
use super::figure::{Figure, Form, Segment, Shape, UNITS};

/// Steps of the SVG's own unit in a backend unit, so that letters too have whole coordinates.
const FINER: f64 = 10.0;

/// The document. Equal figures give equal bytes.
pub fn document(figure: &Figure) -> String {
    let [width, height] = [figure.size.0, figure.size.1].map(|size| f64::from(size) * FINER);
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" width=\"{}pt\" height=\"{}pt\" \
         viewBox=\"0 0 {width} {height}\">\n<title>{}</title>\n<path fill=\"#fff\" d=\"M0 0H{width}V{height}H0Z\"/>\n",
        width / FINER / UNITS,
        height / FINER / UNITS,
        escape(&figure.title),
    );
    drawing(&mut out, figure);
    out.push_str("</svg>\n");
    out
}

/// The figure as an element of a page, which sets its size and its ground; `label` is an attribute already. No part of it has a
/// name, so that several can stand in one page.
pub fn element_of_page(figure: &Figure, label: &str) -> String {
    let [width, height] = [figure.size.0, figure.size.1].map(|size| f64::from(size) * FINER);
    let mut out =
        format!("<svg role=\"img\" aria-label=\"{label}\" viewBox=\"0 0 {width} {height}\">\n");
    drawing(&mut out, figure);
    out.push_str("</svg>\n");
    out
}

/// All shapes, neighbours of one paint in one group.
fn drawing(out: &mut String, figure: &Figure) {
    let mut open = String::new();
    for shape in &figure.shapes {
        let paint = paint(shape);
        if paint != open {
            out.push_str(if open.is_empty() { "" } else { "</g>\n" });
            // Writing to a string cannot fail, here and below.
            let _ = writeln!(out, "<g {paint}>");
            open = paint;
        }
        element(out, &shape.form);
    }
    out.push_str(if open.is_empty() { "" } else { "</g>\n" });
}

fn paint(shape: &Shape) -> String {
    let (r, g, b) = shape.rgb;
    let (kind, rest) = match &shape.form {
        Form::Stroke(_, width) => (
            "stroke",
            format!(
                " fill=\"none\" stroke-linejoin=\"round\" stroke-width=\"{}\"",
                f64::from(*width) * FINER
            ),
        ),
        _ => ("fill", String::new()),
    };
    let opacity = match shape.alpha {
        alpha if alpha < 1.0 => format!(" {kind}-opacity=\"{alpha}\""),
        _ => String::new(),
    };
    format!("{kind}=\"#{r:02x}{g:02x}{b:02x}\"{opacity}{rest}")
}

fn element(out: &mut String, form: &Form) {
    let _ = match form {
        Form::Disc([x, y], radius) => {
            let [x, y] = whole([*x, *y]);
            let radius = f64::from(*radius) * FINER;
            writeln!(out, "<circle cx=\"{x}\" cy=\"{y}\" r=\"{radius}\"/>")
        }
        Form::Picture([from, to], bitmap) => {
            let ([x, y], [right, bottom]) = (whole(*from), whole(*to));
            let png = bitmap.png(None).expect("a bitmap has three bytes a pixel");
            writeln!(
                out,
                "<image x=\"{x}\" y=\"{y}\" width=\"{}\" height=\"{}\" preserveAspectRatio=\"none\" \
                 href=\"data:image/png;base64,{}\"/>",
                right - x,
                bottom - y,
                base64(&png)
            )
        }
        Form::Stroke(line, _) => {
            let mut path = Path::default();
            path.move_to(line[0]);
            line[1..].iter().for_each(|&to| path.line_to(to));
            writeln!(out, "<path d=\"{}\"/>", path.data)
        }
        Form::Fill(segments) => {
            let mut path = Path::default();
            for &segment in segments {
                match segment {
                    Segment::Move(to) => {
                        path.close();
                        path.move_to(to);
                    }
                    Segment::Line(to) => path.line_to(to),
                    Segment::Quad(control, to) => path.quad_to(control, to),
                }
            }
            path.close();
            writeln!(out, "<path d=\"{}\"/>", path.data)
        }
    };
}

fn whole([x, y]: [f32; 2]) -> [i64; 2] {
    [x, y].map(|v| (f64::from(v) * FINER).round() as i64)
}

/// Path data in relative whole coordinates, the shortest way to write outlines of letters.
#[derive(Default)]
struct Path {
    data: String,
    at: [i64; 2],
}

impl Path {
    fn move_to(&mut self, to: [f32; 2]) {
        self.at = whole(to);
        let [x, y] = self.at;
        let _ = write!(self.data, "M{x} {y}");
    }

    fn line_to(&mut self, to: [f32; 2]) {
        let to = whole(to);
        let [dx, dy] = [to[0] - self.at[0], to[1] - self.at[1]];
        let _ = match (dx, dy) {
            (0, 0) => Ok(()),
            (_, 0) => write!(self.data, "h{dx}"),
            (0, _) => write!(self.data, "v{dy}"),
            _ => write!(self.data, "l{dx}{}", next(dy)),
        };
        self.at = to;
    }

    fn quad_to(&mut self, control: [f32; 2], to: [f32; 2]) {
        let (control, to, [x, y]) = (whole(control), whole(to), self.at);
        let [cx, cy, dx, dy] = [control[0] - x, control[1] - y, to[0] - x, to[1] - y];
        let _ = write!(self.data, "q{cx}{}{}{}", next(cy), next(dx), next(dy));
        self.at = to;
    }

    fn close(&mut self) {
        self.data
            .push_str(if self.data.is_empty() { "" } else { "Z" });
    }
}

/// A number after another one: a minus sign parts them as well as a space.
fn next(value: i64) -> String {
    if value < 0 {
        value.to_string()
    } else {
        format!(" {value}")
    }
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
}
