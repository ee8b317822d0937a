//! A figure as PNG: every shape filled with exact area coverage, so edges and thin lines are smooth at any size.

use ab_glyph_rasterizer::{Point, Rasterizer, point};

use super::bitmap::Bitmap;
use super::figure::{Figure, Form, Segment, Shape, UNITS};

/// The encoded image, on white, with its resolution noted.
pub fn png(figure: &Figure, dots_per_inch: f64) -> Result<Vec<u8>, png::EncodingError> {
    let scale = dots_per_inch / 72.0 / UNITS;
    let size = |units: u32| (f64::from(units) * scale).round().max(1.0) as usize;
    let mut image = Bitmap::white(size(figure.size.0), size(figure.size.1));
    for shape in &figure.shapes {
        match &shape.form {
            Form::Picture([from, to], picture) => {
                let dots =
                    |[x, y]: [f32; 2]| [x, y].map(|v| (f64::from(v) * scale).round() as usize);
                image.place(picture, dots(*from), dots(*to));
            }
            _ => image.paint(shape, scale as f32),
        }
    }
    image.png(Some(dots_per_inch))
}

impl Bitmap {
    /// Draws a picture between two corners, interpolating between the middles of its pixels.
    fn place(&mut self, picture: &Bitmap, [x0, y0]: [usize; 2], [x1, y1]: [usize; 2]) {
        // For every dot across or up: two neighbouring pixels and the weight of the second.
        let taps = |dots: usize, pixels: usize| {
            (0..dots).map(move |dot| {
                let last = (pixels - 1) as f64;
                let at = (dot as f64 + 0.5) * pixels as f64 / dots as f64 - 0.5;
                let at = at.clamp(0.0, last);
                let first = at as usize;
                (first, (first + 1).min(pixels - 1), at - at.floor())
            })
        };
        for (y, (above, below, down)) in (y0..self.height).zip(taps(y1 - y0, picture.height)) {
            for (x, (left, right, along)) in (x0..self.width).zip(taps(x1 - x0, picture.width)) {
                let at = 3 * (y * self.width + x);
                for (c, byte) in self.rgb[at..at + 3].iter_mut().enumerate() {
                    let of = |x, y| f64::from(picture.rgb[3 * (y * picture.width + x) + c]);
                    let row = |y| of(left, y) * (1.0 - along) + of(right, y) * along;
                    *byte = (row(above) * (1.0 - down) + row(below) * down).round() as u8;
                }
            }
        }
    }

    fn paint(&mut self, shape: &Shape, scale: f32) {
        let contours = contours(&shape.form, scale);
        // The pixels the shape can touch, inside the image.
        let (mut low, mut high) = ([f32::MAX; 2], [f32::MIN; 2]);
        for &[x, y] in contours.iter().flatten() {
            (low, high) = (
                [low[0].min(x), low[1].min(y)],
                [high[0].max(x), high[1].max(y)],
            );
        }
        let clip = |v: f32, end: usize| v.clamp(0.0, end as f32) as usize;
        let (x0, y0) = (
            clip(low[0].floor(), self.width),
            clip(low[1].floor(), self.height),
        );
        let (x1, y1) = (
            clip(high[0].ceil() + 1.0, self.width),
            clip(high[1].ceil() + 1.0, self.height),
        );
        if x0 >= x1 || y0 >= y1 {
            return;
        }
        let mut coverage = Rasterizer::new(x1 - x0, y1 - y0);
        let local = |[x, y]: [f32; 2]| -> Point { point(x - x0 as f32, y - y0 as f32) };
        for contour in &contours {
            for (i, &from) in contour.iter().enumerate() {
                coverage.draw_line(local(from), local(contour[(i + 1) % contour.len()]));
            }
        }
        let (r, g, b) = shape.rgb;
        coverage.for_each_pixel_2d(|x, y, covered| {
            let alpha = covered.min(1.0) * shape.alpha as f32;
            if alpha <= 0.0 {
                return;
            }
            let at = 3 * ((y0 + y as usize) * self.width + x0 + x as usize);
            for (under, over) in self.rgb[at..at + 3].iter_mut().zip([r, g, b]) {
                let mixed = f32::from(*under) * (1.0 - alpha) + f32::from(over) * alpha;
                *under = mixed.round() as u8;
            }
        });
    }
}

