//! Exact probabilities for two kinds of rays that begin inside the root, as checks of the counts.
//!
//! Take an isotropic line with chord [0, L] in the root, of which [a, b] lies in node N. A ray from a uniform point of the
//! root in an isotropic direction is such a line, drawn in proportion to L, with its origin uniform in [0, L]: it hits N if
//! the origin lies before b. Hence P = E(b; line hits N) / E(L), or by reversal E(L - a; line hits N) / E(L); E(L) = 4V/SA.
//! Two uniform points lie on a line drawn in proportion to L^4 (their density on it is the square of their distance), and
//! the segment between them misses N if both lie in [0, a] or both in [b, L]: P = E(L^4 - a^4 - (L - b)^4; line hits N) /
//! E(L^4), with E(L^4) = 12 V^2 / (pi SA). Source: Santalo, "Integral Geometry and Geometric Probability" (1976), 4.2; Kingman,
//! "Random secants of a convex body" (J. Appl. Prob. 6, 1969).
//!
//! So lines that have nothing to do with the counted rays, and boxes that no tree was walked for, give what each node must
//! count. Across one axis the second expectation has a closed form: a slab [c, d] of the root is missed by a segment whose
//! ends both lie below c or both above d, P = 1 - c^2 - (1 - d)^2.

use std::f64::consts::PI;

use rayon::prelude::*;

use crate::geom::{Aabb, Span};
use crate::kd::Ask;
use crate::rays::{LineLaw, Source, SurfaceLines};
use crate::stats::binomial_tail;
use crate::study::ray_sets::RaysOf;

/// Rays for which theory knows more than the metric.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Inside {
    /// From a uniform point of the root's box, in an isotropic direction.
    Ray,
    /// Between two uniform points of the box.
    Segment,
}

impl Inside {
    /// Which of them these rays are, if nothing stops them.
    pub fn of(rays: RaysOf) -> Option<Self> {
        match rays {
            RaysOf::Source(Source::Law(LineLaw::VolumeRay), Ask::All) => Some(Self::Ray),
            RaysOf::Source(Source::Law(LineLaw::VolumeSegment), Ask::All) => Some(Self::Segment),
            _ => None,
        }
    }

    /// What a line with chord L in the root, [a, b] of it in a node, adds to the mean of the node; it hits the node.
    fn weight(self, chord: f64, [a, b]: [f64; 2], root: &Aabb) -> f64 {
        let (area, volume) = (root.surface_area(), root.volume());
        match self {
            // The mean of both directions.
            Self::Ray => 0.5 * (b + chord - a) / (4.0 * volume / area),
            Self::Segment => {
                let fourth = |x: f64| (x * x) * (x * x);
                let missed = fourth(a) + fourth(chord - b);
                (fourth(chord) - missed) / (12.0 * volume * volume / (PI * area))
            }
        }
    }
}

/// The share of rays that hit a node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Share {
    /// Expected.
    pub mean: f64,
    /// Its standard error.
    pub se: f64,
    /// Bound of the skewness of the mean's error: E|w - mean|^3 is at most the heaviest weight times the variance, so it is
    /// at most (heaviest weight)/(n se). In a flat root a few long chords weigh more than all others.
    pub skewness: f64,
}

impl Share {
    /// A share known exactly.
    pub fn known(mean: f64) -> Self {
        Self {
            mean,
            se: 0.0,
            skewness: 0.0,
        }
    }
}

/// Lines that one thread takes at a time; sums are added in the order of the lines.
const CHUNK: u64 = 4096;

