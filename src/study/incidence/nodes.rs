//! The nodes that a kernel visits on a line, against those whose boxes the line meets.

use crate::geom::{Line, Real, Span};
use crate::kd::{Mode, NodeKind, Planes, Probe, Stack, traverse};

use super::{Exact, Judged, Pair, Subject, exact_line};

/// The nodes that a kernel visits on a line; kept from line to line, to spare allocations.
#[derive(Default)]
pub struct Visits<R> {
    stack: Stack<R>,
    nodes: Nodes,
}

#[derive(Default)]
struct Nodes(Vec<u32>);

impl Probe for Nodes {
    #[inline(always)]
    fn inner(&mut self, node: u32) {
        self.0.push(node);
    }

    #[inline(always)]
    fn leaf(&mut self, node: u32, _: u32) {
        self.0.push(node);
    }
}

impl<R: Real> Visits<R> {
    /// The nodes that a kernel visits on the whole line, in the order of their numbers.
    pub fn follow<M: Mode, T: Planes<Real = R>>(
        &mut self,
        tree: &T,
        line: &Line<T::Vector>,
    ) -> &[u32] {
        let Self { stack, nodes } = self;
        nodes.0.clear();
        traverse::<M, T, _>(tree, line, Span::FULL, stack, nodes, |_, _| R::INFINITY);
        nodes.0.sort_unstable();
        &nodes.0
    }
}

/// Judge every node whose parent the kernel visits or the line meets, so that misses are seen too. `visited` as of
/// [`Visits::follow`].
pub fn nodes<T: Planes<Vector: Exact>>(
    subject: &Subject<'_, T>,
    line: &Line<T::Vector>,
    visited: &[u32],
) -> Vec<Pair> {
    let line = exact_line(line);
    let mut pairs = Vec::new();
    let mut open = vec![0];
    while let Some(target) = open.pop() {
        let said = visited.binary_search(&target).is_ok();
        let b = &subject.boxes[target as usize];
        let judged = Judged::of_box::<T::Vector>(said, &line, b);
        pairs.push(Pair { target, judged });
        if let NodeKind::Inner { left, .. } = subject.tree.node(target)
            && (judged.said || judged.exact)
        {
            open.extend([left, left + 1]);
        }
    }
    pairs
}
