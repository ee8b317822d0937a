//! An independent tracer: Embree, in single precision, by way of the Python packages `embreex` and `numpy`. Skipped where
//! they are not installed; `SAHLAB_PYTHON` names the interpreter.

use std::fmt;
use std::fs;
use std::process::Command;

use glam::DVec3;
use sahlab::geom::{Cast, Line, Objects, Span, Triangle};
use sahlab::rays::SurfaceLines;
use sahlab::scene::Scene;
use tempfile::tempdir;

use crate::common::target;
use crate::{as_npy, numbers, traced};

/// Reads `v.npy` (nine numbers a triangle) and `r.npy`, writes the triangle hit (-1: none) and t as `e.csv`.
const SCRIPT: &str = "
import numpy as np
from embreex.mesh_construction import TriangleMesh
from embreex.rtcore_scene import EmbreeScene
v = np.load('v.npy').reshape(-1, 3, 3).astype(np.float32)
r = np.load('r.npy')
scene = EmbreeScene()
mesh = TriangleMesh(scene, v)
o, d = (np.ascontiguousarray(r[:, i:i + 3], dtype=np.float32) for i in (0, 3))
out = scene.run(o, d, output=True)
np.savetxt('e.csv', np.column_stack([out['primID'], out['tfar']]), fmt=['%d', '%.9g'], delimiter=',')
";

/// Of t, in units of the box's diagonal: single precision has 6e-8, and rays that graze a triangle lose some of it.
const TOLERANCE: f64 = 1e-4;

/// Likewise, how near to an edge of a triangle a ray passes where its hit may be doubtful.
const EDGE: f64 = 1e-6;

#[test]
fn embree_hits_the_same() {
    let python = std::env::var("SAHLAB_PYTHON").unwrap_or_else(|_| "python3".into());
    let has = Command::new(&python)
        .args(["-c", "import embreex, numpy"])
        .output();
    if !has.is_ok_and(|output| output.status.success()) {
        println!(
            "skipped: {python} has not the packages embreex and numpy (pip install embreex numpy)"
        );
        return;
    }
    for name in ["simple:soup:2000", "spd:teapot:4"] {
        let triangles = Scene::load(name).unwrap().objects.triangles;
        assert!(triangles.len() > 500, "{name}: {}", triangles.len());
        let objects = Objects {
            triangles,
            ..Objects::default()
        };
        let scene = Scene::new("m.obj", objects, Vec::new()).unwrap();
        let free = compare(&python, &scene, &isotropic(&scene));
        println!("{name}, isotropic rays: {free}");
        // Only rays that pass an edge nearer than single precision tells may differ.
        assert!(free.hits > RAYS / 4 && free.alone + free.apart + free.ties <= RAYS / 1000);
        let aimed = compare(&python, &scene, &aimed(&scene));
        println!("{name}, rays at corners and edges: {aimed}");
        assert!(aimed.hits > RAYS / 4);
        // Whatever differs, a hit that one tracer has and the other has not lies next to an edge.
        assert_eq!([free.unexplained, aimed.unexplained], [0; 2]);
    }
}

/// Rays of each kind and scene.
const RAYS: usize = 20_000;

/// How two tracers agree.
#[derive(Default)]
struct Agreement {
    /// Rays for which both have a hit.
    hits: usize,
    /// Of these, with the same t at another triangle.
    ties: usize,
    /// Of these, with another t.
    apart: usize,
    /// Rays for which one alone has a hit.
    alone: usize,
    /// Of all that differ, those whose ray passes further than [`EDGE`] from the edges of the nearer triangle hit.
    unexplained: usize,
    /// Largest difference between t that are the same, as a share of the box's diagonal.
    furthest: f64,
}

impl fmt::Display for Agreement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            hits,
            ties,
            apart,
            alone,
            unexplained,
            furthest,
        } = self;
        write!(
            f,
            "of {RAYS} both hit {hits}, {ties} of these at another triangle of the same t, {apart} at another t; {alone} hit by \
             one alone; {unexplained} of these away from edges; t agrees within {furthest:.1e} of the box's diagonal"
        )
    }
}

