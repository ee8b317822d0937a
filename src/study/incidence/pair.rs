//! A line and a box or triangle: what a kernel says, and what is right.

use crate::exact::{Meeting, line_box, line_triangle};
use crate::geom::{Aabb, Line, Ray, Triangle};

use super::Exact;

/// Distance from a tie, in units of the last place of the kernel's numbers, below which a wrong verdict is one of rounding.
pub const TIE: f64 = 8.0;

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
    /// What a kernel whose points are `V` says of a line, given in exact numbers, and a closed box.
    pub fn of_box<V: Exact>(said: bool, line: &Line, b: &Aabb) -> Self {
        let exact = line_box(line.origin, line.direction, b);
        Self {
            said,
            exact: exact.hit,
            ulps: exact.ulps * V::UNIT,
        }
    }

    /// What the object test says of a whole line and a triangle. One in its plane, or a triangle without area, is no hit.
    pub fn of_triangle<V: Exact>(ray: &Ray<V>, triangle: &Triangle<V>) -> Self {
        let [origin, direction] = [ray.line.origin, ray.line.direction].map(Exact::exact);
        let exact = line_triangle(origin, direction, &triangle.0.map(Exact::exact));
        Self {
            said: triangle.intersect(ray).is_some(),
            exact: matches!(exact.meeting, Meeting::Hit(_)),
            ulps: exact.ulps * V::UNIT,
        }
    }

    /// Whether it is so near to a tie that rounding may decide.
    pub fn is_tie(&self) -> bool {
        self.ulps < TIE
    }

    /// Whether the kernel is wrong.
    pub fn errs(&self) -> bool {
        self.said != self.exact
    }
}

/// One thing that a line was held against.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    /// Number of the node or triangle.
    pub target: u32,
    /// The verdict.
    pub judged: Judged,
}
