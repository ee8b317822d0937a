//! Five checks of a line sampler, each against an exact value of integral geometry (Santalo 1976).
//!
//! Hits of boxes alone cannot tell most wrong direction laws: for axis-aligned boxes only the ratio of the mean |w_x|,
//! |w_y|, |w_z| matters, so lines along the axes pass. Chord lengths, direction moments and triangles see the rest.

use glam::DVec3;
use rayon::prelude::*;

use crate::geom::{Aabb, Line, Ray, Span, Triangle};
use crate::stats::{binomial_tail, normal_p};

use super::address::{Purpose, generator, uniform};

/// The p-values of the five checks. Each is corrected for the number of comparisons inside it; `None` where
/// a check does not apply (chords of a very flat or long box).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SamplerChecks {
    /// Hits of boxes: SA(K)/SA(R).
    pub boxes: Option<f64>,
    /// Mean chord of the root: 4V/SA.
    pub mean_chord: Option<f64>,
    /// Mean fourth power of the chord: 12 V^2/(pi SA).
    pub fourth_chord: Option<f64>,
    /// Moments of the directions of lines that hit the box, up to the fourth.
    pub directions: Option<f64>,
    /// Hits of triangles of any orientation: 2A/SA(R).
    pub triangles: Option<f64>,
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
    pub fn values(&self) -> [Option<f64>; 5] {
        [
            self.boxes,
            self.mean_chord,
            self.fourth_chord,
            self.directions,
            self.triangles,
        ]
    }
}

const BOXES: usize = 30;
const TRIANGLES: usize = 60;
/// Shortest over longest side below which chords are not checked: their fourth power then hangs on the few lines that
/// run along the box, and its mean has no normal law.
const THINNEST: f64 = 1.0 / 25.0;
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
    /// Sums of the moments, the chord and its fourth power, each less its expectation, and of their squares.
    deviations: [(f64, f64); MOMENTS + 2],
}

impl Sums {
    const NONE: Self = Self {
        boxes: [0; BOXES],
        triangles: [0; TRIANGLES],
        deviations: [(0.0, 0.0); MOMENTS + 2],
    };

    fn add(mut self, other: &Self) -> Self {
        self.boxes
            .iter_mut()
            .zip(other.boxes)
            .for_each(|(x, y)| *x += y);
        self.triangles
            .iter_mut()
            .zip(other.triangles)
            .for_each(|(x, y)| *x += y);
        for (mine, theirs) in self.deviations.iter_mut().zip(other.deviations) {
            *mine = (mine.0 + theirs.0, mine.1 + theirs.1);
        }
        self
    }
}

/// Check a sampler with `lines` lines given by index. The boxes and triangles are those of `seed`.
///
/// The lines are carried to a box of size about 1 first, by a shift and a power of two, so that no area or volume
/// overflows.
pub fn check_sampler(
    world: &Aabb,
    seed: u64,
    lines: u64,
    sample: impl Fn(u64) -> (Line, Span) + Sync,
) -> SamplerChecks {
    let scale = libm::ldexp(1.0, -libm::ilogb(world.extent().max_element()));
    let corner = world.lo;
    let world = Aabb::new(DVec3::ZERO, world.extent() * scale);
    let (boxes, triangles) = targets(&world, seed);
    let area = world.surface_area();
    let volume = world.volume();
    let diagonal = world.extent().length();
    let mut expected = [0.0; MOMENTS + 2];
    expected[..MOMENTS].copy_from_slice(&expected_moments(&world));
    expected[MOMENTS] = 4.0 * volume / area / diagonal;
    let fourth = diagonal * diagonal * diagonal * diagonal;
    expected[MOMENTS + 1] = 12.0 * volume * volume / (std::f64::consts::PI * area) / fourth;

    let chunk = |start: u64| {
        let mut sums = Sums::NONE;
        for i in start..lines.min(start + CHUNK) {
            let (line, span) = sample(i);
            let line = Line::new((line.origin - corner) * scale, line.direction * scale);
            // Rounding may carry a line that only touched the box past it: then its chord is 0.
            let inside = world.clip(&line, span).unwrap_or(Span { t0: 0.0, t1: 0.0 });
            let chord = (inside.t1 - inside.t0) * line.direction.length() / diagonal;
            let square = chord * chord;
            let values = moments(line.direction)
                .into_iter()
                .chain([chord, square * square]);
            for ((value, expected), sum) in values.zip(expected).zip(&mut sums.deviations) {
                let d = value - expected;
                *sum = (sum.0 + d, sum.1 + d * d);
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
    let total = chunks.iter().fold(Sums::NONE, Sums::add);

    let n = lines as f64;
    let p_of = |(sum, squares): (f64, f64)| {
        let mean = sum / n;
        let variance = squares / n - mean * mean;
        (variance > 0.0).then(|| normal_p(mean / (variance / n).sqrt()))
    };
    let compact = world.extent().min_element() >= THINNEST * world.extent().max_element();
    let worst = |ps: &mut dyn Iterator<Item = f64>, m: usize| {
        ps.reduce(f64::min).map(|p| (m as f64 * p).min(1.0))
    };
    let tail =
        |(&hits, p): (&u64, f64)| (0.0 < p && p < 1.0).then(|| binomial_tail(hits, lines, p));
    let box_p = boxes.iter().map(|b| b.surface_area() / area);
    let triangle_p = triangles.iter().map(|t| 2.0 * t.area() / area);
    let (directions, chords) = total.deviations.split_at(MOMENTS);
    SamplerChecks {
        boxes: worst(&mut total.boxes.iter().zip(box_p).filter_map(tail), BOXES),
        mean_chord: p_of(chords[0]).filter(|_| compact),
        fourth_chord: p_of(chords[1]).filter(|_| compact),
        directions: worst(&mut directions.iter().filter_map(|&d| p_of(d)), MOMENTS),
        triangles: worst(
            &mut total.triangles.iter().zip(triangle_p).filter_map(tail),
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
