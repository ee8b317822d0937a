//! An octree, to compare with: every cell is halved on all three axes at once.
//!
//! A kd-tree of strategy 1 under the stop rule `octree` has the same leaves and visits the same of them; what differs is
//! the number of inner nodes on the way, as one octree node stands for up to seven kd-nodes.

use crate::geom::{Aabb, Line, Span};

use super::Probe;

/// An octree over objects given by their boxes. Node 0 is the root.
#[derive(Clone, Debug, PartialEq)]
pub struct Octree {
    cells: Vec<Cell>,
    references: Vec<u32>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Cell {
    bounds: Aabb,
    kind: CellKind,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum CellKind {
    /// The children are this cell and the seven after it; bit k of a child's place says that it is the upper one on axis k.
    Inner(u32),
    /// References `first .. first + count`.
    Leaf { first: u32, count: u32 },
}

impl Octree {
    /// Halve cells of more than `limit` objects, at most `levels` times.
    ///
    /// Objects go where the kd-tree puts them: left if lo < s, right if hi > s; one that lies in the plane goes left, as the
    /// halves are equally dear.
    ///
    /// # Panics
    /// If `world` is flat: the halves of a flat side are no cells. If there would be 2^32 cells or references.
    pub fn build(bounds: &[Aabb], world: Aabb, limit: u32, levels: u32) -> Self {
        assert!(
            world.extent().min_element() > 0.0,
            "an octree needs a volume"
        );
        let objects = u32::try_from(bounds.len()).expect("more than 2^32 objects");
        let mut tree = Self {
            cells: vec![Cell {
                bounds: world,
                kind: CellKind::Leaf { first: 0, count: 0 },
            }],
            references: Vec::new(),
        };
        tree.grow(
            0,
            bounds,
            &(0..objects).collect::<Vec<u32>>(),
            limit,
            levels,
        );
        tree
    }

    fn grow(&mut self, cell: usize, bounds: &[Aabb], objects: &[u32], limit: u32, levels: u32) {
        let index = |n: usize| u32::try_from(n).expect("more than 2^32 entries");
        if objects.len() <= limit as usize || levels == 0 {
            let first = index(self.references.len());
            self.references.extend_from_slice(objects);
            index(self.references.len());
            self.cells[cell].kind = CellKind::Leaf {
                first,
                count: objects.len() as u32,
            };
            return;
        }
        // One, two, four, eight parts, each with its objects.
        let mut parts = vec![(self.cells[cell].bounds, objects.to_vec())];
        let middle = self.cells[cell].bounds.centre();
        for axis in 0..3 {
            let s = middle[axis];
            let halves = |(part, held): &(Aabb, Vec<u32>), upper: bool| {
                let goes = |o: &&u32| {
                    let b = &bounds[**o as usize];
                    let right = b.hi[axis] > s;
                    if upper {
                        right
                    } else {
                        b.lo[axis] < s || !right
                    }
                };
                let (below, above) = part.split(axis, s);
                let held: Vec<u32> = held.iter().filter(goes).copied().collect();
                (if upper { above } else { below }, held)
            };
            parts = [false, true]
                .into_iter()
                .flat_map(|upper| parts.iter().map(move |p| (p, upper)))
                .map(|(part, upper)| halves(part, upper))
                .collect();
        }
        let first = self.cells.len();
        index(first + 8);
        self.cells[cell].kind = CellKind::Inner(first as u32);
        self.cells.extend(parts.iter().map(|&(bounds, _)| Cell {
            bounds,
            kind: CellKind::Leaf { first: 0, count: 0 },
        }));
        for (i, (_, held)) in parts.iter().enumerate() {
            self.grow(first + i, bounds, held, limit, levels - 1);
        }
    }

    /// Number of inner nodes.
    pub fn inner_nodes(&self) -> usize {
        self.cells.len() - self.leaves().count()
    }

    /// Every leaf: its number, box and objects.
    pub fn leaves(&self) -> impl Iterator<Item = (u32, Aabb, &[u32])> {
        (0_u32..)
            .zip(&self.cells)
            .filter_map(|(i, c)| match c.kind {
                CellKind::Leaf { first, count } => {
                    let objects = &self.references[first as usize..][..count as usize];
                    Some((i, c.bounds, objects))
                }
                CellKind::Inner(_) => None,
            })
    }

    /// Visit the nodes that a line meets, in no particular order: those whose closed boxes pass the slab test.
    pub fn visit(&self, line: &Line, mut probe: impl Probe) {
        let mut stack = vec![0_u32];
        while let Some(i) = stack.pop() {
            let cell = &self.cells[i as usize];
            if cell.bounds.clip(line, Span::FULL).is_none() {
                continue;
            }
            match cell.kind {
                CellKind::Inner(first) => {
                    probe.inner(i);
                    stack.extend(first..first + 8);
                }
                CellKind::Leaf { count, .. } => probe.leaf(i, count),
            }
        }
    }

    /// Expected visits of inner nodes by a line that hits the world: the sum of their areas over the root's.
    pub fn predicted_inner(&self) -> f64 {
        let inner = |c: &&Cell| matches!(c.kind, CellKind::Inner(_));
        let root = self.cells[0].bounds.surface_area();
        let areas = self
            .cells
            .iter()
            .filter(inner)
            .map(|c| c.bounds.surface_area());
        areas.sum::<f64>() / root
    }
}
