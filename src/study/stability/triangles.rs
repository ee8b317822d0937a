//! Hard cases of triangles: corners, edges, planes, triangles without area, needles, extreme scales, closed meshes.

use std::sync::Arc;

use crate::geom::{Line, Triangle};
use crate::study::kernel::Kernel;

use super::case::{Case, Check, Finding, Group};
use super::judge::{Judged, line_and_triangle, refused};
use super::leaks;
use super::table::{meet, rows, vector};

/// A whole line against a triangle, and whether they meet by hand.
struct TriangleCase {
    name: &'static str,
    stresses: &'static str,
    line: Line,
    triangle: Triangle,
    hit: bool,
}

/// The cases of `tables/triangles.txt`.
fn table() -> impl Iterator<Item = TriangleCase> {
    let rows = rows(include_str!("tables/triangles.txt"));
    rows.map(
        |[name, hit, origin, direction, a, b, c, stresses]| TriangleCase {
            name,
            stresses,
            line: Line::new(vector(origin), vector(direction)),
            triangle: Triangle([a, b, c].map(vector)),
            hit: meet(hit),
        },
    )
}

impl TriangleCase {
    fn check(&self, kernel: Kernel) -> Option<Finding> {
        // Padding is for planes: there is one triangle test in single precision.
        if kernel == Kernel::F32Padded {
            return None;
        }
        let demanded = kernel == Kernel::F64;
        Some(
            match line_and_triangle(kernel, &self.line, &self.triangle) {
                Ok(judged) => judged.finding(kernel, demanded),
                Err(refusal) => refused(Judged::word(self.hit), &refusal, demanded),
            },
        )
    }
}

/// The cases of this group.
pub fn cases() -> Vec<Case> {
    let one = |case: TriangleCase| Case {
        name: case.name,
        group: Group::Triangles,
        stresses: case.stresses,
        check: Check::Kernels(Arc::new(move |kernel| case.check(kernel))),
    };
    table().map(one).chain(leaks::cases()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::{Meeting, line_triangle};

    /// By hand and by the oracle: the same.
    #[test]
    fn the_oracle_agrees_with_the_hand() {
        for TriangleCase {
            line,
            triangle,
            name,
            hit,
            ..
        } in table()
        {
            let exact = line_triangle(line.origin, line.direction, &triangle.0).meeting;
            assert_eq!(matches!(exact, Meeting::Hit(_)), hit, "{}", name);
        }
    }
}
