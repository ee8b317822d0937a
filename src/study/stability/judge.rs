//! One line against one box or triangle: what a kernel says, and what the exact oracle says of the very numbers it was given.

use glam::Vec3;

use crate::exact::{Meeting, line_box, line_triangle};
use crate::geom::{Aabb, Line, Ray, Span, Triangle, Vector};
use crate::kd::narrow::{Refusal, narrow_line};
use crate::study::kernel::Kernel;

use super::case::{Finding, Outcome};

/// Distance from a tie, in units of the kernel's last place, below which a wrong verdict is one of rounding.
pub const TIE: f64 = 8.0;

/// A unit of the last place of a kernel's numbers, in units of that of `f64`.
pub fn last_place(kernel: Kernel) -> f64 {
    match kernel {
        Kernel::F64 => 1.0,
        Kernel::F32 | Kernel::F32Padded => f64::from(f32::EPSILON) / f64::EPSILON,
    }
}

/// What a kernel says of a pair, and what is right.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Judged {
    /// Whether the kernel says they meet.
    pub said: bool,
    /// Whether they do.
    pub exact: bool,
    /// Distance from a tie in units of the last place of the kernel's numbers.
    pub ulps: f64,
}

impl Judged {
    /// The same words for what is expected and what is measured.
    pub fn word(hit: bool) -> &'static str {
        if hit { "hit" } else { "miss" }
    }

    /// What it means. `f64` must be right in ties too, as the numbers are such that it rounds nothing that matters; padded `f32`
    /// must miss nothing; what else is wrong is told. Whether that is demanded the case says beforehand.
    pub fn finding(self, kernel: Kernel, demanded: bool) -> Finding {
        let Self { said, exact, ulps } = self;
        let outcome = match kernel {
            _ if said == exact => Outcome::Pass,
            Kernel::F64 => Outcome::Failed,
            Kernel::F32Padded if exact => Outcome::Failed,
            Kernel::F32 | Kernel::F32Padded => Outcome::Off(ulps),
        };
        Finding {
            expected: Self::word(exact).into(),
            measured: Self::word(said).into(),
            outcome,
            demanded,
        }
    }
}

/// The finding where a kernel refuses its input.
pub fn refused(expected: impl ToString, refusal: &Refusal, demanded: bool) -> Finding {
    Finding {
        expected: expected.to_string(),
        measured: refusal.to_string(),
        outcome: Outcome::Refused,
        demanded,
    }
}

/// A box test that stands for the one of `f64`: the unit tests put a broken one in its place.
pub type BoxTest = fn(&Aabb, &Line) -> bool;

/// The box test of `f64`.
pub fn meets(b: &Aabb, line: &Line) -> bool {
    b.clip(line, Span::FULL).is_some()
}

/// A whole line against a closed box.
pub fn line_and_box(
    kernel: Kernel,
    line: &Line,
    b: &Aabb,
    f64_test: BoxTest,
) -> Result<Judged, Refusal> {
    let (said, exact) = match kernel {
        Kernel::F64 => (f64_test(b, line), line_box(line.origin, line.direction, b)),
        Kernel::F32 | Kernel::F32Padded => {
            let line = narrow_line(line)?;
            let b = Aabb {
                lo: b.lo.as_vec3(),
                hi: b.hi.as_vec3(),
            };
            let span = if kernel == Kernel::F32 {
                b.clip(&line, Span::FULL)
            } else {
                b.clip_conservative(&line, Span::FULL)
            };
            let wide = Aabb::new(b.lo.as_dvec3(), b.hi.as_dvec3());
            let [o, d] = [line.origin, line.direction].map(Vec3::as_dvec3);
            (span.is_some(), line_box(o, d, &wide))
        }
    };
    Ok(Judged {
        said,
        exact: exact.hit,
        ulps: exact.ulps / last_place(kernel),
    })
}

/// A whole line against a triangle. One in its plane, or a triangle without area, is no hit.
pub fn line_and_triangle(
    kernel: Kernel,
    line: &Line,
    triangle: &Triangle,
) -> Result<Judged, Refusal> {
    fn said<V: Vector>(line: &Line<V>, triangle: &Triangle<V>) -> bool {
        triangle.intersect(&Ray::new(*line, Span::FULL)).is_some()
    }
    let (said, exact) = match kernel {
        Kernel::F64 => (
            said(line, triangle),
            line_triangle(line.origin, line.direction, &triangle.0),
        ),
        Kernel::F32 | Kernel::F32Padded => {
            let line = narrow_line(line)?;
            let narrow = Triangle(triangle.0.map(|p| p.as_vec3()));
            let [o, d] = [line.origin, line.direction].map(Vec3::as_dvec3);
            (
                said(&line, &narrow),
                line_triangle(o, d, &narrow.0.map(Vec3::as_dvec3)),
            )
        }
    };
    Ok(Judged {
        said,
        exact: matches!(exact.meeting, Meeting::Hit(_)),
        ulps: exact.ulps / last_place(kernel),
    })
}
