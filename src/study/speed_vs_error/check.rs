//! Whether the values of a `speed-vs-error` experiment make sense together and with its scenes.

use std::ops::RangeInclusive;

use crate::kd::Strategy;
use crate::study::lines::{FEWEST_LINES, check_error};
use crate::study::plan::{Wrong, each_once, wrong_unless};
use crate::study::timing;

use super::asked::{Coverage, Method, Planes, Precision, Samplers, SpeedVsError};

/// Fewest replicates: the interval of an RMSE is then -20 % to +32 %.
const FEWEST_REPLICATES: u32 = 32;

/// Most of anything that is done again and again.
const MOST_TIMES: u32 = 1 << 16;

/// The reference takes at least so many times the most lines that are held against it: its error is then below a tenth of
/// theirs.
pub const LONGER: u64 = 128;

impl SpeedVsError {
    /// Whether the values make sense together and with the scenes.
    pub fn check(&self, scenes: &[String]) -> Result<(), Wrong> {
        let Self {
            samplers,
            precision,
            planes,
            coverage,
            ..
        } = self;
        let some =
            samplers.is_some() || precision.is_some() || planes.is_some() || coverage.is_some();
        wrong_unless(some, "expect", || {
            "nothing is asked for; give a section [samplers], [precision], [planes] or [coverage]"
                .into()
        })?;
        if let Some(part) = samplers {
            check_samplers(part, scenes)?;
        }
        if let Some(part) = precision {
            check_precision(part, scenes)?;
        }
        if let Some(part) = planes {
            check_planes(part, scenes)?;
        }
        if let Some(part) = coverage {
            check_coverage(part, scenes)?;
        }
        self.check_bounds()
    }

    /// What is expected is measured.
    fn check_bounds(&self) -> Result<(), Wrong> {
        if let Some(bounds) = &self.expect.sobol {
            let part = self.samplers.as_ref();
            let there = |part: &&Samplers| part.methods.contains(&Method::Sobol);
            let Some(part) = part.filter(there) else {
                return Err(Wrong {
                    key: "expect.sobol",
                    message: "expect.sobol judges the method 'sobol', but samplers.methods does not name it".into(),
                });
            };
            named(
                "expect.sobol.scenes",
                &bounds.scenes,
                &part.scenes,
                "samplers.scenes",
            )?;
            let numbers = [bounds.nodes, bounds.gain, bounds.exponent];
            let possible = numbers
                .iter()
                .all(|bound| *bound > 0.0 && bound.is_finite());
            wrong_unless(possible, "expect.sobol", || {
                "expect.sobol: nodes, gain and exponent must be numbers above 0".into()
            })?;
        }
        if let Some(bound) = &self.expect.planes {
            let part = self.planes.as_ref();
            let there = part.is_some_and(|part| part.strategies.contains(&bound.strategy));
            let possible = bound.above >= 0.0 && bound.above.is_finite();
            wrong_unless(there && possible, "expect.planes", || {
                format!(
                    "expect.planes: '{}' must be among planes.strategies, and above a number, 0 or more",
                    bound.strategy
                )
            })?;
        }
        Ok(())
    }
}

/// Scenes that a part names: some, each once, of these.
fn named(key: &'static str, own: &[String], all: &[String], of: &str) -> Result<(), Wrong> {
    each_once(key, "scene", own)?;
    own.iter().try_for_each(|scene| {
        wrong_unless(all.contains(scene), key, || {
            format!("{key}: '{scene}' is not among {of}")
        })
    })
}

/// Times of anything that is done again and again for two halves.
fn halves(key: &'static str, times: u32) -> Result<(), Wrong> {
    timing::halves(key, times)?;
    within(key, times, 2..=MOST_TIMES)
}

fn within<T: PartialOrd + std::fmt::Display>(
    key: &'static str,
    value: T,
    range: RangeInclusive<T>,
) -> Result<(), Wrong> {
    wrong_unless(range.contains(&value), key, || {
        format!(
            "{key} = {value}, but it must be {} to {}",
            range.start(),
            range.end()
        )
    })
}

