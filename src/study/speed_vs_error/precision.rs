//! What a kernel's precision costs in time and in error: visits and hits held against the exact oracle.

mod count;
mod rate;
mod seconds;
mod verdicts;

use glam::DVec3;

use crate::geom::{Aabb, Line, Objects, Triangle};
use crate::kd::narrow::{NarrowTree, fitness, resolution};
use crate::kd::{Counting, Mode, Planes, Tracing, Tree, build};
use crate::rays::SurfaceLines;
use crate::study::Watcher;
use crate::study::hits::scores::weighted_slope;
use crate::study::identity::line_seed;
use crate::study::incidence::{Against, Aim, Exact, Narrow, Subject};
use crate::study::kernel::Kernel;
use crate::study::records::PrecisionRecord;

use super::asked::Precision;
use super::{Found, Piece};
use count::{Counted, count};
use rate::Rate;
use seconds::{Pass, passes, seconds};
pub use verdicts::verdicts;

/// Fewest lines expected to hit, and to miss, a node that `max_z` looks at: below, z is far from normal.
const FEWEST: f64 = 25.0;

/// Lines that are judged and timed where the tree is refused: most often it has collapsed, nearly every comparison is a tie, and lines visit it
/// in large part.
const OF_REFUSED: usize = 1 << 6;

/// Visits of such a tree that its slope takes, if fewer than of all lines.
const MOST_VISITS: f64 = (1u64 << 25) as f64;

/// Units of progress of a scene: lines judged.
pub fn units(asked: &Precision) -> u64 {
    2 * asked.lines * asked.kernels.len() as u64 * asked.offsets.len() as u64
}

/// Measure a scene, of triangles alone, as the plan has it.
pub fn measure(asked: &Precision, piece: &Piece<'_>, watcher: &impl Watcher) -> Found {
    let mut found = Found::default();
    for &offset in &asked.offsets {
        let place = Place::new(asked, piece, offset);
        place.measure(watcher, &mut found);
    }
    found
}

/// A scene that was moved, and its tree.
struct Place<'a> {
    asked: &'a Precision,
    piece: &'a Piece<'a>,
    offset: f64,
    objects: Objects,
    tree: Tree,
    lines: SurfaceLines,
}

impl<'a> Place<'a> {
    fn new(asked: &'a Precision, piece: &'a Piece<'a>, offset: f64) -> Self {
        let scene = piece.scene;
        let by = DVec3::splat(offset * scene.world.extent().max_element());
        let moved = |t: &Triangle| Triangle(t.0.map(|p| p + by));
        let triangles: Vec<Triangle> = scene.objects.triangles.iter().map(moved).collect();
        let bounds: Vec<Aabb> = triangles.iter().map(Triangle::bounds).collect();
        let world = bounds.iter().fold(Aabb::EMPTY, |w, b| w.union(*b));
        Self {
            asked,
            piece,
            offset,
            objects: Objects {
                triangles,
                ..Objects::default()
            },
            tree: build(&bounds, world, &piece.rules),
            lines: SurfaceLines {
                world,
                seed: line_seed(piece.seed, &format!("precision of {}", scene.name)),
            },
        }
    }

    /// The rows of every kernel.
    fn measure(&self, watcher: &impl Watcher, found: &mut Found) {
        let wide = Subject::new(&self.tree, &self.objects.triangles);
        let wide_lines = self.random(&wide);
        // Beyond the range of f32 there is nothing to measure.
        let narrow = NarrowTree::however_coarse(&self.tree).ok();
        let narrow = narrow.map(|tree| Narrow::new(tree, &self.objects.triangles));
        let narrow = narrow.as_ref().map(Narrow::subject);
        let narrow_lines = narrow.as_ref().map(|subject| self.random(subject));
        let mut timed: Vec<Pass<'_>> = Vec::new();
        for &kernel in &self.asked.kernels {
            match (kernel, &narrow, &narrow_lines) {
                (Kernel::F64, _, _) => {
                    self.add::<Counting, _>(kernel, &wide, &wide_lines, found, &mut timed);
                }
                (Kernel::F32, Some(narrow), Some(lines)) => {
                    self.add::<Counting, _>(kernel, narrow, lines, found, &mut timed);
                }
                (Kernel::F32Padded, Some(narrow), Some(lines)) => {
                    self.add::<Tracing, _>(kernel, narrow, lines, found, &mut timed);
                }
                _ => found
                    .precision
                    .push(self.row(kernel, "random", &Counted::default(), 0, &[])),
            }
            watcher.done(2 * self.asked.lines);
        }
        let rows = seconds(timed, self.asked.rounds, self.piece.seed);
        let named = rows.into_iter().map(|row| self.piece.named(row));
        found.timings.extend(named);
    }

    fn aim<'b, T: Planes>(&self, subject: &'b Subject<'b, T>) -> Aim<'b, T> {
        let lines = self.lines;
        Aim { subject, lines }
    }

