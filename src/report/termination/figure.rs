//! Cost, or time, against the size of the tree: one curve a rule, one panel a scene.

use plotters::style::RGBAColor;
use plotters::style::text_anchor::{HPos, VPos};

use super::{Measure, Setting, best};
use crate::report::axis::{Axis, extent};
use crate::report::figure::{Figure, LEFT, Pen, WIDTH};
use crate::report::legend::{Key, LEGEND_LEADING, legend, legend_rows};
use crate::report::number::Z99;
use crate::report::palette::{INK, Look, Marker, faded};
use crate::report::panel::{Frame, Panel};
use crate::report::series::distinct;
use crate::report::text::{LEADING, MEDIUM, SMALL, caption_lines, fit};

/// Scenes side by side.
pub const COLUMNS: usize = 4;

/// Left edge of the first panel, and what lies between two of them.
const FIRST: f64 = 38.0;
const GAP: f64 = 18.0;
const DOWN: f64 = 118.0;
const ROW: f64 = 146.0;
/// Settings this many times as dear as the best are left out: they would flatten the rest.
const MOST: f64 = 4.0;

/// What one figure shows.
pub struct Drawn<'d> {
    /// The strategy of its trees.
    pub strategy: &'d str,
    /// Its scenes, at most [`COLUMNS`].
    pub scenes: &'d [&'d str],
    /// The settings of all scenes and strategies.
    pub settings: &'d [Setting<'d>],
    /// What the cells have in common, for the caption.
    pub provenance: String,
    /// Whether the run was a quick one.
    pub quick: bool,
}

