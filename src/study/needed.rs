//! How many lines a wanted relative error of the tree cost C takes: the rule behind `--error`.
//!
//! Trial lines of their own are looked at after 1024, 2048, 4096, ... of them, until they tell the variance of C well enough
//! (Stein's two stages, the first of them sequential). Then so many lines are counted afresh. Their number is settled before
//! the first of them is drawn, so they are a sample of fixed size: every interval and test of a run holds as it stands, which
//! it would not around lines that had been stopped by what they showed.
//!
//! A trial knows nothing of what its lines are too few to meet: a dense cluster that one line in 10^5 hits may make most of
//! the variance. But areas tell how often a line hits each node, and what it is expected to do there: see [`Rare`].

#[cfg(test)]
mod tests;
mod verdict;

use std::ops::Range;

use rayon::prelude::*;

use crate::cost::CostModel;
use crate::kd::{Node, NodeKind, Prediction, Stack, Tree};
use crate::stats::{ScoreMoments, normal_quantile};

pub use verdict::{of_cells, of_rays, verdict};

/// C is within the wanted error with this probability.
pub const CONFIDENCE: f64 = 0.95;

/// The first trial line: no run counts as many.
pub const TRIAL: u64 = 1 << 40;

/// Trial lines of the first look.
const FIRST: u64 = 1024;

/// Most trial lines.
const MOST: u64 = 1 << 24;

/// Standard errors by which the variance is taken larger, and the mean smaller, than the trial shows them.
const CAUTION: f64 = 3.3;

/// A variance known to this share, and a mean known to a quarter of it, end the trial: at most a third of the lines are then
/// more than needed.
const KNOWN: f64 = 0.2;

/// A trial of this share of the lines it asks for ends, too.
const SHARE: f64 = 0.25;

/// Lines that one thread takes at a time; sums are merged in the order of the lines.
const CHUNK: u64 = 1024;

/// The variance of C that events too rare for a trial add to it, from areas alone.
///
/// A subtree K that a line hits with probability p and in which it is then expected to spend t adds at least p t^2; where what
/// is spent there falls to parts of it that are rarer still, the sum over these is more.
pub struct Rare {
    /// Of every node p, what it adds, and the first of its two children.
    nodes: Vec<(f64, f64, Option<usize>)>,
}

/// A subtree that fewer trial lines than this are expected to hit is rare.
const FEW: f64 = 30.0;

/// What a line spends in a rare subtree varies: its second moment is taken as so many times the square of its mean.
const VARIES: f64 = 2.0;

impl Rare {
    /// Of the lines of a tree.
    pub fn of(tree: &Tree, prediction: &Prediction, cost: CostModel) -> Self {
        let own = |node: &Node| match node.kind() {
            NodeKind::Inner { .. } => cost.cost(1.0, 0.0, 0.0),
            NodeKind::Leaf { count, .. } => cost.cost(0.0, 1.0, count.into()),
        };
        let mut below: Vec<f64> = tree
            .nodes
            .iter()
            .zip(&prediction.p)
            .map(|(node, p)| p * own(node))
            .collect();
        let mut nodes = vec![(0.0, 0.0, None); tree.nodes.len()];
        // Children come after their parent in the arena: from the end, every sum is complete when it is passed up.
        for i in (0..tree.nodes.len()).rev() {
            let left = match tree.nodes[i].kind() {
                NodeKind::Inner { left, .. } => Some(left as usize),
                NodeKind::Leaf { .. } => None,
            };
            if let Some(left) = left {
                below[i] += below[left] + below[left + 1];
            }
            let p = prediction.p[i];
            let whole = if p > 0.0 {
                below[i] * below[i] / p
            } else {
                0.0
            };
            let parts = left.map_or(0.0, |left| nodes[left].1 + nodes[left + 1].1);
            nodes[i] = (p, whole.max(parts), left);
        }
        Self { nodes }
    }

