//! Seconds of every way, and of building what it needs: all of a scene interleaved, of each chunk the least time. The ways take the same
//! chunks of rays, so that the error of their ratio to the stack's is that of pairs.

use std::hint::black_box;
use std::ops::Range;
use std::time::Instant;

use crate::geom::{Targets, Vector};
use crate::kd::{NoProbe, Stack, Walk};
use crate::study::records::{PassTiming, RUN};
use crate::study::timing::{CHUNK, Minima, interleaved, scatter};

use super::trail::Set;
use super::way::Task;

/// What the chunks tell of the error of their sum.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Error {
    /// Nothing: it is one thing.
    None,
    /// How the seconds of rays scatter.
    OfRays,
    /// How they scatter about a multiple of those of the latest pass before it that is [`Error::OfRays`], which took the same chunks.
    OfRatio,
}

/// Something that is timed chunk by chunk.
pub struct Pass<'a> {
    /// Name of its row.
    what: String,
    /// Rays in all, of which the chunks are a part.
    all: usize,
    chunks: Vec<Range<usize>>,
    error: Error,
    /// Does a chunk; gives its seconds.
    run: Box<dyn FnMut(Range<usize>) -> f64 + Send + 'a>,
    best: Minima,
}

impl<'a> Pass<'a> {
    /// These chunks of `all` rays; `run` does one and gives its seconds.
    pub fn new(
        what: String,
        (all, chunks): (usize, Vec<Range<usize>>),
        error: Error,
        run: impl FnMut(Range<usize>) -> f64 + Send + 'a,
    ) -> Self {
        Self {
            what,
            all,
            best: Minima::new(chunks.len()),
            chunks,
            error,
            run: Box::new(run),
        }
    }

    /// One thing that is built; to let it go takes no time of it.
    pub fn build<T>(what: String, build: impl Fn() -> T + Send + 'a) -> Self {
        let one = std::iter::once(0..1).collect();
        Self::new(what, (1, one), Error::None, move |_| {
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

    /// The row of this pass, its chunks scaled to all rays, given its least times and those of what it is held against.
    fn row(&self, least: &[f64], stack: &[f64], rounds: u32) -> PassTiming {
        let rays: Vec<f64> = self.chunks.iter().map(|chunk| chunk.len() as f64).collect();
        let timed: f64 = rays.iter().sum();
        let scatter = |base| scatter(least, base, RUN / CHUNK);
        let row = self.best.row(self.what.clone(), timed as u64, rounds);
        let scale = self.all as f64 / timed;
        PassTiming {
            units: self.all as u64,
            seconds: scale * row.seconds,
            half_a_s: scale * row.half_a_s,
            half_b_s: scale * row.half_b_s,
            sampling_se_s: match self.error {
                Error::None => 0.0,
                Error::OfRays => scale * scatter(&rays),
                Error::OfRatio => scale * scatter(stack),
            },
            ..row
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
    let mut stack = None;
    let row = |pass: &Pass<'_>| {
        let least = pass.best.least();
        if pass.error == Error::OfRays {
            stack = Some(least.clone());
        }
        pass.row(&least, stack.as_deref().unwrap_or(&least), rounds)
    };
    passes.iter().map(row).collect()
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows of a stack and of a way beside it, given the seconds of their chunks.
    fn rows(stack: &[f64], way: &[f64]) -> [PassTiming; 2] {
        let chunks: Vec<_> = (0..way.len()).map(|i| i * CHUNK..(i + 1) * CHUNK).collect();
        let all = 2 * CHUNK * way.len();
        let pass = |(error, seconds): (Error, &[f64])| {
            let seconds = seconds.to_vec();
            let run = move |chunk: Range<usize>| seconds[chunk.start / CHUNK];
            Pass::new(String::new(), (all, chunks.clone()), error, run)
        };
        let passes = [(Error::OfRays, stack), (Error::OfRatio, way)].map(pass);
        let rows = seconds(passes.into(), 2, 1, || ());
        rows.try_into().unwrap()
    }

    #[test]
    fn a_sample_is_scaled_and_ways_are_paired() {
        // Two runs of eight chunks; the way takes twice as long in each, however much they differ.
        let stack: Vec<f64> = (0..16).map(|i| f64::from(1 + i)).collect();
        let twice: Vec<f64> = stack.iter().map(|s| 2.0 * s).collect();
        let [alone, beside] = rows(&stack, &twice);
        assert_eq!((alone.units, alone.timed_units), (2048, 1024));
        assert_eq!((alone.seconds, beside.seconds), (272.0, 544.0));
        assert_eq!((alone.half_a_s, beside.half_b_s), (272.0, 544.0));
        assert_eq!(beside.sampling_se_s, 0.0);
        // Runs of 36 and 100 seconds, 68 expected of each: the square root of 2 (32² + 32²) / 1, twice.
        assert!((alone.sampling_se_s - 128.0).abs() < 1e-9);
        // One run does not tell its error.
        let [alone, beside] = rows(&stack[..8], &twice[..8]);
        assert!(alone.sampling_se_s == f64::INFINITY && beside.sampling_se_s == f64::INFINITY);
    }

    #[test]
    fn intervals_of_ratios_cover() {
        // Both ways take equally long on average, and the cost of rays, which they share, scatters much.
        let mut state = 1_u64;
        let mut uniform = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        const RUNS: usize = 32;
        const TIMES: usize = 2000;
        // Student's t of 31 degrees of freedom at 99 %.
        const T: f64 = 2.744;
        let mut missed = 0;
        for _ in 0..TIMES {
            let run = |_| {
                let cost = 1.0 + 9.0 * uniform();
                [0.9 + 0.2 * uniform(), 0.9 + 0.2 * uniform()].map(|noise| cost * noise)
            };
            let runs: Vec<[f64; 2]> = (0..RUNS).map(run).collect();
            let [stack, way] = [0, 1].map(|i| runs.iter().map(|run| run[i]).collect::<Vec<_>>());
            let [total, of] = [&way, &stack].map(|seconds| seconds.iter().sum::<f64>());
            missed += usize::from((total - of).abs() > T * scatter(&way, &stack, 1));
        }
        // 20 are expected; fewer than 6 or more than 38 have a chance below 1e-3 (binomial).
        assert!((6..=38).contains(&missed), "{missed}");
    }
}
