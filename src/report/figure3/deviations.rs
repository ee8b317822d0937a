//! Panel (c): how many standard deviations each node is off, and the histogram of that.

use plotters::style::text_anchor::{HPos, VPos};

use super::{BAND, BOTTOM, Data, EDGE, LEAST_EXPECTED, TOP, samples};
use crate::report::axis::{Axis, extent};
use crate::report::figure::Pen;
use crate::report::palette::{BLUE, INK, MUTED, faded};
use crate::report::panel::{Frame, Panel};
use crate::report::text::SMALL;

impl Data<'_> {
    /// Panel (c) and the histogram beside it.
    pub(super) fn deviations(&self, pen: &Pen) {
        let judged = self.judged().count();
        // A histogram of a few nodes would say nothing.
        let histogram = judged >= 50;
        let frame = Frame {
            left: 366.0,
            top: TOP,
            right: if histogram { 466.0 } else { EDGE },
            bottom: BOTTOM,
        };
        let areas = extent(self.judged().map(|(node, _)| node.area));
        let (low, high) = areas.unwrap_or((0.1 * self.root_area, self.root_area));
        let highest = self
            .judged()
            .map(|(_, z)| z.abs())
            .fold(self.joint + 0.5, f64::max);
        let x = Axis::log("SA(K), scene units²", low / 1.6, high * 1.6, 4);
        let y = Axis::linear(
            "z (standard deviations from N p)",
            -1.08 * highest,
            1.08 * highest,
            6,
        );
        let mut panel = Panel::new(pen, frame, x, y);
        let limits = |z: f64| -> Vec<_> {
            let inside = samples(&panel.x).filter(|&area| self.expected(area) >= LEAST_EXPECTED);
            inside
                .map(|area| (area, limit(z, self.expected(area) / self.lines, self.lines)))
                .collect()
        };
        let [lower, upper, below, above] = [-1.96, 1.96, -self.joint, self.joint].map(limits);
        panel.band(&lower, &upper, BAND);
        self.cloud(
            pen,
            &panel,
            self.judged().map(|(node, z)| (node, node.area, z)),
        );
        panel.line(
            &[(panel.x.value(0.0), 0.0), (panel.x.value(1.0), 0.0)],
            INK,
            0.7,
        );
        for edge in [&lower, &upper] {
            // The band's edges again: a dense cloud hides the band.
            panel.line(edge, faded(INK, 0.55), 0.45);
        }
        panel.dashes(&below, INK, 0.7);
        panel.dashes(&above, INK, 0.7);
        self.finish(&panel, "(c)");
        if histogram {
            self.histogram(pen, &panel);
        }
        if judged == 0 {
            let besides_root = self.nodes.iter().any(|node| node.z.is_some());
            panel.note(
                if besides_root {
                    "no node with N p ≥ 10"
                } else {
                    "no node but the root to judge"
                },
                false,
            );
        }
    }

    /// z of the same nodes, turned to stand beside panel (c), with the standard normal density.
    fn histogram(&self, pen: &Pen, panel: &Panel) {
        let Frame { right, bottom, .. } = panel.frame;
        let (base, end) = (right + 6.0, EDGE);
        let z: Vec<f64> = self.judged().map(|(_, z)| z).collect();
        // A quarter where it fits, coarser when z runs far out.
        let step = ((panel.y.hi - panel.y.lo) / 40.0).max(0.25);
        let first = (panel.y.lo / step).floor() as i64;
        let mut bins = vec![0u32; ((panel.y.hi / step).ceil() as i64 - first + 1) as usize];
        for value in &z {
            bins[((value / step).floor() as i64 - first) as usize] += 1;
        }
        let normal = |z: f64| (-0.5 * z * z).exp() / std::f64::consts::TAU.sqrt();
        let share = |count: u32| f64::from(count) / (z.len().max(1) as f64 * step);
        let highest = bins
            .iter()
            .map(|&count| share(count))
            .fold(normal(0.0), f64::max);
        let across = |density: f64| base + (end - base) * density / highest;
        let height = |z: f64| {
            panel
                .place((panel.x.value(0.0), z))
                .map_or(bottom, |(_, y)| y)
        };
        let mut steps = vec![(base, bottom)];
        for (i, &count) in bins.iter().enumerate() {
            let low = (i as i64 + first) as f64 * step;
            steps.extend([low, low + step].map(|z| (across(share(count)), height(z))));
        }
        steps.push((base, height(panel.y.hi)));
        pen.polygon(&steps, faded(BLUE, 0.35));
        let curve: Vec<_> = (0..=120)
            .map(|i| panel.y.value(f64::from(i) / 120.0))
            .collect();
        let curve: Vec<_> = curve
            .into_iter()
            .map(|z| (across(normal(z)), height(z)))
            .collect();
        pen.line(&curve, INK, 0.7);
        let middle = (base + end) / 2.0;
        pen.text(
            "density",
            (middle, bottom + 4.5),
            SMALL,
            MUTED,
            (HPos::Center, VPos::Top),
        );
        pen.text(
            "of z",
            (middle, bottom + 14.5),
            SMALL,
            MUTED,
            (HPos::Center, VPos::Top),
        );
    }
}

/// The z that a node of hit probability `p` exceeds as often as a normal one exceeds `z` (Cornish-Fisher, third order).
fn limit(z: f64, p: f64, lines: f64) -> f64 {
    let variance = lines * p * (1.0 - p);
    let skew = (1.0 - 2.0 * p) / variance.sqrt();
    let kurtosis = (1.0 - 6.0 * p * (1.0 - p)) / variance;
    z + skew * (z * z - 1.0) / 6.0 + kurtosis * (z * z * z - 3.0 * z) / 24.0
        - skew * skew * (2.0 * z * z * z - 5.0 * z) / 36.0
}
