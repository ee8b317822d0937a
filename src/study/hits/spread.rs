//! The covariance of what is observed of a line, and how far it can be trusted.
//!
//! It comes from the pilot's lines. A sum that hangs on events too rare for them (a cluster that one line in a million
//! meets) would seem to have no variance, and any deviation would seem impossible. So the variance that theory gives to
//! what the pilot has not seen is added, and a quantity whose variance hangs on the unseen, or on a handful of lines, is
//! told to be unknown: its nodes are still judged one by one by their exact binomial tails.

use crate::kd::{NodeKind, Prediction, Tree};

use super::scores::{OBSERVED, Scored, Scoring};

/// Fewest lines that may share a variance: the participation ratio (sum d^2)^2 / sum d^4. At 30 the standard error is
/// known to about an eighth.
const FEWEST: f64 = 30.0;
/// Differences of this size relative to the values are rounding: the sums of scores are not exact.
const ROUNDING: f64 = 1e-9;
/// Most of a variance that may come from what the pilot has not seen.
const MOST_UNSEEN: f64 = 0.25;

/// Covariances of everything observed of a line.
type Matrix = [[f64; OBSERVED]; OBSERVED];

/// Covariance of everything observed of a line.
pub struct Spread {
    covariance: Matrix,
    reliable: [bool; OBSERVED],
    /// Whether no line of the pilot differs from another, but for rounding.
    constant: [bool; OBSERVED],
}

impl Spread {
    /// The pilot's covariance with the variance of what it has not seen.
    pub fn new(tree: &Tree, prediction: &Prediction, scoring: &Scoring, pilot: &Scored) -> Self {
        let n = pilot.lines.len() as f64;
        let mean = pilot.moments.mean().expect("a pilot has lines");
        let mut covariance = pilot.moments.covariance().expect("a pilot has two lines");
        let mut fourth = [0.0; OBSERVED];
        for row in &pilot.lines {
            for (sum, (value, mean)) in fourth.iter_mut().zip(row.iter().zip(mean)) {
                let square = (value - mean) * (value - mean);
                *sum += square * square;
            }
        }
        let constant = std::array::from_fn(|i| {
            let values = || pilot.lines.iter().map(|row| row[i]);
            let (lo, hi) =
                values().fold((f64::MAX, f64::MIN), |(lo, hi), v| (lo.min(v), hi.max(v)));
            hi - lo <= ROUNDING * hi.abs().max(lo.abs())
        });
        let unseen = unseen(tree, prediction, scoring, pilot);
        let reliable = std::array::from_fn(|i| {
            let variance = covariance[i][i];
            let squares = variance * (n - 1.0);
            let lines = squares * squares / fourth[i];
            !constant[i] && lines >= FEWEST && unseen[i][i] <= MOST_UNSEEN * variance
        });
        for i in 0..OBSERVED {
            (0..OBSERVED).for_each(|j| covariance[i][j] += unseen[i][j]);
        }
        Self {
            covariance,
            reliable,
            constant,
        }
    }

    /// Covariance of two quantities.
    pub fn covariance(&self, i: usize, j: usize) -> f64 {
        self.covariance[i][j]
    }

    /// Whether the pilot tells the variance of a quantity.
    pub fn is_reliable(&self, i: usize) -> bool {
        self.reliable[i]
    }

    /// Standard deviation of a quantity; with the unseen, so never too small by much.
    pub fn deviation(&self, i: usize) -> f64 {
        self.covariance[i][i].sqrt()
    }

    /// Standard error of the mean of a form of the quantities over `lines` lines, or `None` where the pilot cannot tell it.
    /// A form of quantities that no line changes, and that came out as predicted, has none.
    pub fn standard_error(
        &self,
        form: &[(usize, f64)],
        lines: f64,
        as_predicted: bool,
    ) -> Option<f64> {
        let form: Vec<_> = form.iter().filter(|(_, weight)| *weight != 0.0).collect();
        if form.iter().all(|(i, _)| self.constant[*i]) && as_predicted {
            return Some(0.0);
        }
        let known = |i: usize| self.reliable[i] || (self.constant[i] && as_predicted);
        let pairs = form.iter().flat_map(|a| form.iter().map(move |b| (a, b)));
        let variance: f64 = pairs
            .map(|(a, b)| a.1 * b.1 * self.covariance[a.0][b.0])
            .sum();
        form.iter()
            .all(|(i, _)| known(*i))
            .then(|| (variance.max(0.0) / lines).sqrt())
    }
}

/// Variance from events that no line of the pilot met: hits of nodes it never hit, misses of nodes it never missed.
///
/// A subtree K that no line hit adds p_K t t', with t what a line that hits K is expected to add there. Subtrees inside it
/// are counted with it.
fn unseen(tree: &Tree, prediction: &Prediction, scoring: &Scoring, pilot: &Scored) -> Matrix {
    let n = pilot.counts.lines;
    let hits = &pilot.counts.hits;
    let mut total = [[0.0; OBSERVED]; OBSERVED];
    let mut inside = vec![false; tree.nodes.len()];
    for (i, node) in tree.nodes.iter().enumerate() {
        let p = prediction.p[i];
        let below_unseen = inside[i];
        if let NodeKind::Inner { left, .. } = node.kind() {
            inside[left as usize..][..2].fill(below_unseen || hits[i] == 0);
        }
        let chance = match hits[i] {
            0 if !below_unseen => p,
            h if h == n => 1.0 - p,
            _ => 0.0,
        };
        if chance <= 0.0 || p <= 0.0 {
            continue;
        }
        let sum = subtree(tree, prediction, scoring, i);
        for a in 0..OBSERVED {
            (0..OBSERVED).for_each(|b| total[a][b] += chance * (sum[a] / p) * (sum[b] / p));
        }
    }
    total
}

/// What a line is expected to add in a subtree.
fn subtree(
    tree: &Tree,
    prediction: &Prediction,
    scoring: &Scoring,
    root: usize,
) -> [f64; OBSERVED] {
    let mut sum = [0.0; OBSERVED];
    let mut open = vec![root];
    while let Some(i) = open.pop() {
        let added = scoring.adds(tree, i);
        (0..OBSERVED).for_each(|a| sum[a] += prediction.p[i] * added[a]);
        if let NodeKind::Inner { left, .. } = tree.nodes[i].kind() {
            open.extend([left as usize, left as usize + 1]);
        }
    }
    sum
}
