//! Seconds of every way, and of building what it needs: all of a scene interleaved, of each chunk the least time.

use std::hint::black_box;
use std::ops::Range;
use std::time::Instant;

use crate::geom::{Targets, Vector};
use crate::kd::{NoProbe, Stack, Walk};
use crate::study::records::PassTiming;
use crate::study::timing::{Minima, interleaved};

use super::trail::Set;
use super::way::Task;

/// Something that is timed chunk by chunk.
pub struct Pass<'a> {
    /// Name of its row.
    what: String,
    chunks: Vec<Range<usize>>,
    /// Does a chunk; gives its seconds.
    run: Box<dyn FnMut(Range<usize>) -> f64 + 'a>,
    best: Minima,
}

impl<'a> Pass<'a> {
    /// These chunks; `run` does one and gives its seconds.
    pub fn new(
        what: String,
        chunks: Vec<Range<usize>>,
        run: impl FnMut(Range<usize>) -> f64 + 'a,
    ) -> Self {
        Self {
            what,
            best: Minima::new(chunks.len()),
            chunks,
            run: Box::new(run),
        }
    }

    /// One thing that is built; to let it go takes no time of it.
    pub fn build<T>(what: String, build: impl Fn() -> T + 'a) -> Self {
        Self::new(what, std::iter::once(0..1).collect(), move |_| {
            let started = Instant::now();
            let built = build();
            let took = started.elapsed().as_secs_f64();
            drop(black_box(built));
            took
        })
    }

    fn once(&mut self, half: usize) {
        for (number, chunk) in self.chunks.iter().enumerate() {
            self.best.note(half, number, (self.run)(chunk.clone()));
        }
    }
}

/// Time all of these in rounds of a fresh random order, on this thread. Gives rows without the names of their cell.
pub fn seconds(
    mut passes: Vec<Pass<'_>>,
    rounds: u32,
    seed: u64,
    tick: impl FnMut(),
) -> Vec<PassTiming> {
    interleaved(&mut passes, rounds, seed, Pass::once, tick);
    let row = |pass: Pass<'_>| {
        let units: usize = pass.chunks.iter().map(ExactSizeIterator::len).sum();
        pass.best.row(pass.what, units as u64, rounds)
    };
    passes.into_iter().map(row).collect()
}

/// Take a chunk of rays along a way; gives its seconds.
pub struct Trace<'a, 's, V: Vector, O: ?Sized> {
    /// The rays of the chunk.
    pub set: Set<'a, V, O>,
    /// For the way that has one.
    pub stack: &'s mut Stack<V::Real>,
}

impl<V, O> Task<V> for Trace<'_, '_, V, O>
where
    V: Vector,
    O: Targets<Vector = V> + ?Sized,
{
    type Done = f64;

    fn along<W: Walk<Vector = V> + Sync>(self, walk: &W) -> f64 {
        let Self { set, stack } = self;
        let mut trace = |ray| {
            black_box(set.follow(walk, ray, stack, NoProbe));
        };
        // One ray is not timed: it brings what its neighbours need into the cache, as the chunk before would have done.
        if let Some(first) = set.rays.first() {
            trace(first);
        }
        let started = Instant::now();
        set.rays.iter().for_each(trace);
        started.elapsed().as_secs_f64()
    }
}
