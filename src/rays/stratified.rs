//! Stratified points: one uniform point in each of m^4 equal cells.
//!
//! The variance of the mean of an indicator whose boundary has a finite area falls as N^(-1 - 1/4) instead of N^-1.

use super::Uniforms;

/// One point in each cell, cell by cell.
pub(super) struct Stratified {
    jitter: Uniforms,
    /// The cell of the next point, the first coordinate fastest.
    cell: [u32; 4],
    /// Cells along each axis.
    side: u32,
}

impl Stratified {
    /// From cell number `i` on, of `side`^4.
    pub(super) fn starting_at(jitter: Uniforms, side: u32, i: u64) -> Self {
        let mut rest = i;
        let cell = std::array::from_fn(|_| {
            let digit = rest % u64::from(side);
            rest /= u64::from(side);
            digit as u32
        });
        Self { jitter, cell, side }
    }

    /// The point of this cell, each coordinate in (0, 1); moves on to the next.
    #[inline]
    pub(super) fn next4(&mut self) -> [f64; 4] {
        /// The largest number below 1: the sum may be rounded up to the next cell, and there is none behind the last.
        const LARGEST: f64 = 1.0 - 0.5 * f64::EPSILON;
        let inside = self.jitter.next4();
        let side = f64::from(self.side);
        let point =
            std::array::from_fn(|k| ((f64::from(self.cell[k]) + inside[k]) / side).min(LARGEST));
        for digit in &mut self.cell {
            *digit += 1;
            if *digit < self.side {
                break;
            }
            *digit = 0;
        }
        point
    }
}
