//! A panel: a plotters chart with our axes around it.

use plotters::chart::{ChartBuilder, ChartContext};
use plotters::coord::cartesian::Cartesian2d;
use plotters::coord::types::RangedCoordf64;
use plotters::element::{PathElement, Polygon, Rectangle};
use plotters::style::text_anchor::{HPos, VPos};
use plotters::style::{Color, RGBAColor};

use super::axis::Axis;
use super::canvas::Canvas;
use super::figure::{DRAWN, Pen, UNITS, stroke, units};
use super::palette::{AXIS, GRID, INK, MUTED, Marker};
use super::text::{MEDIUM, SMALL, text_width};

/// Where a panel's data area sits in the figure, in points.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    /// Left edge.
    pub left: f64,
    /// Top edge.
    pub top: f64,
    /// Right edge.
    pub right: f64,
    /// Bottom edge.
    pub bottom: f64,
}

/// A panel whose axes are drawn and whose data may be.
pub struct Panel<'p, 'a> {
    pen: &'p Pen<'a>,
    /// Its data area.
    pub frame: Frame,
    /// Horizontal axis.
    pub x: Axis,
    /// Vertical axis.
    pub y: Axis,
    chart: ChartContext<'p, Canvas<'a>, Cartesian2d<RangedCoordf64, RangedCoordf64>>,
}

impl<'p, 'a> Panel<'p, 'a> {
    /// Draws grid, ticks and labels.
    pub fn new(pen: &'p Pen<'a>, frame: Frame, x: Axis, y: Axis) -> Self {
        let (width, height) = pen.area().dim_in_pixel();
        let area = pen.area().margin(
            units(frame.top),
            height as i32 - units(frame.bottom),
            units(frame.left),
            width as i32 - units(frame.right),
        );
        let chart = ChartBuilder::on(&area)
            .build_cartesian_2d(x.lo..x.hi, y.lo..y.hi)
            .expect(DRAWN);
        let panel = Panel {
            pen,
            frame,
            x,
            y,
            chart,
        };
        panel.draw_axes();
        panel
    }

    fn draw_axes(&self) {
        let Frame {
            left,
            top,
            right,
            bottom,
        } = self.frame;
        for tick in &self.x.ticks {
            let x = self.point((tick.at, self.y.lo)).0;
            self.pen.line(&[(x, top), (x, bottom + 2.5)], GRID, 0.5);
            self.pen.text(
                &tick.label,
                (x, bottom + 4.5),
                SMALL,
                MUTED,
                (HPos::Center, VPos::Top),
            );
        }
        for &at in &self.x.minor {
            let x = self.point((at, self.y.lo)).0;
            self.pen.line(&[(x, bottom), (x, bottom + 1.8)], AXIS, 0.4);
        }
        let mut widest = 0f64;
        for tick in &self.y.ticks {
            let y = self.point((self.x.lo, tick.at)).1;
            self.pen.line(&[(left - 2.5, y), (right, y)], GRID, 0.5);
            self.pen.text(
                &tick.label,
                (left - 4.0, y),
                SMALL,
                MUTED,
                (HPos::Right, VPos::Center),
            );
            widest = widest.max(text_width(&tick.label, SMALL));
        }
        for &at in &self.y.minor {
            let y = self.point((self.x.lo, at)).1;
            self.pen.line(&[(left - 1.8, y), (left, y)], AXIS, 0.4);
        }
        self.pen.line(&[(left, bottom), (right, bottom)], AXIS, 0.6);
        self.pen.line(&[(left, top), (left, bottom)], AXIS, 0.6);
        let middle = ((left + right) / 2.0, bottom + 14.5);
        self.pen.text(
            &self.x.label,
            middle,
            MEDIUM,
            INK,
            (HPos::Center, VPos::Top),
        );
        let side = (left - 7.5 - widest, (top + bottom) / 2.0);
        self.pen.upright(
            &self.y.label,
            side,
            MEDIUM,
            INK,
            (HPos::Center, VPos::Bottom),
        );
    }

