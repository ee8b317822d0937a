//! Per-line scores: what turns correlated nodes into independent observations.
//!
//! Nodes nest, so their hit counts are correlated and a regression's own errors are two to five times too small. But any
//! slope through the origin is a mean over lines: b = (1/N) sum of g, g = sum of a_k over the nodes a line hits, with
//! a_k = w_k p_k / sum w p^2. The g of different lines are independent, so SE(b) = sd(g)/sqrt(N), all correlation inside.

use glam::DVec3;
use rayon::prelude::*;

use crate::geom::{Aabb, Line, Span};
use crate::kd::traverse::traverse_line;
use crate::kd::{Counts, NodeKind, Prediction, Probe, Stack, Tree, Work};
use crate::stats::ScoreMoments;

/// Contrasts for Hotelling's test: counts of visited nodes by size (8 classes of equal expected hits), by thinnest side
/// (x, y), by position (upper half in x, y, z), and of leaves.
pub const CONTRASTS: usize = 14;
const SIZES: usize = 8;

/// Scores a visit adds to a line's: weighted slope, ordinary slope, free line's intercept and slope.
pub const SCORES: usize = 4;
/// Index of the weighted slope's score.
pub const WEIGHTED: usize = 0;
/// Index of the ordinary slope's score.
pub const ORDINARY: usize = 1;
/// Index of the free intercept's score; the free slope's follows.
pub const FREE: usize = 2;

/// Least p of a node that takes part: sums of weights 1/p over 2^32 nodes stay within f64. No line will ever hit less.
const LEAST_P: f64 = 1e-290;

/// Weight of a node in the slope, from the theoretical p: weights from the data would bias it.
fn weight(p: f64) -> f64 {
    1.0 / (p * (1.0 - p))
}

/// Whether a node takes part: its p is below 1, and not so small that its weight overflows.
fn takes_part(p: f64) -> bool {
    (LEAST_P..1.0).contains(&p)
}

/// What one visit of each node adds to the weighted slope's score, from the predicted p: w p / sum of w p^2.
pub fn weighted_slope(p: &[f64]) -> Vec<f64> {
    let own = p.iter().filter(|p| takes_part(**p));
    let total: f64 = own.map(|&p| weight(p) * p * p).sum();
    let score = |&p: &f64| {
        if takes_part(p) {
            weight(p) * p / total
        } else {
            0.0
        }
    };
    p.iter().map(score).collect()
}

/// What one visit of each node adds, from the predicted p alone.
pub struct Scoring {
    scores: Vec<[f64; SCORES]>,
    /// Bit c is set where a visit counts for contrast c.
    contrasts: Vec<u16>,
    /// Whether the node takes part: its p is below 1, and not so small that its weight overflows.
    pub included: Vec<bool>,
    /// Nodes that take part.
    pub nodes: usize,
    /// Whether a free line can be fitted: two nodes differ in p.
    pub has_free_line: bool,
}

impl Scoring {
    /// The scoring of a tree.
    pub fn new(tree: &Tree, prediction: &Prediction) -> Self {
        let p = &prediction.p;
        let included: Vec<bool> = p.iter().map(|&p| takes_part(p)).collect();
        let sum = |term: &dyn Fn(f64) -> f64| -> f64 {
            p.iter()
                .zip(&included)
                .filter(|(_, i)| **i)
                .map(|(&p, _)| term(p))
                .sum()
        };
        let ordinary = sum(&|p| p * p);
        let total = sum(&weight);
        let centre = sum(&|p| weight(p) * p) / total;
        let spread = sum(&|p| weight(p) * (p - centre) * (p - centre));
        let smallest = p
            .iter()
            .zip(&included)
            .filter(|(_, i)| **i)
            .map(|(&p, _)| p)
            .fold(1.0, f64::min);
        let has_free_line = p
            .iter()
            .zip(&included)
            .any(|(&p, &i)| i && p > smallest * (1.0 + 1e-9));
        let score = |p: f64, weighted: f64| {
            let slope = if has_free_line {
                weight(p) * (p - centre) / spread
            } else {
                0.0
            };
            let intercept = if has_free_line {
                weight(p) / total - centre * slope
            } else {
                0.0
            };
            [weighted, p / ordinary, intercept, slope]
        };
        let scores = p.iter().zip(&included).zip(weighted_slope(p));
        let scores = scores.map(|((&p, &included), weighted)| {
            if included {
                score(p, weighted)
            } else {
                [0.0; SCORES]
            }
        });
        Self {
            scores: scores.collect(),
            contrasts: contrasts(tree, p, &included),
            nodes: included.iter().filter(|&&i| i).count(),
            included,
            has_free_line,
        }
    }

    /// What one visit of node `i` adds to everything observed of a line.
    pub fn adds(&self, tree: &Tree, i: usize) -> [f64; OBSERVED] {
        let mut added = [0.0; OBSERVED];
        match tree.nodes[i].kind() {
            NodeKind::Inner { .. } => added[0] = 1.0,
            NodeKind::Leaf { count, .. } => (added[1], added[2]) = (1.0, f64::from(count)),
        }
        bits(self.contrasts[i]).for_each(|c| added[FIRST_CONTRAST + c] = 1.0);
        added[FIRST_SCORE..].copy_from_slice(&self.scores[i]);
        added
    }