/// The shares that theory expects of some boxes in a root with a volume, from isotropic lines through it.
pub fn expected(root: &Aabb, boxes: &[Aabb], inside: Inside, seed: u64, lines: u64) -> Vec<Share> {
    let source = SurfaceLines { world: *root, seed };
    let chunk = |c: u64| {
        let mut sums = vec![[0.0; 2]; boxes.len()];
        for line in source.range(c * CHUNK..lines.min((c + 1) * CHUNK)) {
            let Some(chord) = root.clip(&line, Span::FULL) else {
                continue;
            };
            for (sum, node) in sums.iter_mut().zip(boxes) {
                if let Some(part) = node.clip(&line, Span::FULL) {
                    let ends = [part.t0 - chord.t0, part.t1 - chord.t0];
                    let weight = inside.weight(chord.t1 - chord.t0, ends, root);
                    *sum = [sum[0] + weight, sum[1] + weight * weight];
                }
            }
        }
        sums
    };
    let chunks: Vec<_> = (0..lines.div_ceil(CHUNK))
        .into_par_iter()
        .map(chunk)
        .collect();
    let mut sums = vec![[0.0; 2]; boxes.len()];
    for (sum, part) in chunks.iter().flat_map(|chunk| chunk.iter().enumerate()) {
        sums[sum] = [sums[sum][0] + part[0], sums[sum][1] + part[1]];
    }
    let n = lines as f64;
    let diagonal = root.extent().length();
    let heaviest = inside.weight(diagonal, [0.0, diagonal], root);
    let share = |[sum, squares]: [f64; 2]| {
        let mean = sum / n;
        let se = ((squares / n - mean * mean).max(0.0) / (n - 1.0)).sqrt();
        Share {
            mean,
            se,
            skewness: heaviest / (n * se),
        }
    };
    sums.into_iter().map(share).collect()
}

/// The share of segments that hit a box, where it spans the root but for one axis.
pub fn slab(root: &Aabb, node: &Aabb) -> Option<f64> {
    let spans = |&axis: &usize| node.lo[axis] == root.lo[axis] && node.hi[axis] == root.hi[axis];
    let others: Vec<usize> = (0..3).filter(|axis| !spans(axis)).collect();
    let [axis] = others[..] else {
        return None;
    };
    let place = |x: f64| (x - root.lo[axis]) / (root.hi[axis] - root.lo[axis]);
    let (below, above) = (place(node.lo[axis]), 1.0 - place(node.hi[axis]));
    Some(1.0 - below * below - above * above)
}

/// Standard errors by which an expectation from lines may be off: that it is off by more is rarer than any level asked for,
/// as long as its error is not skewed.
const REACH: f64 = 6.0;
const MOST_SKEWNESS: f64 = 0.1;

