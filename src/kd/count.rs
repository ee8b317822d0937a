//! Hits per node, and the identities that every count obeys.

use super::{NodeKind, Probe, Tree, Work};

/// How many lines hit each node, and what they did together.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Counts {
    /// Lines counted.
    pub lines: u64,
    /// Lines that hit node i (box closed, touching counts).
    pub hits: Vec<u64>,
    /// Visits and tests of all lines, counted on their own as they happen, not summed from `hits`.
    pub work: Work,
}

impl Counts {
    /// Nothing counted yet.
    pub fn new(tree: &Tree) -> Self {
        Self {
            lines: 0,
            hits: vec![0; tree.nodes.len()],
            work: Work::default(),
        }
    }

    /// Add the counts of other lines on the same tree. Integers: the order does not matter.
    pub fn merge(mut self, other: &Self) -> Self {
        assert_eq!(
            self.hits.len(),
            other.hits.len(),
            "counts of different trees"
        );
        self.lines += other.lines;
        self.work += other.work;
        for (mine, theirs) in self.hits.iter_mut().zip(&other.hits) {
            *mine += theirs;
        }
        self
    }

    /// (line, node) visits in all.
    pub fn visits(&self) -> u64 {
        self.work.inner + self.work.leaves
    }

    /// Check the integer identities; the error names the first that fails.
    ///
    /// Every line hits the root; a line that hits a node hits a child, and none that misses it does, so
    /// max(h_left, h_right) <= h <= h_left + h_right; n_B = N + sum (h_left + h_right - h), as every visit of both
    /// children adds one leaf; and the work counted by itself equals the sums over the nodes.
    pub fn check(&self, tree: &Tree) -> Result<(), String> {
        let hits = &self.hits;
        if hits[0] != self.lines {
            return Err(format!("{} of {} lines hit the root", hits[0], self.lines));
        }
        let mut sums = Work::default();
        let mut both: u64 = 0;
        for (i, node) in tree.nodes.iter().enumerate() {
            match node.kind() {
                NodeKind::Inner { left, .. } => {
                    let (l, r) = (hits[left as usize], hits[left as usize + 1]);
                    if l.max(r) > hits[i] || hits[i] > l + r {
                        return Err(format!(
                            "node {i}: {} hits, but its children have {l} and {r}",
                            hits[i]
                        ));
                    }
                    sums.inner += hits[i];
                    both += l + r - hits[i];
                }
                NodeKind::Leaf { count, .. } => {
                    sums.leaves += hits[i];
                    sums.tests += hits[i] * u64::from(count);
                }
            }
        }
        if sums != self.work {
            return Err(format!(
                "nodes add up to {sums:?}, lines did {:?}",
                self.work
            ));
        }
        if self.work.leaves != self.lines + both {
            let wanted = self.lines + both;
            return Err(format!(
                "{} leaf visits, the children's hits ask for {wanted}",
                self.work.leaves
            ));
        }
        Ok(())
    }
}

/// Counts one line after the other: the plain reference for the streams.
impl Probe for Counts {
    #[inline(always)]
    fn inner(&mut self, node: u32) {
        self.hits[node as usize] += 1;
        self.work.inner(node);
    }

    #[inline(always)]
    fn leaf(&mut self, node: u32, objects: u32) {
        self.hits[node as usize] += 1;
        self.work.leaf(node, objects);
    }
}
