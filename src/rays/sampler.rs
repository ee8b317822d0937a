//! Sets of points of the unit hypercube that become lines: independent, stratified, and scrambled Sobol' points.
//!
//! The exact law of the lines is the same for all; what differs is how evenly a set of N covers the four uniforms of a line,
//! and so how fast a mean over the set approaches its expectation. Only independent points have the binomial errors of
//! counts: the error of a mean over the others is told by replicates.

use std::fmt;
use std::ops::Range;
use std::str::FromStr;

use crate::geom::{Aabb, Line};

use super::address::{Purpose, Uniforms};
use super::sobol::{LARGEST_LOG2, ScrambledSobol};
use super::stratified::Stratified;
use super::surface::Lines;

/// How the points of a set are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Sampler {
    /// Independent uniform points.
    Random,
    /// One uniform point in each of m^4 equal cells.
    Stratified,
    /// Sobol' points with Owen's nested uniform scrambling.
    Sobol,
}

impl Sampler {
    /// Each of them.
    pub const ALL: [Self; 3] = [Self::Random, Self::Stratified, Self::Sobol];

    /// The name in files and on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Random => "random",
            Self::Stratified => "stratified",
            Self::Sobol => "sobol",
        }
    }

    /// One line on what it does.
    pub const fn description(self) -> &'static str {
        match self {
            Self::Random => "independent uniform points, any number",
            Self::Stratified => "one uniform point in each of m^4 equal cells, m^4 points",
            Self::Sobol => "Sobol' points, Owen-scrambled, a power of two of them",
        }
    }

    /// Whether there are sets of that many points.
    pub fn takes(self, points: u64) -> bool {
        match self {
            Self::Random => true,
            Self::Stratified => side(points).is_some(),
            Self::Sobol => points.is_power_of_two() && points <= 1 << LARGEST_LOG2,
        }
    }

    /// The size of a set nearest to `points` by ratio, the smaller one on a tie; at least 1.
    pub fn nearest_size(self, points: u64) -> u64 {
        let points = points.clamp(1, 1 << LARGEST_LOG2);
        let (below, above) = match self {
            Self::Random => return points,
            Self::Stratified => {
                let side = (points as f64).sqrt().sqrt() as u64;
                // Taken exactly: a fourth power's root is exact, any other lies well between two.
                (side.pow(4), (side + 1).pow(4))
            }
            Self::Sobol => (1 << points.ilog2(), points.next_power_of_two()),
        };
        // points / below against above / points.
        if u128::from(points).pow(2) <= u128::from(below) * u128::from(above) {
            below
        } else {
            above
        }
    }

    /// The smallest set of at least so many points; `None` if all sets are smaller.
    pub fn size_at_least(self, points: u64) -> Option<u64> {
        if points > 1 << LARGEST_LOG2 {
            return None;
        }
        Some(match self {
            Self::Random => points,
            Self::Stratified => {
                let below = (points as f64).sqrt().sqrt() as u64;
                (below..)
                    .map(|side| side.pow(4))
                    .find(|&n| n >= points.max(1))?
            }
            Self::Sobol => points.next_power_of_two(),
        })
    }
}

/// m, if that many points are m^4 of them and m > 0.
fn side(points: u64) -> Option<u32> {
    let side = (points as f64).sqrt().sqrt() as u32;
    (points > 0 && u128::from(side).pow(4) == u128::from(points)).then_some(side)
}

impl FromStr for Sampler {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let named = Self::ALL.into_iter().find(|sampler| sampler.name() == text);
        named.ok_or_else(|| {
            let names = Self::ALL.map(Self::name).join(", ");
            format!("'{text}' is no sampler; expected one of {names}")
        })
    }
}

impl fmt::Display for Sampler {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// One set of points. Sets of different replicates are independent; each is a function of these four values, and point i of
/// it of them and i.
///
/// ```
/// use sahlab::rays::{PointSet, Sampler};
///
/// // Of 256 scrambled Sobol' points, each 256th of the first coordinate's range has one.
/// let points = PointSet::new(Sampler::Sobol, 1, 0, 256);
/// let mut cells: Vec<u32> = points.range(0..256).map(|point| (256.0 * point[0]) as u32).collect();
/// cells.sort_unstable();
/// assert!(cells.into_iter().eq(0..256));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PointSet {
    sampler: Sampler,
    seed: u64,
    replicate: u64,
    points: u64,
}

impl PointSet {
    /// The set of a sampler, a seed, a replicate and a number of points.
    ///
    /// # Panics
    /// If the sampler has no set of that size ([`Sampler::takes`]).
    pub fn new(sampler: Sampler, seed: u64, replicate: u64, points: u64) -> Self {
        assert!(
            sampler.takes(points),
            "{sampler}: no set of {points} points"
        );
        Self {
            sampler,
            seed,
            replicate,
            points,
        }
    }

