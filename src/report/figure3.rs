//! Hits against surface area for every node of one tree, after Figure 3 of MacDonald and Booth (1990).
//!
//! Theory: hits are binomial with N lines and p = SA(K)/SA(R), so they lie on the straight line N p with a known
//! scatter. Panel (a) has the paper's linear axes, (b) shows the small nodes, (c) the deviation in standard deviations.

mod deviations;

use plotters::style::RGBAColor;
use statrs::distribution::{Binomial, ContinuousCDF, DiscreteCDF, Normal};

use super::ReportError;
use super::axis::{Axis, extent};
use super::density::Density;
use super::figure::{Figure, LEFT, Pen, WIDTH};
use super::legend::{Key, legend};
use super::number::{Z99, counted, decimals_for, fixed, grouped, significant};
use super::palette::{BLUE, INK, Look, Marker, SKY, VERMILLION, faded};
use super::panel::{Frame, Panel};
use super::text::{LEADING, caption_lines};
use crate::study::records::{CellRecord, NodeRecord};

/// Above this many nodes a density is drawn, not every node.
pub const MOST_MARKS: usize = 5_000;

/// z of nodes with fewer hits (or misses) expected is not shown: it is far from normal.
const LEAST_EXPECTED: f64 = 10.0;

const TITLE: &str = "Does a node's surface area tell how many lines hit it?";
/// Right edge of the panels.
const EDGE: f64 = WIDTH - LEFT;
const LEGEND: f64 = 31.0;
const TOP: f64 = 63.0;
const BOTTOM: f64 = 207.0;
const CAPTION: f64 = BOTTOM + 35.0;
/// The 95 % band.
const BAND: RGBAColor = faded(SKY, 0.32);
const INNER: Look = Look {
    colour: BLUE,
    marker: Marker::Disc,
};
const LEAF: Look = Look {
    colour: VERMILLION,
    marker: Marker::Up,
};

/// The figure of one cell and all its nodes.
pub fn figure(cell: &CellRecord, nodes: &[NodeRecord], quick: bool) -> Result<Figure, ReportError> {
    let data = Data::new(cell, nodes)?;
    let caption = caption_lines(data.caption(), WIDTH - 2.0 * LEFT, quick);
    let height = CAPTION + LEADING * (caption.len() - 1) as f64 + 6.0;
    Ok(Figure::draw(
        TITLE,
        (&caption, CAPTION),
        WIDTH,
        height,
        |pen| {
            let last_row = legend(pen, (LEFT, EDGE), LEGEND, &data.keys());
            debug_assert!(last_row <= LEGEND, "the legend fits one row");
            data.linear(pen);
            data.log(pen);
            data.deviations(pen);
        },
    ))
}

struct Data<'r> {
    cell: &'r CellRecord,
    nodes: &'r [NodeRecord],
    lines: f64,
    root_area: f64,
    /// Limit on |z| that a correct program exceeds at some node with probability 5 % at most (Bonferroni).
    joint: f64,
}

impl<'r> Data<'r> {
    fn new(cell: &'r CellRecord, nodes: &'r [NodeRecord]) -> Result<Self, ReportError> {
        let empty = |what: &str| ReportError::Empty {
            what: format!("cell {}: {what}", cell.cell),
        };
        let largest = nodes.iter().max_by(|a, b| a.p.total_cmp(&b.p));
        let largest = largest.ok_or_else(|| empty("no nodes to draw"))?;
        if !(largest.p > 0.0 && largest.area > 0.0) {
            return Err(empty("no node has an area"));
        }
        let tested = nodes.iter().filter(|node| node.z.is_some()).count().max(1);
        Ok(Data {
            cell,
            nodes,
            lines: cell.lines as f64,
            root_area: largest.area / largest.p,
            joint: Normal::standard().inverse_cdf(1.0 - 0.025 / tested as f64),
        })
    }

    /// Where every node cannot be drawn: the count with the last colour, 1 % of the nodes. (In (a) nearly all of them
    /// share the corner; a scale up to that count would leave the other panels dark.)
    fn density_top(&self) -> Option<u64> {
        (self.nodes.len() > MOST_MARKS).then_some(self.nodes.len() as u64 / 100)
    }

