//! Hard cases of boxes: lines in faces and edges, through corners, beside them; flat, huge and tiny boxes.

use std::sync::Arc;

use glam::DVec3;

use crate::geom::{Aabb, Line};
use crate::study::kernel::Kernel;

use super::case::{Case, Check, Finding, Group};
use super::judge::{BoxTest, Judged, line_and_box, meets, refused};

/// A whole line against a box, and whether they meet by hand, of `f64` numbers.
struct BoxCase {
    name: &'static str,
    stresses: &'static str,
    origin: [f64; 3],
    direction: [f64; 3],
    b: Aabb,
    hit: bool,
}

const UNIT: Aabb = Aabb::new(DVec3::ZERO, DVec3::ONE);
const FLAT: Aabb = Aabb::new(DVec3::ZERO, DVec3::new(1.0, 1.0, 0.0));
const POINT: Aabb = Aabb::new(DVec3::ONE, DVec3::ONE);
const SEGMENT: Aabb = Aabb::new(DVec3::ZERO, DVec3::Z);
/// The least number above 0, of f64 and of f32.
const LEAST: f64 = f64::from_bits(1);
const LEAST_F32: f64 = power_of_two(-149);
/// The step beyond 1 in f64 and in f32.
const STEP: f64 = f64::EPSILON;
const STEP_F32: f64 = f32::EPSILON as f64;

/// 2^k as a constant, for normal results.
const fn power_of_two(k: i32) -> f64 {
    f64::from_bits(((1023 + k) as u64) << 52)
}

/// 2^100, 2^-100, 2^-130 and 2^40.
const HUGE: f64 = power_of_two(100);
const TINY: f64 = power_of_two(-100);
const SUBNORMAL_F32: f64 = power_of_two(-130);
const TERA: f64 = power_of_two(40);
const FAR: Aabb = Aabb::new(DVec3::splat(1e6), DVec3::splat(1e6 + 1.0));
const PLATE: Aabb = Aabb::new(DVec3::ZERO, DVec3::new(1e6, 1e6, 1.0));

/// The cube between 0 and this.
const fn cube(side: f64) -> Aabb {
    Aabb::new(DVec3::ZERO, DVec3::splat(side))
}

/// The cube around 0 that reaches this far.
const fn around(reach: f64) -> Aabb {
    Aabb::new(DVec3::splat(-reach), DVec3::splat(reach))
}