    /// The points with these indices, each coordinate in (0, 1).
    ///
    /// # Panics
    /// If the set has fewer points. All of them are wanted for a mean: a part of a set that is not random is no set.
    pub fn range(&self, indices: Range<u64>) -> impl Iterator<Item = [f64; 4]> + use<> {
        assert!(
            indices.end <= self.points,
            "points {indices:?} of {}",
            self.points
        );
        let (seed, replicate, i) = (self.seed, self.replicate, indices.start);
        let uniforms = |purpose| Uniforms::of_replicate(seed, purpose, replicate, i);
        let mut sequence = match self.sampler {
            Sampler::Random => Sequence::Random(uniforms(Purpose::Replicates)),
            Sampler::Stratified => {
                let side = side(self.points).expect("a fourth power");
                let jitter = uniforms(Purpose::Strata);
                Sequence::Stratified(Stratified::starting_at(jitter, side, i))
            }
            Sampler::Sobol => Sequence::Sobol(ScrambledSobol::starting_at(seed, replicate, i)),
        };
        indices.map(move |_| sequence.next4())
    }

    /// The lines of these points through a box.
    pub fn lines(&self, world: &Aabb, indices: Range<u64>) -> impl Iterator<Item = Line> + use<> {
        Lines::new(world, self.range(indices))
    }
}

/// Points from some index on.
enum Sequence {
    Random(Uniforms),
    Stratified(Stratified),
    Sobol(ScrambledSobol),
}

impl Sequence {
    #[inline]
    fn next4(&mut self) -> [f64; 4] {
        match self {
            Self::Random(uniforms) => uniforms.next4(),
            Self::Stratified(strata) => strata.next4(),
            Self::Sobol(sobol) => sobol.next4(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::Span;
    use crate::rays::checks::check_sampler;
    use glam::DVec3;

    fn set(sampler: Sampler, replicate: u64, points: u64) -> Vec<[f64; 4]> {
        let set = PointSet::new(sampler, 5, replicate, points);
        set.range(0..points).collect()
    }

    #[test]
    fn names_and_sizes() {
        for sampler in Sampler::ALL {
            assert_eq!(sampler.to_string().parse(), Ok(sampler));
            for points in (1..2000).chain([65_535, 65_536, 1 << 20, 104_976, (1 << 32) - 1]) {
                let size = sampler.nearest_size(points);
                assert!(sampler.takes(size));
                assert!(
                    !sampler.takes(points) || size == points,
                    "{sampler} {points}"
                );
                let ratio = size as f64 / points as f64;
                assert!(
                    (0.24..4.1).contains(&ratio),
                    "{sampler}: {size} for {points}"
                );
            }
        }
        assert!("halton".parse::<Sampler>().is_err());
        let sizes = |sampler: Sampler| [100, 512, 1 << 13].map(|n| sampler.nearest_size(n));
        assert_eq!(sizes(Sampler::Random), [100, 512, 8192]);
        assert_eq!(sizes(Sampler::Stratified), [81, 625, 10_000]);
        assert_eq!(sizes(Sampler::Sobol), [128, 512, 8192]);
        assert!(!Sampler::Stratified.takes(0) && !Sampler::Sobol.takes(3));
    }

    #[test]
    fn a_point_depends_on_its_index_alone() {
        for sampler in Sampler::ALL {
            let points = sampler.nearest_size(1 << 10);
            let all = set(sampler, 3, points);
            assert!(all.iter().flatten().all(|&u| 0.0 < u && u < 1.0));
            for start in [0, 1, 64, 255, 256, points - 1] {
                let part = PointSet::new(sampler, 5, 3, points).range(start..points);
                let part: Vec<_> = part.collect();
                assert_eq!(part, all[start as usize..], "{sampler}");
            }
            for other in [0, 2, 4, 1 << 40] {
                let other = set(sampler, other, points);
                assert!(all.iter().zip(&other).all(|(a, b)| a != b), "{sampler}");
            }
        }
        assert_ne!(set(Sampler::Random, 0, 81), set(Sampler::Stratified, 0, 81));
    }

    #[test]
    fn every_cell_of_a_stratified_set_has_one_point() {
        let cells = set(Sampler::Stratified, 0, 2401).into_iter().map(|u| {
            let digits = u.map(|u| (7.0 * u) as usize);
            digits.into_iter().fold(0, |cell, digit| 7 * cell + digit)
        });
        let mut cells: Vec<usize> = cells.collect();
        cells.sort_unstable();
        assert!(cells.into_iter().eq(0..2401));
    }

    /// The lines of every sampler follow the law, over many replicates: the i-th point of each is an independent uniform
    /// point. False alarm: five p-values each below 1e-4 for each of three samplers, so 0.15 %.
    #[test]
    fn over_replicates_every_sampler_has_the_exact_law() {
        let world = Aabb::new(DVec3::ZERO, DVec3::new(1.0, 0.8, 0.5));
        for sampler in Sampler::ALL {
            let points = sampler.nearest_size(256);
            let sample = |i: u64| {
                let at = i % points;
                let mut lines = PointSet::new(sampler, 11, i, points).lines(&world, at..at + 1);
                (lines.next().expect("one line"), Span::FULL)
            };
            let checks = check_sampler(&world, 1, 1 << 18, sample);
            for (name, p) in crate::rays::checks::SamplerChecks::NAMES
                .iter()
                .zip(checks.values())
            {
                assert!(p.expect("it applies") >= 1e-4, "{sampler}: {name}");
            }
        }
    }
}
