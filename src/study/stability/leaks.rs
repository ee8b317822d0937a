//! Hard cases of closed meshes: no ray from inside gets out, not even through an edge or a vertex.

use std::sync::Arc;

use glam::DVec3;

use crate::geom::{Line, Ray, Span, Triangle};
use crate::kd::narrow::{narrow_line, narrow_triangles};
use crate::scene::Scene;
use crate::study::kernel::Kernel;

use super::case::{Case, Check, Finding, Group, Outcome};
use super::judge::refused;

/// The cases of closed meshes, of the group of triangles.
pub fn cases() -> impl Iterator<Item = Case> {
    let towards = [
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
    ];
    towards.into_iter().map(|(name, stresses, to)| Case {
        name,
        group: Group::Triangles,
        stresses,
        check: Check::Kernels(Arc::new(move |kernel| no_leak(kernel, to))),
    })
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
    // The first point of an edge is its first corner.
    let points = match to {
        Towards::Edges => 16,
        Towards::Vertices => 1,
    };
    let targets = triangles.iter().flat_map(|Triangle(corners)| {
        let along = move |k: usize| {
            (0..points).map(move |i| corners[k].lerp(corners[(k + 1) % 3], f64::from(i) / 16.0))
        };
        (0..3).flat_map(along)
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
