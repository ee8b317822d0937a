//! Seconds on a machine that others use too: the sum of chunk minima over interleaved rounds.
//!
//! A pass over many rays is cut into chunks of well below a millisecond; whatever disturbs the machine disturbs some
//! chunks in some rounds, and the least time of a chunk over all rounds is free of it. Every round visits all trees in a
//! fresh random order, so that slow minutes are shared. Two half-sets of rounds tell how far the result can be believed.

use std::hint::black_box;
use std::ops::Range;
use std::time::Instant;

use rand::SeedableRng;
use rand::rngs::ChaCha8Rng;
use rand::seq::SliceRandom;
use serde::{Deserialize, Serialize};

use crate::geom::Cast;
use crate::kd::{Ask, NoProbe, Rules, Stack, Tree};
use crate::scene::Scene;

use super::hits::cell::{CellPlan, build_tree, on_one_thread};
use super::plan::{Wrong, wrong_unless};
use super::records::PassTiming;

/// What a row of builds is called.
pub const BUILD: &str = "build";

/// Rays of a chunk: at about a microsecond each well below a scheduler's slice.
pub const CHUNK: usize = 64;

/// Fewest chunks of a sample, for its standard error.
const FEWEST: usize = 128;

/// Halves that are further apart than this tell of a disturbed machine.
const DISTURBED: f64 = 0.03;

/// How seconds are measured.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Timing {
    /// Times that every chunk of rays is traced; even, so that there are two halves.
    pub rounds: u32,
    /// Times that every tree is built; even likewise.
    pub builds: u32,
    /// Seconds above which a pass over the rays of one kind is timed on a random sample.
    pub pass_s: f64,
}

impl Timing {
    /// Whether the values make sense together.
    pub fn check(&self) -> Result<(), Wrong> {
        let Self {
            rounds,
            builds,
            pass_s,
        } = *self;
        for (key, times) in [("timing.rounds", rounds), ("timing.builds", builds)] {
            halves(key, times)?;
        }
        wrong_unless(pass_s > 0.0 && pass_s.is_finite(), "timing.pass_s", || {
            format!("timing.pass_s = {pass_s}, but it must be a number above 0")
        })
    }
}

/// Rays to be timed in every tree.
pub struct Timed<'a> {
    /// What the rows are called.
    pub what: String,
    /// What the rays ask.
    pub ask: Ask,
    /// The rays.
    pub casts: &'a [Cast],
    /// Their chunks; a tree in which all of them take too long gets a sample.
    pub chunks: Vec<Range<usize>>,
    /// Chunks of a sample that were drawn together, as they follow each other.
    pub together: usize,
}

impl<'a> Timed<'a> {
    /// All of these rays.
    pub fn all(what: String, ask: Ask, casts: &'a [Cast]) -> Self {
        let chunk = |start: usize| start..(start + CHUNK).min(casts.len());
        Self {
            what,
            ask,
            casts,
            chunks: (0..casts.len()).step_by(CHUNK).map(chunk).collect(),
            together: 1,
        }
    }
}

/// The least seconds of each chunk of a job, in the even and the odd rounds.
pub struct Minima([Vec<f64>; 2]);

impl Minima {
    /// Of so many chunks, none timed yet.
    pub fn new(chunks: usize) -> Self {
        let never = vec![f64::INFINITY; chunks];
        Self([never.clone(), never])
    }

    /// A chunk took so long in one of the even (`half` 0) or odd (1) rounds.
    pub fn note(&mut self, half: usize, chunk: usize, seconds: f64) {
        let least = &mut self.0[half][chunk];
        *least = least.min(seconds);
    }

    /// The least of each chunk.
    pub fn least(&self) -> Vec<f64> {
        let [a, b] = &self.0;
        a.iter().zip(b).map(|(a, b)| a.min(*b)).collect()
    }

    /// The row of a job all of whose units were timed in so many rounds. It has no name of a cell.
    pub fn row(&self, what: String, units: u64, rounds: u32) -> PassTiming {
        let timing = Timing {
            rounds,
            builds: rounds,
            pass_s: f64::INFINITY,
        };
        let [half_a_s, half_b_s] = self.0.each_ref().map(|half| half.iter().sum());
        PassTiming {
            what,
            units,
            timed_units: units,
            seconds: self.least().iter().sum(),
            half_a_s,
            half_b_s,
            disturbed: apart(half_a_s, half_b_s),
            ..blank(timing, false)
        }
    }
}