    /// The metric's lines.
    fn random<T: Planes<Vector: Exact>>(&self, subject: &Subject<'_, T>) -> Vec<Line<T::Vector>> {
        let aim = self.aim(subject);
        aim.drawn(0..self.asked.lines).collect()
    }

    /// The rows of one kernel, and what is to be timed of it.
    fn add<'b, M: Mode, T: Planes<Vector: Exact + Sync> + Sync>(
        &self,
        kernel: Kernel,
        subject: &Subject<'b, T>,
        lines: &'b [Line<T::Vector>],
        found: &mut Found,
        timed: &mut Vec<Pass<'b>>,
    ) {
        let root = subject.boxes[0].surface_area();
        let p: Vec<f64> = subject
            .boxes
            .iter()
            .map(|b| b.surface_area() / root)
            .collect();
        let score = weighted_slope(&p);
        let refused = kernel != Kernel::F64 && fitness(&self.tree.world).is_err();
        let (lines, enough) = if refused {
            let few = &lines[..OF_REFUSED.min(lines.len())];
            let visits: u64 = count::<M, T>(subject, few, 0, &score).hits.iter().sum();
            let affordable = MOST_VISITS * few.len() as f64 / visits.max(1) as f64;
            let most = (affordable as usize).clamp(few.len(), lines.len());
            (&lines[..most], few.len())
        } else {
            (lines, lines.len())
        };
        let aim = self.aim(subject);
        let at = |i: u64| [Against::Box, Against::Triangle][(i % 2) as usize];
        let aimed: Vec<_> = aim.aimed(0..lines.len() as u64, at).collect();
        for (family, lines) in [("random", lines), ("aimed", &aimed)] {
            let counted = count::<M, T>(subject, lines, enough, &score);
            found
                .precision
                .push(self.row(kernel, family, &counted, lines.len() as u64, &p));
        }
        timed.extend(passes::<M, T>(
            kernel.name(),
            self.offset,
            subject,
            &lines[..enough.min(lines.len())],
        ));
    }

    fn row(
        &self,
        kernel: Kernel,
        family: &str,
        counted: &Counted,
        lines: u64,
        p: &[f64],
    ) -> PrecisionRecord {
        let resolution = (kernel != Kernel::F64).then(|| resolution(&self.tree.world));
        let verdict = match (kernel, fitness(&self.tree.world)) {
            (Kernel::F64, _) | (_, Ok(None)) => "clean",
            (_, Ok(Some(_))) => "warned",
            (_, Err(_)) => "refused",
        };
        let n = lines as f64;
        let mean = counted.scores[0] / n;
        let variance = (counted.scores[1] / n - mean * mean) / (n - 1.0);
        let by_area = family == "random" && lines > 1;
        let Counted {
            nodes, triangles, ..
        } = counted;
        let visits = Rate::of(nodes, nodes.hits);
        let hits = Rate::of(triangles, triangles.cases);
        PrecisionRecord {
            cell: self.piece.id.clone(),
            scene: self.piece.scene.name.clone(),
            strategy: self.piece.rules.strategy.name(),
            offset: self.offset,
            kernel: kernel.name().into(),
            family: family.into(),
            verdict: verdict.into(),
            resolution,
            lines,
            visits: nodes.hits,
            wrong_visits: nodes.wrong,
            missed_visits: nodes.missed,
            tied_visits: nodes.tied_errors(),
            tied_missed_visits: nodes.tied_missed,
            visits_per_1e9: visits.map(|r| r.rate),
            visits_per_1e9_lo: visits.map(|r| r.lo),
            visits_per_1e9_hi: visits.map(|r| r.hi),
            tests: triangles.cases,
            wrong_hits: triangles.wrong,
            missed_hits: triangles.missed,
            tied_hits: triangles.tied_errors(),
            hits_per_1e9: hits.map(|r| r.rate),
            hits_per_1e9_lo: hits.map(|r| r.lo),
            hits_per_1e9_hi: hits.map(|r| r.hi),
            slope_error: by_area.then_some(mean - 1.0),
            slope_se: by_area.then(|| variance.max(0.0).sqrt()),
            max_z: by_area.then(|| largest_z(&counted.hits, p, n)).flatten(),
            flat_nodes: p.iter().filter(|p| **p == 0.0).count() as u64,
        }
    }
}

/// The largest |z| of a node that enough lines are expected to hit and to miss.
fn largest_z(hits: &[u64], p: &[f64], n: f64) -> Option<f64> {
    let nodes = hits.iter().zip(p);
    let judged = nodes.filter(|(_, p)| n * **p >= FEWEST && n * (1.0 - **p) >= FEWEST);
    let z = judged.map(|(&h, p)| (h as f64 - n * p).abs() / (n * p * (1.0 - p)).sqrt());
    z.reduce(f64::max)
}

#[cfg(test)]
mod tests;
