//! What names a cell, a scene's content and a scene's lines.

use sha2::{Digest, Sha256};

use crate::geom::Cast;
use crate::scene::Scene;

/// The first 16 hexadecimal digits of the SHA-256: names a cell, a scene's content, a file.
pub fn digest(bytes: &[u8]) -> String {
    hex(&Sha256::digest(bytes))
}

fn hex(hash: &[u8]) -> String {
    hash.iter().take(8).map(|b| format!("{b:02x}")).collect()
}

/// A scene's boxes: all that an unclipped tree and the counts of lines depend on.
pub fn content(scene: &Scene) -> String {
    let numbers = scene
        .bounds
        .iter()
        .flat_map(|b| [b.lo.to_array(), b.hi.to_array()].concat());
    let bytes: Vec<u8> = numbers.flat_map(f64::to_le_bytes).collect();
    digest(&bytes)
}

/// Rays, to the bit: the same for all files that give them.
pub fn rays(casts: &[Cast]) -> String {
    let mut hash = Sha256::new();
    for cast in casts {
        let numbers = cast.origin.to_array().into_iter();
        let numbers = numbers.chain(cast.direction.to_array());
        for number in numbers.chain([cast.span.t0, cast.span.t1]) {
            hash.update(number.to_le_bytes());
        }
    }
    hex(&hash.finalize())
}

/// All of a scene: its objects and, if it has one, its look, on which clipped trees, rays and pictures depend.
pub fn whole(scene: &Scene) -> String {
    digest(format!("{:?} {:?}", scene.objects, scene.look).as_bytes())
}

/// Seed of a scene's lines: the run's and the scene's boxes.
pub fn line_seed(seed: u64, content: &str) -> u64 {
    let hash = Sha256::digest(format!("lines of {content}, seed {seed}"));
    u64::from_le_bytes(std::array::from_fn(|i| hash[i]))
}
