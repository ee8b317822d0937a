//! Errors of estimates over independent replicates, with their intervals and what they gain over independent lines.

use crate::stats::{chi_square_quantile, cluster_bootstrap, f_quantile, normal_quantile};
use crate::study::records::ErrorRecord;

use super::Piece;
use super::method::Way;
use super::replicates::Replicate;

/// What is estimated, in the order of [`Replicate::rates`] and then the nodes.
pub const QUANTITIES: [&str; 5] = ["n_K", "n_B", "n_t", "C", "nodes"];

/// The quantity that the nodes' shares of hits make up together.
pub const NODES: &str = QUANTITIES[4];

/// Level of the intervals.
pub const LEVEL: f64 = 0.95;

/// Draws of a bootstrap.
pub const DRAWS: usize = 1000;

/// An interval from drawing replicates, made as much wider around `value` as the few of them ask for: percentiles are too
/// short by sqrt(1 - 1/n) and by the tails of Student's t (Davison & Hinkley 1997, 5.3).
pub fn widened(value: f64, (lo, hi): (f64, f64), replicates: usize) -> (f64, f64) {
    let n = replicates as f64;
    let student = f_quantile(LEVEL, 1.0, n - 1.0).sqrt();
    let factor = student / normal_quantile(LEVEL) * (n / (n - 1.0)).sqrt();
    (value + factor * (lo - value), value + factor * (hi - value))
}

/// The same of what is positive, by its logarithm.
fn widened_ratio(value: f64, (lo, hi): (f64, f64), replicates: usize) -> (f64, f64) {
    if !(value > 0.0 && lo > 0.0) {
        return (lo, hi);
    }
    let ends = (libm::log(lo / value), libm::log(hi / value));
    let (lo, hi) = widened(0.0, ends, replicates);
    (value * libm::exp(lo), value * libm::exp(hi))
}

/// Relative errors below this are rounding: the estimate is exact.
pub const EXACT: f64 = 1e-12;

/// True values of n_K, n_B, n_t and C.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Truth {
    /// The values.
    pub rates: [f64; 4],
    /// Their standard errors, where they are not exact.
    pub errors: Option<[f64; 4]>,
}

impl Truth {
    /// The mean of replicates of a long reference.
    pub fn of_reference(replicates: &[Replicate]) -> Self {
        let n = replicates.len() as f64;
        let moments = |k: usize| {
            let mean = replicates.iter().map(|r| r.rates[k]).sum::<f64>() / n;
            let squares = replicates
                .iter()
                .map(|r| (r.rates[k] - mean) * (r.rates[k] - mean));
            (mean, (squares.sum::<f64>() / (n * (n - 1.0))).sqrt())
        };
        let moments: [_; 4] = std::array::from_fn(moments);
        Self {
            rates: moments.map(|m| m.0),
            errors: Some(moments.map(|m| m.1)),
        }
    }
}

/// Replicates of so many lines.
#[derive(Clone, Debug, PartialEq)]
pub struct Level {
    /// Lines of each.
    pub lines: u64,
    /// Mean of the replicates over the truth, minus 1; `None` of nodes.
    bias: Option<f64>,
    /// The squared relative error of each.
    pub squares: Vec<f64>,
}

impl Level {
    fn mean_square(&self) -> f64 {
        self.squares.iter().sum::<f64>() / self.squares.len() as f64
    }

    /// The mean square error of these replicates of it.
    pub fn mean_square_of(&self, drawn: &[usize]) -> f64 {
        drawn.iter().map(|&r| self.squares[r]).sum::<f64>() / drawn.len() as f64
    }
}

/// The errors of one quantity by one way, by the number of lines.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// The way.
    pub way: Way,
    /// The quantity.
    pub quantity: &'static str,
    truth: Option<f64>,
    truth_error: Option<f64>,
    /// Few lines first. The numbers of replicates are the same.
    pub levels: Vec<Level>,
}

