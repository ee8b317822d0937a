//! Axes: a range, where its ticks sit, and what they are called.
//!
//! Positions are worked out here and not by plotters, whose log labels print rounding noise and vanish on ranges
//! below a decade. A log axis is a linear axis of log10: [`Axis::at`] turns data into positions for both.

use super::number::{fixed, power_of_ten};

/// One labelled tick.
#[derive(Clone, Debug, PartialEq)]
pub struct Tick {
    /// Position on the axis (log10 of the value on a log axis).
    pub at: f64,
    /// Its label.
    pub label: String,
}

/// One axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// What is shown and its unit.
    pub label: String,
    /// Lower end (log10 of it on a log axis).
    pub lo: f64,
    /// Upper end (log10 of it on a log axis).
    pub hi: f64,
    /// Whether positions are log10 of the data.
    pub log: bool,
    /// Labelled ticks, each with a grid line.
    pub ticks: Vec<Tick>,
    /// Ticks without a label.
    pub minor: Vec<f64>,
}

impl Axis {
    /// A linear axis with about `want` ticks at 1, 2 or 5 times a power of ten.
    pub fn linear(label: impl Into<String>, lo: f64, hi: f64, want: usize) -> Self {
        let (lo, hi) = proper(lo, hi, false);
        let ticks = linear_ticks(lo, hi, want);
        Axis {
            label: label.into(),
            lo,
            hi,
            log: false,
            ticks,
            minor: Vec::new(),
        }
    }

    /// A log axis with at most about `want` ticks, at whole powers of ten where there are two or more.
    pub fn log(label: impl Into<String>, lo: f64, hi: f64, want: usize) -> Self {
        let (lo, hi) = proper(lo, hi, true);
        let (ticks, minor) = log_ticks(lo, hi, want);
        Axis {
            label: label.into(),
            lo: lo.log10(),
            hi: hi.log10(),
            log: true,
            ticks,
            minor,
        }
    }

    /// Position of a value, kept on the axis. None where there is none: not a number, or not positive on a log axis.
    pub fn at(&self, value: f64) -> Option<f64> {
        let at = if self.log { value.log10() } else { value };
        (!at.is_nan() && (!self.log || value > 0.0)).then(|| at.clamp(self.lo, self.hi))
    }

    /// The value at a share (0 to 1) of the way along the axis.
    pub fn value(&self, share: f64) -> f64 {
        let at = self.lo + (self.hi - self.lo) * share;
        if self.log { 10f64.powf(at) } else { at }
    }
}

/// Any two numbers made into a range that can be drawn.
fn proper(lo: f64, hi: f64, log: bool) -> (f64, f64) {
    let usable = lo.is_finite() && hi.is_finite() && (!log || lo > 0.0);
    match (usable, log) {
        (false, true) => (0.1, 1.0),
        (false, false) => (0.0, 1.0),
        (true, _) if hi < lo => proper(hi, lo, log),
        (true, true) if hi / lo < 1.0 + 1e-9 => (lo / 2.0, lo * 2.0),
        (true, false) if hi - lo <= 1e-12 * lo.abs().max(hi.abs()) => (lo - 0.5, lo + 0.5),
        (true, _) => (lo, hi),
    }
}

/// The lowest and highest of the finite values.
pub fn extent(values: impl IntoIterator<Item = f64>) -> Option<(f64, f64)> {
    values
        .into_iter()
        .filter(|value| value.is_finite())
        .fold(None, |range, value| match range {
            None => Some((value, value)),
            Some((lo, hi)) => Some((value.min(lo), value.max(hi))),
        })
}

/// 1, 2 or 5 times a power of ten, so that the range holds about `want` steps: factor and exponent.
fn nice_step(range: f64, want: usize) -> (f64, i32) {
    let rough = range / want.max(1) as f64;
    let exponent = rough.log10().floor() as i32;
    let lead = rough / 10f64.powi(exponent);
    match lead {
        lead if lead <= 1.1 => (1.0, exponent),
        lead if lead <= 2.2 => (2.0, exponent),
        lead if lead <= 5.5 => (5.0, exponent),
        _ => (1.0, exponent + 1),
    }
}

