//! Random numbers for scenes: the same on every machine and in every version.
//!
//! ChaCha8 from a 32-byte seed that spells the scene's name and size. Uniforms are taken from the words by hand, and
//! directions use + - * / and square roots only, so no platform's mathematical library has a say.

use glam::DVec3;
use rand::rngs::ChaCha8Rng;
use rand::{Rng, SeedableRng};
use rand_distr::{Distribution, UnitSphere};

use crate::geom::{Polygon, Triangle};

/// (k + 1/2) / 2^52 for the upper 52 bits k of a word: exact, so never 0 and never 1. (With 53 bits, k + 1/2 would be
/// rounded, the largest to 2^53.) The uniforms of lines are made by it too.
#[inline]
pub(crate) fn unit_interval(bits: u64) -> f64 {
    ((bits >> 12) as f64 + 0.5) * (1.0 / (1_u64 << 52) as f64)
}

/// A stream of random numbers and shapes.
pub(super) struct Random(ChaCha8Rng);

impl Random {
    /// The stream of that name, which must fit in 32 bytes.
    pub(super) fn named(name: &str) -> Self {
        let mut seed = [0; 32];
        seed[..name.len()].copy_from_slice(name.as_bytes());
        Self(ChaCha8Rng::from_seed(seed))
    }

    /// Uniform in (0, 1), (k + 1/2) / 2^52: neither end ever comes.
    pub(super) fn uniform(&mut self) -> f64 {
        unit_interval(self.0.next_u64())
    }

    /// Uniform between two numbers.
    pub(super) fn between(&mut self, lo: f64, hi: f64) -> f64 {
        lo + (hi - lo) * self.uniform()
    }

    /// Uniform in the unit cube.
    pub(super) fn point(&mut self) -> DVec3 {
        DVec3::new(self.uniform(), self.uniform(), self.uniform())
    }

    /// Bell-shaped about 0 with standard deviation 1 on each axis: the sum of twelve uniforms, less 6.
    pub(super) fn bell(&mut self) -> DVec3 {
        (0..12).map(|_| self.point()).sum::<DVec3>() - 6.0
    }

    /// Two perpendicular unit vectors, uniform over all such pairs.
    fn plane(&mut self) -> (DVec3, DVec3) {
        let mut unit = || DVec3::from(UnitSphere.sample(&mut self.0));
        let normal = unit();
        loop {
            let other = unit();
            let u = other - other.dot(normal) * normal;
            // Nearly parallel: the direction of what is left would be rounding noise.
            if u.length_squared() > 1e-6 {
                let u = u / u.length();
                return (u, normal.cross(u));
            }
        }
    }

    /// An equilateral triangle with corners at distance `radius` from `centre`, uniformly oriented.
    pub(super) fn triangle(&mut self, centre: DVec3, radius: f64) -> Triangle {
        let (u, v) = self.plane();
        let (back, side) = (-0.5 * radius * u, 0.5 * 3_f64.sqrt() * radius * v);
        Triangle([
            centre + radius * u,
            centre + back + side,
            centre + back - side,
        ])
    }

    /// A regular hexagon with corners at distance `radius` from `centre`, uniformly oriented.
    pub(super) fn hexagon(&mut self, centre: DVec3, radius: f64) -> Polygon {
        let (u, v) = self.plane();
        let (along, half, side) = (
            radius * u,
            0.5 * radius * u,
            0.5 * 3_f64.sqrt() * radius * v,
        );
        let corners = [
            along,
            half + side,
            side - half,
            -along,
            -half - side,
            half - side,
        ];
        Polygon::new(corners.map(|c| centre + c).into()).expect("a hexagon is a polygon")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn streams_are_told_apart_by_name() {
        let first = |name| Random::named(name).0.next_u64();
        assert_eq!(first("simple:uniform:10"), first("simple:uniform:10"));
        assert_ne!(first("simple:uniform:10"), first("simple:uniform:100"));
    }

    #[test]
    fn neither_end_ever_comes() {
        assert_eq!(unit_interval(0), 0.5_f64.powi(53));
        assert_eq!(unit_interval(u64::MAX), 1.0 - 0.5_f64.powi(53));
        assert!(unit_interval(u64::MAX) < 1.0);
        assert!(unit_interval(1 << 12) > unit_interval(0));
    }

    #[test]
    fn the_stream_is_fixed() {
        // ChaCha8, first words for this seed: a change here would change every scene.
        let mut random = Random::named("simple:uniform:2000");
        let words = [(); 3].map(|()| random.0.next_u64());
        assert_eq!(words, WORDS);
    }

    const WORDS: [u64; 3] = [
        7_116_331_590_285_420_626,
        6_560_036_713_052_577_049,
        9_429_342_874_055_627_018,
    ];

    #[test]
    fn shapes_are_regular() {
        let mut random = Random::named("shapes");
        for _ in 0..100 {
            let Triangle([a, b, c]) = random.triangle(DVec3::ONE, 2.0);
            for (p, q) in [(a, b), (b, c), (c, a)] {
                assert!((p.distance_squared(q) - 12.0).abs() < 1e-13);
            }
            assert!(((a + b + c) / 3.0).distance(DVec3::ONE) < 1e-15);
            let hexagon = random.hexagon(DVec3::ONE, 2.0);
            assert!((hexagon.area() - 6.0 * 3_f64.sqrt()).abs() < 1e-13);
        }
    }

    #[test]
    fn directions_and_bells_are_centred() {
        // Means over 20,000: standard errors below 0.008, so 0.05 is six of them.
        let mut random = Random::named("means");
        let n = 20_000;
        let (mut normal, mut bell, mut square) = (DVec3::ZERO, DVec3::ZERO, DVec3::ZERO);
        for _ in 0..n {
            let (u, v) = random.plane();
            assert!(u.dot(v).abs() < 1e-12);
            normal += u.cross(v);
            let b = random.bell();
            bell += b;
            square += b * b;
        }
        let n = f64::from(n);
        assert!((normal / n).abs().max_element() < 0.05);
        assert!((bell / n).abs().max_element() < 0.05);
        assert!((square / n - 1.0).abs().max_element() < 0.06);
    }
}
