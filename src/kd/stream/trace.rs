//! Ray streams: what many rays hit, found together; the same hits, visits and tests as of one ray after the other.
//!
//! Lists go down as they do in counting, widened as in tracing. All rays of an octant meet the near child before the far
//! one, so a far list waits until the near subtree is done; then those go on that have found nothing before it begins.

use crate::geom::{Aabb, Ray, Real, Span, Targets};
use crate::kd::traverse::{Planes, Stack};
use crate::kd::{Ask, Hit, NodeKind, Work};

use super::lanes::{Lane, Lanes};
use super::lists::{Cut, Lists, room};
use super::order::Order;

/// Rays that go down together, so that the lists' memory is bounded: by 20 bytes of each in f64, 12 in f32, a level of the tree.
const TOGETHER: usize = 1 << 20;

/// The arenas of one thread, kept from one set of rays to the next.
pub struct RayStreams<V: Lane> {
    /// Origin and reciprocal direction of the octant's rays, by axis.
    lines: [Vec<[V::Real; 2]>; 3],
    /// The octant's rays, in order.
    rays: Vec<Ray<V>>,
    /// Up to which t further nodes matter to them.
    limits: Vec<V::Real>,
    /// What they have found.
    found: Vec<Option<Hit<V::Real>>>,
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

/// What rays are held against, and what they ask.
struct Question<'a, T: Planes, O: ?Sized> {
    tree: &'a T,
    objects: &'a O,
    ask: Ask,
}

impl<V: Lane> RayStreams<V> {
    /// With these instructions; hits are the same with all of them.
    pub fn with(lanes: Lanes) -> Self {
        Self {
            lines: Default::default(),
            rays: Vec::new(),
            limits: Vec::new(),
            found: Vec::new(),
            lists: Lists::new(lanes),
            lanes,
            stack: Stack::default(),
            work: Work::default(),
        }
    }

    /// Trace rays of finite lines; puts into `hits` what each hits, as [`Ask::trace`] does, and gives what they did together. The more rays
    /// the faster, up to a million.
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
        let question = Question { tree, objects, ask };
        for (rays, hits) in rays.chunks(TOGETHER).zip(hits.chunks_mut(TOGETHER)) {
            self.together(&question, rays, hits);
        }
        self.work
    }

    /// Trace so many rays.
    fn together<T: Planes<Vector = V, Real = V::Real>, O: Targets<Vector = V> + ?Sized>(
        &mut self,
        question: &Question<T, O>,
        rays: &[Ray<V>],
        hits: &mut [Option<Hit<V::Real>>],
    ) {
        let &Question { tree, objects, ask } = question;
        let world = tree.world();
        let mut order = Order::new(world);
        for (number, (ray, hit)) in rays.iter().zip(&mut *hits).enumerate() {
            // A ray parallel to a coordinate plane has no near child there: those few are traced one by one.
            if ray.line.is_axis_parallel() {
                *hit = ask.trace(tree, objects, ray, &mut self.stack, &mut self.work);
            } else if let Some(span) = world.clip_conservative(&ray.line, ray.span) {
                order.add(number, &ray.line, span);
            }
        }
        for (octant, numbers) in order.octants() {
            // In a loop of its own, so that many of these rays are on their way from memory at a time.
            self.rays.clear();
            self.rays.extend(numbers.clone().map(|number| rays[number]));
            self.start(world);
            self.descend(question, (0, octant), 0, self.rays.len());
            for (number, found) in numbers.zip(&self.found) {
                hits[number] = *found;
            }
        }
    }

    /// Make the octant's rays, which all meet the world, the list of the root.
    fn start(&mut self, world: &Aabb<V>) {
        self.lines.iter_mut().for_each(Vec::clear);
        self.lists.clear();
        for (number, ray) in self.rays.iter().enumerate() {
            for (k, lines) in self.lines.iter_mut().enumerate() {
                lines.push([ray.line.origin[k], ray.line.inverse[k]]);
            }
            let span = world.clip_conservative(&ray.line, ray.span);
            let Span { t0, t1 } = span.expect("those that miss the world are not in the order");
            self.lists.push(t0, t1, number as u32);
        }
        let n = self.rays.len();
        self.limits.clear();
        self.limits.resize(n, V::Real::INFINITY);
        self.found.clear();
        self.found.resize(n, None);
    }

    fn descend<T: Planes<Vector = V, Real = V::Real>, O: Targets<Vector = V> + ?Sized>(
        &mut self,
        question: &Question<T, O>,
        (node, octant): (u32, usize),
        start: usize,
        n: usize,
    ) {
        if n == 0 {
            return;
        }
        match question.tree.node(node) {
            NodeKind::Leaf { first, count } => {
                self.work.leaves += n as u64;
                self.work.tests += n as u64 * u64::from(count);
                let in_leaf = question.tree.objects(first, count);
                if count > 0 {
                    self.test(question, in_leaf, start, n);
                }
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
                // The near list lies behind the far one: it goes first, then its place is free.
                self.descend(question, (near, octant), start + room(n), near_n);
                let far_n = self.lists.retain(&self.limits, start, far_n);
                self.descend(question, (far, octant), start, far_n);
            }
        }
    }

    /// Test the objects of a leaf against the rays of its list.
    #[inline]
    fn test<T: Planes<Vector = V>, O: Targets<Vector = V> + ?Sized>(
        &mut self,
        question: &Question<T, O>,
        in_leaf: &[u32],
        start: usize,
        n: usize,
    ) {
        let &Question { objects, ask, .. } = question;
        let list = self.lists.lines(start, n);
        let (rays, limits, found) = (&self.rays, &mut self.limits, &mut self.found);
        let tests = &mut self.work.tests;
        if ask == Ask::Any {
            // Those that have ended test nothing; they are here if their spans begin at -infinity.
            let ended = |&&number: &&u32| limits[number as usize] == V::Real::NEG_INFINITY;
            *tests -= (list.iter().filter(ended).count() * in_leaf.len()) as u64;
        }
        let mut test = |i: usize, place: usize| {
            let number = list[i] as usize;
            let limit = &mut limits[number];
            // An any-hit ends with the first object that is hit.
            if *limit == V::Real::NEG_INFINITY {
                return;
            }
            let object = in_leaf[place];
            let Some(t) = objects.intersect(object, &rays[number]) else {
                return;
            };
            let best = Hit::nearer(found[number], object, t);
            found[number] = best;
            match (ask, best) {
                (Ask::Nearest, Some(best)) => *limit = best.t,
                (Ask::Any, _) => {
                    *limit = V::Real::NEG_INFINITY;
                    *tests -= (in_leaf.len() - 1 - place) as u64;
                }
                _ => {}
            }
        };
        if in_leaf.iter().all(|&o| objects.triangle(o).is_some()) {
            let places = in_leaf.iter().enumerate();
            let triangles = places.filter_map(|(place, &o)| Some((place, objects.triangle(o)?)));
            V::sieve(self.lanes, rays, list, triangles, test);
        } else {
            for i in 0..n {
                for place in 0..in_leaf.len() {
                    test(i, place);
                }
            }
        }
    }
}