const SCENES: &str = "the experiment's scenes";

fn check_samplers(part: &Samplers, scenes: &[String]) -> Result<(), Wrong> {
    named("samplers.scenes", &part.scenes, scenes, SCENES)?;
    each_once("samplers.methods", "method", &part.methods)?;
    let random = part.methods.contains(&Method::Random);
    wrong_unless(random, "samplers.methods", || {
        "samplers.methods must name 'random', which the others are held against".into()
    })?;
    for (key, lines) in [("samplers.from", part.from), ("samplers.to", part.to)] {
        within(key, lines, 64..=1 << 24)?;
        wrong_unless(lines.is_power_of_two(), key, || {
            format!("{key} = {lines}, but it must be a power of two")
        })?;
    }
    wrong_unless(part.from < part.to, "samplers.to", || {
        format!(
            "samplers.to = {}, but it must be above samplers.from = {}",
            part.to, part.from
        )
    })?;
    within(
        "samplers.replicates",
        part.replicates,
        FEWEST_REPLICATES..=MOST_TIMES,
    )?;
    let least = LONGER * part.to;
    let long = part.reference.is_power_of_two() && (least..=1 << 32).contains(&part.reference);
    wrong_unless(part.reference == 0 || long, "samplers.reference", || {
        format!(
            "samplers.reference = {}, but it must be 0 or a power of two, from {LONGER} times samplers.to, {least}, to 2^32",
            part.reference
        )
    })?;
    each_once("samplers.wanted", "error", &part.wanted)?;
    let shares = part.wanted.iter().all(|e| *e > 0.0 && *e < 1.0);
    wrong_unless(shares, "samplers.wanted", || {
        "samplers.wanted must be relative errors between 0 and 1".into()
    })?;
    halves("samplers.rounds", part.rounds)
}

fn check_precision(part: &Precision, scenes: &[String]) -> Result<(), Wrong> {
    named("precision.scenes", &part.scenes, scenes, SCENES)?;
    each_once("precision.kernels", "kernel", &part.kernels)?;
    each_once("precision.offsets", "offset", &part.offsets)?;
    let offsets = part.offsets.iter().all(|o| (0.0..=1e12).contains(o));
    wrong_unless(offsets, "precision.offsets", || {
        "precision.offsets must be numbers of 0 to 1e12".into()
    })?;
    within("precision.lines", part.lines, 64..=1 << 28)?;
    halves("precision.rounds", part.rounds)
}

fn check_planes(part: &Planes, scenes: &[String]) -> Result<(), Wrong> {
    named("planes.scenes", &part.scenes, scenes, SCENES)?;
    each_once("planes.strategies", "strategy", &part.strategies)?;
    let exact = part.strategies.contains(&Strategy::Sah);
    wrong_unless(exact, "planes.strategies", || {
        "planes.strategies must name 'sah', the exact search".into()
    })?;
    let once = matches!(part.clipped[..], [false] | [false, true] | [true, false]);
    wrong_unless(once, "planes.clipped", || {
        "planes.clipped must be [false] or [false, true]".into()
    })?;
    halves("planes.builds", part.builds)
}

fn check_coverage(part: &Coverage, scenes: &[String]) -> Result<(), Wrong> {
    let own = std::slice::from_ref(&part.scene);
    named("coverage.scene", own, scenes, SCENES)?;
    for (key, runs) in [
        ("coverage.seeds", part.seeds),
        ("coverage.replicates", part.replicates),
        ("coverage.stops", part.stops),
    ] {
        within(key, runs, 1..=MOST_TIMES)?;
    }
    within("coverage.lines", part.lines, FEWEST_LINES..=1 << 32)?;
    check_error(part.error).map_err(|message| Wrong {
        key: "coverage.error",
        message: format!("coverage.error: {message}"),
    })
}
