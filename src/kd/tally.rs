//! Object counts at given planes across one axis of a node, from one pass over the objects' boxes in any order.
//!
//! A strategy whose candidates are positions, not object bounds, needs no sorted events: each box is put between the
//! planes where it begins and ends, and sums over the planes tell the rest (the binning of Wald 2007, exact at the planes).

use std::ops::Range;

use super::planes::{Fractions, Planes};
use super::split::{Coster, Split};

/// Relative error that the computed costs of two planes may have together: each takes some ten roundings of numbers that
/// are not negative, of 2^-53 each.
const ROUNDING: f64 = 1e-14;

/// Counts left of, in and right of planes. Empty between two uses.
pub(super) struct Tally {
    /// What is new at each plane; one more for what is new behind the last.
    changes: Vec<Change>,
    /// Which of them are not zero: bit i mod 64 of word i / 64.
    changed: Vec<u64>,
}

/// Objects whose side changes from one plane to the next.
#[derive(Clone, Copy, Default)]
struct Change {
    /// They begin before this plane, not before the one below.
    begun: u32,
    /// They end before or in this plane, not so in the one below.
    ended: u32,
    /// They lie in this plane.
    planar: u32,
}

impl Tally {
    pub fn new(fractions: &Fractions) -> Self {
        let planes = fractions.len();
        Self {
            changes: vec![Change::default(); planes + 1],
            changed: vec![0; planes / 64 + 1],
        }
    }

    /// Count an object that reaches from `lo` to `hi`.
    #[inline]
    pub fn add(&mut self, planes: &Planes, lo: f64, hi: f64) {
        // It is on the left of the planes from `begun` on, on the right of those before `ended`.
        let begun = planes.count_below(lo, |s| s <= lo);
        let ended = planes.count_below(hi, |s| s < hi);
        self.at(begun).begun += 1;
        self.at(ended).ended += 1;
        for plane in ended..begun {
            self.at(plane).planar += 1;
        }
    }

    #[inline]
    fn at(&mut self, i: usize) -> &mut Change {
        self.changed[i / 64] |= 1 << (i % 64);
        &mut self.changes[i]
    }

    /// The cheapest plane, of equals the lowest, for a node of `n` objects. Empties the tally.
    pub fn cheapest(&mut self, planes: &Planes, coster: &Coster, n: usize) -> Option<Split> {
        let mut best = None;
        let (mut first, mut left, mut planar, mut right) = (0, 0, 0, n);
        for (i, word) in self.changed.iter_mut().enumerate() {
            while *word != 0 {
                let next = 64 * i + word.trailing_zeros() as usize;
                *word &= *word - 1;
                offer_run(
                    &mut best,
                    planes,
                    coster,
                    first..next,
                    [left, planar, right],
                );
                let change = std::mem::take(&mut self.changes[next]);
                left += change.begun as usize;
                right -= change.ended as usize;
                planar = change.planar as usize;
                first = next;
            }
        }
        let run = first..planes.len();
        offer_run(&mut best, planes, coster, run, [left, planar, right]);
        best
    }
}

/// Offer planes with the same counts.
///
/// Between such planes the cost is linear, so that but for rounding none costs less than both ends. Where it may, all are
/// looked at, so that the choice is what it would be if all always were.
#[inline]
fn offer_run(
    best: &mut Option<Split>,
    planes: &Planes,
    coster: &Coster,
    run: Range<usize>,
    [left, planar, right]: [usize; 3],
) {
    let offer = |best: &mut Option<Split>, i: usize| {
        coster.offer(best, planes.at(i), left, planar, right);
    };
    if run.len() > 4 {
        let mut of_ends = *best;
        offer(&mut of_ends, run.start);
        offer(&mut of_ends, run.end - 1);
        // All others lie between these two.
        let inner = [run.start + 1, run.end - 2];
        let costs = inner.map(|i| coster.split(planes.at(i), left, planar, right));
        if let ([Some(a), Some(b)], Some(ends)) = (costs, of_ends)
            && a.cost.min(b.cost) * (1.0 - ROUNDING) > ends.cost
        {
            *best = of_ends;
            return;
        }
    }
    for i in run {
        offer(best, i);
    }
}