    /// The variance, for a trial of so many lines: of the largest subtrees that are rare for it.
    fn variance(&self, lines: f64) -> f64 {
        let mut sum = 0.0;
        let mut open = vec![0];
        while let Some(i) = open.pop() {
            let Some(&(p, adds, left)) = self.nodes.get(i) else {
                break;
            };
            if p * lines < FEW {
                sum += VARIES * adds;
            } else if let Some(left) = left {
                open.extend([left, left + 1]);
            }
        }
        sum
    }
}

/// Lines that bring the relative error of C's mean to `error` or below, with probability [`CONFIDENCE`]; not fewer than
/// `least` and not more than `most`. `cost` gives what line i costs, or `None` where it misses the root's box: of such lines
/// no cost is predicted, and more are drawn instead. `rare` is of isotropic lines; of other rays it is the best guess there is.
pub fn needed(
    error: f64,
    [least, most]: [u64; 2],
    rare: &Rare,
    cost: impl Fn(u64, &mut Stack) -> Option<f64> + Sync,
) -> u64 {
    let mut trial = ScoreMoments::default();
    let mut looked_at = 0;
    loop {
        let next = (2 * looked_at).max(FIRST);
        trial.merge(&moments(TRIAL + looked_at..TRIAL + next, &cost));
        looked_at = next;
        let asked = asked(error, rare.variance(trial.n() as f64), &trial);
        // Of every line that hits the root's box so many are drawn.
        let drawn = looked_at as f64 / trial.n().max(1) as f64;
        let lines = asked.lines * drawn;
        if asked.known || looked_at as f64 >= SHARE * lines || looked_at >= MOST {
            return (lines.ceil() as u64).clamp(least, most);
        }
    }
}

/// Of C and C^2, line by line.
fn moments(
    lines: Range<u64>,
    cost: &(impl Fn(u64, &mut Stack) -> Option<f64> + Sync),
) -> ScoreMoments<2> {
    let starts: Vec<u64> = lines.clone().step_by(CHUNK as usize).collect();
    let chunk = |&start: &u64| {
        let mut own = ScoreMoments::default();
        let mut stack = Stack::default();
        for i in start..lines.end.min(start + CHUNK) {
            if let Some(c) = cost(i, &mut stack) {
                own.push([c, c * c]);
            }
        }
        own
    };
    let chunks: Vec<ScoreMoments<2>> = starts.par_iter().map(chunk).collect();
    let mut all = ScoreMoments::default();
    chunks.iter().for_each(|own| all.merge(own));
    all
}

/// What a trial asks for.
struct Asked {
    /// Lines, of those that hit the root's box.
    lines: f64,
    /// Whether the trial tells the variance well enough.
    known: bool,
}

/// N = (z s / (E C))^2, with s taken larger and C smaller than the trial shows them, and what is `rare` for it added to s^2.
fn asked(error: f64, rare: f64, trial: &ScoreMoments<2>) -> Asked {
    let (Some([mean, _]), Some([[variance, with_square], [_, of_square]])) =
        (trial.mean(), trial.covariance())
    else {
        // No two lines that hit the root's box: nothing to be known, so all that may be drawn.
        return Asked {
            lines: f64::INFINITY,
            known: false,
        };
    };
    if variance + rare <= 0.0 {
        return Asked {
            lines: 0.0,
            known: true,
        };
    }
    let n = trial.n() as f64;
    // Variance of (C - mean)^2, so that of the sample's variance.
    let of_variance = of_square - 4.0 * mean * with_square + 4.0 * mean * mean * variance;
    let uncertain = CAUTION * (of_variance.max(0.0) / n).sqrt();
    let off = CAUTION * (variance / n).sqrt();
    let least_mean = mean - off;
    let z = normal_quantile(CONFIDENCE);
    let lines = if least_mean > 0.0 {
        z * z * (variance + uncertain + rare) / (error * error * least_mean * least_mean)
    } else {
        f64::INFINITY
    };
    Asked {
        lines,
        known: uncertain + rare <= KNOWN * variance && off <= 0.25 * KNOWN * mean,
    }
}
