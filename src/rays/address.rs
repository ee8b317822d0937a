//! One address for every random number: a seed, a purpose and a position in a ChaCha8 stream.
//!
//! ChaCha8 is portable and seekable, so line i is a function of (seed, i) whatever the threads, blocks or order.

use rand::Rng;
use rand::SeedableRng;
use rand::rngs::ChaCha8Rng;

use crate::scene::unit_interval;

/// What random numbers are for: different purposes never share a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// The lines of a study.
    Lines = 1,
    /// Lines of the independent samplers and of the wrong laws.
    Laws = 2,
    /// Boxes and triangles that check a sampler.
    Checks = 3,
    /// Rays of sources that are no law of lines.
    Sources = 4,
    /// Independent points of a replicate.
    Replicates = 5,
    /// Where in its cell a stratified point lies.
    Strata = 6,
    /// Keys that scramble a Sobol' sequence.
    Scrambles = 7,
    /// Lines aimed at edges and corners.
    Pairs = 8,
}

/// A generator for a seed and a purpose, at the start of its stream.
pub fn generator(seed: u64, purpose: Purpose) -> ChaCha8Rng {
    let mut key = [0; 32];
    key[..8].copy_from_slice(&seed.to_le_bytes());
    key[8] = purpose as u8;
    ChaCha8Rng::from_seed(key)
}

/// Sequences of uniforms in (0, 1), four to an index.
pub struct Uniforms {
    rng: ChaCha8Rng,
}

/// 32-bit words one index takes: four 64-bit draws.
const WORDS: u128 = 8;

impl Uniforms {
    /// The sequence of a seed, from index `i` on.
    pub fn starting_at(seed: u64, i: u64) -> Self {
        Self::of_replicate(seed, Purpose::Lines, 0, i)
    }

    /// The sequence of a seed, a purpose and a replicate, from index `i` on. Replicates are independent.
    pub fn of_replicate(seed: u64, purpose: Purpose, replicate: u64, i: u64) -> Self {
        let mut rng = generator(seed, purpose);
        rng.set_stream(replicate);
        rng.set_word_pos(WORDS * u128::from(i));
        Self { rng }
    }

    /// The uniforms of this index; moves on to the next.
    #[inline]
    pub fn next4(&mut self) -> [f64; 4] {
        std::array::from_fn(|_| uniform(&mut self.rng))
    }
}

/// A uniform number in (0, 1) from the next 64 bits.
#[inline]
pub(super) fn uniform(rng: &mut impl Rng) -> f64 {
    unit_interval(rng.next_u64())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_index_has_its_own_place() {
        let mut all = Uniforms::starting_at(7, 0);
        let sequence: Vec<_> = (0..100).map(|_| all.next4()).collect();
        for i in [0, 1, 2, 17, 63, 99] {
            assert_eq!(Uniforms::starting_at(7, i as u64).next4(), sequence[i]);
        }
        assert_ne!(Uniforms::starting_at(8, 0).next4(), sequence[0]);
        assert!(sequence.iter().flatten().all(|&u| 0.0 < u && u < 1.0));
    }
}
