//! Mutations of seeds, the same in every run.

use rand::rngs::ChaCha8Rng;
use rand::{Rng, RngExt};

/// Text that readers of numbers and counts stumble over.
const WORDS: [&str; 30] = [
    "nan",
    "inf",
    "-inf",
    "1e308",
    "-1e308",
    "1e309",
    "1e-320",
    "-0",
    "0",
    "1",
    "-1",
    "2",
    "255",
    "65536",
    "2147483648",
    "4294967295",
    "9223372036854775807",
    "-9223372036854775808",
    "18446744073709551615",
    "1152921504606846976",
    "1e",
    ".5",
    "0x10",
    "\n",
    "\r",
    "\\\n",
    " ",
    "#",
    "\"",
    "\u{feff}",
];

/// Longest input made.
const LONGEST: usize = 4096;

/// A seed changed in one to eight places; `other` is a seed to splice with.
pub fn mutate(seed: &[u8], other: &[u8], rng: &mut ChaCha8Rng) -> Vec<u8> {
    let mut bytes = seed.to_vec();
    for _ in 0..rng.random_range(1..=8) {
        once(&mut bytes, other, rng);
    }
    bytes.truncate(LONGEST);
    bytes
}

fn once(bytes: &mut Vec<u8>, other: &[u8], rng: &mut ChaCha8Rng) {
    let at = rng.random_range(0..=bytes.len());
    let length = rng.random_range(1..=16).min(bytes.len() - at);
    match rng.random_range(0..8) {
        0 if length > 0 => bytes[at] ^= 1 << rng.random_range(0..8),
        1 if length > 0 => bytes[at] = rng.random(),
        2 => drop(bytes.drain(at..at + length)),
        3 => {
            let copy = bytes[at..at + length].to_vec();
            let to = rng.random_range(0..=bytes.len());
            bytes.splice(to..to, copy);
        }
        4 => {
            let mut noise = [0; 8];
            rng.fill_bytes(&mut noise);
            let length = rng.random_range(1..=8);
            bytes.splice(at..at, noise[..length].iter().copied());
        }
        5 => {
            let from = rng.random_range(0..=other.len());
            bytes.splice(at.., other[from..].iter().copied());
        }
        _ => {
            // A word in the place of one.
            let word = WORDS[rng.random_range(0..WORDS.len())];
            let end = bytes[at..].iter().position(u8::is_ascii_whitespace);
            let end = end.map_or(bytes.len(), |n| at + n);
            bytes.splice(at..end, word.bytes());
        }
    }
}
