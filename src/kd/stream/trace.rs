//! Ray streams: what many rays hit, found together; the same hits, visits and tests as of one ray after the other.
//!
//! Lists go down as they do in counting, widened as in tracing. All rays of an octant meet the near child before the far
//! one, so a far list waits until the near subtree is done; then those go on that have found nothing before it begins.

use crate::geom::{Aabb, Frame, Ray, Real, Span, Targets};
use crate::kd::traverse::{Planes, Stack};
use crate::kd::{Ask, Hit, NodeKind, Work};

use super::lanes::{Lane, Lanes};
use super::lists::{Cut, Lists, room};
use super::order::Order;

/// The arenas of one thread, kept from one set of rays to the next.
pub struct RayStreams<V: Lane> {
    /// Origin and reciprocal direction of the octant's rays, by axis.
    lines: [Vec<[V::Real; 2]>; 3],
    /// The octant's rays, and their numbers in the set.
    rays: Vec<(Ray<V>, u32)>,
    /// Their frames.
    frames: Vec<Frame<V::Real>>,
    /// Up to which t further nodes matter to them.
    limits: Vec<V::Real>,
    /// What they have found.
    found: Vec<Option<Hit<V::Real>>>,
    order: Order,
    lists: Lists<V>,
    lanes: Lanes,
    stack: Stack<V::Real>,
    work: Work,
}

impl<V: Lane> Default for RayStreams<V> {
    fn default() -> Self {
        Self::with(Lanes::widest())
    }
}

impl<V: Lane> RayStreams<V> {
    /// With these instructions; hits are the same with all of them.
    pub fn with(lanes: Lanes) -> Self {
        Self {
            lines: Default::default(),
            rays: Vec::new(),
            limits: Vec::new(),
            found: Vec::new(),
            order: Order::default(),
            lists: Lists::new(lanes),
            lanes,
            frames: Vec::new(),
            stack: Stack::default(),
            work: Work::default(),
        }
    }

    /// Trace rays; gives what each hits, as [`Ask::trace`] does, and what they did together.
    pub fn trace<T: Planes<Vector = V, Real = V::Real>>(
        &mut self,
        tree: &T,
        objects: &(impl Targets<Vector = V> + ?Sized),
        rays: &[Ray<V>],
        ask: Ask,
        hits: &mut Vec<Option<Hit<V::Real>>>,
    ) -> Work {
        self.work = Work::default();
        hits.clear();
        hits.resize(rays.len(), None);
        let world = tree.world();
        let mut order = std::mem::take(&mut self.order);
        order.clear();
        for (number, (ray, hit)) in rays.iter().zip(&mut *hits).enumerate() {
            // A ray parallel to a coordinate plane has no near child there: those few are traced one by one.
            if ray.line.is_axis_parallel() {
                *hit = ask.trace(tree, objects, ray, &mut self.stack, &mut self.work);
            } else if let Some(span) = world.clip_conservative(&ray.line, ray.span) {
                order.add(number, &ray.line, world, span);
            }
        }
        for (octant, numbers) in order.octants() {
            self.fill(world, rays, numbers);
            let n = self.rays.len();
            self.descend(tree, objects, ask, (0, octant), 0, n);
            for ((_, number), found) in self.rays.iter().zip(&self.found) {
                hits[*number as usize] = *found;
            }
        }
        self.order = order;
        self.work
    }

    /// Make these rays, of one octant, the list of the root.
    fn fill(&mut self, world: &Aabb<V>, rays: &[Ray<V>], numbers: impl Iterator<Item = usize>) {
        self.lines.iter_mut().for_each(Vec::clear);
        self.rays.clear();
        self.frames.clear();
        self.lists.clear();
        for number in numbers {
            let ray = &rays[number];
            // Those that miss the world are not in the order.
            let Some(Span { t0, t1 }) = world.clip_conservative(&ray.line, ray.span) else {
                continue;
            };
            self.lists.push(t0, t1, self.rays.len() as u32);
            for (k, lines) in self.lines.iter_mut().enumerate() {
                lines.push([ray.line.origin[k], ray.line.inverse[k]]);
            }
            self.rays.push((*ray, number as u32));
            self.frames.push(ray.frame);
        }
        let n = self.rays.len();
        self.limits.clear();
        self.limits.resize(n, V::Real::INFINITY);
        self.found.clear();
        self.found.resize(n, None);
    }

    fn descend<T: Planes<Vector = V, Real = V::Real>>(
        &mut self,
        tree: &T,
        objects: &(impl Targets<Vector = V> + ?Sized),
        ask: Ask,
        (node, octant): (u32, usize),
        start: usize,
        n: usize,
    ) {
        if n == 0 {
            return;
        }
        match tree.node(node) {
            NodeKind::Leaf { first, count } => {
                self.work.leaves += n as u64;
                self.work.tests += n as u64 * u64::from(count);
                self.test(tree.objects(first, count), objects, ask, start, n);
            }
            NodeKind::Inner { axis, split, left } => {
                self.work.inner += n as u64;
                let cut = Cut {
                    position: split,
                    padding: V::Real::PADDING,
                    lines: &self.lines[axis],
                };
                let (near_n, far_n) = self.lists.divide(&cut, start, n);
                let right_first = (octant >> axis) as u32 & 1;
                let (near, far) = (left + right_first, left + 1 - right_first);
                self.descend(tree, objects, ask, (near, octant), start + room(n), near_n);
                let far_n = self.lists.retain(&self.limits, start, far_n);
                self.descend(tree, objects, ask, (far, octant), start, far_n);
            }
        }
    }

    #[inline]
    fn test(
        &mut self,
        in_leaf: &[u32],
        objects: &(impl Targets<Vector = V> + ?Sized),
        ask: Ask,
        start: usize,
        n: usize,
    ) {
        let numbers = self.lists.lines(start, n);
        let (limits, found) = (&mut self.limits, &mut self.found);
        let (rays, tests) = (&self.rays, &mut self.work.tests);
        let mut test = |i: usize, place: usize| {
            let number = numbers[i] as usize;
            let (limit, best) = (&mut limits[number], &mut found[number]);
            // An any-hit ends with the first object that is hit.
            if *limit == V::Real::NEG_INFINITY {
                return;
            }
            let object = in_leaf[place];
            if let Some(t) = objects.intersect(object, &rays[number].0) {
                *best = Hit::nearer(*best, object, t);
                match (ask, *best) {
                    (Ask::Nearest, Some(best)) => *limit = best.t,
                    (Ask::Any, _) => {
                        *limit = V::Real::NEG_INFINITY;
                        *tests -= (in_leaf.len() - 1 - place) as u64;
                    }
                    _ => {}
                }
            }
        };
        let places = in_leaf.iter().enumerate();
        let triangles = places.filter_map(|(place, &o)| Some((place, objects.triangle(o)?)));
        if in_leaf.iter().all(|&o| objects.triangle(o).is_some()) {
            V::sieve(self.lanes, &self.frames, numbers, triangles, test);
        } else {
            for i in 0..n {
                for place in 0..in_leaf.len() {
                    test(i, place);
                }
            }
        }
    }
}
