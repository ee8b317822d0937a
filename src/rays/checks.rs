//! Five checks of a line sampler, each against an exact value of integral geometry (Santalo 1976).
//!
//! Hits of boxes alone cannot tell most wrong direction laws: for axis-aligned boxes only the ratio of the mean |w_x|,
//! |w_y|, |w_z| matters, so lines along the axes pass. Chord lengths, direction moments and triangles see the rest.

use glam::DVec3;
use rayon::prelude::*;

use crate::geom::{Aabb, Line, Ray, Span, Triangle};
use crate::stats::{binomial_tail, normal_p};

use super::address::{Purpose, generator, uniform};

/// The p-values of the five checks. Each is corrected for the number of comparisons inside it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SamplerChecks {
    /// Hits of boxes: SA(K)/SA(R).
    pub boxes: f64,
    /// Mean chord of the root: 4V/SA.
    pub mean_chord: f64,
    /// Mean fourth power of the chord: 12 V^2/(pi SA).
    pub fourth_chord: f64,
    /// Moments of the directions of lines that hit the box, up to the fourth.
    pub directions: f64,
    /// Hits of triangles of any orientation: 2A/SA(R).
    pub triangles: f64,
}

impl SamplerChecks {
    /// The names, in the order of [`values`](Self::values).
    pub const NAMES: [&'static str; 5] = [
        "boxes",
        "mean chord",
        "fourth chord moment",
        "directions",
        "triangles",
    ];

    /// The five p-values.
    pub fn values(&self) -> [f64; 5] {
        [
            self.boxes,
            self.mean_chord,
            self.fourth_chord,
            self.directions,
            self.triangles,
        ]
    }

    /// The smallest of the five times five: the p-value of all together.
    pub fn smallest(&self) -> f64 {
        (5.0 * self.values().into_iter().fold(1.0, f64::min)).min(1.0)
    }
}

const BOXES: usize = 30;
const TRIANGLES: usize = 60;
/// Mean and mean square are summed per chunk, and chunks in order: the sums do not depend on threads.
const CHUNK: u64 = 4096;

/// Direction moments: first (3), second (x, y; z follows), mixed second (3), fourth (3), mixed fourth (3).
const MOMENTS: usize = 14;

fn moments(d: DVec3) -> [f64; MOMENTS] {
    let w = d.normalize();
    let s = w * w;
    [
        w.x,
        w.y,
        w.z,
        s.x,
        s.y,
        w.x * w.y,
        w.y * w.z,
        w.z * w.x,
        s.x * s.x,
        s.y * s.y,
        s.z * s.z,
        s.x * s.y,
        s.y * s.z,
        s.z * s.x,
    ]
}

/// Expected moments for lines that hit the box: the direction's density is proportional to the box's shadow
/// sum |w_i| S_i, with E|w_i| = 1/2, E w_i^2|w_i| = 1/4, E w_j^2|w_i| = 1/8, E w_i^4|w_i| = 1/6, E w_j^4|w_i| = 1/16,
/// E w_i^2 w_j^2|w_i| = 1/24 and E w_j^2 w_k^2|w_i| = 1/48 on the sphere.
fn expected_moments(world: &Aabb) -> [f64; MOMENTS] {
    let share = world.face_areas() / world.face_areas().element_sum();
    let second = |i: usize| share[i] / 2.0 + (1.0 - share[i]) / 4.0;
    let fourth = |i: usize| share[i] / 3.0 + (1.0 - share[i]) / 8.0;
    let mixed =
        |i: usize, j: usize| (share[i] + share[j]) / 12.0 + (1.0 - share[i] - share[j]) / 24.0;
    [
        0.0,
        0.0,
        0.0,
        second(0),
        second(1),
        0.0,
        0.0,
        0.0,
        fourth(0),
        fourth(1),
        fourth(2),
        mixed(0, 1),
        mixed(1, 2),
        mixed(2, 0),
    ]
}

/// What a chunk of lines adds up to. Chords count relative to the box's diagonal.
#[derive(Clone)]
struct Sums {
    boxes: [u64; BOXES],
    triangles: [u64; TRIANGLES],
    /// Sum and sum of squares of the moments, the chord and its fourth power, each less its expectation.
    deviations: [(f64, f64); MOMENTS + 2],
}