/// The p-value of so many hits of `cast` rays; `None` where too few hits or misses are expected to tell, or too few lines
/// make up the expectation.
pub fn p_value(share: Share, hits: u64, cast: u64) -> Option<f64> {
    let open = |p: f64| p > 0.0 && p < 1.0;
    if share.se == 0.0 {
        return open(share.mean).then(|| binomial_tail(hits, cast, share.mean));
    }
    // The tail at the expectation within reach that is nearest to the count: never too small.
    let [lo, hi] = [-REACH, REACH].map(|reach| share.mean + reach * share.se);
    let enough = open(lo) && open(hi) && share.skewness <= MOST_SKEWNESS;
    let nearest = (hits as f64 / cast as f64).clamp(lo, hi);
    enough.then(|| binomial_tail(hits, cast, nearest))
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    const ROOT: Aabb = Aabb::new(DVec3::ZERO, DVec3::ONE);

    /// A cube by its lower corner and side.
    fn cube(lo: [f64; 3], side: f64) -> Aabb {
        let lo = DVec3::from(lo);
        Aabb::new(lo, lo + side)
    }

    /// Octant, centred half cube, and cubes of a tenth in a corner, at a face's centre, in the middle.
    fn cubes() -> [Aabb; 5] {
        [
            cube([0.0; 3], 0.5),
            cube([0.25; 3], 0.5),
            cube([0.0; 3], 0.1),
            cube([0.0, 0.45, 0.45], 0.1),
            cube([0.45; 3], 0.1),
        ]
    }

    fn hits(law: LineLaw, boxes: &[Aabb], cast: u64) -> Vec<u64> {
        let rays: Vec<_> = (0..cast).map(|i| law.sample(&ROOT, 5, i)).collect();
        let hit = |node: &Aabb| {
            rays.iter()
                .filter(|(line, span)| node.clip(line, *span).is_some())
                .count() as u64
        };
        boxes.iter().map(hit).collect()
    }

    /// Shares over SA(N)/SA(R), known from four million rays each to two decimals.
    #[test]
    fn known_shares() {
        for (inside, known) in [
            (Inside::Ray, [0.87, 1.07, 0.42, 0.71, 0.97]),
            (Inside::Segment, [1.25, 2.39, 0.20, 0.65, 3.48]),
        ] {
            let shares = expected(&ROOT, &cubes(), inside, 3, 1 << 21);
            for ((share, known), node) in shares.iter().zip(known).zip(cubes()) {
                let p = node.surface_area() / 6.0;
                let apart = (share.mean / p - known).abs();
                // Half a unit of the last decimal, and five standard errors of both estimates.
                let of_known = (share.mean / 4e6).sqrt();
                let slack = 0.005 + 5.0 * share.se.hypot(of_known) / p;
                assert!(apart < slack && slack < 0.2, "{inside:?} {apart} {slack}");
            }
        }
    }

    /// The share of volume rays is V_N/V + (1/V) times the integral over the points outside N of N's solid angle over 4 pi:
    /// here by the midpoint rule, with the solid angle a sum over the faces turned to the point.
    #[test]
    fn volume_rays_by_solid_angles() {
        let node = Aabb::new(DVec3::new(0.5, 0.25, 0.0), DVec3::new(1.0, 1.0, 0.5));
        // Seen from a corner's foot: a rectangle with sides u, v at height h.
        let corner = |u: f64, v: f64, h: f64| (u * v).atan2(h * (u * u + v * v + h * h).sqrt());
        let angle = |point: DVec3| -> f64 {
            let mut sum = 0.0;
            for k in 0..3 {
                let [i, j] = [(k + 1) % 3, (k + 2) % 3];
                let height = (node.lo[k] - point[k]).max(point[k] - node.hi[k]);
                if height > 0.0 {
                    let [u0, u1] = [node.lo[i] - point[i], node.hi[i] - point[i]];
                    let [v0, v1] = [node.lo[j] - point[j], node.hi[j] - point[j]];
                    sum += corner(u1, v1, height) - corner(u0, v1, height);
                    sum += corner(u0, v0, height) - corner(u1, v0, height);
                }
            }
            sum
        };
        let steps = 64_u32;
        let at = |i: u32| (f64::from(i) + 0.5) / f64::from(steps);
        let mut sum = 0.0;
        for (x, y, z) in
            (0..steps.pow(3)).map(|n| (n / steps / steps, n / steps % steps, n % steps))
        {
            let point = DVec3::new(at(x), at(y), at(z));
            let inside = node.contains(&Aabb::new(point, point));
            sum += if inside {
                1.0
            } else {
                angle(point) / (4.0 * PI)
            };
        }
        let exact = sum / f64::from(steps.pow(3));
        let [share] = expected(&ROOT, &[node], Inside::Ray, 8, 1 << 18)[..] else {
            panic!("one box");
        };
        // The rule's own error is below 1e-4: the integrand jumps only at the node's faces, which lie on cell faces.
        let apart = (share.mean - exact).abs();
        assert!(apart < 1e-4 + 5.0 * share.se, "{} for {exact}", share.mean);
        assert!(share.se < 1e-3);
    }

    #[test]
    fn slabs() {
        let node = |lo: f64, hi: f64| Aabb::new(DVec3::new(0.0, lo, 0.0), DVec3::new(1.0, hi, 1.0));
        assert_eq!(slab(&ROOT, &node(0.0, 0.5)), Some(0.75));
        assert_eq!(slab(&ROOT, &node(0.25, 0.5)), Some(1.0 - 0.0625 - 0.25));
        assert_eq!(slab(&ROOT, &ROOT), None);
        assert_eq!(slab(&ROOT, &cubes()[0]), None);
        // The same from lines.
        let [share] = expected(&ROOT, &[node(0.25, 0.5)], Inside::Segment, 4, 1 << 18)[..] else {
            panic!("one box");
        };
        assert!((share.mean - 0.6875).abs() < 5.0 * share.se && share.se < 4e-3);
    }

    /// Right rays pass, those of another law are caught.
    #[test]
    fn wrong_rays_are_caught() {
        let cast = 1 << 15;
        let all = cubes();
        for (inside, right, wrong) in [
            (Inside::Ray, LineLaw::VolumeRay, LineLaw::VolumeSegment),
            (Inside::Segment, LineLaw::VolumeSegment, LineLaw::VolumeRay),
        ] {
            let shares = expected(&ROOT, &all, inside, 6, 1 << 17);
            let least = |law| {
                let hits = hits(law, &all, cast);
                let p = shares.iter().zip(&hits);
                let p = p.filter_map(|(share, &hits)| p_value(*share, hits, cast));
                p.fold(1.0, f64::min)
            };
            assert!(least(right) > 1e-3, "{inside:?} {}", least(right));
            assert!(least(wrong) < 1e-12, "{inside:?} {}", least(wrong));
        }
    }
}
