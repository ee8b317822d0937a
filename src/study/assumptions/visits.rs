//! What a set of rays does in a tree, node by node and ray by ray.

use rayon::prelude::*;

use crate::cost::CostModel;
use crate::geom::{Cast, Objects};
use crate::kd::{NodeKind, Probe, Stack, Tree, Work};
use crate::study::ray_sets::Rays;
use crate::study::work::{Counted, PIECE};

/// What the rays did. The same whatever the number of threads.
pub struct Visits {
    /// Together.
    pub counted: Counted,
    /// Rays that hit each node.
    pub hits: Vec<u64>,
    /// What each ray cost.
    pub costs: Vec<f64>,
}

/// Counts the nodes that a ray hits.
struct Nodes<'a>(&'a mut [u64]);

impl Probe for Nodes<'_> {
    #[inline(always)]
    fn inner(&mut self, node: u32) {
        self.0[node as usize] += 1;
    }

    #[inline(always)]
    fn leaf(&mut self, node: u32, _: u32) {
        self.0[node as usize] += 1;
    }
}

/// Trace rays through a tree.
///
/// # Errors
/// If the counts contradict each other: a bug in the program.
pub fn count(
    tree: &Tree,
    objects: &Objects,
    rays: &Rays,
    cost: CostModel,
) -> Result<Visits, String> {
    let nothing = || Visits {
        counted: Counted::default(),
        hits: vec![0; tree.nodes.len()],
        costs: Vec::new(),
    };
    let trace = |piece: &[Cast]| {
        let mut sum = nothing();
        let mut stack = Stack::default();
        for cast in piece {
            let mut own = Work::default();
            let probes = (Nodes(&mut sum.hits), &mut own);
            let ask = rays.of.ask();
            let hit = ask.hits(tree, objects, &cast.ray(), &mut stack, probes);
            sum.counted.push(hit, own);
            let [inner, leaves, tests] = [own.inner, own.leaves, own.tests].map(|n| n as f64);
            sum.costs.push(cost.cost(inner, leaves, tests));
        }
        sum
    };
    let pieces: Vec<Visits> = rays.casts.par_chunks(PIECE).map(trace).collect();
    let visits = pieces.into_iter().fold(nothing(), |mut sum, piece| {
        sum.counted.merge(&piece.counted);
        for (mine, theirs) in sum.hits.iter_mut().zip(&piece.hits) {
            *mine += theirs;
        }
        sum.costs.extend(piece.costs);
        sum
    });
    visits.check(tree)?;
    Ok(visits)
}

impl Visits {
    /// Rays that hit the root's box.
    pub fn entered(&self) -> u64 {
        self.hits[0]
    }

    /// The identities that hold however early a ray ends: whoever visits a node goes on into a child of it, and the work
    /// counted by itself is that of the nodes.
    fn check(&self, tree: &Tree) -> Result<(), String> {
        let (mut inner, mut leaves) = (0, 0);
        for (i, node) in tree.nodes.iter().enumerate() {
            let hits = self.hits[i];
            match node.kind() {
                NodeKind::Inner { left, .. } => {
                    let (l, r) = (self.hits[left as usize], self.hits[left as usize + 1]);
                    if l.max(r) > hits || hits > l + r {
                        return Err(format!(
                            "node {i}: {hits} hits, but its children have {l} and {r}"
                        ));
                    }
                    inner += hits;
                }
                NodeKind::Leaf { .. } => leaves += hits,
            }
        }
        let work = self.counted.work;
        if (inner, leaves) != (work.inner, work.leaves) {
            return Err(format!(
                "nodes add up to {inner} inner and {leaves} leaf visits, rays did {work:?}"
            ));
        }
        Ok(())
    }
}