impl Drawn<'_> {
    /// Cost of lines and of rays.
    pub fn costs(&self) -> Figure {
        let caption = format!(
            "Every mark is a tree of strategy {}, every curve a stop rule over a range of its parameter. Above: cost C of \
             isotropic lines, predicted from areas (curves) and counted (marks; bars: 99 % intervals). Below: cost of all \
             rays of the picture (eye, shadow and secondary; complete counts). Relative to the least of the scene, which is \
             ringed and named; {} {}",
            self.strategy,
            self.left_out([Measure::Predicted, Measure::Traced]),
            self.provenance
        );
        let title =
            "When should a node become a leaf? The metric's lines, and the rays of a picture";
        self.figure(
            title,
            caption,
            [
                (Measure::Predicted, "C of lines / least"),
                (Measure::Traced, "C of rays / least"),
            ],
        )
    }

    /// Seconds, where there are any.
    pub fn times(&self) -> Option<Figure> {
        best(Measure::Trace, self.settings)?;
        let caption = format!(
            "Every mark is a tree of strategy {}, every curve a stop rule over a range of its parameter. Above: seconds to \
             trace all rays of the picture, one thread. Below: to build the tree and trace them. Least times of short \
             stretches over interleaved rounds. Relative to the least of the scene, which is ringed and named; {} {}",
            self.strategy,
            self.left_out([Measure::Trace, Measure::Total]),
            self.provenance
        );
        let title = "When should a node become a leaf? The clock";
        Some(self.figure(
            title,
            caption,
            [
                (Measure::Trace, "tracing / least"),
                (Measure::Total, "building and tracing / least"),
            ],
        ))
    }

    fn of_scene(&self, scene: &str) -> impl Iterator<Item = &Setting<'_>> {
        let strategy = self.strategy;
        self.settings
            .iter()
            .filter(move |s| s.tree.cell.scene == scene && s.tree.cell.strategy == strategy)
    }

    /// Settings of a scene relative to the best of them.
    fn relative(&self, scene: &str, measure: Measure) -> Vec<(&Setting<'_>, f64)> {
        let Some((_, least)) = best(measure, self.of_scene(scene)) else {
            return Vec::new();
        };
        self.of_scene(scene)
            .filter_map(|setting| Some((setting, setting.value(measure)? / least)))
            .collect()
    }

    /// Those of them that are not too dear to be shown.
    fn shown(&self, scene: &str, measure: Measure) -> Vec<(&Setting<'_>, f64)> {
        let mut shown = self.relative(scene, measure);
        shown.retain(|&(_, ratio)| ratio <= MOST);
        shown
    }

    /// How many marks are too dear to be shown.
    fn left_out(&self, measures: [Measure; 2]) -> String {
        let dear = |&(_, ratio): &(&Setting, f64)| ratio > MOST;
        let number: usize = measures
            .iter()
            .flat_map(|&m| self.scenes.iter().map(move |scene| (m, *scene)))
            .map(|(m, scene)| self.relative(scene, m).into_iter().filter(dear).count())
            .sum();
        match number {
            0 => format!("no mark lies above {MOST}."),
            1 => format!("1 mark lies above {MOST} and is left out."),
            n => format!("{n} marks lie above {MOST} and are left out."),
        }
    }

    fn figure(&self, title: &str, caption: String, rows: [(Measure, &str); 2]) -> Figure {
        let caption = caption_lines(caption, WIDTH - 2.0 * LEFT, self.quick);
        let rules = distinct(self.settings.iter().map(|s| s.rule.as_str()));
        let keys: Vec<_> = rules
            .iter()
            .enumerate()
            .map(|(i, rule)| (Key::Mark(Look::of(i)), (*rule).to_owned()))
            .collect();
        let texts = keys.iter().map(|(_, text)| text.as_str());
        let lines = legend_rows(WIDTH - 2.0 * LEFT, texts);
        let top = 54.0 + LEGEND_LEADING * (lines - 1) as f64;
        let bottom = top + ROW + DOWN;
        let height = bottom + 36.0 + LEADING * (caption.len() - 1) as f64 + 6.0;
        let columns = self.scenes.len() as f64;
        let pitch = (WIDTH - LEFT - FIRST + GAP) / columns;
        let across = pitch - GAP;
        Figure::draw(title, (&caption, bottom + 36.0), WIDTH, height, |pen| {
            legend(pen, (LEFT, WIDTH - LEFT), 31.0, &keys);
            for (column, scene) in self.scenes.iter().enumerate() {
                let left = FIRST + pitch * column as f64;
                pen.text(
                    &fit(scene, MEDIUM, across),
                    (left, top - 4.0),
                    MEDIUM,
                    INK,
                    (HPos::Left, VPos::Bottom),
                );
                // Both panels of a scene have the same horizontal axis.
                let shown = rows
                    .iter()
                    .flat_map(|(measure, _)| self.shown(scene, *measure));
                let sizes = extent(shown.map(|(setting, _)| size(setting)));
                let (low, high) = sizes.unwrap_or((0.1, 10.0));
                for (row, (measure, label)) in rows.iter().enumerate() {
                    let top = top + ROW * row as f64;
                    let frame = Frame {
                        left,
                        top,
                        right: left + across,
                        bottom: top + DOWN,
                    };
                    let x_label = if row == 1 { "nodes per object" } else { "" };
                    let y_label = if column == 0 { *label } else { "" };
                    let x = Axis::log(x_label, low / 1.3, high * 1.3, 4);
                    let y = Axis::log(y_label, 0.93, 1.05 * self.most(*measure), 4);
                    self.panel(pen, frame, (scene, *measure), (x, y), &rules);
                }
            }
        })
    }

    /// The dearest setting that is shown, so that the panels of a row have one scale.
    fn most(&self, measure: Measure) -> f64 {
        let shown = self.scenes.iter().flat_map(|s| self.shown(s, measure));
        shown.map(|(_, ratio)| ratio).fold(1.2, f64::max)
    }

    fn panel(
        &self,
        pen: &Pen,
        frame: Frame,
        (scene, measure): (&str, Measure),
        (x, y): (Axis, Axis),
        rules: &[&str],
    ) {
        let shown = self.shown(scene, measure);
        let mut panel = Panel::new(pen, frame, x, y);
        let point = |&(setting, ratio): &(&Setting, f64)| (size(setting), ratio);
        for (i, rule) in rules.iter().enumerate() {
            let look = Look::of(i);
            let mut curve: Vec<_> = shown.iter().filter(|(s, _)| s.rule == *rule).collect();
            curve.sort_by(|a, b| size(a.0).total_cmp(&size(b.0)));
            let path: Vec<_> = curve.iter().map(|s| point(s)).collect();
            panel.line(&path, faded(look.colour, 0.6), 0.9);
            for &&(setting, ratio) in &curve {
                // Lines were counted besides: their marks stand where the count is.
                let counted = match measure {
                    Measure::Predicted => {
                        ratio * setting.tree.cell.c_counted / setting.tree.cell.c_predicted
                    }
                    _ => ratio,
                };
                let at = (size(setting), counted);
                if let (Measure::Predicted, Some(se)) = (measure, setting.tree.cell.c_se) {
                    let half = ratio * Z99 * se / setting.tree.cell.c_predicted;
                    let bar = [(at.0, counted - half), (at.0, counted + half)];
                    panel.line(&bar, faded(look.colour, 0.6), 0.7);
                }
                panel.mark(at, look.marker, 1.7, look.colour);
            }
        }
        let best = shown.iter().min_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((setting, ratio)) = best {
            let look = rules.iter().position(|rule| *rule == setting.rule);
            ring(
                &panel,
                (size(setting), *ratio),
                Look::of(look.unwrap_or_default()),
            );
            pen.text(
                &setting.tree.cell.stop,
                (frame.right - 1.5, frame.top + 3.0),
                SMALL,
                INK,
                (HPos::Right, VPos::Top),
            );
        }
    }
}

/// The mark of the best, in a ring.
fn ring(panel: &Panel, at: (f64, f64), look: Look) {
    const WHITE: RGBAColor = RGBAColor(255, 255, 255, 1.0);
    panel.mark(at, Marker::Disc, 4.4, INK);
    panel.mark(at, Marker::Disc, 3.6, WHITE);
    panel.mark(at, look.marker, 2.0, look.colour);
}

/// Nodes per object.
fn size(setting: &Setting) -> f64 {
    let cell = setting.tree.cell;
    (cell.inner_nodes + cell.leaves) as f64 / cell.objects as f64
}
