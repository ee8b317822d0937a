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

use crate::geom::Cast;
use crate::kd::{NoProbe, Rules, Stack, Tree};
use crate::scene::Scene;
use crate::study::hits::cell::build_tree;
use crate::study::records::PassTiming;
use crate::tracer::{RayKind, RaySet};

use super::asked::Timing;

/// What a row of builds is called.
pub const BUILD: &str = "build";

/// Rays of a chunk: at about a microsecond each well below a scheduler's slice.
const CHUNK: usize = 64;

/// Fewest chunks of a sample, for its standard error.
const FEWEST: usize = 128;

/// Halves that are further apart than this tell of a disturbed machine.
const DISTURBED: f64 = 0.03;

/// The least seconds of each chunk, in the even and the odd rounds.
struct Pass {
    kind: RayKind,
    /// Which tree.
    tree: usize,
    chunks: Vec<Range<usize>>,
    best: [Vec<f64>; 2],
}

/// Time the tracing of every kind of ray through every tree, on this thread. `tick` is told after each round. Gives rows
/// without the name of their cell, tree by tree and kind by kind.
pub fn trace_times(
    scene: &Scene,
    trees: &[Tree],
    rays: &RaySet,
    timing: Timing,
    seed: u64,
    mut tick: impl FnMut(),
) -> Vec<Vec<PassTiming>> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut passes = Vec::new();
    for kind in RayKind::ALL {
        let all = rays.of(kind).rays.len();
        let mut order: Vec<_> = (0..all.div_ceil(CHUNK)).collect();
        order.shuffle(&mut random);
        for (number, tree) in trees.iter().enumerate() {
            let chunks = order.iter().map(|&c| c * CHUNK..((c + 1) * CHUNK).min(all));
            let mut chunks = sample(scene, tree, rays, kind, chunks.collect(), timing.pass_s);
            // In the order of the picture, as a renderer would go.
            chunks.sort_by_key(|chunk| chunk.start);
            let never = vec![f64::INFINITY; chunks.len()];
            passes.push(Pass {
                kind,
                tree: number,
                chunks,
                best: [never.clone(), never],
            });
        }
    }
    let mut order: Vec<_> = (0..passes.len()).collect();
    for round in 0..timing.rounds {
        order.shuffle(&mut random);
        for &i in &order {
            let pass = &mut passes[i];
            let mut stack = Stack::default();
            let best = &mut pass.best[round as usize % 2];
            for (chunk, best) in pass.chunks.iter().zip(best) {
                let took = seconds(scene, &trees[pass.tree], rays, pass.kind, chunk, &mut stack);
                *best = best.min(took);
            }
        }
        tick();
    }
    let mut rows = vec![Vec::new(); trees.len()];
    for pass in passes {
        let all = rays.of(pass.kind).rays.len();
        rows[pass.tree].push(pass.row(all, timing));
    }
    rows
}

/// As many of the chunks, from the first on, as fit in `pass_s` seconds.
fn sample(
    scene: &Scene,
    tree: &Tree,
    rays: &RaySet,
    kind: RayKind,
    mut chunks: Vec<Range<usize>>,
    pass_s: f64,
) -> Vec<Range<usize>> {
    let mut stack = Stack::default();
    let mut took = 0.0;
    let mut fit = 0;
    for chunk in &chunks {
        if fit >= FEWEST && took > pass_s {
            break;
        }
        took += seconds(scene, tree, rays, kind, chunk, &mut stack);
        fit += 1;
    }
    chunks.truncate(fit);
    chunks
}