    /// Sum over the nodes that take part of `value` by contrast.
    pub fn by_contrast(&self, value: impl Fn(usize) -> f64) -> [f64; CONTRASTS] {
        let mut sums = [0.0; CONTRASTS];
        for (i, &mask) in self.contrasts.iter().enumerate() {
            let value = value(i);
            bits(mask).for_each(|c| sums[c] += value);
        }
        sums
    }
}

fn bits(mut mask: u16) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let bit = (mask != 0).then(|| mask.trailing_zeros() as usize);
        mask &= mask.wrapping_sub(1);
        bit
    })
}

fn contrasts(tree: &Tree, p: &[f64], included: &[bool]) -> Vec<u16> {
    let mut masks = vec![0; p.len()];
    // Size classes with equal sums of p: each is hit about equally often, however many small nodes there are.
    let mut by_size: Vec<usize> = (0..p.len()).filter(|&i| included[i]).collect();
    by_size.sort_by(|&a, &b| p[b].total_cmp(&p[a]).then(a.cmp(&b)));
    let total: f64 = by_size.iter().map(|&i| p[i]).sum();
    let mut before = 0.0;
    for i in by_size {
        let class = (SIZES as f64 * (before + 0.5 * p[i]) / total) as usize;
        before += p[i];
        masks[i] = 1 << class.min(SIZES - 1) | shape(&tree.boxes[i], &tree.world) << SIZES;
        if matches!(tree.nodes[i].kind(), NodeKind::Leaf { .. }) {
            masks[i] |= 1 << (CONTRASTS - 1);
        }
    }
    masks
}

/// Bits 0-1: thinnest along x, y; bits 2-4: centre in the world's upper half in x, y, z.
fn shape(node: &Aabb, world: &Aabb) -> u16 {
    let DVec3 { x, y, z } = node.extent();
    let upper = node.centre().cmpgt(world.centre()).bitmask() as u16;
    u16::from(x <= y && x <= z) | u16::from(y < x && y <= z) << 1 | upper << 2
}

/// Everything observed of a line: inner nodes, leaves, tests; then the contrasts; then the scores.
pub const OBSERVED: usize = 3 + CONTRASTS + SCORES;
/// Where the contrasts begin among what is observed.
pub const FIRST_CONTRAST: usize = 3;
/// Where the scores begin among what is observed.
pub const FIRST_SCORE: usize = 3 + CONTRASTS;

/// What was observed of each line, and the hits of all, by the plain traversal.
pub struct Scored {
    /// One row a line.
    pub lines: Vec<[f64; OBSERVED]>,
    /// Means and covariances of the rows.
    pub moments: ScoreMoments<OBSERVED>,
    /// Hits per node.
    pub counts: Counts,
}

/// Lines that one thread takes at a time; rows stand and moments are merged in the order of the lines, whatever the
/// threads.
const CHUNK: u64 = 4096;

/// Score the first `lines` lines given by `make(start..end)`.
pub fn score_lines<I>(
    tree: &Tree,
    scoring: &Scoring,
    lines: u64,
    make: impl Fn(std::ops::Range<u64>) -> I + Sync,
) -> Scored
where
    I: Iterator<Item = Line>,
{
    let chunk = |c: u64| {
        let mut counts = Counts::new(tree);
        let mut stack = Stack::default();
        let mut rows = Vec::new();
        let mut moments = ScoreMoments::default();
        for line in make(c * CHUNK..lines.min((c + 1) * CHUNK)) {
            let mut watch = LineScore {
                scoring,
                scores: [0.0; SCORES],
                contrasts: [0; CONTRASTS],
            };
            let mut work = Work::default();
            counts.lines += 1;
            let probes = (&mut counts, (&mut work, &mut watch));
            traverse_line(tree, &line, Span::FULL, &mut stack, probes);
            let work = [work.inner, work.leaves, work.tests].map(|count| count as f64);
            let mut row = [0.0; OBSERVED];
            row[..FIRST_CONTRAST].copy_from_slice(&work);
            row[FIRST_CONTRAST..FIRST_SCORE].copy_from_slice(&watch.contrasts.map(f64::from));
            row[FIRST_SCORE..].copy_from_slice(&watch.scores);
            moments.push(row);
            rows.push(row);
        }
        (rows, moments, counts)
    };
    let chunks: Vec<_> = (0..lines.div_ceil(CHUNK))
        .into_par_iter()
        .map(chunk)
        .collect();
    let mut all = Scored {
        lines: Vec::new(),
        moments: ScoreMoments::default(),
        counts: Counts::new(tree),
    };
    for (rows, moments, counts) in chunks {
        all.lines.extend(rows);
        all.moments.merge(&moments);
        all.counts = all.counts.merge(&counts);
    }
    all
}

/// Adds up one line's scores as it goes.
struct LineScore<'a> {
    scoring: &'a Scoring,
    scores: [f64; SCORES],
    contrasts: [u32; CONTRASTS],
}

impl LineScore<'_> {
    #[inline]
    fn visit(&mut self, node: u32) {
        let added = &self.scoring.scores[node as usize];
        for (sum, score) in self.scores.iter_mut().zip(added) {
            *sum += score;
        }
        bits(self.scoring.contrasts[node as usize]).for_each(|c| self.contrasts[c] += 1);
    }
}

impl Probe for LineScore<'_> {
    #[inline]
    fn inner(&mut self, node: u32) {
        self.visit(node);
    }

    #[inline]
    fn leaf(&mut self, node: u32, _: u32) {
        self.visit(node);
    }
}