/// Positions of nice ticks, as multiples of one step.
fn linear_positions(lo: f64, hi: f64, want: usize) -> (Vec<f64>, i32) {
    let (lead, exponent) = nice_step(hi - lo, want);
    let step = lead * 10f64.powi(exponent);
    // A hair of tolerance keeps a tick that rounding pushed off the end.
    let (first, last) = (
        (lo / step - 1e-9).ceil() as i64,
        (hi / step + 1e-9).floor() as i64,
    );
    // Dividing by a whole power of ten keeps 0.3 from becoming 0.30000000000000004.
    let position = |i: i64| match exponent {
        0.. => i as f64 * step,
        _ => i as f64 * lead / 10f64.powi(-exponent),
    };
    ((first..=last).map(position).collect(), exponent)
}

fn linear_ticks(lo: f64, hi: f64, want: usize) -> Vec<Tick> {
    let (positions, exponent) = linear_positions(lo, hi, want);
    let largest = positions
        .iter()
        .fold(0f64, |largest, value| largest.max(value.abs()));
    positions
        .iter()
        .map(|&at| Tick {
            at,
            label: linear_label(at, exponent, largest),
        })
        .collect()
}

/// All ticks of an axis share a unit: thousands, millions, ... or a power of ten for very small numbers.
fn linear_label(value: f64, step_exponent: i32, largest: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let (unit, suffix) = match largest {
        largest if !(1e-3..1e15).contains(&largest) => {
            let exponent = largest.log10().floor() as i32;
            (exponent, format!("·{}", power_of_ten(exponent)))
        }
        largest if largest >= 1e12 => (12, "T".to_owned()),
        largest if largest >= 1e9 => (9, "G".to_owned()),
        largest if largest >= 1e6 => (6, "M".to_owned()),
        largest if largest >= 1e4 => (3, "k".to_owned()),
        _ => (0, String::new()),
    };
    format!(
        "{}{suffix}",
        fixed(
            value / 10f64.powi(unit),
            (unit - step_exponent).max(0) as usize
        )
    )
}

fn log_ticks(lo: f64, hi: f64, want: usize) -> (Vec<Tick>, Vec<f64>) {
    let (first, last) = (
        (lo.log10() - 1e-9).ceil() as i32,
        (hi.log10() + 1e-9).floor() as i32,
    );
    let decades = (last - first + 1).max(0) as usize;
    if decades < 2 {
        return (narrow_ticks(lo, hi, want), Vec::new());
    }
    // Every decade, or every second, third, ...: multiples of the stride, so that 1 is among them.
    let stride = decades.div_ceil(want.max(2)) as i32;
    let plain = first >= -2 && last <= 3;
    let label = |k: i32| {
        if plain {
            fixed(10f64.powi(k), (-k).max(0) as usize)
        } else {
            power_of_ten(k)
        }
    };
    let ticks = (first..=last)
        .filter(|k| k.rem_euclid(stride) == 0)
        .map(|k| Tick {
            at: f64::from(k),
            label: label(k),
        })
        .collect();
    let minor = if stride > 1 {
        (first..=last)
            .filter(|k| k.rem_euclid(stride) != 0)
            .map(f64::from)
            .collect()
    } else if decades > 5 {
        Vec::new()
    } else {
        let within = |at: &f64| *at >= lo.log10() && *at <= hi.log10();
        let steps = (first - 1..=last)
            .flat_map(|k| (2..10).map(move |m| f64::from(k) + f64::from(m).log10()));
        steps.filter(within).collect()
    };
    (ticks, minor)
}

