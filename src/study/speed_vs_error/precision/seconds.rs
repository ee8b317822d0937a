//! Seconds of a kernel: the sum of chunk minima over interleaved rounds, on one thread.

use std::hint::black_box;
use std::ops::Range;
use std::time::Instant;

use crate::geom::{Line, Ray, Real, Span};
use crate::kd::hits::nearest_in;
use crate::kd::{Mode, NoProbe, Planes, Stack, Work, traverse};
use crate::study::incidence::Subject;
use crate::study::records::PassTiming;
use crate::study::timing::{CHUNK, Minima, interleaved};

/// Most lines that are timed.
pub const TIMED: usize = 1 << 14;

/// What is timed: some lines, a chunk at a time.
pub struct Pass<'a> {
    /// Name of its row.
    what: String,
    /// Visits or rays in all.
    units: u64,
    lines: usize,
    run: Box<dyn FnMut(Range<usize>) + 'a>,
    best: Minima,
}

/// A kernel's two passes: every node that lines meet (a unit is a visit), and the nearest hits of rays from the same origins (a unit
/// is a ray).
pub fn passes<'a, M: Mode, T: Planes>(
    kernel: &str,
    offset: f64,
    subject: &Subject<'a, T>,
    lines: &'a [Line<T::Vector>],
) -> [Pass<'a>; 2] {
    let (tree, triangles) = (subject.tree, subject.triangles);
    let lines = &lines[..lines.len().min(TIMED)];
    let rays: Vec<Ray<T::Vector>> = lines
        .iter()
        .map(|line| Ray::new(*line, Span::from(T::Real::ZERO)))
        .collect();
    let endless = |_: &[u32], _: &mut _| T::Real::INFINITY;
    let mut work = Work::default();
    let mut stack = Stack::default();
    for line in lines {
        traverse::<M, T, _>(tree, line, Span::FULL, &mut stack, &mut work, endless);
    }
    let mut near = Stack::default();
    let visit = move |chunk: Range<usize>| {
        for line in &lines[chunk] {
            let endless = |_: &[u32], _: &mut NoProbe| T::Real::INFINITY;
            traverse::<M, T, _>(tree, line, Span::FULL, &mut stack, &mut NoProbe, endless);
        }
    };
    let trace = move |chunk: Range<usize>| {
        for ray in &rays[chunk] {
            let best = nearest_in::<M, T>(tree, triangles, ray, &mut near, NoProbe);
            black_box(best);
        }
    };
    let pass = |what: &str, units: u64, run: Box<dyn FnMut(Range<usize>) + 'a>| Pass {
        what: format!("{kernel} {what} {offset:e}"),
        units,
        lines: lines.len(),
        run,
        best: Minima::new(lines.len().div_ceil(CHUNK)),
    };
    [
        pass("visit", work.inner + work.leaves, Box::new(visit)),
        pass("ray", lines.len() as u64, Box::new(trace)),
    ]
}

/// Time all passes in rounds of a fresh random order. Gives rows without the names of their cell.
pub fn seconds(mut passes: Vec<Pass<'_>>, rounds: u32, seed: u64) -> Vec<PassTiming> {
    interleaved(&mut passes, rounds, seed, Pass::once, || ());
    let row = |pass: Pass<'_>| pass.best.row(pass.what, pass.units, rounds);
    passes.into_iter().map(row).collect()
}

impl Pass<'_> {
    /// Go once through the lines.
    fn once(&mut self, half: usize) {
        for chunk in 0..self.lines.div_ceil(CHUNK) {
            let started = Instant::now();
            (self.run)(chunk * CHUNK..(chunk * CHUNK + CHUNK).min(self.lines));
            self.best.note(half, chunk, started.elapsed().as_secs_f64());
        }
    }
}