impl Series {
    /// All quantities of a way, but those whose truth is 0 (no relative error is) and nodes where none was judged.
    pub fn all(way: Way, truth: &Truth, found: &[(u64, Vec<Replicate>)]) -> Vec<Self> {
        let rates = (0..4).filter(|&k| truth.rates[k] > 0.0).map(|k| {
            let truth_k = truth.rates[k];
            let level = |(lines, replicates): &(u64, Vec<Replicate>)| {
                let errors = replicates.iter().map(|r| r.rates[k] / truth_k - 1.0);
                Level {
                    lines: *lines,
                    bias: Some(errors.clone().sum::<f64>() / replicates.len() as f64),
                    squares: errors.map(|e| e * e).collect(),
                }
            };
            Self {
                way,
                quantity: QUANTITIES[k],
                truth: Some(truth_k),
                truth_error: truth.errors.map(|errors| errors[k] / truth_k),
                levels: found.iter().map(level).collect(),
            }
        });
        let nodes = |(lines, replicates): &(u64, Vec<Replicate>)| {
            let squares: Option<Vec<f64>> = replicates.iter().map(|r| r.nodes).collect();
            Some(Level {
                lines: *lines,
                bias: None,
                squares: squares?,
            })
        };
        let nodes: Option<Vec<Level>> = found.iter().map(nodes).collect();
        let nodes = nodes.map(|levels| Self {
            way,
            quantity: NODES,
            truth: None,
            truth_error: None,
            levels,
        });
        rates.chain(nodes).collect()
    }

    /// The mean square error of one line, all replicates together: of independent lines it is N times that of N.
    fn of_one_line(&self, drawn: &[usize]) -> f64 {
        let levels = self.levels.iter();
        let sum: f64 = levels
            .map(|l| l.lines as f64 * l.mean_square_of(drawn))
            .sum();
        sum / self.levels.len() as f64
    }

    /// The rows, one a level. `random` is the same quantity by independent lines, which gain nothing over themselves.
    pub fn rows(&self, piece: &Piece<'_>, random: &Series) -> Vec<ErrorRecord> {
        let one = |level: &Level| self.row(piece, level, random);
        self.levels.iter().map(one).collect()
    }

    fn row(&self, piece: &Piece<'_>, level: &Level, random: &Series) -> ErrorRecord {
        let replicates = level.squares.len();
        let all: Vec<usize> = (0..replicates).collect();
        let gain = |drawn: &[usize]| {
            random.of_one_line(drawn) / (level.lines as f64 * level.mean_square_of(drawn))
        };
        let rmse = level.mean_square().sqrt();
        let (of_rmse, of_gain) = if self.quantity == NODES {
            // A sum over nodes that depend on each other has no degrees of freedom to speak of.
            let figures =
                |drawn: &[usize]| Some(vec![level.mean_square_of(drawn).sqrt(), gain(drawn)]);
            let found = cluster_bootstrap(replicates, DRAWS, piece.seed, LEVEL, figures);
            let of_rmse = found[0].expect("every draw has an error");
            (
                widened_ratio(rmse, of_rmse, replicates),
                found[1].map(|ends| widened_ratio(gain(&all), ends, replicates)),
            )
        } else {
            let r = replicates as f64;
            let outside = 0.5 * (1.0 - LEVEL);
            let end = |p: f64| rmse * (r / chi_square_quantile(p, r)).sqrt();
            let ends = |p: f64| gain(&all) / f_quantile(p, r * random.levels.len() as f64, r);
            (
                (end(1.0 - outside), end(outside)),
                Some((ends(1.0 - outside), ends(outside))),
            )
        };
        let own_gain = (self.way.method != random.way.method && rmse > EXACT).then(|| gain(&all));
        let of_gain = of_gain.filter(|_| own_gain.is_some());
        ErrorRecord {
            cell: piece.id.clone(),
            scene: piece.scene.name.clone(),
            strategy: piece.rules.strategy.name(),
            sampler: self.way.method.name().into(),
            rays: self.way.rays(),
            quantity: self.quantity.into(),
            lines: level.lines,
            replicates: replicates as u64,
            truth: self.truth,
            truth_error: self.truth_error,
            bias: level.bias,
            rmse,
            rmse_lo: of_rmse.0,
            rmse_hi: of_rmse.1,
            gain: own_gain,
            gain_lo: of_gain.map(|g| g.0),
            gain_hi: of_gain.map(|g| g.1),
        }
    }
}

#[cfg(test)]
mod tests;
