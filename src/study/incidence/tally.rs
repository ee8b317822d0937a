//! Verdicts of a kernel, counted.

use std::ops::AddAssign;

use super::{Judged, Pair};

/// Verdicts of a kernel over some lines, counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Pairs judged.
    pub cases: u64,
    /// Of them, exact hits.
    pub hits: u64,
    /// Misses taken for hits, and no tie.
    pub wrong: u64,
    /// Hits taken for misses, and no tie.
    pub missed: u64,
    /// Pairs nearer to a tie than [`TIE`](super::TIE).
    pub ties: u64,
    /// Of them, misses taken for hits.
    pub tied_wrong: u64,
    /// Of them, hits taken for misses.
    pub tied_missed: u64,
    /// Sum over the lines of the squares of their errors of all kinds. One line that grazes a box errs in all nodes below: lines
    /// err independently, nodes do not.
    pub squares: u64,
}

impl Tally {
    /// All the pairs of one line.
    pub fn of_a_line(pairs: &[Pair]) -> Self {
        let mut tally = Self::default();
        for pair in pairs {
            tally.count(pair.judged);
        }
        tally.squares = tally.errors().pow(2);
        tally
    }

    fn count(&mut self, judged: Judged) {
        let tie = judged.is_tie();
        self.cases += 1;
        self.hits += u64::from(judged.exact);
        self.ties += u64::from(tie);
        if judged.errs() {
            *match (tie, judged.exact) {
                (false, false) => &mut self.wrong,
                (false, true) => &mut self.missed,
                (true, false) => &mut self.tied_wrong,
                (true, true) => &mut self.tied_missed,
            } += 1;
        }
    }

    /// Ties judged wrongly.
    pub fn tied_errors(&self) -> u64 {
        self.tied_wrong + self.tied_missed
    }

    /// Errors of all kinds.
    pub fn errors(&self) -> u64 {
        self.wrong + self.missed + self.tied_errors()
    }
}

impl AddAssign for Tally {
    fn add_assign(&mut self, other: Self) {
        self.cases += other.cases;
        self.hits += other.hits;
        self.wrong += other.wrong;
        self.missed += other.missed;
        self.ties += other.ties;
        self.tied_wrong += other.tied_wrong;
        self.tied_missed += other.tied_missed;
        self.squares += other.squares;
    }
}
