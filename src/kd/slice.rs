//! A plane through a tree: the leaves that it cuts.

use crate::geom::Axis;

use super::{NodeKind, Tree};

/// A leaf where a plane cuts it, on the two other axes in ascending order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SliceCell {
    /// Lower corner.
    pub lo: [f64; 2],
    /// Upper corner.
    pub hi: [f64; 2],
    /// Depth of the leaf (root = 0).
    pub depth: u32,
    /// Objects in the leaf.
    pub objects: u32,
}

/// The two other axes, ascending.
pub fn across(axis: Axis) -> [Axis; 2] {
    [[1, 2], [0, 2], [0, 1]][axis]
}

/// The leaves that the plane at `at` across an axis cuts, lower parts first. A leaf holds its lower face and not its upper
/// one, but for the root's; so the cells tile the slice. Outside the root there are none.
pub fn slice(tree: &Tree, axis: Axis, at: f64) -> Vec<SliceCell> {
    let inside = tree.world.lo[axis] <= at && at <= tree.world.hi[axis];
    let mut stack = if inside { vec![(0, 0)] } else { Vec::new() };
    let mut cells = Vec::new();
    while let Some((node, depth)) = stack.pop() {
        match tree.nodes[node as usize].kind() {
            NodeKind::Leaf { count, .. } => {
                let b = &tree.boxes[node as usize];
                let corner = |p: glam::DVec3| across(axis).map(|k| p[k]);
                cells.push(SliceCell {
                    lo: corner(b.lo),
                    hi: corner(b.hi),
                    depth,
                    objects: count,
                });
            }
            NodeKind::Inner {
                axis: cut,
                split,
                left,
            } => {
                // The lower part on top of the stack.
                if cut != axis || at >= split {
                    stack.push((left + 1, depth + 1));
                }
                if cut != axis || at < split {
                    stack.push((left, depth + 1));
                }
            }
        }
    }
    cells
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cost::CostModel;
    use crate::geom::Aabb;
    use crate::kd::{Rules, StopRule, Strategy, build};

    #[test]
    fn the_cells_tile_the_slice() {
        let rules = Rules {
            strategy: Strategy::SpatialMedian,
            stop: StopRule::Depth(5),
            cost: CostModel::WALD_HAVRAN,
            clipped: false,
        };
        let world = Aabb::new([0.0; 3].into(), [4.0, 2.0, 1.0].into());
        // Planes x, y, z, x, y: four cells along x, four along y, two along z.
        let tree = build(&[world], world, &rules);
        for (axis, cells, area) in [(0, 8, 2.0), (1, 8, 4.0), (2, 16, 8.0)] {
            // On a plane, on both faces and between.
            for share in [0.0, 0.3, 0.5, 1.0] {
                let at = share * world.hi[axis];
                let found = slice(&tree, axis, at);
                assert_eq!(found.len(), cells, "{axis} {at}");
                let covered = found
                    .iter()
                    .map(|c| (c.hi[0] - c.lo[0]) * (c.hi[1] - c.lo[1]));
                assert_eq!(covered.sum::<f64>(), area);
                assert!(found.iter().all(|c| c.objects == 1 && c.depth == 5));
            }
        }
        assert!(slice(&tree, 2, 1.1).is_empty());
    }
}
