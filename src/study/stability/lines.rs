//! Hard cases of lines and rays: where they begin and end, and the lines that are drawn through boxes of any shape.

use std::sync::Arc;

use glam::DVec3;

use crate::geom::{Aabb, Line, Span};
use crate::kd::narrow::narrow_line;
use crate::rays::{SurfaceLines, surface_line};
use crate::study::kernel::Kernel;

use super::case::{Case, Check, Finding, Group};
use super::first_hit::once;
use super::judge::refused;
use super::table::{meet, number, rows, vector};

/// A part of a line against the unit cube; all numbers are dyadic, so that every kernel must be right.
struct SpanCase {
    name: &'static str,
    stresses: &'static str,
    line: Line,
    span: Span,
    hit: bool,
}

const UNIT: Aabb = Aabb::new(DVec3::ZERO, DVec3::ONE);

/// The cases of `tables/spans.txt`.
fn table() -> impl Iterator<Item = SpanCase> {
    let rows = rows(include_str!("tables/spans.txt"));
    rows.map(
        |[name, hit, origin, direction, t0, t1, stresses]| SpanCase {
            name,
            stresses,
            line: Line::new(vector(origin), vector(direction)),
            span: Span {
                t0: number(t0),
                t1: number(t1),
            },
            hit: meet(hit),
        },
    )
}

impl SpanCase {
    fn check(&self, kernel: Kernel) -> Finding {
        let word = |hit: bool| if hit { "hit" } else { "miss" };
        let (line, Span { t0, t1 }) = (self.line, self.span);
        let said = match kernel {
            Kernel::F64 => UNIT.clip(&line, Span { t0, t1 }).is_some(),
            Kernel::F32 | Kernel::F32Padded => {
                let line = match narrow_line(&line) {
                    Ok(line) => line,
                    Err(refusal) => return refused(word(self.hit), &refusal, true),
                };
                let unit = Aabb {
                    lo: UNIT.lo.as_vec3(),
                    hi: UNIT.hi.as_vec3(),
                };
                let span = Span {
                    t0: t0 as f32,
                    t1: t1 as f32,
                };
                match kernel {
                    Kernel::F32 => unit.clip(&line, span),
                    _ => unit.clip_conservative(&line, span),
                }
                .is_some()
            }
        };
        Finding::of(word(self.hit), word(said))
    }
}

/// The cases of this group.
pub fn cases() -> Vec<Case> {
    let span = |case: SpanCase| Case {
        name: case.name,
        group: Group::Lines,
        stresses: case.stresses,
        check: Check::Kernels(Arc::new(move |kernel| Some(case.check(kernel)))),
    };
    let mut cases: Vec<Case> = table().map(span).collect();
    let drawn = |name, stresses, check| once(Group::Lines, name, stresses, check);
    cases.extend([
        drawn(
            "drawn-in-flat-box",
            "a box without height: lines begin on its two faces",
            || drawn_through(Aabb::new(DVec3::ZERO, DVec3::new(1.0, 2.0, 0.0))),
        ),
        drawn(
            "drawn-in-long-box",
            "a box of 10^6 x 1 x 1: faces are taken by area",
            || drawn_through(Aabb::new(DVec3::ZERO, DVec3::new(1e6, 1.0, 1.0))),
        ),
        drawn(
            "drawn-far-away",
            "a box of side 1 a hundred million away",
            || drawn_through(Aabb::new(DVec3::splat(1e8), DVec3::splat(1e8 + 1.0))),
        ),
        drawn("drawn-in-tiny-box", "a box of side 2^-460", || {
            drawn_through(Aabb::new(DVec3::ZERO, DVec3::splat(libm::ldexp(1.0, -460))))
        }),
        drawn("drawn-in-huge-box", "a box of side 2^460", || {
            drawn_through(Aabb::new(DVec3::ZERO, DVec3::splat(libm::ldexp(1.0, 460))))
        }),
        drawn(
            "drawn-from-extreme-numbers",
            "random numbers next to 0 and to 1",
            extreme_numbers,
        ),
        drawn(
            "reciprocal-overflows",
            "a direction part whose reciprocal overflows is kept as 0, and no number is NaN",
            || {
                let line = Line::new(DVec3::ZERO, DVec3::new(f64::from_bits(1), -0.0, 1.0));
                Finding::of(
                    "parallel to x, parallel to y, direction [0, 0, 1], inverse of z 1",
                    format!(
                        "{}parallel to x, {}parallel to y, direction {}, inverse of z {}",
                        if line.is_parallel(0) { "" } else { "not " },
                        if line.is_parallel(1) { "" } else { "not " },
                        line.direction,
                        line.inverse.z
                    ),
                )
            },
        ),
    ]);
    cases
}

