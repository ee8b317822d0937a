//! Object counts at given planes across one axis of a node, from one pass over the objects' boxes in any order.
//!
//! A strategy whose candidates are positions, not object bounds, needs no sorted events: each box is put between the
//! planes where it begins and ends, and sums over the planes tell the rest (the binning of Wald 2007, exact at the planes).

use super::split::{Coster, Split};

/// Counts left of, in and right of planes.
#[derive(Default)]
pub(super) struct Tally {
    /// Ascending, distinct, strictly inside the node.
    planes: Vec<f64>,
    /// Planes per length, to guess how many lie below a position.
    density: f64,
    /// What is new at each plane; one more for what is new behind the last.
    changes: Vec<Change>,
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
    /// Begin anew with these planes, ascending; those that do not part the node are left out.
    pub fn restart(&mut self, planes: &[f64], coster: &Coster) {
        self.planes.clear();
        let inside = planes.iter().copied().filter(|&s| coster.is_inside(s));
        self.planes.extend(inside);
        self.density = match self.planes[..] {
            [first, .., last] => (self.planes.len() - 1) as f64 / (last - first),
            _ => 0.0,
        };
        self.changes.clear();
        self.changes
            .resize(self.planes.len() + 1, Change::default());
    }

    /// Count an object that reaches from `lo` to `hi`.
    #[inline]
    pub fn add(&mut self, lo: f64, hi: f64) {
        // It is on the left of the planes from `begun` on, on the right of those before `ended`.
        let begun = self.planes_below(|s| s <= lo, lo);
        let ended = self.planes_below(|s| s < hi, hi);
        self.changes[begun].begun += 1;
        self.changes[ended].ended += 1;
        if begun > ended {
            self.changes[ended].planar += 1;
        }
    }

    /// How many planes are `below` the position x: guessed as if they were equally spaced, which they nearly are, and put
    /// right.
    #[inline]
    fn planes_below(&self, below: impl Fn(f64) -> bool, x: f64) -> usize {
        let Some(&first) = self.planes.first() else {
            return 0;
        };
        // The cast takes what is negative or not a number to 0.
        let mut found = (((x - first) * self.density) as usize).min(self.planes.len());
        while found < self.planes.len() && below(self.planes[found]) {
            found += 1;
        }
        while found > 0 && !below(self.planes[found - 1]) {
            found -= 1;
        }
        found
    }

    /// The cheapest plane, of equals the lowest, for a node of `n` objects.
    pub fn cheapest(&self, coster: &Coster, n: usize) -> Option<Split> {
        let (mut left, mut right) = (0, n);
        let mut best = None;
        for (&s, change) in self.planes.iter().zip(&self.changes) {
            left += change.begun as usize;
            right -= change.ended as usize;
            let planar = change.planar as usize;
            coster.offer(&mut best, s, left, planar, right);
        }
        best
    }
}