/// Check a sampler with `lines` lines given by index. The boxes and triangles are those of `seed`.
pub fn check_sampler(
    world: &Aabb,
    seed: u64,
    lines: u64,
    sample: impl Fn(u64) -> (Line, Span) + Sync,
) -> SamplerChecks {
    let (boxes, triangles) = targets(world, seed);
    let area = world.surface_area();
    let volume = world.volume();
    let mut expected = [0.0; MOMENTS + 2];
    expected[..MOMENTS].copy_from_slice(&expected_moments(world));
    let diagonal = world.extent().length();
    expected[MOMENTS] = 4.0 * volume / area / diagonal;
    expected[MOMENTS + 1] =
        12.0 * volume * volume / (std::f64::consts::PI * area) / diagonal.powi(4);

    let chunk = |start: u64| {
        let mut sums = Sums {
            boxes: [0; BOXES],
            triangles: [0; TRIANGLES],
            deviations: [(0.0, 0.0); MOMENTS + 2],
        };
        for i in start..lines.min(start + CHUNK) {
            let (line, span) = sample(i);
            let inside = world
                .clip(&line, span)
                .expect("a sampled line hits the box");
            let chord = (inside.t1 - inside.t0) * line.direction.length() / diagonal;
            let square = chord * chord;
            let values = moments(line.direction)
                .into_iter()
                .chain([chord, square * square]);
            for ((value, expected), sum) in values.zip(expected).zip(&mut sums.deviations) {
                sum.0 += value - expected;
                sum.1 += (value - expected) * (value - expected);
            }
            for (hits, b) in sums.boxes.iter_mut().zip(&boxes) {
                *hits += u64::from(b.clip(&line, span).is_some());
            }
            let ray = Ray::new(line, span);
            for (hits, t) in sums.triangles.iter_mut().zip(&triangles) {
                *hits += u64::from(t.intersect(&ray).is_some());
            }
        }
        sums
    };
    let chunks: Vec<Sums> = (0..lines.div_ceil(CHUNK))
        .into_par_iter()
        .map(|c| chunk(c * CHUNK))
        .collect();
    let total = chunks.into_iter().reduce(|mut a, b| {
        a.boxes.iter_mut().zip(b.boxes).for_each(|(x, y)| *x += y);
        a.triangles
            .iter_mut()
            .zip(b.triangles)
            .for_each(|(x, y)| *x += y);
        a.deviations
            .iter_mut()
            .zip(b.deviations)
            .for_each(|(x, y)| *x = (x.0 + y.0, x.1 + y.1));
        a
    });
    let total = total.expect("at least one line");

    let n = lines as f64;
    let p_of = |(sum, squares): (f64, f64)| {
        let mean = sum / n;
        let variance = squares / n - mean * mean;
        normal_p(mean / (variance / n).sqrt().max(f64::MIN_POSITIVE))
    };
    let worst =
        |ps: &mut dyn Iterator<Item = f64>, m: usize| (m as f64 * ps.fold(1.0, f64::min)).min(1.0);
    let tail = |(&hits, p): (&u64, f64)| binomial_tail(hits, lines, p);
    let box_p = boxes.iter().map(|b| b.surface_area() / area);
    let triangle_p = triangles.iter().map(|t| 2.0 * t.area() / area);
    SamplerChecks {
        boxes: worst(&mut total.boxes.iter().zip(box_p).map(tail), BOXES),
        mean_chord: p_of(total.deviations[MOMENTS]),
        fourth_chord: p_of(total.deviations[MOMENTS + 1]),
        directions: worst(
            &mut total.deviations[..MOMENTS].iter().map(|&d| p_of(d)),
            MOMENTS,
        ),
        triangles: worst(
            &mut total.triangles.iter().zip(triangle_p).map(tail),
            TRIANGLES,
        ),
    }
}

/// Boxes and triangles between uniform points of the world.
fn targets(world: &Aabb, seed: u64) -> (Vec<Aabb>, Vec<Triangle>) {
    let mut rng = generator(seed, Purpose::Checks);
    let mut point = || {
        world.lo + DVec3::from_array(std::array::from_fn(|_| uniform(&mut rng))) * world.extent()
    };
    let boxes = (0..BOXES)
        .map(|_| Aabb::around([point(), point()]))
        .collect();
    let triangles = (0..TRIANGLES)
        .map(|_| Triangle([point(), point(), point()]))
        .collect();
    (boxes, triangles)
}