    /// Nodes whose z is near enough to normal to be looked at.
    fn judged(&self) -> impl Iterator<Item = (&'r NodeRecord, f64)> {
        let least = self.lines.recip() * LEAST_EXPECTED;
        let near_normal = move |node: &NodeRecord| node.p >= least && 1.0 - node.p >= least;
        self.nodes
            .iter()
            .filter_map(move |node| Some((node, node.z?)).filter(|_| near_normal(node)))
    }

    fn probability_axis(&self, area: &Axis) -> Axis {
        let (lo, hi) = (
            area.value(0.0) / self.root_area,
            area.value(1.0) / self.root_area,
        );
        let label = "p = SA(K) / SA(R)";
        if area.log {
            Axis::log(label, lo, hi, 4)
        } else {
            Axis::linear(label, lo, hi, 2)
        }
    }

    /// Draws marks or a density.
    fn cloud<'n>(
        &self,
        pen: &Pen,
        panel: &Panel,
        data: impl Iterator<Item = (&'n NodeRecord, f64, f64)>,
    ) {
        if let Some(most) = self.density_top() {
            Density::new(data.filter_map(|(_, x, y)| panel.place((x, y)))).draw(pen, most);
            return;
        }
        let (radius, alpha) = if self.nodes.len() > 150 {
            (1.6, 0.45)
        } else {
            (2.2, 0.75)
        };
        for (node, x, y) in data {
            let look = if node.kind == "leaf" { LEAF } else { INNER };
            panel.mark((x, y), look.marker, radius, faded(look.colour, alpha));
        }
    }

    /// Panel (a).
    fn linear(&self, pen: &Pen) {
        let frame = Frame {
            left: 41.0,
            top: TOP,
            right: 163.0,
            bottom: BOTTOM,
        };
        let most = self
            .nodes
            .iter()
            .map(|node| node.hits as f64)
            .fold(self.lines, f64::max);
        let x = Axis::linear(
            "surface area SA(K), scene units²",
            0.0,
            1.04 * self.root_area,
            4,
        );
        let y = Axis::linear("lines that hit the node", 0.0, 1.04 * most, 4);
        let mut panel = Panel::new(pen, frame, x, y);
        self.theory_band(&mut panel);
        self.cloud(
            pen,
            &panel,
            self.nodes
                .iter()
                .map(|node| (node, node.area, node.hits as f64)),
        );
        panel.line(&[(0.0, 0.0), (self.root_area, self.lines)], INK, 0.7);
        self.finish(&panel, "(a)");
    }

    /// Panel (b).
    fn log(&self, pen: &Pen) {
        let frame = Frame {
            left: 208.0,
            top: TOP,
            right: 330.0,
            bottom: BOTTOM,
        };
        let hit = || {
            self.nodes
                .iter()
                .filter(|node| node.hits > 0 && node.area > 0.0)
        };
        let (low, high) =
            extent(hit().map(|node| node.area)).unwrap_or((self.root_area, self.root_area));
        let (fewest, most) =
            extent(hit().map(|node| node.hits as f64)).unwrap_or((1.0, self.lines));
        let x = Axis::log("surface area SA(K), scene units²", low / 1.6, high * 1.6, 4);
        let y = Axis::log(
            "lines that hit the node",
            fewest / 1.6,
            most.max(self.lines) * 1.6,
            7,
        );
        let mut panel = Panel::new(pen, frame, x, y);
        self.theory_band(&mut panel);
        self.cloud(
            pen,
            &panel,
            hit().map(|node| (node, node.area, node.hits as f64)),
        );
        // The line from where it enters the panel.
        let start = panel
            .x
            .value(0.0)
            .max(panel.y.value(0.0) / self.lines * self.root_area);
        panel.line(
            &[(start, self.expected(start)), (self.root_area, self.lines)],
            INK,
            0.7,
        );
        self.finish(&panel, "(b)");
    }

    fn expected(&self, area: f64) -> f64 {
        self.lines * (area / self.root_area).min(1.0)
    }

    /// The central 95 % of the binomial law, exact, at every area.
    fn theory_band(&self, panel: &mut Panel) {
        let areas = samples(&panel.x).filter(|&area| area <= self.root_area);
        let limits = areas.filter_map(|area| {
            let law = Binomial::new((area / self.root_area).min(1.0), self.cell.lines).ok()?;
            let quantile = |share| quantile(&law, self.cell.lines, share) as f64;
            // Zero hits have no place on a log axis: the band then reaches the panel's edge.
            let floor = panel.y.value(0.0);
            Some((
                (area, quantile(0.025).max(floor)),
                (area, quantile(0.975).max(floor)),
            ))
        });
        let (lower, upper): (Vec<_>, Vec<_>) = limits.unzip();
        panel.band(&lower, &upper, BAND);
    }

