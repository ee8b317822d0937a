//! Hard cases of triangles: corners, edges, planes, triangles without area, needles, extreme scales, closed meshes.

use std::sync::Arc;

use glam::DVec3;

use crate::geom::{Line, Ray, Span, Triangle};
use crate::kd::narrow::{narrow_line, narrow_triangles};
use crate::scene::Scene;
use crate::study::kernel::Kernel;

use super::case::{Case, Check, Finding, Group, Outcome};
use super::judge::{Judged, line_and_triangle, refused};

/// A whole line against a triangle, and whether they meet by hand.
struct TriangleCase {
    name: &'static str,
    stresses: &'static str,
    origin: [f64; 3],
    direction: [f64; 3],
    corners: [[f64; 3]; 3],
    hit: bool,
}

/// The triangle (0, 0), (1, 0), (0, 1) in z = 0.
const RIGHT: [[f64; 3]; 3] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
const DOWN: [f64; 3] = [0.0, 0.0, -1.0];
const LEAST: f64 = f64::from_bits(1);
const STEP: f64 = f64::EPSILON;
/// 2^-20.
const MICRO: f64 = f64::from_bits((1023 - 20) << 52);
const HUGE: f64 = f64::from_bits((1023 + 460) << 52);
const TINY: f64 = f64::from_bits((1023 - 300) << 52);

/// 2^-60.
const SLIVER: f64 = f64::from_bits((1023 - 60) << 52);

