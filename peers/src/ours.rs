//! Our own ways, under the same conditions: one `impl Peer` a way, listed in [`ways`].
//!
//! Of every work one way is "ours" (see [`best`]); the others stand beside the peers by their names.

use glam::Vec3;
use sahlab::cost::CostModel;
use sahlab::geom::{Aabb, Line, Objects, Real, Span, Triangle};
use sahlab::kd::hits::Hit;
use sahlab::kd::stream::{Lane, RayStreams};
use sahlab::kd::{self, Ask, NarrowTree, Planes, Rules, Stack, Strategy};

use crate::trial::Work;
use crate::{Mesh, Peer, Ray, Tracer};

/// The plain loop in double precision through a tree that is not clipped, which everybody's hits are held against.
pub const UNCLIPPED: &str = "sahlab-single-f64-unclipped";
const BEST: &str = "sahlab-streams-f32";
/// Counting, and making lines (`own_ways`).
pub const STREAMS: &str = "sahlab-streams-f64";
pub const LINES: &str = "sahlab-lines";

/// All of them. All but one are through trees of clipped triangles.
pub fn ways() -> Vec<Box<dyn Peer>> {
    let way = |name, clipped, single, narrow| -> Box<dyn Peer> {
        Box::new(Way {
            name,
            clipped,
            single,
            narrow,
        })
    };
    vec![
        way(BEST, true, false, true),
        way(STREAMS, true, false, false),
        way("sahlab-single-f32", true, true, true),
        way("sahlab-single-f64", true, true, false),
        way(UNCLIPPED, false, true, false),
    ]
}

/// The way that is "ours" for a work: of building the tree that nearest and any hits are asked of.
pub fn best(work: Work) -> &'static str {
    match work {
        Work::Build | Work::Nearest | Work::Any => BEST,
        Work::Count => STREAMS,
        Work::Lines => LINES,
    }
}

/// Through a tree by the surface area heuristic that stops where no cut gains.
struct Way {
    name: &'static str,
    /// Whether splits are clipped.
    clipped: bool,
    /// One ray after the other, or all rays at once.
    single: bool,
    /// In single precision.
    narrow: bool,
}

impl Peer for Way {
    fn name(&self) -> &str {
        self.name
    }

    fn build<'a>(&'a self, mesh: &'a Mesh) -> Box<dyn Tracer + 'a> {
        let objects = Objects {
            triangles: mesh
                .triangles()
                .map(|t| Triangle(t.map(Vec3::as_dvec3)))
                .collect(),
            ..Objects::default()
        };
        let bounds = objects.bounds();
        let world = bounds.iter().copied().fold(Aabb::EMPTY, Aabb::union);
        let rules = Rules {
            strategy: Strategy::Sah,
            stop: kd::StopRule::CostGain { depth: None },
            cost: CostModel::WALD_HAVRAN,
            clipped: self.clipped,
        };
        let tree = kd::build_objects(&objects, &bounds, world, &rules);
        if self.narrow {
            let (tree, _) = NarrowTree::of(&tree).expect("a tree that single precision can hold");
            let triangles: Vec<Triangle<Vec3>> = mesh.triangles().map(Triangle).collect();
            asked(self.single, tree, triangles, |v| v)
        } else {
            asked(self.single, tree, objects.triangles, Vec3::as_dvec3)
        }
    }

    fn most_triangles(&self) -> usize {
        // Of ways that share a tree one is enough to time its building.
        if self.single == self.narrow {
            0
        } else {
            usize::MAX
        }
    }
}

fn asked<'a, T, F>(
    single: bool,
    tree: T,
    triangles: Vec<Triangle<T::Vector>>,
    point: F,
) -> Box<dyn Tracer + 'a>
where
    T: Planes<Vector: Lane> + 'a,
    F: Fn(Vec3) -> T::Vector + 'a,
{
    let built = Built {
        tree,
        triangles,
        point,
    };
    if single {
        Box::new(Single {
            built,
            stack: Stack::default(),
        })
    } else {
        Box::new(Streams {
            built,
            streams: RayStreams::default(),
            rays: Vec::new(),
            hits: Vec::new(),
        })
    }
}

/// A tree and its triangles, in either precision.
struct Built<T: Planes, F> {
    tree: T,
    triangles: Vec<Triangle<T::Vector>>,
    /// A point in that precision.
    point: F,
}

type OurRay<V> = sahlab::geom::Ray<V>;

impl<T: Planes, F: Fn(Vec3) -> T::Vector> Built<T, F> {
    fn ray(&self, ray: &Ray) -> OurRay<T::Vector> {
        let [origin, direction] = [ray.origin, ray.direction].map(|v| (self.point)(v.into()));
        OurRay::new(Line::new(origin, direction), Span::from(T::Real::ZERO))
    }
}

/// One ray after the other.
struct Single<T: Planes, F> {
    built: Built<T, F>,
    stack: Stack<T::Real>,
}

impl<T: Planes, F: Fn(Vec3) -> T::Vector> Tracer for Single<T, F> {
    fn nearest(&mut self, rays: &[Ray], hits: &mut [f32]) {
        let Built {
            tree, triangles, ..
        } = &self.built;
        for (r, hit) in rays.iter().zip(hits) {
            let found = kd::nearest(tree, &triangles[..], &self.built.ray(r), &mut self.stack);
            *hit = found.map_or(f32::INFINITY, |h| h.t.to_f64() as f32);
        }
    }

    fn any(&mut self, rays: &[Ray], hits: &mut [bool]) {
        let Built {
            tree, triangles, ..
        } = &self.built;
        for (r, hit) in rays.iter().zip(hits) {
            *hit = kd::occluded(tree, &triangles[..], &self.built.ray(r), &mut self.stack);
        }
    }
}

/// All rays at once.
struct Streams<T: Planes<Vector: Lane>, F> {
    built: Built<T, F>,
    streams: RayStreams<T::Vector>,
    rays: Vec<OurRay<T::Vector>>,
    hits: Vec<Option<Hit<T::Real>>>,
}

impl<T: Planes<Vector: Lane>, F: Fn(Vec3) -> T::Vector> Streams<T, F> {
    fn ask(&mut self, rays: &[Ray], ask: Ask) -> impl Iterator<Item = Option<Hit<T::Real>>> {
        self.rays.clear();
        self.rays.extend(rays.iter().map(|r| self.built.ray(r)));
        let Built {
            tree, triangles, ..
        } = &self.built;
        self.streams
            .trace(tree, &triangles[..], &self.rays, ask, &mut self.hits);
        self.hits.iter().copied()
    }
}

impl<T: Planes<Vector: Lane>, F: Fn(Vec3) -> T::Vector> Tracer for Streams<T, F> {
    fn nearest(&mut self, rays: &[Ray], hits: &mut [f32]) {
        for (found, hit) in self.ask(rays, Ask::Nearest).zip(hits) {
            *hit = found.map_or(f32::INFINITY, |h| h.t.to_f64() as f32);
        }
    }

    fn any(&mut self, rays: &[Ray], hits: &mut [bool]) {
        for (found, hit) in self.ask(rays, Ask::Any).zip(hits) {
            *hit = found.is_some();
        }
    }

    fn takes_all(&self) -> bool {
        true
    }
}
