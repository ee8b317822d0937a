//! What many numbers have in common: their middle and how far they lie apart.

/// Middle and ends of some positive numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Spread {
    /// How many there are.
    pub number: usize,
    /// Geometric mean: twice as much here and half as much there make 1.
    pub geometric: f64,
    /// Median.
    pub median: f64,
    /// 5 % quantile.
    pub low: f64,
    /// 95 % quantile.
    pub high: f64,
    /// The least.
    pub least: f64,
    /// The largest.
    pub largest: f64,
}

impl Spread {
    /// Of the positive numbers among these; `None` without one.
    pub fn of(values: impl IntoIterator<Item = f64>) -> Option<Self> {
        let usable = values.into_iter().filter(|v| v.is_finite() && *v > 0.0);
        let mut sorted: Vec<f64> = usable.collect();
        sorted.sort_by(f64::total_cmp);
        let logs: f64 = sorted.iter().map(|&value| libm::log(value)).sum();
        Some(Self {
            number: sorted.len(),
            geometric: libm::exp(logs / sorted.len() as f64),
            median: quantile(&sorted, 0.5)?,
            low: quantile(&sorted, 0.05)?,
            high: quantile(&sorted, 0.95)?,
            least: *sorted.first()?,
            largest: *sorted.last()?,
        })
    }
}

/// The middle of some numbers, in any order; `None` without one.
pub fn median(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    let mut sorted: Vec<f64> = values.into_iter().collect();
    sorted.sort_by(f64::total_cmp);
    quantile(&sorted, 0.5)
}

/// The value below which this share of sorted values lies, interpolated (definition 7 of Hyndman and Fan, American
/// Statistician 50, 1996).
fn quantile(sorted: &[f64], share: f64) -> Option<f64> {
    let position = share * sorted.len().checked_sub(1)? as f64;
    let below = position as usize;
    let above = (below + 1).min(sorted.len() - 1);
    Some(sorted[below] + (position - below as f64) * (sorted[above] - sorted[below]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spread_by_hand() {
        let found = Spread::of([8.0, 0.0, 2.0, 1.0, f64::NAN, 4.0]).unwrap();
        assert_eq!((found.number, found.median), (4, 3.0));
        assert_eq!((found.least, found.largest), (1.0, 8.0));
        assert!((found.geometric - 8.0_f64.sqrt()).abs() < 1e-14);
        // Positions 0.15 and 2.85.
        assert!((found.low - 1.15).abs() < 1e-14 && (found.high - 7.4).abs() < 1e-14);
        assert_eq!(Spread::of([0.0]), None);
        assert_eq!(median([3.0, 1.0, 2.0]), Some(2.0));
        assert_eq!(median([]), None);
    }
}
