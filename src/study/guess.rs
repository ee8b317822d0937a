//! What work takes, roughly: seconds on two cores of 2024, bytes on disk. For those who plan a run; no result depends on it, and
//! a scene that is unlike the others may take several times as much.

use super::ray_sets::{Number, RaysOf};
use crate::scene::Scene;

/// Seconds that a tree over so many objects takes: building, audit, prediction.
pub fn tree(objects: usize) -> f64 {
    6e-6 * objects as f64
}

/// Seconds that so many lines take, made and counted as a stream on all cores, with a pilot.
pub fn streamed(lines: u64) -> f64 {
    0.1 + 4e-7 * lines as f64
}

/// Seconds that so many rays take, traced and counted one by one on all cores.
pub fn traced(rays: u64) -> f64 {
    4e-7 * rays as f64
}

/// Seconds that so many rays take, timed on one core.
pub fn timed(rays: u64) -> f64 {
    4e-7 * rays as f64
}

/// Bytes of so many rows of results.
pub fn rows(rows: usize) -> u64 {
    250 * rows as u64
}

/// Rays of the picture of a scene: to the eye, to the lights, further on.
pub fn pictured(scene: &Scene, pixels: u32) -> u64 {
    scene.look.as_ref().map_or(0, |look| {
        let lights = look.stage.lights.len() as f64;
        // An eye ray has about one shadow ray for each second light, and half a secondary ray.
        (f64::from(pixels + 1).powi(2) * (1.5 + 0.5 * lights)) as u64
    })
}

/// Rays of these sets in a scene; where a wanted error settles how many, the fewest.
pub fn rays_of(scene: &Scene, sets: &[RaysOf], number: Number) -> u64 {
    let sources = sets.iter().filter(|set| matches!(set, RaysOf::Source(..)));
    let traces = sets.iter().any(|set| matches!(set, RaysOf::Traced(_)));
    let pictured = if traces {
        pictured(scene, number.pixels)
    } else {
        0
    };
    sources.count() as u64 * number.rays + pictured
}