    fn finish(&self, panel: &Panel, letter: &str) {
        panel.top_axis(&self.probability_axis(&panel.x));
        panel.heading(letter, panel.frame.left - 33.0, 13.0);
    }

    fn keys(&self) -> Vec<(Key, String)> {
        let mut keys = match self.density_top() {
            Some(most) => vec![(Key::Density(most), "nodes per square".to_owned())],
            None => vec![
                (Key::Mark(INNER), "inner node".to_owned()),
                (Key::Mark(LEAF), "leaf".to_owned()),
            ],
        };
        keys.push((Key::Line(INK), "theory: N p".to_owned()));
        keys.push((
            Key::Area(BAND),
            "95 % of a node's hits (binomial)".to_owned(),
        ));
        keys.push((Key::Dashes(INK), "95 % limit, all nodes".to_owned()));
        keys
    }

    fn caption(&self) -> String {
        let cell = self.cell;
        let mut text = format!(
            "{} ({}), strategy {}, stop {}, seed {}: {} ({} inner, {}), N\u{a0}=\u{a0}{} lines.",
            cell.scene,
            counted(cell.objects, "object"),
            cell.strategy,
            cell.stop,
            cell.seed,
            counted(self.nodes.len() as u64, "node"),
            grouped(cell.inner_nodes),
            if cell.leaves == 1 {
                "1 leaf".to_owned()
            } else {
                format!("{} leaves", grouped(cell.leaves))
            },
            grouped(cell.lines),
        );
        if let (Some(slope), Some(se)) = (cell.slope, cell.slope_se) {
            let half = Z99 * se;
            let digits = decimals_for(half);
            text += &format!(
                " Slope {}\u{a0}±\u{a0}{} (99\u{a0}% interval, weights 1/(p(1\u{a0}−\u{a0}p))).",
                fixed(slope, digits),
                fixed(half, digits)
            );
        }
        if let (Some(found), Some(expected)) = (cell.unexplained, cell.unexplained_expected) {
            text += &format!(
                " 1\u{a0}−\u{a0}R²\u{a0}=\u{a0}{}, chance alone gives {}.",
                significant(found, 2),
                significant(expected, 2)
            );
        }
        if let Some(z) = cell.max_abs_z {
            text += &format!(
                " Largest |z| {} (nodes with N p ≥ {LEAST_EXPECTED}).",
                fixed(z, 1)
            );
        }
        let unhit = self
            .nodes
            .iter()
            .filter(|node| node.hits == 0 && node.area > 0.0)
            .count();
        let flat = self.nodes.iter().filter(|node| node.area <= 0.0).count();
        let unjudged =
            self.nodes.iter().filter(|node| node.z.is_some()).count() - self.judged().count();
        let left_out = [
            (
                unhit,
                format!("in (b) {} without a hit", counted(unhit as u64, "node")),
            ),
            (
                flat,
                format!(
                    "in (b) and (c) {} without area",
                    counted(flat as u64, "node")
                ),
            ),
            (
                unjudged,
                format!(
                    "in (c) {} with N p < {LEAST_EXPECTED}",
                    counted(unjudged as u64, "node")
                ),
            ),
        ];
        let left_out: Vec<_> = left_out
            .into_iter()
            .filter(|(count, _)| *count > 0)
            .map(|(_, text)| text)
            .collect();
        if !left_out.is_empty() {
            text.push_str(&format!(" Not shown: {}.", left_out.join("; ")));
        }
        text
    }
}

/// Values along an axis, close enough together for a smooth curve.
fn samples(axis: &Axis) -> impl Iterator<Item = f64> {
    (0..=160).map(|i| axis.value(f64::from(i) / 160.0))
}

/// The least number of hits that the law stays at or below with probability `share`.
///
/// By bisection: statrs' own inverse panics on some of these laws.
pub(super) fn quantile(law: &Binomial, lines: u64, share: f64) -> u64 {
    let (mut low, mut high) = (0, lines);
    while low < high {
        let middle = low + (high - low) / 2;
        if law.cdf(middle) >= share {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    low
}