/// Run every job once a round, in rounds of a fresh random order; `run` is told the half that the round belongs to, and
/// `tick` after each round.
pub fn interleaved<J>(
    jobs: &mut [J],
    rounds: u32,
    seed: u64,
    mut run: impl FnMut(&mut J, usize),
    mut tick: impl FnMut(),
) {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut order: Vec<_> = (0..jobs.len()).collect();
    for round in 0..rounds {
        order.shuffle(&mut random);
        for &i in &order {
            run(&mut jobs[i], round as usize % 2);
        }
        tick();
    }
}

/// One set of rays in one tree, and the seconds of its chunks.
pub struct Pass<'t, 'r> {
    timed: &'t Timed<'r>,
    /// Which tree.
    tree: usize,
    chunks: Vec<Range<usize>>,
    best: Minima,
}

impl<'t, 'r> Pass<'t, 'r> {
    /// Of these chunks of the set, in tree number `tree`.
    pub fn new(timed: &'t Timed<'r>, tree: usize, mut chunks: Vec<Range<usize>>) -> Self {
        // In the order of the rays, as a renderer would go.
        chunks.sort_by_key(|chunk| chunk.start);
        Self {
            timed,
            tree,
            best: Minima::new(chunks.len()),
            chunks,
        }
    }
}

/// Every set in every tree, on a random sample where all of it would take longer than `pass_s` seconds.
pub fn sampled<'t, 'r>(
    scene: &Scene,
    trees: &[Tree],
    sets: &'t [Timed<'r>],
    pass_s: f64,
    seed: u64,
) -> Vec<Pass<'t, 'r>> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut passes = Vec::new();
    for timed in sets {
        let mut order = timed.chunks.clone();
        order.shuffle(&mut random);
        for (number, tree) in trees.iter().enumerate() {
            let chunks = sample(scene, tree, timed, &order, pass_s);
            passes.push(Pass::new(timed, number, chunks));
        }
    }
    passes
}

/// Time these passes on this thread, in rounds of a fresh random order. `tick` is told after each round. Gives rows without
/// the name of their cell, tree by tree and set by set.
pub fn trace_times(
    scene: &Scene,
    trees: &[Tree],
    mut passes: Vec<Pass>,
    timing: Timing,
    seed: u64,
    tick: impl FnMut(),
) -> Vec<Vec<PassTiming>> {
    let run = |pass: &mut Pass, half: usize| {
        let mut stack = Stack::default();
        for (number, chunk) in pass.chunks.iter().enumerate() {
            let took = seconds(scene, &trees[pass.tree], pass.timed, chunk, &mut stack);
            pass.best.note(half, number, took);
        }
    };
    interleaved(&mut passes, timing.rounds, seed, run, tick);
    let mut rows = vec![Vec::new(); trees.len()];
    for pass in passes {
        rows[pass.tree].push(pass.row(timing));
    }
    rows
}

/// As many of the chunks, from the first on, as fit in `pass_s` seconds.
fn sample(
    scene: &Scene,
    tree: &Tree,
    timed: &Timed,
    chunks: &[Range<usize>],
    pass_s: f64,
) -> Vec<Range<usize>> {
    let mut stack = Stack::default();
    let mut took = 0.0;
    let mut fit = 0;
    for chunk in chunks {
        if fit >= FEWEST && took > pass_s {
            break;
        }
        took += seconds(scene, tree, timed, chunk, &mut stack);
        fit += 1;
    }
    chunks[..fit].to_vec()
}

/// Trace a chunk of rays.
fn seconds(
    scene: &Scene,
    tree: &Tree,
    timed: &Timed,
    chunk: &Range<usize>,
    stack: &mut Stack,
) -> f64 {
    let rays = &timed.casts[chunk.clone()];
    let mut trace = |cast: &Cast| {
        let ray = cast.ray();
        black_box(timed.ask.hits(tree, &scene.objects, &ray, stack, NoProbe));
    };
    // One ray is not timed: it brings what its neighbours need into the cache, as the chunk before would have done, be it
    // in the sample or not.
    if let Some(first) = rays.first() {
        trace(first);
    }
    let started = Instant::now();
    rays.iter().for_each(trace);
    started.elapsed().as_secs_f64()
}