/// Closed polygons in pixels. Coverage adds up and is cut at 1, so polygons that overlap must turn the same way.
fn contours(form: &Form, scale: f32) -> Vec<Vec<[f32; 2]>> {
    let scaled = |[x, y]: [f32; 2]| [x * scale, y * scale];
    match form {
        Form::Picture(..) => Vec::new(),
        Form::Fill(segments) => flatten(segments, scaled),
        Form::Disc(centre, radius) => vec![disc(scaled(*centre), radius * scale)],
        Form::Stroke(line, width) => {
            let line: Vec<_> = line.iter().copied().map(scaled).collect();
            let half = 0.5 * width * scale;
            let joints = line.iter().skip(1).take(line.len().saturating_sub(2));
            let bars = line
                .windows(2)
                .filter_map(|ends| bar(ends[0], ends[1], half));
            bars.chain(joints.map(|&joint| disc(joint, half))).collect()
        }
    }
}

fn flatten(segments: &[Segment], scaled: impl Fn([f32; 2]) -> [f32; 2]) -> Vec<Vec<[f32; 2]>> {
    /// Enough for letters; their curves are a few pixels long.
    const STEPS: usize = 6;
    let mut contours: Vec<Vec<[f32; 2]>> = Vec::new();
    for segment in segments {
        match (*segment, contours.last_mut()) {
            (Segment::Move(to), _) => contours.push(vec![scaled(to)]),
            (Segment::Line(to), Some(contour)) => contour.push(scaled(to)),
            (Segment::Quad(control, to), Some(contour)) => {
                let from = *contour.last().expect("a contour begins with a point");
                let (control, to) = (scaled(control), scaled(to));
                for step in 1..=STEPS {
                    let t = step as f32 / STEPS as f32;
                    let mix = |i: usize| {
                        (1.0 - t) * ((1.0 - t) * from[i] + t * control[i])
                            + t * ((1.0 - t) * control[i] + t * to[i])
                    };
                    contour.push([mix(0), mix(1)]);
                }
            }
            (_, None) => unreachable!("a contour begins with a move"),
        }
    }
    contours
}

/// The rectangle around a piece of a line.
fn bar(from: [f32; 2], to: [f32; 2], half: f32) -> Option<Vec<[f32; 2]>> {
    let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
    let length = (dx * dx + dy * dy).sqrt();
    let (u, v) = (dx / length * half, dy / length * half);
    (length > 0.0).then(|| {
        vec![
            [from[0] + v, from[1] - u],
            [to[0] + v, to[1] - u],
            [to[0] - v, to[1] + u],
            [from[0] - v, from[1] + u],
        ]
    })
}

/// A regular 32-gon, turning the same way as `bar`: a quarter by its sines, the rest by symmetry.
fn disc([x, y]: [f32; 2], radius: f32) -> Vec<[f32; 2]> {
    const SINES: [f32; 9] = [
        0.0,
        0.195_090_32,
        0.382_683_43,
        0.555_570_23,
        0.707_106_77,
        0.831_469_6,
        0.923_879_5,
        0.980_785_25,
        1.0,
    ];
    (0..32)
        .map(|i| {
            let (s, c) = (SINES[i % 8], SINES[8 - i % 8]);
            let (u, v) = match i / 8 {
                0 => (c, s),
                1 => (-s, c),
                2 => (-c, -s),
                _ => (s, -c),
            };
            [x + radius * u, y + radius * v]
        })
        .collect()
}