/// Whether a line of a box is sound: finite, of unit length up to rounding, from the box's surface, and meeting the box.
fn is_sound(line: &Line, b: &Aabb) -> bool {
    let (o, d) = (line.origin, line.direction);
    let on_face = (0..3).any(|k| o[k] == b.lo[k] || o[k] == b.hi[k]);
    o.is_finite()
        && on_face
        && b.contains(&Aabb::new(o, o))
        && (d.length() - 1.0).abs() <= 4.0 * f64::EPSILON
        && b.clip(line, Span::FULL).is_some()
}

/// The study's lines through a box: all sound, and of those that begin on each pair of faces no more and no fewer than areas say,
/// give or take five standard errors.
fn drawn_through(world: Aabb) -> Finding {
    const LINES: u64 = 4096;
    let lines = SurfaceLines { world, seed: 1 };
    let mut of_axis = [0.0; 3];
    let mut unsound = 0;
    for line in lines.range(0..LINES) {
        unsound += u32::from(!is_sound(&line, &world));
        // The axis whose face it begins on: that it leaves by the cosine law, so the point is on that face.
        let on = |k: &usize| {
            let inwards = line.direction[*k] > 0.0;
            let face = if inwards { world.lo } else { world.hi };
            line.origin[*k] == face[*k]
        };
        if let Some(axis) = (0..3).find(on) {
            of_axis[axis] += 1.0;
        }
    }
    let n = LINES as f64;
    let share = world.face_areas() / world.face_areas().element_sum();
    let fair = (0..3).all(|k| {
        let expected = n * share[k];
        (of_axis[k] - expected).abs() <= 5.0 * (expected * (1.0 - share[k])).sqrt() + 1.0
    });
    let told = |unsound: u32, fair: bool| {
        let faces = if fair { "by area" } else { "not by area" };
        format!("{unsound} of {LINES} lines unsound, faces {faces}")
    };
    Finding::of(told(0, true), told(unsound, fair))
}

/// Every choice of four numbers next to 0, next to 1, or where one face ends and the next begins.
fn extreme_numbers() -> Finding {
    let least = 0.5 / (1_u64 << 52) as f64;
    let numbers = [
        least,
        0.5 - least,
        0.5 + least,
        1.0 - least,
        1.0 / 6.0,
        1.0 / 3.0,
    ];
    let worlds = [
        UNIT,
        Aabb::new(DVec3::ZERO, DVec3::new(1.0, 2.0, 0.0)),
        Aabb::new(DVec3::ZERO, DVec3::new(1e6, 1.0, 1.0)),
        Aabb::new(DVec3::splat(-1e8), DVec3::splat(1.0 - 1e8)),
    ];
    let count = numbers.len();
    let (mut lines, mut unsound) = (0, 0);
    for world in &worlds {
        for choice in 0..count.pow(4) {
            let u = [0, 1, 2, 3].map(|k| numbers[choice / count.pow(k) % count]);
            lines += 1;
            unsound += u32::from(!is_sound(&surface_line(world, u), world));
        }
    }
    let told = |unsound: u32| format!("{unsound} of {lines} lines unsound");
    Finding::of(told(0), told(unsound))
}
