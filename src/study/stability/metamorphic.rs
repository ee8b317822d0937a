//! Metamorphic checks: a tree and its lines are scaled, reflected or given other axes together, and every count must stay.
//!
//! Powers of two, changes of sign and permutations of axes round nothing, so each node must be hit by the same lines. Scaled and
//! reflected, nearest hits must be the same objects at the same t (times the scale), to the bit. With axes permuted too, those of triangles;
//! in the tests of other objects sums of three products are then taken in another order, and t may differ by rounding.

use glam::DVec3;

use crate::geom::{Aabb, Axis, Cone, Line, Objects, Polygon, Ray, Span, Sphere, Triangle};
use crate::kd::{Counting, Counts, Hit, Node, NodeKind, Stack, Tree, nearest, traverse};
use crate::rays::SurfaceLines;
use crate::scene::Scene;
use crate::study::AXES;
use crate::study::records::MetamorphicRecord;

/// A map of space that rounds nothing.
#[derive(Clone, Copy, Debug)]
pub struct Transform {
    /// Power of two that lengths are multiplied by.
    exponent: i32,
    /// Which axes are turned round.
    reflected: [bool; 3],
    /// The axis that becomes x, y and z.
    axes: [Axis; 3],
}

const NONE: Transform = Transform {
    exponent: 0,
    reflected: [false; 3],
    axes: [0, 1, 2],
};

const fn scale(exponent: i32) -> Transform {
    Transform { exponent, ..NONE }
}

const fn reflect(reflected: [bool; 3]) -> Transform {
    Transform { reflected, ..NONE }
}

const fn permute(axes: [Axis; 3]) -> Transform {
    Transform { axes, ..NONE }
}

/// The transforms that are tried.
pub const TRANSFORMS: [Transform; 14] = [
    scale(-100),
    scale(-30),
    scale(10),
    scale(40),
    scale(100),
    reflect([true, false, false]),
    reflect([false, true, false]),
    reflect([false, false, true]),
    reflect([true; 3]),
    permute([1, 2, 0]),
    permute([2, 0, 1]),
    permute([0, 2, 1]),
    permute([1, 0, 2]),
    permute([2, 1, 0]),
];

impl Transform {
    /// The name in files.
    pub fn name(&self) -> String {
        if self.exponent != 0 {
            return format!("scale 2^{}", self.exponent);
        }
        let turned: String = (0..3)
            .filter(|&k| self.reflected[k])
            .map(|k| AXES[k])
            .collect();
        if turned.is_empty() {
            format!("axes {}", self.axes.map(|k| AXES[k]).concat())
        } else {
            format!("reflect {turned}")
        }
    }

    fn scale(&self) -> f64 {
        libm::ldexp(1.0, self.exponent)
    }

    /// A direction: not scaled, so that t is.
    fn direction(&self, d: DVec3) -> DVec3 {
        let turned = |k: Axis| if self.reflected[k] { -d[k] } else { d[k] };
        DVec3::from_array(self.axes.map(turned))
    }

    fn point(&self, p: DVec3) -> DVec3 {
        self.scale() * self.direction(p)
    }

    fn bounds(&self, b: &Aabb) -> Aabb {
        Aabb::around([self.point(b.lo), self.point(b.hi)])
    }

    fn line(&self, line: &Line) -> Line {
        Line::new(self.point(line.origin), self.direction(line.direction))
    }

    /// The tree, and the new number of each of its nodes: below a plane that is turned round, the children trade places.
    fn tree(&self, tree: &Tree) -> (Tree, Vec<u32>) {
        let mut number: Vec<u32> = (0..tree.nodes.len() as u32).collect();
        let mut moved = tree.clone();
        for (i, node) in tree.nodes.iter().enumerate() {
            let new = number[i] as usize;
            moved.boxes[new] = self.bounds(&tree.boxes[i]);
            moved.nodes[new] = *node;
            if let NodeKind::Inner { axis, split, left } = node.kind() {
                let mut plane = DVec3::ZERO;
                plane[axis] = split;
                let to = self.axes.iter().position(|&k| k == axis).unwrap_or(axis);
                moved.nodes[new] = Node::inner(to, self.point(plane)[to], left);
                if self.reflected[axis] {
                    number.swap(left as usize, left as usize + 1);
                }
            }
        }
        moved.world = self.bounds(&tree.world);
        (moved, number)
    }

    fn objects(&self, objects: &Objects) -> Option<Objects> {
        let s = self.scale();
        let polygon =
            |p: &Polygon| Polygon::new(p.corners().iter().map(|&c| self.point(c)).collect());
        Some(Objects {
            triangles: objects
                .triangles
                .iter()
                .map(|t| Triangle(t.0.map(|p| self.point(p))))
                .collect(),
            spheres: objects
                .spheres
                .iter()
                .map(|sphere| Sphere {
                    centre: self.point(sphere.centre),
                    radius: s * sphere.radius,
                })
                .collect(),
            cones: objects
                .cones
                .iter()
                .map(|cone| Cone {
                    base: self.point(cone.base),
                    base_radius: s * cone.base_radius,
                    apex: self.point(cone.apex),
                    apex_radius: s * cone.apex_radius,
                })
                .collect(),
            polygons: objects
                .polygons
                .iter()
                .map(polygon)
                .collect::<Result<_, _>>()
                .ok()?,
        })
    }