/// Trace a chunk of rays.
fn seconds(
    scene: &Scene,
    tree: &Tree,
    rays: &RaySet,
    kind: RayKind,
    chunk: &Range<usize>,
    stack: &mut Stack,
) -> f64 {
    let rays = &rays.of(kind).rays[chunk.clone()];
    let ask = kind.ask();
    let mut trace = |cast: &Cast| {
        let ray = cast.ray();
        black_box(ask.hits(tree, &scene.objects, &ray, stack, NoProbe));
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

impl Pass {
    /// The row of this pass, the sample scaled to `all` rays.
    fn row(&self, all: usize, timing: Timing) -> PassTiming {
        let timed: usize = self.chunks.iter().map(ExactSizeIterator::len).sum();
        let scale = if timed == 0 {
            0.0
        } else {
            all as f64 / timed as f64
        };
        let [a, b] = &self.best;
        let least: Vec<f64> = a.iter().zip(b).map(|(a, b)| a.min(*b)).collect();
        let total = |seconds: &[f64]| scale * seconds.iter().sum::<f64>();
        let (half_a_s, half_b_s) = (total(a), total(b));
        PassTiming {
            what: self.kind.name().into(),
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

    /// Standard error of the scaled sum: a ratio estimate over chunks drawn without replacement.
    fn sampling_error(&self, least: &[f64], all: usize, timed: usize) -> f64 {
        let drawn = least.len() as f64;
        if timed == all || drawn < 2.0 {
            return 0.0;
        }
        let rate = least.iter().sum::<f64>() / timed as f64;
        let residual = |(seconds, chunk): (&f64, &Range<usize>)| {
            let off = seconds - rate * chunk.len() as f64;
            off * off
        };
        let squares: f64 = least.iter().zip(&self.chunks).map(residual).sum();
        let chunks = all.div_ceil(CHUNK) as f64;
        let left_out = 1.0 - drawn / chunks;
        chunks * (squares / (drawn - 1.0) * left_out / drawn).sqrt()
    }
}

/// Time the building of every tree, on this thread, in rounds of a fresh random order. Gives rows without the name of their
/// cell.
pub fn build_times(scene: &Scene, rules: &[Rules], timing: Timing, seed: u64) -> Vec<PassTiming> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut order: Vec<_> = (0..rules.len()).collect();
    let mut seconds = vec![Vec::new(); rules.len()];
    for _ in 0..timing.builds {
        order.shuffle(&mut random);
        for &i in &order {
            let started = Instant::now();
            let tree = build_tree(scene, &rules[i]);
            seconds[i].push(started.elapsed().as_secs_f64());
            drop(tree);
        }
    }
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

fn apart(a: f64, b: f64) -> bool {
    (a - b).abs() > DISTURBED * a.min(b)
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

    fn pass(a: Vec<f64>, b: Vec<f64>) -> Pass {
        Pass {
            kind: RayKind::Primary,
            tree: 0,
            chunks: (0..a.len()).map(|i| i * CHUNK..(i + 1) * CHUNK).collect(),
            best: [a, b],
        }
    }

    #[test]
    fn the_least_of_each_chunk_counts_and_is_scaled() {
        let row = pass(vec![1.0, 5.0], vec![3.0, 2.0]).row(4 * CHUNK, TIMING);
        assert_eq!((row.seconds, row.half_a_s, row.half_b_s), (6.0, 12.0, 10.0));
        assert!(row.disturbed);
        // Chunks of 1 and 2 seconds, two of four: N sqrt(s^2 (1 - 1/2) / 2) with s^2 = 1/2.
        assert!((row.sampling_se_s - 4.0 * 0.125_f64.sqrt()).abs() < 1e-12);
        let whole = pass(vec![1.0, 2.0], vec![1.01, 2.02]).row(2 * CHUNK, TIMING);
        assert_eq!((whole.sampling_se_s, whole.disturbed), (0.0, false));
        let none = pass(vec![], vec![]).row(0, TIMING);
        assert_eq!((none.seconds, none.disturbed), (0.0, false));
    }

    #[test]
    fn builds_have_halves() {
        let row = build_row(&[2.0, 1.0, 1.5, 3.0], TIMING);
        assert_eq!((row.half_a_s, row.half_b_s, row.seconds), (1.5, 1.0, 1.0));
        assert!(row.disturbed);
    }
}