const CASES: [BoxCase; 46] = [
    BoxCase {
        name: "box-parallel-in-face",
        stresses: "a line in a face: 0 * inf",
        origin: [0.0, 0.5, -1.0],
        direction: [0.0, 0.0, 1.0],
        b: UNIT,
        hit: true,
    },
    BoxCase {
        name: "box-parallel-in-upper-face",
        stresses: "a line in an upper face",
        origin: [0.5, 1.0, -1.0],
        direction: [0.0, 0.0, 1.0],
        b: UNIT,
        hit: true,
    },
    BoxCase {
        name: "box-parallel-in-edge",
        stresses: "a line in an edge: two slabs of 0 * inf",
        origin: [0.0, 0.0, -1.0],
        direction: [0.0, 0.0, 1.0],
        b: UNIT,
        hit: true,
    },
    BoxCase {
        name: "box-parallel-in-far-edge",
        stresses: "a line in the edge of both upper faces, backwards",
        origin: [1.0, 1.0, 3.0],
        direction: [0.0, 0.0, -1.0],
        b: UNIT,
        hit: true,
    },
    BoxCase {
        name: "box-negative-zero-in-face",
        stresses: "a direction part of -0.0 in a face",
        origin: [0.0, 0.5, -1.0],
        direction: [-0.0, -0.0, 1.0],
        b: UNIT,
        hit: true,
    },
    BoxCase {
        name: "box-negative-zero-in-edge",
        stresses: "direction parts of -0.0 in an edge",
        origin: [0.0, 0.0, -1.0],
        direction: [-0.0, -0.0, -1.0],
        b: UNIT,
        hit: true,
    },
    BoxCase {
        name: "box-parallel-one-step-outside",
        stresses: "beside a face by the least number: no flushing to zero",
        origin: [-LEAST, 0.5, -1.0],
        direction: [0.0, 0.0, 1.0],
        b: UNIT,
        hit: false,
    },
    BoxCase {
        name: "box-parallel-one-step-outside-f32",
        stresses: "beside a face by the least number of f32",
        origin: [-LEAST_F32, 0.5, -1.0],
        direction: [0.0, 0.0, 1.0],
        b: UNIT,
        hit: false,
    },
    BoxCase {
        name: "box-parallel-one-step-above",
        stresses: "beside an upper face by one step",
        origin: [1.0 + STEP, 0.5, -1.0],
        direction: [0.0, 0.0, 1.0],
        b: UNIT,
        hit: false,
    },
    BoxCase {
        name: "box-in-face-plane-oblique",
        stresses: "a line in a face's plane that crosses the face",
        origin: [-1.0, 0.25, 0.0],
        direction: [1.0, 0.25, 0.0],
        b: UNIT,
        hit: true,
    },
    BoxCase {
        name: "box-in-face-plane-beside",
        stresses: "a line in a face's plane that passes the face",
        origin: [-1.0, 1.5, 0.0],
        direction: [1.0, 0.25, 0.0],
        b: UNIT,
        hit: false,
    },
    BoxCase {
        name: "box-corner-diagonal",
        stresses: "through two opposite corners",
        origin: [-1.0, -1.0, -1.0],
        direction: [1.0, 1.0, 1.0],
        b: UNIT,
        hit: true,
    },
    BoxCase {
        name: "box-corner-diagonal-backwards",
        stresses: "the same against all axes, with the box behind",
        origin: [-1.0, -1.0, -1.0],
        direction: [-1.0, -1.0, -1.0],
        b: UNIT,
        hit: true,
    },
    BoxCase {
        name: "box-corner-touch",
        stresses: "touches one corner: a single t",
        origin: [-1.0, 1.0, 0.0],
        direction: [1.0, -1.0, 0.0],
        b: UNIT,
        hit: true,
    },
    BoxCase {
        name: "box-corner-near-miss",
        stresses: "passes a corner by 2^-24",
        origin: [-1.0, 1.0 - 0.5 * STEP_F32, 0.0],
        direction: [1.0, -1.0, 0.0],
        b: UNIT,
        hit: false,
    },
    BoxCase {
        name: "box-corner-nearest-miss",
        stresses: "passes a corner by 2^-50: nearer than 8 ulp",
        origin: [-1.0, 1.0 - 4.0 * STEP, 0.0],
        direction: [1.0, -1.0, 0.0],
        b: UNIT,
        hit: false,
    },
    BoxCase {
        name: "box-edge-touch",
        stresses: "touches an edge at a slant",
        origin: [-1.0, 1.0, -2.0],
        direction: [1.0, -1.0, 2.5],
        b: UNIT,
        hit: true,
    },
    BoxCase {
        name: "box-edge-touch-thirds",
        stresses: "through an edge's point by thirds, which no number has",
        origin: [-1.0, -1.0, -0.5],
        direction: [1.0 / 3.0, 1.0 / 3.0, 0.25],
        b: UNIT,
        hit: true,
    },
    BoxCase {
        name: "box-edge-behind",
        stresses: "touches an edge at negative t, where padding must widen to both sides",
        origin: [2.0, 0.0, 0.25],
        direction: [1.0, -1.0, 0.0],
        b: UNIT,
        hit: true,
    },
    BoxCase {
        name: "box-flat-in-plane",
        stresses: "a line in a flat box",
        origin: [-1.0, 0.5, 0.0],
        direction: [1.0, 0.0, 0.0],
        b: FLAT,
        hit: true,
    },
    BoxCase {
        name: "box-flat-crossing",
        stresses: "a flat box crossed: near and far t are equal",
        origin: [0.25, 0.375, -1.0],
        direction: [0.125, 0.25, 1.0],
        b: FLAT,
        hit: true,
    },
    BoxCase {
        name: "box-flat-parallel-above",
        stresses: "a line above a flat box by the least number",
        origin: [-1.0, 0.5, LEAST],
        direction: [1.0, 0.0, 0.0],
        b: FLAT,
        hit: false,
    },
    BoxCase {
        name: "box-point-met",
        stresses: "a box that is a point",
        origin: [0.0, 0.0, 0.0],
        direction: [1.0, 1.0, 1.0],
        b: POINT,
        hit: true,
    },
    BoxCase {
        name: "box-point-missed",
        stresses: "beside a point by one step of f64",
        origin: [0.0, 0.0, 0.0],
        direction: [1.0, 1.0, 1.0 + STEP],
        b: POINT,
        hit: false,
    },
    BoxCase {
        name: "box-point-missed-f32",
        stresses: "beside a point by one step of f32",
        origin: [0.0, 0.0, 0.0],
        direction: [1.0, 1.0, 1.0 + STEP_F32],
        b: POINT,
        hit: false,
    },
    BoxCase {
        name: "box-segment-met",
        stresses: "a box of two zero extents, met",
        origin: [-1.0, -1.0, 0.5],
        direction: [1.0, 1.0, 0.0],
        b: SEGMENT,
        hit: true,
    },
    BoxCase {
        name: "box-segment-along",
        stresses: "a line along a box that is a segment",
        origin: [0.0, 0.0, -1.0],
        direction: [0.0, 0.0, 1.0],
        b: SEGMENT,
        hit: true,
    },
    BoxCase {
        name: "box-tiny-direction-part",
        stresses: "a direction part of 1e-20 through an edge",
        origin: [0.0, 0.5, -1.0],
        direction: [-1e-20, 0.0, 1.0],
        b: UNIT,
        hit: false,
    },
    BoxCase {
        name: "box-tiny-direction-part-inwards",
        stresses: "the same, inwards",
        origin: [0.0, 0.5, -1.0],
        direction: [1e-20, 0.0, 1.0],
        b: UNIT,
        hit: true,
    },
    BoxCase {
        name: "box-subnormal-direction-part-f32",
        stresses: "a direction part that is subnormal in f32",
        origin: [0.0, 0.5, -1.0],
        direction: [5e-39, 0.0, 1.0],
        b: UNIT,
        hit: true,
    },
    BoxCase {
        name: "box-vanishing-direction-part",
        stresses: "a reciprocal that overflows in f32: there the line is the one with that part 0, and hits",
        origin: [0.0, 0.5, -1.0],
        direction: [-1e-41, 0.0, 1.0],
        b: UNIT,
        hit: false,
    },
    BoxCase {
        name: "box-vanishing-direction-part-f64",
        stresses: "a reciprocal that overflows: the line is the one with that part 0, in a face, and hits",
        origin: [0.0, 0.5, -1.0],
        direction: [-LEAST, 0.0, 1.0],
        b: UNIT,
        hit: true,
    },
    BoxCase {
        name: "box-vanishing-direction-part-f64-beside",
        stresses: "the same beside a face, which the part would reach: a miss",
        origin: [-4e-309, 0.25, -1.0],
        direction: [5e-309, 0.0, 1.0],
        b: UNIT,
        hit: false,
    },
    BoxCase {
        name: "box-scale-1e30",
        stresses: "a corner touched at scale 2^100",
        origin: [-HUGE, HUGE, 0.0],
        direction: [1.0, -1.0, 0.0],
        b: cube(HUGE),
        hit: true,
    },
    BoxCase {
        name: "box-scale-1e30-miss",
        stresses: "the same, missed by 2^-23",
        origin: [-HUGE, HUGE * (1.0 - STEP_F32), 0.0],
        direction: [1.0, -1.0, 0.0],
        b: cube(HUGE),
        hit: false,
    },
    BoxCase {
        name: "box-scale-1e-30",
        stresses: "a corner touched at scale 2^-100",
        origin: [-TINY, TINY, 0.0],
        direction: [1.0, -1.0, 0.0],
        b: cube(TINY),
        hit: true,
    },
    BoxCase {
        name: "box-scale-1e-30-miss",
        stresses: "the same, missed by 2^-23",
        origin: [-TINY, TINY * (1.0 - STEP_F32), 0.0],
        direction: [1.0, -1.0, 0.0],
        b: cube(TINY),
        hit: false,
    },
    BoxCase {
        name: "box-subnormal-box-f32",
        stresses: "a corner touched of a box that is subnormal in f32",
        origin: [-SUBNORMAL_F32, SUBNORMAL_F32, 0.0],
        direction: [1.0, -1.0, 0.0],
        b: cube(SUBNORMAL_F32),
        hit: true,
    },
    BoxCase {
        name: "box-subnormal-box",
        stresses: "a corner touched of a box of the least number",
        origin: [-LEAST, LEAST, 0.0],
        direction: [1.0, -1.0, 0.0],
        b: cube(LEAST),
        hit: true,
    },
    BoxCase {
        name: "box-overflow-f32",
        stresses: "differences overflow in f32",
        origin: [-3e38, 0.0, 0.0],
        direction: [1.0, 0.0, 0.0],
        b: around(3e38),
        hit: true,
    },
    BoxCase {
        name: "box-overflow",
        stresses: "differences overflow",
        origin: [-f64::MAX, 0.0, 0.0],
        direction: [1.0, 0.0, 0.0],
        b: around(f64::MAX),
        hit: true,
    },
    BoxCase {
        name: "box-overflow-diagonal",
        stresses: "two slabs overflow",
        origin: [-f64::MAX, -f64::MAX, 0.0],
        direction: [1.0, 1.0, 0.0],
        b: around(f64::MAX),
        hit: true,
    },
    BoxCase {
        name: "box-far-offset-1e6",
        stresses: "a corner touched a million away",
        origin: [1e6 - 1.0, 1e6 + 1.0, 1e6],
        direction: [1.0, -1.0, 0.0],
        b: FAR,
        hit: true,
    },
    BoxCase {
        name: "box-far-offset-1e6-miss",
        stresses: "the same, missed by 2^-20",
        origin: [1e6 - 1.0, 1e6 + 1.0 - 16.0 * 0.5 * STEP_F32, 1e6],
        direction: [1.0, -1.0, 0.0],
        b: FAR,
        hit: false,
    },
    BoxCase {
        name: "box-far-origin",
        stresses: "the origin 2^40 away, towards an edge",
        origin: [-TERA, TERA, 0.5],
        direction: [1.0, -1.0, 0.0],
        b: UNIT,
        hit: true,
    },
    BoxCase {
        name: "box-aspect-1e6",
        stresses: "a plate of 10^6 x 10^6 x 1 passed at its rim",
        origin: [-1e6, 0.5, -1.0],
        direction: [1e6, 0.0, 1.0],
        b: PLATE,
        hit: true,
    },
];