/// Ticks of a log axis that holds fewer than two powers of ten: 1, 2, 5 steps, or evenly spaced numbers.
fn narrow_ticks(lo: f64, hi: f64, want: usize) -> Vec<Tick> {
    let (first, last) = (lo.log10().floor() as i32, hi.log10().ceil() as i32);
    let coarse = (first..=last).flat_map(|k| [1.0, 2.0, 5.0].map(|lead| (lead * 10f64.powi(k), k)));
    let mut values: Vec<_> = coarse
        .filter(|(value, _)| (lo..=hi).contains(value))
        .collect();
    if values.len() < 3 {
        let (positions, exponent) = linear_positions(lo, hi, want);
        values = positions
            .into_iter()
            .map(|value| (value, exponent))
            .collect();
    }
    let largest = values
        .iter()
        .fold(0f64, |largest, value| largest.max(value.0));
    let tick = |&(value, exponent): &(f64, i32)| Tick {
        at: value.log10(),
        label: linear_label(value, exponent, largest),
    };
    values
        .iter()
        .filter(|(value, _)| *value > 0.0)
        .map(tick)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(axis: &Axis) -> Vec<&str> {
        axis.ticks.iter().map(|tick| tick.label.as_str()).collect()
    }

    #[test]
    fn log_ticks_are_whole_powers_with_superscripts() {
        let axis = Axis::log("", 1e-6, 1.0, 7);
        assert_eq!(
            labels(&axis),
            ["10⁻⁶", "10⁻⁵", "10⁻⁴", "10⁻³", "10⁻²", "10⁻¹", "10⁰"]
        );
        assert_eq!(axis.ticks[0].at, -6.0);
        assert_eq!(
            labels(&Axis::log("", 2e-9, 1.0, 4)),
            ["10⁻⁶", "10⁻³", "10⁰"]
        );
        assert_eq!(
            labels(&Axis::log("", 0.5, 2000.0, 6)),
            ["1", "10", "100", "1000"]
        );
    }

    #[test]
    fn a_narrow_log_axis_still_has_labels() {
        assert_eq!(
            labels(&Axis::log("", 12.0, 80.0, 4)),
            ["20", "40", "60", "80"]
        );
        assert_eq!(labels(&Axis::log("", 0.8, 9.0, 5)), ["1", "2", "5"]);
        assert!(Axis::log("", 20.0, 21.0, 5).ticks.len() >= 3);
        assert!(Axis::log("", 7.0, 7.0, 5).ticks.len() >= 2);
    }

    #[test]
    fn linear_ticks_are_nice_and_share_a_unit() {
        assert_eq!(
            labels(&Axis::linear("", 0.0, 4_194_304.0, 4)),
            ["0", "1M", "2M", "3M", "4M"]
        );
        assert_eq!(
            labels(&Axis::linear("", 0.0, 1.3e6, 3)),
            ["0", "0.5M", "1.0M"]
        );
        assert_eq!(
            labels(&Axis::linear("", -0.25, 0.31, 6)),
            ["−0.2", "−0.1", "0", "0.1", "0.2", "0.3"]
        );
        assert_eq!(
            labels(&Axis::linear("", 0.0, 2.1e-5, 2)),
            ["0", "1·10⁻⁵", "2·10⁻⁵"]
        );
        assert_eq!(
            labels(&Axis::linear("", 0.0, 12_000.0, 3)),
            ["0", "5k", "10k"]
        );
    }

    #[test]
    fn any_range_makes_an_axis() {
        for (lo, hi) in [
            (0.0, 0.0),
            (f64::NAN, 1.0),
            (5.0, 5.0),
            (f64::NEG_INFINITY, 3.0),
            (2.0, 1.0),
        ] {
            for axis in [Axis::linear("", lo, hi, 4), Axis::log("", lo, hi, 4)] {
                assert!(axis.lo < axis.hi, "{lo} {hi}");
                assert!(axis.ticks.len() < 20, "{lo} {hi}");
            }
        }
        assert_eq!(Axis::log("", 1.0, 10.0, 4).at(0.0), None);
        assert_eq!(Axis::linear("", 0.0, 1.0, 4).at(7.0), Some(1.0));
    }
}