const CASES: [TriangleCase; 32] = [
    TriangleCase {
        name: "triangle-inside",
        stresses: "through the inside",
        origin: [0.25, 0.25, 3.0],
        direction: DOWN,
        corners: RIGHT,
        hit: true,
    },
    TriangleCase {
        name: "triangle-corner",
        stresses: "through a corner, which belongs to it",
        origin: [0.0, 0.0, 1.0],
        direction: DOWN,
        corners: RIGHT,
        hit: true,
    },
    TriangleCase {
        name: "triangle-leg",
        stresses: "through an edge along an axis",
        origin: [0.5, 0.0, 1.0],
        direction: DOWN,
        corners: RIGHT,
        hit: true,
    },
    TriangleCase {
        name: "triangle-hypotenuse",
        stresses: "through an edge at a slant",
        origin: [0.5, 0.5, 1.0],
        direction: DOWN,
        corners: RIGHT,
        hit: true,
    },
    TriangleCase {
        name: "triangle-edge-oblique",
        stresses: "through an edge along no axis",
        origin: [0.5, -1.0, 1.0],
        direction: [0.0, 1.0, -1.0],
        corners: RIGHT,
        hit: true,
    },
    TriangleCase {
        name: "triangle-beside-leg",
        stresses: "outside an edge by the least number",
        origin: [0.5, -LEAST, 1.0],
        direction: DOWN,
        corners: RIGHT,
        hit: false,
    },
    TriangleCase {
        name: "triangle-beside-hypotenuse",
        stresses: "outside an edge by one step",
        origin: [0.5, 0.5 + STEP, 1.0],
        direction: DOWN,
        corners: RIGHT,
        hit: false,
    },
    TriangleCase {
        name: "triangle-from-behind",
        stresses: "from below: the other winding",
        origin: [0.25, 0.25, -3.0],
        direction: [0.0, 0.0, 1.0],
        corners: RIGHT,
        hit: true,
    },
    TriangleCase {
        name: "triangle-origin-on-it",
        stresses: "t = 0",
        origin: [0.25, 0.25, 0.0],
        direction: [0.5, 0.25, 1.0],
        corners: RIGHT,
        hit: true,
    },
    TriangleCase {
        name: "triangle-in-its-plane",
        stresses: "a line in the plane is no hit",
        origin: [-1.0, 0.25, 0.0],
        direction: [1.0, 0.0, 0.0],
        corners: RIGHT,
        hit: false,
    },
    TriangleCase {
        name: "triangle-in-its-plane-beside",
        stresses: "a line in the plane that passes it",
        origin: [-1.0, 7.0, 0.0],
        direction: [1.0, 0.0, 0.0],
        corners: RIGHT,
        hit: false,
    },
    TriangleCase {
        name: "triangle-parallel-above",
        stresses: "a line above the plane by the least number",
        origin: [-1.0, 0.25, LEAST],
        direction: [1.0, 0.0, 0.0],
        corners: RIGHT,
        hit: false,
    },
    TriangleCase {
        name: "triangle-along-an-edge",
        stresses: "a line along an edge, in the plane",
        origin: [-1.0, 0.0, 0.0],
        direction: [1.0, 0.0, 0.0],
        corners: RIGHT,
        hit: false,
    },
    TriangleCase {
        name: "triangle-equal-direction-parts",
        stresses: "no largest part of the direction",
        origin: [-0.75, -0.75, -1.0],
        direction: [1.0, 1.0, 1.0],
        corners: RIGHT,
        hit: true,
    },
    TriangleCase {
        name: "triangle-grazing",
        stresses: "at 2^-20 to the plane",
        origin: [-0.75, 0.25, MICRO],
        direction: [1.0, 0.0, -MICRO],
        corners: RIGHT,
        hit: true,
    },
    TriangleCase {
        name: "triangle-grazing-edge",
        stresses: "at 2^-20 to the plane, through an edge",
        origin: [-1.0, 0.25, MICRO],
        direction: [1.0, 0.0, -MICRO],
        corners: RIGHT,
        hit: true,
    },
    TriangleCase {
        name: "triangle-grazing-beside",
        stresses: "at 2^-20 to the plane, before an edge",
        origin: [-1.0 - 4.0 * STEP, 0.25, MICRO],
        direction: [1.0, 0.0, -MICRO],
        corners: RIGHT,
        hit: false,
    },
    TriangleCase {
        name: "triangle-tiny-direction",
        stresses: "a direction of 2^-300",
        origin: [0.25, 0.25, 3.0],
        direction: [0.0, 0.0, -TINY],
        corners: RIGHT,
        hit: true,
    },
    TriangleCase {
        name: "triangle-tiny-direction-part",
        stresses: "a direction part of 1e-20 beside an edge",
        origin: [0.5, 0.0, 1.0],
        direction: [0.0, -1e-20, -1.0],
        corners: RIGHT,
        hit: false,
    },
    TriangleCase {
        name: "triangle-point",
        stresses: "three equal corners",
        origin: [0.25, 0.25, 1.0],
        direction: DOWN,
        corners: [[0.25, 0.25, 0.0]; 3],
        hit: false,
    },
    TriangleCase {
        name: "triangle-segment",
        stresses: "three corners on a line",
        origin: [0.5, 0.0, 1.0],
        direction: DOWN,
        corners: [[0.0; 3], [0.25, 0.0, 0.0], [1.0, 0.0, 0.0]],
        hit: false,
    },
    TriangleCase {
        name: "triangle-repeated-corner",
        stresses: "a corner twice",
        origin: [0.5, 0.0, 1.0],
        direction: DOWN,
        corners: [[0.0; 3], [1.0, 0.0, 0.0], [1.0, 0.0, 0.0]],
        hit: false,
    },
    TriangleCase {
        name: "triangle-needle-across",
        stresses: "2^-20 wide, crossed",
        origin: [0.5, 0.25 * MICRO, 1.0],
        direction: DOWN,
        corners: [[0.0; 3], [1.0, 0.0, 0.0], [0.0, MICRO, 0.0]],
        hit: true,
    },
    TriangleCase {
        name: "triangle-needle-beside",
        stresses: "2^-20 wide, passed",
        origin: [0.5, 0.75 * MICRO, 1.0],
        direction: DOWN,
        corners: [[0.0; 3], [1.0, 0.0, 0.0], [0.0, MICRO, 0.0]],
        hit: false,
    },
    TriangleCase {
        name: "triangle-needle-along",
        stresses: "a needle seen nearly from its end",
        origin: [-1.0, 0.25 * MICRO, 1.25 * MICRO],
        direction: [1.0, 0.0, -MICRO],
        corners: [[0.0; 3], [1.0, 0.0, 0.0], [0.0, MICRO, 0.0]],
        hit: true,
    },
    TriangleCase {
        name: "triangle-sliver-aside",
        stresses: "2^-60 wide, on another side of the origin: terms that cancel in the shear",
        origin: [0.0; 3],
        direction: [1.0, 1.0, 1.0],
        corners: [[0.0, 0.0, 1.0], [SLIVER, 0.0, 2.0], [0.0, SLIVER, 3.0]],
        hit: false,
    },
    TriangleCase {
        name: "triangle-sliver-aside-thirds",
        stresses: "the same with a direction that rounds: whatever the shear leaves of the sliver is noise",
        origin: [0.0; 3],
        direction: [1.0, 0.7, 0.3],
        corners: [[0.1, 0.1, 1.0], [0.2 + SLIVER, 0.2, 2.0], [0.3, 0.3, 3.0]],
        hit: false,
    },
    TriangleCase {
        name: "triangle-far-1e6",
        stresses: "a million away",
        origin: [1e6 + 0.25, 1e6 + 0.25, 1e6 + 3.0],
        direction: DOWN,
        corners: [[1e6; 3], [1e6 + 1.0, 1e6, 1e6], [1e6, 1e6 + 1.0, 1e6]],
        hit: true,
    },
    TriangleCase {
        name: "triangle-far-1e8-edge",
        stresses: "a hundred million away, through an edge",
        origin: [1e8 + 0.5, 1e8 + 0.5, 1e8 + 3.0],
        direction: DOWN,
        corners: [[1e8; 3], [1e8 + 1.0, 1e8, 1e8], [1e8, 1e8 + 1.0, 1e8]],
        hit: true,
    },
    TriangleCase {
        name: "triangle-far-origin",
        stresses: "the origin 2^40 away",
        origin: [0.25, 0.25, 1_099_511_627_776.0],
        direction: DOWN,
        corners: RIGHT,
        hit: true,
    },
    TriangleCase {
        name: "triangle-scale-2^460",
        stresses: "products near the largest number",
        origin: [0.25 * HUGE, 0.25 * HUGE, HUGE],
        direction: DOWN,
        corners: [[0.0; 3], [HUGE, 0.0, 0.0], [0.0, HUGE, 0.0]],
        hit: true,
    },
    TriangleCase {
        name: "triangle-scale-2^-300",
        stresses: "products near the least number",
        origin: [0.25 * TINY, 0.25 * TINY, TINY],
        direction: DOWN,
        corners: [[0.0; 3], [TINY, 0.0, 0.0], [0.0, TINY, 0.0]],
        hit: true,
    },
];

