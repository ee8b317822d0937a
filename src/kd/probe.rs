//! Probes: what a traversal tells whoever is watching. One loop serves counting, scoring, tracing and timing.

use crate::cost::CostModel;

/// Where a ray goes from an inner node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Turn {
    /// Into the near child alone.
    Near,
    /// Into the far child alone.
    Far,
    /// Into both, the near one first.
    Both,
}

/// Receives the events of a traversal, before the work they count. Every event defaults to nothing.
pub trait Probe {
    /// An inner node is visited.
    #[inline(always)]
    fn inner(&mut self, _node: u32) {}
    /// From the inner node just visited the ray goes on like this.
    #[inline(always)]
    fn turn(&mut self, _node: u32, _turn: Turn) {}
    /// A leaf with this many objects is visited, each of which is tested.
    #[inline(always)]
    fn leaf(&mut self, _node: u32, _objects: u32) {}
    /// This object is tested against a ray; of lines that are only counted, none is.
    #[inline(always)]
    fn test(&mut self, _object: u32) {}
    /// The traversal ended within the last leaf, as an any-hit does: this many of its objects were not tested after all.
    #[inline(always)]
    fn untested(&mut self, _objects: u32) {}
    /// The walk goes on from the leaf just left along a link, or, if it has none, again from the root.
    #[inline(always)]
    fn link(&mut self) {}
    /// The exit of the leaf just left is not certain, as planes tie: the rest is walked with a stack.
    #[inline(always)]
    fn fall_back(&mut self) {}
}

/// Watches nothing: for production and timing.
pub struct NoProbe;

impl Probe for NoProbe {}

/// Visits and tests of one line, or of many together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Inner nodes visited (n_K).
    pub inner: u64,
    /// Leaves visited, empty ones too (n_B).
    pub leaves: u64,
    /// Objects tested, one in several leaves each time (n_t).
    pub tests: u64,
}

impl Work {
    /// Its cost: C if the work is one line's.
    #[inline]
    pub fn cost(&self, model: CostModel) -> f64 {
        model.cost(self.inner as f64, self.leaves as f64, self.tests as f64)
    }
}

impl Probe for Work {
    #[inline(always)]
    fn inner(&mut self, _: u32) {
        self.inner += 1;
    }

    #[inline(always)]
    fn leaf(&mut self, _: u32, objects: u32) {
        self.leaves += 1;
        self.tests += u64::from(objects);
    }

    #[inline(always)]
    fn untested(&mut self, objects: u32) {
        self.tests -= u64::from(objects);
    }
}

impl std::ops::AddAssign for Work {
    fn add_assign(&mut self, other: Self) {
        self.inner += other.inner;
        self.leaves += other.leaves;
        self.tests += other.tests;
    }
}

/// Tells both.
impl<A: Probe, B: Probe> Probe for (A, B) {
    #[inline(always)]
    fn inner(&mut self, node: u32) {
        self.0.inner(node);
        self.1.inner(node);
    }

    #[inline(always)]
    fn turn(&mut self, node: u32, turn: Turn) {
        self.0.turn(node, turn);
        self.1.turn(node, turn);
    }

    #[inline(always)]
    fn leaf(&mut self, node: u32, objects: u32) {
        self.0.leaf(node, objects);
        self.1.leaf(node, objects);
    }

    #[inline(always)]
    fn test(&mut self, object: u32) {
        self.0.test(object);
        self.1.test(object);
    }

    #[inline(always)]
    fn untested(&mut self, objects: u32) {
        self.0.untested(objects);
        self.1.untested(objects);
    }

    #[inline(always)]
    fn link(&mut self) {
        self.0.link();
        self.1.link();
    }

    #[inline(always)]
    fn fall_back(&mut self) {
        self.0.fall_back();
        self.1.fall_back();
    }
}

impl<P: Probe> Probe for &mut P {
    #[inline(always)]
    fn inner(&mut self, node: u32) {
        (**self).inner(node);
    }

    #[inline(always)]
    fn turn(&mut self, node: u32, turn: Turn) {
        (**self).turn(node, turn);
    }

    #[inline(always)]
    fn leaf(&mut self, node: u32, objects: u32) {
        (**self).leaf(node, objects);
    }

    #[inline(always)]
    fn test(&mut self, object: u32) {
        (**self).test(object);
    }

    #[inline(always)]
    fn untested(&mut self, objects: u32) {
        (**self).untested(objects);
    }

    #[inline(always)]
    fn link(&mut self) {
        (**self).link();
    }

    #[inline(always)]
    fn fall_back(&mut self) {
        (**self).fall_back();
    }
}