impl Pass<'_, '_> {
    /// The row of this pass, the sample scaled to all rays of the set.
    fn row(&self, timing: Timing) -> PassTiming {
        let chunks = self.timed.chunks.iter();
        let all: usize = chunks.map(ExactSizeIterator::len).sum();
        let timed: usize = self.chunks.iter().map(ExactSizeIterator::len).sum();
        let scale = if timed == 0 {
            0.0
        } else {
            all as f64 / timed as f64
        };
        let Minima([a, b]) = &self.best;
        let least = self.best.least();
        let total = |seconds: &[f64]| scale * seconds.iter().sum::<f64>();
        let (half_a_s, half_b_s) = (total(a), total(b));
        PassTiming {
            what: self.timed.what.clone(),
            units: all as u64,
            timed_units: timed as u64,
            seconds: total(&least),
            sampling_se_s: self.sampling_error(&least, all, timed),
            half_a_s,
            half_b_s,
            disturbed: apart(half_a_s, half_b_s),
            ..blank(timing, false)
        }
    }

    /// Standard error of the scaled sum: a ratio estimate over what was drawn, without replacement.
    fn sampling_error(&self, least: &[f64], all: usize, timed: usize) -> f64 {
        let together = self.timed.together;
        let drawn = least.len().div_ceil(together) as f64;
        if timed == all || drawn < 2.0 {
            return 0.0;
        }
        let rays: Vec<f64> = self.chunks.iter().map(|chunk| chunk.len() as f64).collect();
        let population = self.timed.chunks.len().div_ceil(together) as f64;
        let left_out = (1.0 - drawn / population).max(0.0);
        population / drawn * left_out.sqrt() * scatter(least, &rays, together)
    }
}

/// Standard error of the sum of `own` as a multiple of that of `base`, over chunks of which so many at a time were drawn together,
/// as if from endlessly many: the residuals of a ratio estimate. Infinite for less than two draws, which do not tell.
pub fn scatter(own: &[f64], base: &[f64], together: usize) -> f64 {
    let ratio = own.iter().sum::<f64>() / base.iter().sum::<f64>();
    let residual = |(own, base): (&[f64], &[f64])| {
        let off = own.iter().sum::<f64>() - ratio * base.iter().sum::<f64>();
        off * off
    };
    let squares = own
        .chunks(together)
        .zip(base.chunks(together))
        .map(residual);
    let (squares, drawn) = squares.fold((0.0, 0.0), |(sum, n), square| (sum + square, n + 1.0));
    if drawn < 2.0 {
        return f64::INFINITY;
    }
    (squares * drawn / (drawn - 1.0)).sqrt()
}

/// Time the building of every tree, on one thread, in rounds of a fresh random order. Gives rows without the name of their
/// cell.
pub fn build_times(scene: &Scene, rules: &[Rules], timing: Timing, seed: u64) -> Vec<PassTiming> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut order: Vec<_> = (0..rules.len()).collect();
    let mut seconds = vec![Vec::new(); rules.len()];
    on_one_thread(|| {
        for _ in 0..timing.builds {
            order.shuffle(&mut random);
            for &i in &order {
                let started = Instant::now();
                let tree = build_tree(scene, &rules[i]);
                seconds[i].push(started.elapsed().as_secs_f64());
                drop(tree);
            }
        }
    });
    let row = |seconds: &Vec<f64>| build_row(seconds, timing);
    seconds.iter().map(row).collect()
}

/// The row of builds of one tree, from the seconds of each.
fn build_row(seconds: &[f64], timing: Timing) -> PassTiming {
    let least = |from: usize| {
        let every_second = seconds.iter().skip(from).step_by(2);
        every_second.copied().fold(f64::INFINITY, f64::min)
    };
    let (half_a_s, half_b_s) = (least(0), least(1));
    PassTiming {
        what: BUILD.into(),
        units: 1,
        timed_units: 1,
        seconds: half_a_s.min(half_b_s),
        half_a_s,
        half_b_s,
        disturbed: apart(half_a_s, half_b_s),
        ..blank(timing, true)
    }
}