impl BoxCase {
    /// `f64` must be right; padded `f32` must miss nothing where the numbers are in its range.
    fn demanded(&self, kernel: Kernel) -> bool {
        let points = [self.origin, self.b.lo.to_array(), self.b.hi.to_array()];
        let mut numbers = points.as_flattened().iter();
        match kernel {
            Kernel::F64 => true,
            Kernel::F32 => false,
            Kernel::F32Padded => numbers.all(|x| x.abs() <= f64::from(f32::MAX)),
        }
    }

    fn check(&self, kernel: Kernel, test: BoxTest) -> Finding {
        let line = Line::new(self.origin.into(), self.direction.into());
        match line_and_box(kernel, &line, &self.b, test) {
            Ok(judged) => judged.finding(kernel, self.demanded(kernel)),
            Err(refusal) => refused(Judged::word(self.hit), &refusal, self.demanded(kernel)),
        }
    }
}

/// The cases of this group.
pub fn cases() -> Vec<Case> {
    let one = |case: &'static BoxCase| Case {
        name: case.name,
        group: Group::Boxes,
        stresses: case.stresses,
        check: Check::Kernels(Arc::new(|kernel| Some(case.check(kernel, meets)))),
    };
    CASES.iter().map(one).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::line_box;
    use crate::study::stability::case::Outcome;

    /// By hand and by the oracle: the same.
    #[test]
    fn the_oracle_agrees_with_the_hand() {
        for case in &CASES {
            let line = Line::new(case.origin.into(), case.direction.into());
            let exact = line_box(line.origin, line.direction, &case.b);
            assert_eq!(exact.hit, case.hit, "{}", case.name);
        }
    }

    /// Box tests as often written: each fails in some case that the program's own passes.
    #[test]
    fn broken_box_tests_are_caught() {
        // min and max of both ends, where 0 * inf = NaN becomes an end of the wrong side.
        let chain: BoxTest = |b, line| {
            let inverse = line.direction.recip();
            let (mut t0, mut t1) = (f64::NEG_INFINITY, f64::INFINITY);
            for k in 0..3 {
                let one = (b.lo[k] - line.origin[k]) * inverse[k];
                let other = (b.hi[k] - line.origin[k]) * inverse[k];
                t0 = t0.max(one.min(other));
                t1 = t1.min(one.max(other));
            }
            t0 <= t1
        };
        // An open box.
        let open: BoxTest = |b, line| {
            let span = b.clip(line, crate::geom::Span::FULL);
            span.is_some_and(|span| span.t0 < span.t1)
        };
        // Always there.
        let blind: BoxTest = |_, _| true;
        for (test, least) in [(chain, 4), (open, 4), (blind, 8)] {
            let failed = CASES.iter().filter(|case| {
                let finding = case.check(Kernel::F64, test);
                finding.demanded && finding.outcome == Outcome::Failed
            });
            assert!(failed.count() >= least);
        }
    }
}
