//! Least squares with coefficients that are not negative, as costs are not.
//!
//! The idea: columns are freed from 0 one by one, always the one along which the sum of squares falls fastest; whatever
//! the fit of the free columns would make negative returns to 0. Source: Lawson and Hanson, "Solving Least Squares
//! Problems" (1974), chapter 23, algorithm NNLS; from the normal equations: Bro and de Jong, "A fast
//! non-negativity-constrained least squares algorithm" (J. Chemometrics 11, 1997).
//!
//! The invariant: the solution satisfies the conditions of Karush, Kuhn and Tucker: b >= 0, and the gradient
//! w = X'(y - X b) is 0 where b > 0 and not positive elsewhere, to rounding; but for columns that depend on the free
//! ones to 1e-5 of their length, where w may be up to 1e-5 of their length times |y - X b|.

use std::collections::BTreeSet;

use super::cholesky::Cholesky;
use super::normal_equations::{Normal, Scaled};

/// A component of the gradient is positive if it exceeds this share of the magnitudes it is the sum of.
const ROUNDING: f64 = 1e-12;

impl Normal {
    /// The b >= 0 that makes the sum of squares |y - X b|^2 least, a coefficient a column.
    ///
    /// A column that is zero has the coefficient 0; of columns that depend on each other as many have as need be.
    pub fn solve(&self) -> Vec<f64> {
        let Scaled {
            gram,
            rhs,
            inverse_lengths,
        } = self.scaled();
        let columns = rhs.len();
        let fit = |passive: &[usize]| {
            let mut factor = Cholesky::default();
            for &j in passive {
                factor.take(&gram, j);
            }
            factor.solve(&rhs)
        };
        // The columns that are not held at 0, in the order they came: then each depends on those before no more than it
        // did when it came. Every set of them is kept once only, so the search ends whatever rounding does.
        let mut passive: Vec<usize> = Vec::new();
        let mut seen = BTreeSet::from([vec![]]);
        let mut refused = vec![false; columns];
        let mut x = vec![0.0; columns];
        while let Some(j) = steepest(&gram, &rhs, &x, |j| !refused[j] && !passive.contains(&j)) {
            let (mut trial, mut free) = (x.clone(), passive.clone());
            free.push(j);
            let mut target = fit(&free);
            // If not, the gradient is all rounding, or j depends on the others.
            let gains = target[j] > 0.0;
            while let Some(share) = step(&trial, &target, &free).filter(|_| gains) {
                free.retain(|&i| {
                    let blocks = target[i] <= 0.0 && reach(trial[i], target[i]) <= share;
                    trial[i] += share * (target[i] - trial[i]);
                    !blocks && trial[i] > 0.0
                });
                target = fit(&free);
            }
            let mut set = free.clone();
            set.sort_unstable();
            if gains && seen.insert(set) {
                (x, passive) = (target, free);
                refused.fill(false);
            } else {
                refused[j] = true;
            }
        }
        (x.iter().zip(inverse_lengths))
            .map(|(x, scale)| x * scale)
            .collect()
    }
}

/// The first column held at 0 along which the sum of squares falls fastest, if it falls by more than rounding.
fn steepest(
    gram: &[Vec<f64>],
    rhs: &[f64],
    x: &[f64],
    held: impl Fn(usize) -> bool,
) -> Option<usize> {
    let mut best = (0.0, None);
    for j in (0..x.len()).filter(|&j| held(j)) {
        let (mut gradient, mut magnitude) = (rhs[j], rhs[j].abs());
        for (g, x) in gram[j].iter().zip(x) {
            gradient -= g * x;
            magnitude += (g * x).abs();
        }
        if gradient > ROUNDING * magnitude && gradient > best.0 {
            best = (gradient, Some(j));
        }
    }
    best.1
}

/// The share of the way from x to the target at which the first free column reaches 0; `None` if none does.
fn step(x: &[f64], target: &[f64], free: &[usize]) -> Option<f64> {
    let blocking = free.iter().filter(|&&i| target[i] <= 0.0);
    blocking.map(|&i| reach(x[i], target[i])).reduce(f64::min)
}

/// The share of the way from x > 0 to the target <= 0 at which 0 is.
fn reach(x: f64, target: f64) -> f64 {
    x / (x - target)
}

#[cfg(test)]
mod tests;