/// Whether two halves are so far apart that the machine was disturbed.
pub fn apart(a: f64, b: f64) -> bool {
    (a - b).abs() > DISTURBED * a.min(b)
}

/// Whether what is done so many times has two halves.
pub fn halves(key: &'static str, times: u32) -> Result<(), Wrong> {
    wrong_unless(times >= 2 && times.is_multiple_of(2), key, || {
        format!("{key} = {times}, but it must be even and at least 2, for two halves")
    })
}

/// The rows of trees, one tree after the other, with their names.
pub fn named<'a>(
    trees: impl Iterator<Item = &'a CellPlan<'a>>,
    rows: impl IntoIterator<Item = Vec<PassTiming>>,
) -> Vec<PassTiming> {
    let of_tree = |(tree, rows): (&'a CellPlan<'a>, Vec<PassTiming>)| {
        rows.into_iter().map(|row| PassTiming {
            cell: tree.id.clone(),
            scene: tree.scene.name.clone(),
            strategy: tree.rules.strategy.name(),
            stop: tree.rules.stop.to_string(),
            ..row
        })
    };
    trees.zip(rows).flat_map(of_tree).collect()
}

/// A row that says how it was measured and nothing else.
pub fn blank(timing: Timing, build: bool) -> PassTiming {
    let rounds = if build { timing.builds } else { timing.rounds };
    PassTiming {
        cell: String::new(),
        scene: String::new(),
        strategy: String::new(),
        stop: String::new(),
        what: String::new(),
        units: 0,
        timed_units: 0,
        rounds: rounds.into(),
        pass_s: timing.pass_s,
        seconds: 0.0,
        sampling_se_s: 0.0,
        half_a_s: 0.0,
        half_b_s: 0.0,
        disturbed: false,
        load_average: load_average(),
        revision: crate::REVISION.into(),
    }
}

/// Load average of the last minute, where the system tells it.
fn load_average() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/loadavg").ok()?;
    text.split_whitespace().next()?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    const TIMING: Timing = Timing {
        rounds: 2,
        builds: 4,
        pass_s: 1.0,
    };

    fn set(chunks: usize) -> Timed<'static> {
        Timed {
            what: "primary".into(),
            ask: Ask::Nearest,
            casts: &[],
            chunks: (0..chunks).map(|i| i * CHUNK..(i + 1) * CHUNK).collect(),
            together: 1,
        }
    }

    fn row(timed: &Timed, a: Vec<f64>, b: Vec<f64>) -> PassTiming {
        let mut pass = Pass::new(timed, 0, timed.chunks[..a.len()].to_vec());
        pass.best = Minima([a, b]);
        pass.row(TIMING)
    }

    #[test]
    fn the_least_of_each_chunk_counts_and_is_scaled() {
        let half = row(&set(4), vec![1.0, 5.0], vec![3.0, 2.0]);
        assert_eq!(
            (half.seconds, half.half_a_s, half.half_b_s),
            (6.0, 12.0, 10.0)
        );
        assert!(half.disturbed);
        // Chunks of 1 and 2 seconds, two of four: N sqrt(s^2 (1 - 1/2) / 2) with s^2 = 1/2.
        assert!((half.sampling_se_s - 4.0 * 0.125_f64.sqrt()).abs() < 1e-12);
        // Drawn two by two: pairs of 3 and 7 seconds, two of four, s^2 = 8.
        let mut pairs = set(8);
        pairs.together = 2;
        let half = row(&pairs, vec![1.0, 2.0, 3.0, 4.0], vec![9.0; 4]);
        assert!((half.sampling_se_s - 4.0 * 2.0_f64.sqrt()).abs() < 1e-12);
        let whole = row(&set(2), vec![1.0, 2.0], vec![1.01, 2.02]);
        assert_eq!((whole.sampling_se_s, whole.disturbed), (0.0, false));
        let none = row(&set(0), vec![], vec![]);
        assert_eq!((none.seconds, none.disturbed), (0.0, false));
    }

    #[test]
    fn builds_have_halves() {
        let row = build_row(&[2.0, 1.0, 1.5, 3.0], TIMING);
        assert_eq!((row.half_a_s, row.half_b_s, row.seconds), (1.5, 1.0, 1.0));
        assert!(row.disturbed);
    }
}