impl TriangleCase {
    fn parts(&self) -> (Line, Triangle) {
        let line = Line::new(self.origin.into(), self.direction.into());
        (line, Triangle(self.corners.map(DVec3::from)))
    }

    fn check(&self, kernel: Kernel) -> Option<Finding> {
        // Padding is for planes: there is one triangle test in single precision.
        if kernel == Kernel::F32Padded {
            return None;
        }
        let (line, triangle) = self.parts();
        let demanded = kernel == Kernel::F64;
        Some(match line_and_triangle(kernel, &line, &triangle) {
            Ok(judged) => judged.finding(kernel, demanded),
            Err(refusal) => refused(Judged::word(self.hit), &refusal, demanded),
        })
    }
}

/// The cases of this group.
pub fn cases() -> Vec<Case> {
    let one = |case: &'static TriangleCase| Case {
        name: case.name,
        group: Group::Triangles,
        stresses: case.stresses,
        check: Check::Kernels(Arc::new(|kernel| case.check(kernel))),
    };
    let mut cases: Vec<Case> = CASES.iter().map(one).collect();
    for (name, stresses, to) in [
        (
            "octahedron-edges",
            "from inside a closed mesh to points of its edges: no leak",
            Towards::Edges,
        ),
        (
            "octahedron-vertices",
            "from inside a closed mesh to its vertices: no leak",
            Towards::Vertices,
        ),
    ] {
        cases.push(Case {
            name,
            group: Group::Triangles,
            stresses,
            check: Check::Kernels(Arc::new(move |kernel| no_leak(kernel, to))),
        });
    }
    cases
}

/// What rays from inside a mesh are aimed at.
#[derive(Clone, Copy)]
enum Towards {
    Edges,
    Vertices,
}

/// Rays from inside a closed mesh meet it, all of them.
fn no_leak(kernel: Kernel, to: Towards) -> Option<Finding> {
    if kernel == Kernel::F32Padded {
        return None;
    }
    let demanded = kernel == Kernel::F64;
    let scene = match Scene::load("hard:octahedron:2") {
        Ok(scene) => scene,
        Err(error) => return Some(Finding::failed("no leak", error)),
    };
    let triangles = &scene.objects.triangles;
    let narrow = match narrow_triangles(&scene.objects) {
        Ok(narrow) => narrow,
        Err(refusal) => return Some(refused("no leak", &refusal, demanded)),
    };
    let origin = DVec3::new(0.05, -0.03, 0.02);
    let targets = triangles.iter().flat_map(|Triangle(corners)| {
        let edge = move |k: usize| {
            let share = |i: u32| f64::from(i) / 16.0;
            (0..16).map(move |i| corners[k].lerp(corners[(k + 1) % 3], share(i)))
        };
        let vertex = move |k: usize| corners[k];
        let edges = (0..3)
            .flat_map(edge)
            .filter(move |_| matches!(to, Towards::Edges));
        edges.chain(
            (0..3)
                .map(vertex)
                .filter(move |_| matches!(to, Towards::Vertices)),
        )
    });
    let (mut rays, mut leaks) = (0, 0);
    for target in targets {
        let line = Line::new(origin, target - origin);
        let met = if kernel == Kernel::F64 {
            let ray = Ray::new(line, Span::from(0.0));
            triangles.iter().any(|t| t.intersect(&ray).is_some())
        } else {
            match narrow_line(&line) {
                Ok(line) => {
                    let ray = Ray::new(line, Span::from(0.0));
                    narrow.iter().any(|t| t.intersect(&ray).is_some())
                }
                Err(refusal) => return Some(refused("no leak", &refusal, demanded)),
            }
        };
        rays += 1;
        leaks += u32::from(!met);
    }
    let told = |leaks: u32| format!("{leaks} of {rays} rays leak");
    Some(Finding {
        expected: told(0),
        measured: told(leaks),
        outcome: match (kernel, leaks) {
            (_, 0) => Outcome::Pass,
            (Kernel::F64, _) => Outcome::Failed,
            _ => Outcome::Off(f64::from(leaks)),
        },
        demanded,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exact::{Meeting, line_triangle};

    /// By hand and by the oracle: the same.
    #[test]
    fn the_oracle_agrees_with_the_hand() {
        for case in &CASES {
            let (line, triangle) = case.parts();
            let exact = line_triangle(line.origin, line.direction, &triangle.0).meeting;
            assert_eq!(matches!(exact, Meeting::Hit(_)), case.hit, "{}", case.name);
        }
    }
}
