//! One line against one box or triangle: what a kernel says, and what the exact oracle says of the very numbers it was given.

use glam::{DVec3, Vec3};

use crate::geom::{Aabb, Line, Ray, Span, Triangle};
use crate::kd::narrow::{Refusal, narrow_box, narrow_line, narrow_triangle};
use crate::study::incidence::exact_line;
use crate::study::kernel::Kernel;

use super::case::{Finding, Outcome};

pub use crate::study::incidence::Judged;

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
    if kernel == Kernel::F64 {
        return Ok(Judged::of_box::<DVec3>(f64_test(b, line), line, b));
    }
    let line = narrow_line(line)?;
    let b = narrow_box(b)?;
    let span = if kernel == Kernel::F32Padded {
        b.clip_conservative(&line, Span::FULL)
    } else {
        b.clip(&line, Span::FULL)
    };
    let exact = Aabb::new(b.lo.as_dvec3(), b.hi.as_dvec3());
    let said = span.is_some();
    Ok(Judged::of_box::<Vec3>(said, &exact_line(&line), &exact))
}

/// A whole line against a triangle. One in its plane, or a triangle without area, is no hit.
pub fn line_and_triangle(
    kernel: Kernel,
    line: &Line,
    triangle: &Triangle,
) -> Result<Judged, Refusal> {
    Ok(match kernel {
        Kernel::F64 => Judged::of_triangle(&Ray::new(*line, Span::FULL), triangle),
        Kernel::F32 | Kernel::F32Padded => {
            let ray = Ray::new(narrow_line(line)?, Span::FULL);
            Judged::of_triangle(&ray, &narrow_triangle(triangle)?)
        }
    })
}
