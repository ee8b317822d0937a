//! A kernel taken through many lines: how often each node is visited, and verdicts on the first of the lines.

use rayon::prelude::*;

use crate::geom::Line;
use crate::kd::{Mode, Planes};
use crate::study::incidence::{Exact, Subject, Tally, Visits, nodes, triangles};

/// Pieces that go to the threads; each has its own floating sums, put together in the order of the pieces.
const PIECES: usize = 64;

/// What came of a set of lines.
#[derive(Clone, Debug, Default)]
pub struct Counted {
    /// Verdicts on nodes.
    pub nodes: Tally,
    /// Verdicts on triangles.
    pub triangles: Tally,
    /// Lines that the kernel took to each node.
    pub hits: Vec<u64>,
    /// Sums of the lines' scores and of their squares: the slope is the mean score.
    pub scores: [f64; 2],
}

/// Take a kernel through some lines and judge the first `judged` of them. `score` is what a visit of each node adds to a line's
/// score.
pub fn count<M: Mode, T: Planes<Vector: Exact> + Sync>(
    subject: &Subject<'_, T>,
    lines: &[Line<T::Vector>],
    judged: usize,
    score: &[f64],
) -> Counted
where
    T::Vector: Sync,
{
    let size = lines.len().div_ceil(PIECES).max(1);
    let none = || Counted {
        hits: vec![0; subject.boxes.len()],
        ..Counted::default()
    };
    let piece = |(i, lines): (usize, &[Line<T::Vector>])| {
        let (mut found, mut visits) = (none(), Visits::default());
        for (k, line) in lines.iter().enumerate() {
            let visited = visits.follow::<M, T>(subject.tree, line);
            found.add(visited, score);
            if i * size + k < judged {
                let pairs = nodes(subject, line, visited);
                found.nodes += Tally::of_a_line(&pairs);
                found.triangles += Tally::of_a_line(&triangles(subject, line, &pairs));
            }
        }
        found
    };
    let pieces = lines.par_chunks(size).enumerate();
    let pieces: Vec<Counted> = pieces.map(piece).collect();
    let mut all = none();
    for piece in pieces {
        all.nodes += piece.nodes;
        all.triangles += piece.triangles;
        let hits = all.hits.iter_mut().zip(piece.hits);
        hits.for_each(|(a, b)| *a += b);
        let scores = all.scores.iter_mut().zip(piece.scores);
        scores.for_each(|(a, b)| *a += b);
    }
    all
}

impl Counted {
    /// One more line's visits.
    fn add(&mut self, visited: &[u32], score: &[f64]) {
        let mut sum = 0.0;
        for &node in visited {
            self.hits[node as usize] += 1;
            sum += score[node as usize];
        }
        self.scores[0] += sum;
        self.scores[1] += sum * sum;
    }
}
