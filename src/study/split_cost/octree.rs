//! Strategy 1 as an octree: the same cells, other inner nodes on the way to them.

use crate::cost::CostModel;
use crate::kd::octree::Octree;
use crate::kd::traverse::traverse_line;
use crate::kd::{Rules, Stack, StopRule, Strategy, Work, predict};
use crate::rays::SurfaceLines;
use crate::scene::Scene;
use crate::study::hits::cell::plant;
use crate::study::identity::{content, line_seed};
use crate::study::records::OctreeRecord;

use super::asked::OctreeOf;

/// Build both over a scene and count lines through them; `None` where the scene is flat and has no octree.
///
/// # Errors
/// If their leaves or what lines visit of them differ: a bug in the program.
pub fn compare(
    scene: &Scene,
    asked: OctreeOf,
    cost: CostModel,
    seed: u64,
) -> Result<Option<OctreeRecord>, String> {
    if scene.world.extent().min_element() <= 0.0 {
        return Ok(None);
    }
    let OctreeOf {
        limit,
        levels,
        lines,
    } = asked;
    let rules = Rules {
        strategy: Strategy::SpatialMedian,
        stop: StopRule::Octree {
            limit,
            depth: 3 * levels,
        },
        cost,
        clipped: false,
    };
    let (tree, _) = plant(scene, &rules)?;
    let octree = Octree::build(&scene.bounds, scene.world, limit, levels);
    let leaves = octree.leaves().count();
    if tree.leaves() != leaves {
        return Err(format!(
            "the kd-tree has {} leaves, the octree {leaves}",
            tree.leaves()
        ));
    }
    let stream = SurfaceLines {
        world: scene.world,
        seed: line_seed(seed, &content(scene)),
    };
    let mut stack = Stack::default();
    let (mut kd, mut oct, mut visited) = (Squares::default(), Squares::default(), 0);
    for (i, line) in stream.range(0..lines).enumerate() {
        let (mut of_kd, mut of_octree) = (Work::default(), Work::default());
        traverse_line(
            &tree,
            &line,
            crate::geom::Span::FULL,
            &mut stack,
            &mut of_kd,
        );
        octree.visit(&line, &mut of_octree);
        if (of_kd.leaves, of_kd.tests) != (of_octree.leaves, of_octree.tests) {
            return Err(format!(
                "line {i} does {of_kd:?} in the kd-tree, {of_octree:?} in the octree"
            ));
        }
        kd.add(of_kd.inner);
        oct.add(of_octree.inner);
        visited += of_kd.leaves;
    }
    Ok(Some(OctreeRecord {
        scene: scene.name.clone(),
        stop: rules.stop.to_string(),
        objects: scene.bounds.len() as u64,
        leaves: leaves as u64,
        kd_inner_nodes: tree.inner_nodes() as u64,
        octree_inner_nodes: octree.inner_nodes() as u64,
        lines,
        n_b_counted: visited as f64 / lines as f64,
        kd_n_k_predicted: predict(&tree).n_k,
        kd_n_k_counted: kd.mean(lines),
        kd_n_k_se: kd.error(lines),
        octree_n_k_predicted: octree.predicted_inner(),
        octree_n_k_counted: oct.mean(lines),
        octree_n_k_se: oct.error(lines),
    }))
}

/// Sums over lines.
#[derive(Default)]
struct Squares {
    sum: u64,
    squares: u64,
}

impl Squares {
    fn add(&mut self, visits: u64) {
        self.sum += visits;
        self.squares += visits * visits;
    }

    fn mean(&self, lines: u64) -> f64 {
        self.sum as f64 / lines as f64
    }

    /// Standard error of the mean.
    fn error(&self, lines: u64) -> f64 {
        let n = lines as f64;
        let mean = self.mean(lines);
        let variance = (self.squares as f64 / n - mean * mean).max(0.0) * n / (n - 1.0);
        (variance / n).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_of_a_mean() {
        let mut sums = Squares::default();
        for visits in [1, 2, 3, 6] {
            sums.add(visits);
        }
        // Variance (4 + 1 + 0 + 9)/3 of a mean of 3.
        assert_eq!(sums.mean(4), 3.0);
        assert!((sums.error(4) - (14.0_f64 / 12.0).sqrt()).abs() < 1e-12);
    }

    #[test]
    fn a_scene_has_both() {
        let scene = Scene::load("simple:soup:200").expect("a scene");
        let asked = OctreeOf {
            limit: 4,
            levels: 3,
            lines: 500,
        };
        let row = compare(&scene, asked, CostModel::WALD_HAVRAN, 1);
        let row = row.expect("no bug").expect("not flat");
        assert_eq!(row.kd_inner_nodes, 7 * row.octree_inner_nodes);
        assert_eq!(row.leaves, 1 + row.kd_inner_nodes);
        assert!(row.octree_n_k_counted < row.kd_n_k_counted);
        let off = (row.octree_n_k_counted - row.octree_n_k_predicted).abs();
        assert!(off < 5.0 * row.octree_n_k_se, "{row:?}");
    }
}
