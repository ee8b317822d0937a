//! Metamorphic checks: a tree and its lines are scaled, reflected or given other axes together, and every count must stay.
//!
//! Powers of two, changes of sign and permutations of axes round nothing, so each node must be hit by the same lines. Scaled and
//! reflected, nearest hits must be the same objects at the same t (times the scale), to the bit, found by the same n_K, n_B and
//! n_t. With axes permuted too, those of triangles; in the tests of other objects sums of three products are then taken in
//! another order, and t may differ by rounding.

mod transform;

use crate::geom::{Line, Objects, Ray, Span};
use crate::kd::traverse::traverse_line;
use crate::kd::{Ask, Counts, Hit, Stack, Tree, Work};
use crate::rays::SurfaceLines;
use crate::scene::Scene;
use crate::study::records::MetamorphicRecord;

pub use transform::TRANSFORMS;
use transform::Transform;

/// The search for a line's nearest hit.
#[derive(Clone, Copy)]
struct Search {
    hit: Option<Hit>,
    work: Work,
}

/// By how much t may differ where sums are taken in another order: a line that grazes a sphere has half the digits.
const ROUNDING: f64 = 1e-7;

/// Whether a search is the same, seen after the transform.
fn is_same(transform: &Transform, before: Search, after: Search, triangles: u32) -> bool {
    let (hit, moved) = match (before.hit, after.hit) {
        (Some(hit), Some(moved)) => (hit, moved),
        (None, None) => return before.work == after.work,
        _ => return false,
    };
    let t = transform.scale() * hit.t;
    if hit.object == moved.object && t == moved.t {
        return before.work == after.work;
    }
    // Of objects whose t may differ by rounding either may be the nearer one, and end the search a leaf earlier.
    let rounded = hit.object.max(moved.object) >= triangles && !transform.keeps_order();
    rounded && (t - moved.t).abs() <= ROUNDING * t.abs().max(moved.t.abs())
}

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
    let before = Untouched::new(scene, tree, drawn.range(0..lines).collect());
    let rows = TRANSFORMS
        .iter()
        .flat_map(|transform| before.against(transform, strategy));
    rows.collect()
}

/// A tree and its lines before any transform.
struct Untouched<'a> {
    scene: &'a Scene,
    tree: &'a Tree,
    lines: Vec<Line>,
    /// Of every node.
    hits: Vec<u64>,
    /// Of every line.
    found: Vec<Search>,
}

impl<'a> Untouched<'a> {
    fn new(scene: &'a Scene, tree: &'a Tree, lines: Vec<Line>) -> Self {
        Self {
            scene,
            tree,
            hits: count(tree, lines.iter().copied()),
            found: searches(tree, &scene.objects, lines.iter().copied()),
            lines,
        }
    }

    /// What differs after a transform: of lines, and of their nearest hits.
    fn against(&self, transform: &Transform, strategy: &str) -> Vec<MetamorphicRecord> {
        let (moved, number) = transform.tree(self.tree);
        let moved_lines = || self.lines.iter().map(|line| transform.line(line));
        let moved_hits = count(&moved, moved_lines());
        let differs = |i: &usize| self.hits[*i] != moved_hits[number[*i] as usize];
        let differing_nodes = (0..self.hits.len()).filter(differs).count() as u64;
        let row = |rays: &str, differing_nodes, differing_hits| MetamorphicRecord {
            scene: self.scene.name.clone(),
            strategy: strategy.into(),
            transform: transform.name(),
            rays: rays.into(),
            lines: self.lines.len() as u64,
            nodes: self.hits.len() as u64,
            differing_nodes,
            differing_hits,
        };
        let mut rows = vec![row("lines", differing_nodes, 0)];
        if let Some(objects) = transform.objects(&self.scene.objects) {
            let triangles = objects.triangles.len() as u32;
            let after = searches(&moved, &objects, moved_lines());
            let pairs = self.found.iter().zip(&after);
            let differs =
                |pair: &(&Search, &Search)| !is_same(transform, *pair.0, *pair.1, triangles);
            rows.push(row(
                "lines:nearest",
                0,
                pairs.filter(differs).count() as u64,
            ));
        }
        rows
    }
}

/// Hits of every node.
fn count(tree: &Tree, lines: impl Iterator<Item = Line>) -> Vec<u64> {
    let (mut counts, mut stack) = (Counts::new(tree), Stack::default());
    for line in lines {
        traverse_line(tree, &line, Span::FULL, &mut stack, &mut counts);
    }
    counts.hits
}

/// The search of every line.
fn searches(tree: &Tree, objects: &Objects, lines: impl Iterator<Item = Line>) -> Vec<Search> {
    let mut stack = Stack::default();
    let search = |line| {
        let mut work = Work::default();
        let ray = Ray::new(line, Span::FULL);
        let hit = Ask::Nearest.trace(tree, objects, &ray, &mut stack, &mut work);
        Search { hit, work }
    };
    lines.map(search).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cost::CostModel;
    use crate::kd::audit::audit;
    use crate::kd::{Rules, Strategy, build_objects};
    use transform::{NONE, scale};

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
    fn every_count_stays() {
        for name in ["simple:soup:40", "simple:mixture:60"] {
            let (scene, tree) = planted(name);
            let rows = check(&scene, &tree, "sah", 1, 256);
            assert_eq!(rows.len(), 2 * TRANSFORMS.len());
            for row in &rows {
                assert_eq!((row.differing_nodes, row.differing_hits), (0, 0), "{row:?}");
            }
        }
    }

    /// So small that coordinates keep eight bits.
    #[test]
    fn a_map_that_rounds_is_caught() {
        let (scene, tree) = planted("simple:soup:40");
        let lines = SurfaceLines {
            world: scene.world,
            seed: 1,
        };
        let before = Untouched::new(&scene, &tree, lines.range(0..256).collect());
        let rows = before.against(&scale(-1066), "sah");
        assert!(rows[0].differing_nodes > 0, "{rows:?}");
        assert!(rows[1].differing_hits > 0, "{rows:?}");
    }

    /// The same hits by another way are told, too.
    #[test]
    fn other_work_differs() {
        let found = |tests| Search {
            hit: Some(Hit { object: 0, t: 1.0 }),
            work: Work {
                inner: 1,
                leaves: 2,
                tests,
            },
        };
        assert!(is_same(&NONE, found(3), found(3), 1));
        assert!(!is_same(&NONE, found(3), found(4), 1));
    }
}
