//! What is fuzzed: functions of bytes that panic where a property is broken. The ordinary test beside this file runs them on
//! seeds and mutations of these, `fuzz/` under libFuzzer.
//!
//! A reader gives what its format promises or one clear message; whatever the bytes, it neither panics nor hangs, and it
//! allocates in proportion to them (libFuzzer's limits see to the last two).

use std::fmt::Display;

use sahlab::geom::Cast;
use sahlab::rays::file;
use sahlab::scene::{AREAS, Scene};
use sahlab::study::plan::Overrides;
use sahlab::study::{Plan, PlanError};

#[path = "bits.rs"]
mod bits;
#[path = "tree.rs"]
mod tree;
#[path = "../links/watch.rs"]
mod watch;
#[path = "ways.rs"]
mod ways;

pub use bits::bits;
pub use tree::tree;

/// Wavefront OBJ.
pub fn obj(bytes: &[u8]) {
    scene("x.obj", bytes);
}

/// Stanford PLY.
pub fn ply(bytes: &[u8]) {
    scene("x.ply", bytes);
}

/// Stereolithography.
pub fn stl(bytes: &[u8]) {
    scene("x.stl", bytes);
}

/// Object File Format.
pub fn off(bytes: &[u8]) {
    scene("x.off", bytes);
}

/// Neutral File Format: besides, what the writer writes reads back to a scene of which it writes the same.
pub fn nff(bytes: &[u8]) {
    let Some(first) = scene("x.nff", bytes) else {
        return;
    };
    if let Some(text) = first.to_nff(17) {
        let again = Scene::parse("x.nff", text.as_bytes()).expect("what was written");
        assert_eq!(again.to_nff(17), Some(text));
        assert_eq!(again.world, first.world);
    }
}

/// The longest message that is still clear: it may quote a word of the file, but not the file.
const LONGEST: usize = 1200;

/// A message that says in one line what is wrong with the file, and what would be right.
fn clear(message: impl Display, name: &str) {
    let message = message.to_string();
    let told = message.strip_prefix(name);
    let told = told.and_then(|rest| rest.split_once(": "));
    assert!(
        told.is_some_and(|(_, cause)| cause.len() > 10),
        "no cause: {message}"
    );
    assert!(message.len() <= LONGEST, "too long: {message}");
    assert!(
        !message.contains(|c: char| c.is_control()),
        "not one line of plain text: {message:?}"
    );
}

fn scene(name: &str, bytes: &[u8]) -> Option<Scene> {
    let scene = match Scene::parse(name, bytes) {
        Ok(scene) => scene,
        Err(error) => {
            clear(&error, name);
            assert!(error.to_string().contains("; "), "no remedy: {error}");
            return None;
        }
    };
    assert!(!scene.objects.is_empty() && scene.bounds.len() == scene.objects.len());
    for b in &scene.bounds {
        assert!(b.is_valid() && scene.world.contains(b), "{b:?}");
    }
    assert!(scene.world.is_valid() && AREAS.contains(&scene.world.surface_area()));
    for note in &scene.notes {
        assert!(note.len() <= LONGEST && !note.contains(|c: char| c.is_control()));
    }
    Some(scene)
}

/// Experiment files: a message has a place; a plan makes sense, and is the same when read from what is kept with a run.
pub fn toml(bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    for quick in [false, true] {
        let overrides = Overrides {
            quick,
            ..Overrides::default()
        };
        match Plan::parse(&text, "x.toml", "x", overrides) {
            Ok(mut plan) => {
                plan.check().expect("a plan that was read makes sense");
                let record = plan.record.take().expect("it was read from a text");
                let kept = record.recorded(&[]);
                let mut again = Plan::parse(&kept, "kept.toml", "kept", Overrides::default())
                    .unwrap_or_else(|e| panic!("the text kept with a run is refused: {e}"));
                again.record = None;
                assert_eq!(again, plan);
            }
            Err(error) => {
                clear(&error, "x.toml");
                if let PlanError::Syntax { line, column, .. } = error {
                    let lines: Vec<&str> = text.split('\n').collect();
                    let length = lines
                        .get(line.wrapping_sub(1))
                        .map(|line| line.chars().count());
                    assert!(
                        length.is_some_and(|n| (1..=n + 1).contains(&column)),
                        "{error}"
                    );
                }
            }
        }
    }
}

/// Rays as text.
pub fn csv(bytes: &[u8]) {
    rays("x.csv", bytes);
}

/// Rays as an array.
pub fn npy(bytes: &[u8]) {
    rays("x.npy", bytes);
}

fn rays(name: &str, bytes: &[u8]) {
    match file::parse(name, bytes) {
        Ok(casts) => {
            assert!(!casts.is_empty());
            casts.iter().for_each(a_ray);
        }
        Err(error) => clear(&error, name),
    }
}

fn a_ray(cast: &Cast) {
    let length = cast.direction.abs().max_element();
    assert!(cast.origin.is_finite() && file::LENGTHS.contains(&length));
    assert!(cast.direction.is_finite());
    assert!(cast.span.t0 == 0.0 && cast.span.t1 >= 0.0);
}