/// Distance of a ray's line from the nearest edge of a triangle: seen along the ray, where precision is best.
fn edge_distance(triangle: &Triangle, cast: &Cast) -> f64 {
    let [a, b, c] = triangle.0;
    let across = |v: DVec3| v.reject_from_normalized(cast.direction);
    let edges = [(a, b), (b, c), (c, a)].map(|(from, to)| {
        let (from, along) = (across(from - cast.origin), across(to - from));
        let share = -from.dot(along) / along.length_squared();
        (from + share.clamp(0.0, 1.0) * along).length()
    });
    edges.into_iter().fold(f64::INFINITY, f64::min)
}

fn compare(python: &str, scene: &Scene, casts: &[Cast]) -> Agreement {
    let folder = tempdir().unwrap();
    let here = folder.path();
    let triangles = &scene.objects.triangles;
    fs::write(here.join("m.obj"), as_obj(triangles)).unwrap();
    fs::write(
        here.join("r.npy"),
        as_npy(7, casts.iter().flat_map(numbers)),
    )
    .unwrap();
    let corners = triangles.iter().flat_map(|t| t.0);
    let corners = corners.flat_map(|corner| corner.to_array());
    fs::write(here.join("v.npy"), as_npy(9, corners)).unwrap();
    let mut embree = Command::new(python);
    let ran = embree
        .args(["-c", SCRIPT])
        .current_dir(here)
        .output()
        .unwrap();
    assert!(
        ran.status.success(),
        "{}",
        String::from_utf8_lossy(&ran.stderr)
    );
    let theirs = fs::read_to_string(here.join("e.csv")).unwrap();
    let (ours, _) = traced(here, "m.obj", "r.npy", &[]);
    assert_eq!((theirs.lines().count(), ours.len()), (RAYS, RAYS));

    let size = scene.world.extent().length();
    let mut agreement = Agreement::default();
    for ((row, line), cast) in ours.iter().zip(theirs.lines()).zip(casts) {
        let (object, t) = line.split_once(',').unwrap();
        let (object, t): (i64, f64) = (object.parse().unwrap(), t.parse().unwrap());
        let own = row.object.zip(row.t);
        let other = (object >= 0).then_some((object as u32, t));
        let nearer = match (own, other) {
            (None, None) => continue,
            (Some(own), Some(other)) => {
                agreement.hits += 1;
                let off = (own.1 - other.1).abs() / size;
                if off <= TOLERANCE {
                    agreement.furthest = agreement.furthest.max(off);
                    agreement.ties += usize::from(own.0 != other.0);
                    continue;
                }
                agreement.apart += 1;
                if own.1 < other.1 { own } else { other }
            }
            (Some(hit), None) | (None, Some(hit)) => {
                agreement.alone += 1;
                hit
            }
        };
        let from_edge = edge_distance(&triangles[nearer.0 as usize], cast) / size;
        agreement.unexplained += usize::from(from_edge > EDGE);
    }
    agreement
}

/// A mesh that reads back to the bit.
fn as_obj(triangles: &[Triangle]) -> String {
    let mut text = String::new();
    for (i, triangle) in triangles.iter().enumerate() {
        for c in triangle.0 {
            text += &format!("v {:?} {:?} {:?}\n", c.x, c.y, c.z);
        }
        text += &format!("f {} {} {}\n", 3 * i + 1, 3 * i + 2, 3 * i + 3);
    }
    text
}

fn cast(origin: DVec3, direction: DVec3) -> Cast {
    let span = Span::from(0.0);
    Cast {
        origin,
        direction,
        span,
    }
}

fn lines(scene: &Scene) -> impl Iterator<Item = Line> {
    let world = scene.world;
    SurfaceLines { world, seed: 21 }.range(0..RAYS as u64)
}

/// Rays from the box, most of them towards its middle.
fn isotropic(scene: &Scene) -> Vec<Cast> {
    let centre = scene.world.centre();
    let towards = |line: Line| {
        let direction = line.direction + 0.5 * (centre - line.origin).normalize();
        cast(line.origin, direction.normalize())
    };
    lines(scene).map(towards).collect()
}

/// Rays from the box to corners of triangles and the middles of edges.
fn aimed(scene: &Scene) -> Vec<Cast> {
    let at = |(i, line): (usize, Line)| {
        let direction = target(&scene.objects, i) - line.origin;
        let flat = direction.length() < 1e-3 * scene.world.extent().length();
        cast(
            line.origin,
            if flat {
                line.direction
            } else {
                direction.normalize()
            },
        )
    };
    lines(scene).enumerate().map(at).collect()
}
