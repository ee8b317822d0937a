//! What a kernel's precision costs in time and in error: visits and hits held against the exact oracle.

mod judge;
mod numbers;
mod rate;
mod seconds;
mod verdicts;

use glam::DVec3;

use crate::geom::{Aabb, Line, Objects, Triangle};
use crate::kd::narrow::{NarrowTree, fitness, narrow_triangles, resolution};
use crate::kd::{Counting, Mode, Planes, Tracing, Tree, build};
use crate::rays::SurfaceLines;
use crate::study::Watcher;
use crate::study::identity::line_seed;
use crate::study::kernel::Kernel;
use crate::study::records::{PassTiming, PrecisionRecord};

use super::asked::Precision;
use super::{Found, Piece};
use judge::{Judged, judge};
use numbers::{Exact, Subject};
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

/// Measure a scene.
///
/// # Errors
/// If it has other objects than triangles, the only ones with a test in f32.
pub fn measure(
    asked: &Precision,
    piece: &Piece<'_>,
    watcher: &impl Watcher,
) -> Result<Found, String> {
    narrow_triangles(&Objects {
        triangles: Vec::new(),
        ..piece.scene.objects.clone()
    })
    .map_err(|refusal| refusal.to_string())?;
    let mut found = Found::default();
    for &offset in &asked.offsets {
        let place = Place::new(asked, piece, offset);
        place.measure(watcher, &mut found);
    }
    Ok(found)
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
        let wide = Subject {
            tree: &self.tree,
            boxes: &self.tree.boxes,
            triangles: &self.objects.triangles,
        };
        let wide_lines = wide.random(&self.lines, self.asked.lines);
        // Beyond the range of f32 there is nothing to measure.
        let narrow = NarrowTree::however_coarse(&self.tree)
            .and_then(|tree| Ok((tree, narrow_triangles(&self.objects)?)))
            .ok();
        let narrow = narrow.as_ref().map(|(tree, triangles)| Subject {
            tree,
            boxes: &tree.boxes,
            triangles,
        });
        let narrow_lines = narrow
            .as_ref()
            .map(|s| s.random(&self.lines, self.asked.lines));
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
                    .push(self.row(kernel, "random", &Judged::default(), 0, &[])),
            }
            watcher.done(2 * self.asked.lines);
        }
        let rows = seconds(timed, self.asked.rounds, self.piece.seed);
        found.timings.extend(rows.into_iter().map(|row| PassTiming {
            cell: self.piece.id.clone(),
            scene: self.piece.scene.name.clone(),
            strategy: self.piece.rules.strategy.name(),
            stop: self.piece.rules.stop.to_string(),
            ..row
        }));
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
        let inside = |p: f64| 0.0 < p && p < 1.0;
        // The weighted slope as a mean over lines: a visit adds w p / sum of w p^2 with w = 1/(p (1 - p)).
        let total: f64 = p
            .iter()
            .filter(|p| inside(**p))
            .map(|p| p / (1.0 - p))
            .sum();
        let add = |&p: &f64| {
            if inside(p) {
                1.0 / (1.0 - p) / total
            } else {
                0.0
            }
        };
        let score: Vec<f64> = p.iter().map(add).collect();
        let refused = kernel != Kernel::F64 && fitness(&self.tree.world).is_err();
        let (lines, enough) = if refused {
            let few = &lines[..OF_REFUSED.min(lines.len())];
            let visits: u64 = judge::<M, T>(subject, few, 0, &score).hits.iter().sum();
            let affordable = MOST_VISITS * few.len() as f64 / visits.max(1) as f64;
            let most = (affordable as usize).clamp(few.len(), lines.len());
            (&lines[..most], few.len())
        } else {
            (lines, lines.len())
        };
        let aimed = subject.aimed(lines, self.lines.seed);
        for (family, lines) in [("random", lines), ("aimed", &aimed)] {
            let judged = judge::<M, T>(subject, lines, enough, &score);
            found
                .precision
                .push(self.row(kernel, family, &judged, lines.len() as u64, &p));
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
        judged: &Judged,
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
        let mean = judged.scores[0] / n;
        let variance = (judged.scores[1] / n - mean * mean) / (n - 1.0);
        let by_area = family == "random" && lines > 1;
        let [visits, hits] = [&judged.visits, &judged.tests].map(Rate::of);
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
            visits: judged.visits.judged,
            wrong_visits: judged.visits.wrong,
            missed_visits: judged.visits.missed,
            tied_visits: judged.visits.tied(),
            tied_missed_visits: judged.visits.tied_missed,
            visits_per_1e9: visits.map(|r| r.rate),
            visits_per_1e9_lo: visits.map(|r| r.lo),
            visits_per_1e9_hi: visits.map(|r| r.hi),
            tests: judged.tests.judged,
            wrong_hits: judged.tests.wrong,
            missed_hits: judged.tests.missed,
            tied_hits: judged.tests.tied(),
            hits_per_1e9: hits.map(|r| r.rate),
            hits_per_1e9_lo: hits.map(|r| r.lo),
            hits_per_1e9_hi: hits.map(|r| r.hi),
            slope_error: by_area.then_some(mean - 1.0),
            slope_se: by_area.then(|| variance.max(0.0).sqrt()),
            max_z: by_area.then(|| largest_z(&judged.hits, p, n)).flatten(),
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