    /// A second scale along the top, of the same length as the horizontal axis.
    pub fn top_axis(&self, axis: &Axis) {
        let Frame {
            left, top, right, ..
        } = self.frame;
        let place = |at: f64| left + (right - left) * (at - axis.lo) / (axis.hi - axis.lo);
        self.pen.line(&[(left, top), (right, top)], AXIS, 0.6);
        for tick in &axis.ticks {
            let x = place(tick.at);
            self.pen.line(&[(x, top - 2.5), (x, top)], AXIS, 0.5);
            self.pen.text(
                &tick.label,
                (x, top - 4.0),
                SMALL,
                MUTED,
                (HPos::Center, VPos::Bottom),
            );
        }
        let middle = ((left + right) / 2.0, top - 13.0);
        self.pen.text(
            &axis.label,
            middle,
            SMALL,
            MUTED,
            (HPos::Center, VPos::Bottom),
        );
    }

    /// The letter or heading of the panel, above its upper left corner.
    pub fn heading(&self, text: &str, left: f64, lift: f64) {
        let at = (left, self.frame.top - lift);
        self.pen
            .text(text, at, MEDIUM + 0.6, INK, (HPos::Left, VPos::Bottom));
    }

    /// A remark inside the panel, in its lower right or upper left corner.
    pub fn note(&self, text: &str, lower_right: bool) {
        let Frame {
            left,
            top,
            right,
            bottom,
        } = self.frame;
        let (at, anchor) = if lower_right {
            ((right - 2.0, bottom - 3.5), (HPos::Right, VPos::Bottom))
        } else {
            ((left + 3.5, top + 3.5), (HPos::Left, VPos::Top))
        };
        self.pen.text(text, at, SMALL, MUTED, anchor);
    }

    /// Axis positions to points of the figure.
    fn point(&self, at: (f64, f64)) -> (f64, f64) {
        let (x, y) = self.chart.backend_coord(&at);
        (f64::from(x) / UNITS, f64::from(y) / UNITS)
    }

    /// Data to axis positions, where they have any.
    fn positions(&self, data: &[(f64, f64)]) -> Vec<(f64, f64)> {
        data.iter()
            .filter_map(|&(x, y)| Some((self.x.at(x)?, self.y.at(y)?)))
            .collect()
    }

    /// Data to points of the figure.
    pub fn place(&self, (x, y): (f64, f64)) -> Option<(f64, f64)> {
        Some(self.point((self.x.at(x)?, self.y.at(y)?)))
    }

    /// A line through data.
    pub fn line(&mut self, data: &[(f64, f64)], colour: RGBAColor, width: f64) {
        let path = PathElement::new(self.positions(data), stroke(colour, width));
        self.chart.draw_series([path]).expect(DRAWN);
    }

    /// A dashed line through data.
    pub fn dashes(&self, data: &[(f64, f64)], colour: RGBAColor, width: f64) {
        let path: Vec<_> = data.iter().filter_map(|&at| self.place(at)).collect();
        self.pen.dashes(&path, colour, width);
    }

    /// The area between two lines.
    pub fn band(&mut self, lower: &[(f64, f64)], upper: &[(f64, f64)], colour: RGBAColor) {
        let mut ring = self.positions(lower);
        ring.extend(self.positions(upper).into_iter().rev());
        self.chart
            .draw_series([Polygon::new(ring, colour.filled())])
            .expect(DRAWN);
    }

    /// A filled rectangle between two corners.
    pub fn rectangle(&mut self, a: (f64, f64), b: (f64, f64), colour: RGBAColor) {
        if let [a, b] = self.positions(&[a, b])[..] {
            self.chart
                .draw_series([Rectangle::new([a, b], colour.filled())])
                .expect(DRAWN);
        }
    }

    /// One mark.
    pub fn mark(&self, at: (f64, f64), marker: Marker, radius: f64, colour: RGBAColor) {
        if let Some(at) = self.place(at) {
            marker.draw(self.pen, at, radius, colour);
        }
    }

    /// The outline of a mark.
    pub fn ring(&self, at: (f64, f64), marker: Marker, radius: f64, colour: RGBAColor) {
        if let Some(at) = self.place(at) {
            marker.ring(self.pen, at, radius, colour);
        }
    }
}
