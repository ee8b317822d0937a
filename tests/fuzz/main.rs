//! A bounded fuzzing of every reader, and of building and traversing trees: all seeds and a fixed number of mutations of
//! each, on any Rust. `fuzz/` searches further with libFuzzer.
//!
//! What breaks a property is written to a file named in the failure. Once it is mended, keep that file under a telling
//! name in `tests/fuzz/seeds/TARGET`.
#![allow(clippy::unwrap_used)]

mod mutate;
#[path = "targets.rs"]
mod targets;

use std::fs;
use std::panic::catch_unwind;
use std::path::Path;
use std::time::{Duration, Instant};

use rand::SeedableRng;
use rand::rngs::ChaCha8Rng;

use mutate::mutate;

/// Mutations of each target: with these all tests together take less than 20 s on one core.
const MUTATIONS: usize = 50_000;

/// What no input of a few kilobytes may take, on a machine however busy.
const LONGEST: Duration = Duration::from_secs(10);

/// The seeds of a target, in the order of their names.
fn seeds(target: &str) -> Vec<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fuzz/seeds");
    let entries = fs::read_dir(folder.join(target)).unwrap();
    let mut paths: Vec<_> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    assert!(!paths.is_empty(), "{target} has no seeds");
    paths.iter().map(|path| fs::read(path).unwrap()).collect()
}

/// Runs an input; one that fails is kept.
fn run(name: &str, target: fn(&[u8]), bytes: &[u8]) {
    let start = Instant::now();
    let ended = catch_unwind(|| target(bytes));
    let slow = start.elapsed() > LONGEST;
    if ended.is_err() || slow {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("fuzz-{name}"));
        fs::write(&path, bytes).unwrap();
        let what = if slow { "hangs on" } else { "fails on" };
        panic!("{name} {what} the input kept in {}", path.display());
    }
}

/// Runs the seeds of a target and their mutations.
fn fuzz(name: &str, target: fn(&[u8])) {
    let seeds = seeds(name);
    for seed in &seeds {
        run(name, target, seed);
    }
    let mut rng = ChaCha8Rng::seed_from_u64(0);
    for i in 0..MUTATIONS {
        let seed = &seeds[i % seeds.len()];
        let other = &seeds[(i / seeds.len()) % seeds.len()];
        run(name, target, &mutate(seed, other, &mut rng));
    }
}

macro_rules! fuzzed {
    ($($target:ident)*) => {
        $(#[test]
        fn $target() {
            fuzz(stringify!($target), targets::$target);
        })*
    };
}

fuzzed!(obj ply stl off nff toml csv npy tree bits);
