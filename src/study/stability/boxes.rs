//! Hard cases of boxes: lines in faces and edges, through corners, beside them; flat, huge and tiny boxes.

use std::sync::Arc;

use glam::DVec3;

use crate::geom::{Aabb, Line};
use crate::study::kernel::Kernel;

use super::case::{Case, Check, Finding, Group};
use super::judge::{BoxTest, Judged, line_and_box, meets, refused};
use super::table::{meet, rows, vector};

/// A whole line against a box, and whether they meet by hand, of `f64` numbers.
struct BoxCase {
    name: &'static str,
    stresses: &'static str,
    origin: DVec3,
    direction: DVec3,
    b: Aabb,
    hit: bool,
}

/// The cases of `tables/boxes.txt`.
fn table() -> impl Iterator<Item = BoxCase> {
    let rows = rows(include_str!("tables/boxes.txt"));
    rows.map(|[name, hit, origin, direction, lo, hi, stresses]| BoxCase {
        name,
        stresses,
        origin: vector(origin),
        direction: vector(direction),
        b: Aabb::new(vector(lo), vector(hi)),
        hit: meet(hit),
    })
}

impl BoxCase {
    fn line(&self) -> Line {
        Line::new(self.origin, self.direction)
    }

    /// `f64` must be right; padded `f32` must miss nothing where the numbers are in its range.
    fn demanded(&self, kernel: Kernel) -> bool {
        let points = [self.origin, self.b.lo, self.b.hi];
        let most = f64::from(f32::MAX);
        match kernel {
            Kernel::F64 => true,
            Kernel::F32 => false,
            Kernel::F32Padded => points.iter().all(|p| p.abs().max_element() <= most),
        }
    }

    fn check(&self, kernel: Kernel, test: BoxTest) -> Finding {
        match line_and_box(kernel, &self.line(), &self.b, test) {
            Ok(judged) => judged.finding(kernel, self.demanded(kernel)),
            Err(refusal) => refused(Judged::word(self.hit), &refusal, self.demanded(kernel)),
        }
    }
}

/// The cases of this group.
pub fn cases() -> Vec<Case> {
    let one = |case: BoxCase| Case {
        name: case.name,
        group: Group::Boxes,
        stresses: case.stresses,
        check: Check::Kernels(Arc::new(move |kernel| Some(case.check(kernel, meets)))),
    };
    table().map(one).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::line_box;
    use crate::study::stability::case::Outcome;

    /// By hand and by the oracle: the same.
    #[test]
    fn the_oracle_agrees_with_the_hand() {
        for case in table() {
            let line = case.line();
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
            let failed = table().filter(|case| {
                let finding = case.check(Kernel::F64, test);
                finding.demanded && finding.outcome == Outcome::Failed
            });
            assert!(failed.count() >= least);
        }
    }
}
