//! What names a cell, a scene's content and a scene's lines.

use sha2::{Digest, Sha256};

use crate::scene::Scene;

/// The first 16 hexadecimal digits of the SHA-256: names a cell, a scene's content, a file.
pub fn digest(bytes: &[u8]) -> String {
    let hash = Sha256::digest(bytes);
    hash.iter().take(8).map(|b| format!("{b:02x}")).collect()
}

/// A scene's content: the boxes are all that a tree and its counts depend on.
pub fn content(scene: &Scene) -> String {
    let numbers = scene
        .bounds
        .iter()
        .flat_map(|b| [b.lo.to_array(), b.hi.to_array()].concat());
    let bytes: Vec<u8> = numbers.flat_map(f64::to_le_bytes).collect();
    digest(&bytes)
}

/// Seed of a scene's lines: the run's and the scene's content.
pub fn line_seed(seed: u64, content: &str) -> u64 {
    let hash = Sha256::digest(format!("lines of {content}, seed {seed}"));
    u64::from_le_bytes(std::array::from_fn(|i| hash[i]))
}