    /// Whether sums of three products keep their order.
    fn keeps_order(&self) -> bool {
        self.axes == [0, 1, 2]
    }

    /// Whether a hit is the same, seen after the transform.
    fn is_same(&self, before: Option<Hit>, after: Option<Hit>, triangles: u32) -> bool {
        let (Some(before), Some(after)) = (before, after) else {
            return before.is_none() == after.is_none();
        };
        let t = self.scale() * before.t;
        if before.object == after.object && t == after.t {
            return true;
        }
        // Of objects whose t may differ by rounding either may be the nearer one.
        let rounded = before.object.max(after.object) >= triangles && !self.keeps_order();
        rounded && (t - after.t).abs() <= ROUNDING * t.abs().max(after.t.abs())
    }
}

/// By how much t may differ where sums are taken in another order: a line that grazes a sphere has half the digits.
const ROUNDING: f64 = 1e-7;

/// Every transform of a tree and the first of its lines.
pub fn check(
    scene: &Scene,
    tree: &Tree,
    strategy: &str,
    seed: u64,
    lines: u64,
) -> Vec<MetamorphicRecord> {
    let drawn = SurfaceLines {
        world: scene.world,
        seed,
    };
    let drawn: Vec<Line> = drawn.range(0..lines).collect();
    let hits = count(tree, drawn.iter().copied());
    let found = nearest_hits(tree, &scene.objects, drawn.iter().copied());
    let mut rows = Vec::new();
    for transform in &TRANSFORMS {
        let (moved, number) = transform.tree(tree);
        let moved_lines = || drawn.iter().map(|line| transform.line(line));
        let moved_hits = count(&moved, moved_lines());
        let differs = |i: &usize| hits[*i] != moved_hits[number[*i] as usize];
        let differing_nodes = (0..hits.len()).filter(differs).count() as u64;
        let row = |rays: &str, differing_nodes, differing_hits| MetamorphicRecord {
            scene: scene.name.clone(),
            strategy: strategy.into(),
            transform: transform.name(),
            rays: rays.into(),
            lines,
            nodes: hits.len() as u64,
            differing_nodes,
            differing_hits,
        };
        rows.push(row("lines", differing_nodes, 0));
        if let Some(objects) = transform.objects(&scene.objects) {
            let triangles = objects.triangles.len() as u32;
            let after = nearest_hits(&moved, &objects, moved_lines());
            let differs = |pair: &(&Option<Hit>, &Option<Hit>)| {
                !transform.is_same(*pair.0, *pair.1, triangles)
            };
            let differing = found.iter().zip(&after).filter(differs).count();
            rows.push(row("lines:nearest", 0, differing as u64));
        }
    }
    rows
}

/// Hits of every node.
fn count(tree: &Tree, lines: impl Iterator<Item = Line>) -> Vec<u64> {
    let (mut counts, mut stack) = (Counts::new(tree), Stack::default());
    for line in lines {
        traverse::<Counting, _, _>(tree, &line, Span::FULL, &mut stack, &mut counts, |_, _| {
            f64::INFINITY
        });
    }
    counts.hits
}

fn nearest_hits(
    tree: &Tree,
    objects: &Objects,
    lines: impl Iterator<Item = Line>,
) -> Vec<Option<Hit>> {
    let mut stack = Stack::default();
    let hit = |line| nearest(tree, objects, &Ray::new(line, Span::FULL), &mut stack);
    lines.map(hit).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cost::CostModel;
    use crate::kd::audit::audit;
    use crate::kd::{Rules, Strategy, build_objects};

    fn planted(name: &str) -> (Scene, Tree) {
        let scene = Scene::load(name).unwrap();
        let rules = Rules {
            strategy: Strategy::Sah,
            stop: "objects:2:16".parse().unwrap(),
            cost: CostModel::WALD_HAVRAN,
            clipped: false,
        };
        let tree = build_objects(&scene.objects, &scene.bounds, scene.world, &rules);
        (scene, tree)
    }

    /// The transformed tree is a tree of the transformed objects.
    #[test]
    fn a_transformed_tree_is_a_tree() {
        let (scene, tree) = planted("simple:soup:40");
        for transform in &TRANSFORMS {
            let (moved, _) = transform.tree(&tree);
            let objects = transform.objects(&scene.objects).unwrap();
            audit(&moved, &objects.bounds()).unwrap();
        }
    }

    #[test]
    fn counts_stay_and_a_moved_plane_does_not() {
        for name in ["simple:soup:40", "simple:mixture:60"] {
            let (scene, tree) = planted(name);
            let rows = check(&scene, &tree, "sah", 1, 256);
            assert_eq!(rows.len(), 2 * TRANSFORMS.len());
            for row in &rows {
                assert_eq!((row.differing_nodes, row.differing_hits), (0, 0), "{row:?}");
            }
        }
        // A map that rounds: hits must differ.
        let (scene, tree) = planted("simple:soup:40");
        let wrong = Transform {
            exponent: 0,
            reflected: [true, false, false],
            axes: [0, 1, 2],
        };
        let drawn = SurfaceLines {
            world: scene.world,
            seed: 1,
        };
        let lines: Vec<Line> = drawn.range(0..256).collect();
        let (moved, _) = wrong.tree(&tree);
        let before = count(&tree, lines.iter().copied());
        let unmapped = count(&moved, lines.iter().map(|line| wrong.line(line)));
        assert_ne!(before, unmapped);
    }
}
