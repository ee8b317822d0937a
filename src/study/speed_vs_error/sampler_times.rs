//! Seconds of drawing, mapping, tracing and counting a set of lines: what an error is paid with.
//!
//! On one thread, line by line with the plain traversal, in chunks well below a scheduler's slice. Lines that nothing stops
//! count the hits of every node, rays that end early their visits and tests, and the conditional estimator sums over
//! directions; building the tree is not part of it.

use std::hint::black_box;
use std::time::Instant;

use crate::geom::{Line, Ray, Span};
use crate::kd::traverse::traverse_line;
use crate::kd::{Ask, Counts, Stack, Work};
use crate::rays::{Conditional, PointSet};
use crate::study::records::PassTiming;
use crate::study::timing::{CHUNK, Minima, interleaved};

use super::Piece;
use super::method::Way;
use super::replicates::Subject;

/// One set of lines to be timed.
struct Job {
    way: Way,
    lines: u64,
    set: PointSet,
    best: Minima,
}

/// Time sets of these sizes, the first replicate of each, and give their rows. `tick` is told after each round.
pub fn times(
    subject: &Subject<'_>,
    piece: &Piece<'_>,
    sizes: &[(Way, Vec<u64>)],
    rounds: u32,
    tick: impl FnMut(),
) -> Vec<PassTiming> {
    let job = |way: Way, level: usize, lines: u64| Job {
        way,
        lines,
        set: subject.set(way.method, level as u32, 0, lines),
        best: Minima::new(lines.div_ceil(CHUNK as u64) as usize),
    };
    let mut jobs = Vec::new();
    for (way, sizes) in sizes {
        let levels = sizes.iter().enumerate();
        jobs.extend(levels.map(|(level, &lines)| job(*way, level, lines)));
    }
    let run = |job: &mut Job, half: usize| pass(subject, job, half);
    interleaved(&mut jobs, rounds, piece.seed, run, tick);
    let row = |job: Job| {
        let what = format!("{} {} {}", job.way.method.name(), job.way.rays(), job.lines);
        piece.named(job.best.row(what, job.lines, rounds))
    };
    jobs.into_iter().map(row).collect()
}

/// Go once through a job's lines.
fn pass(subject: &Subject<'_>, job: &mut Job, half: usize) {
    let (tree, objects) = (subject.tree, &subject.scene.objects);
    let mut stack = Stack::default();
    match job.way.ask {
        _ if job.way.method.is_conditional() => {
            let mut mean = Conditional::new(&subject.scene.world);
            chunks(subject, job, half, |line| mean.push(line.direction));
            black_box(mean);
        }
        Ask::All => {
            let mut counts = Counts::new(tree);
            chunks(subject, job, half, |line| {
                traverse_line(tree, &line, Span::FULL, &mut stack, &mut counts);
            });
            black_box(counts);
        }
        ask => {
            let mut work = Work::default();
            chunks(subject, job, half, |line| {
                let ray = Ray::new(line, Span::FULL);
                black_box(ask.hits(tree, objects, &ray, &mut stack, &mut work));
            });
            black_box(work);
        }
    }
}

/// Draw the lines and do this with each, chunk by chunk. Whatever a set needs before its first line is timed with it.
fn chunks(subject: &Subject<'_>, job: &mut Job, half: usize, mut each: impl FnMut(Line)) {
    let mut started = Instant::now();
    let mut lines = job.set.lines(&subject.scene.world, 0..job.lines);
    for chunk in 0..job.lines.div_ceil(CHUNK as u64) as usize {
        lines.by_ref().take(CHUNK).for_each(&mut each);
        job.best.note(half, chunk, started.elapsed().as_secs_f64());
        started = Instant::now();
    }
}
