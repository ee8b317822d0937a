//! How fast errors fall with the number of lines, and how many lines are enough by that.

use crate::stats::cluster_bootstrap;
use crate::study::records::{EnoughRecord, ExponentRecord};

use super::Piece;
use super::errors::{DRAWS, EXACT, LEVEL, Level, Series, widened};

/// ln RMSE = `constant` - `exponent` ln N, by least squares over the levels, which weigh the same: each has as many
/// replicates.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Law {
    constant: f64,
    exponent: f64,
}

impl Law {
    /// Of these replicates of every level; `None` with fewer than two levels, or where a level has no error but rounding.
    fn fit(series: &Series, drawn: &[usize]) -> Option<Self> {
        let point = |level: &Level| {
            let square = level.mean_square_of(drawn);
            (square > EXACT * EXACT)
                .then(|| (libm::log(level.lines as f64), 0.5 * libm::log(square)))
        };
        let points: Vec<(f64, f64)> = series.levels.iter().map(point).collect::<Option<_>>()?;
        let n = points.len() as f64;
        let x_mean = points.iter().map(|p| p.0).sum::<f64>() / n;
        let y_mean = points.iter().map(|p| p.1).sum::<f64>() / n;
        let squares: f64 = points.iter().map(|p| (p.0 - x_mean) * (p.0 - x_mean)).sum();
        let products: f64 = points.iter().map(|p| (p.0 - x_mean) * (p.1 - y_mean)).sum();
        let slope = products / squares;
        (squares > 0.0).then_some(Self {
            constant: y_mean - slope * x_mean,
            exponent: -slope,
        })
    }
}

/// The fit to a quantity, its interval from drawing replicates, the same of every level.
pub fn exponent(series: &Series, piece: &Piece<'_>) -> Option<ExponentRecord> {
    let (first, last) = (series.levels.first()?, series.levels.last()?);
    let replicates = first.squares.len();
    let all: Vec<usize> = (0..replicates).collect();
    let law = Law::fit(series, &all)?;
    let drawn = |drawn: &[usize]| Some(vec![Law::fit(series, drawn)?.exponent]);
    let intervals = cluster_bootstrap(replicates, DRAWS, piece.seed, LEVEL, drawn);
    let drawn = intervals.first().copied().flatten()?;
    let (exponent_lo, exponent_hi) = widened(law.exponent, drawn, replicates);
    Some(ExponentRecord {
        scene: piece.scene.name.clone(),
        sampler: series.way.method.name().into(),
        rays: series.way.rays(),
        quantity: series.quantity.into(),
        from_lines: first.lines,
        to_lines: last.lines,
        factor: libm::exp(law.constant),
        exponent: law.exponent,
        exponent_lo,
        exponent_hi,
    })
}

/// Lines that wanted errors take by a fit; none where errors do not fall, or the sampler has no set so large.
pub fn enough(series: &Series, fit: &ExponentRecord, wanted: &[f64]) -> Vec<EnoughRecord> {
    let lines = |wanted: f64| {
        let needed = libm::ceil(libm::pow(fit.factor / wanted, 1.0 / fit.exponent));
        // What is too large for 64 bits becomes the largest number, which no sampler has.
        series
            .way
            .method
            .sampler()
            .size_at_least(needed.max(1.0) as u64)
    };
    let row = |&wanted: &f64| {
        let lines = lines(wanted)?;
        Some(EnoughRecord {
            scene: fit.scene.clone(),
            sampler: fit.sampler.clone(),
            rays: fit.rays.clone(),
            wanted,
            lines,
            extrapolated: !(fit.from_lines..=fit.to_lines).contains(&lines),
        })
    };
    let falls = fit.exponent > 0.0;
    wanted.iter().filter(|_| falls).filter_map(row).collect()
}
