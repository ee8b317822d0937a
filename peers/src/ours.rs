//! Our own ways, under the same conditions: one `impl Peer` a way, listed in [`ways`].
//!
//! Of every work one way is "ours" (see [`best`]); the others stand beside the peers by their names.

use glam::Vec3;
use sahlab::cost::CostModel;
use sahlab::geom::{Aabb, Line, Objects, Span, Triangle};
use sahlab::kd::{self, Rules, Stack, Strategy, Tree};

use crate::trial::Work;
use crate::{Mesh, Peer, Ray, Tracer};

const UNCLIPPED: &str = "sahlab-single-f64";
const CLIPPED: &str = "sahlab-single-f64-clipped";
/// Counting, and making lines (`own_ways`).
pub const STREAMS: &str = "sahlab-streams-f64";
pub const LINES: &str = "sahlab-lines";

/// All of them.
pub fn ways() -> Vec<Box<dyn Peer>> {
    [(UNCLIPPED, false), (CLIPPED, true)]
        .map(|(name, clipped)| Box::new(Single { name, clipped }) as Box<dyn Peer>)
        .into()
}

/// The way that is "ours" for a work: the one that a user of sahlab would take for it.
pub fn best(work: Work) -> &'static str {
    match work {
        Work::Build => UNCLIPPED,
        Work::Nearest | Work::Any => CLIPPED,
        Work::Count => STREAMS,
        Work::Lines => LINES,
    }
}

/// Single rays in double precision, through a tree by the surface area heuristic that stops where no cut gains.
struct Single {
    name: &'static str,
    clipped: bool,
}

impl Peer for Single {
    fn name(&self) -> &str {
        self.name
    }

    fn build<'a>(&'a self, mesh: &'a Mesh) -> Box<dyn Tracer + 'a> {
        let triangle = |t: [Vec3; 3]| Triangle(t.map(Vec3::as_dvec3));
        let objects = Objects {
            triangles: mesh.triangles().map(triangle).collect(),
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
        Box::new(Built {
            tree: kd::build_objects(&objects, &bounds, world, &rules),
            objects,
            stack: Stack::default(),
        })
    }
}

struct Built {
    tree: Tree,
    objects: Objects,
    stack: Stack,
}

fn ray(ray: &Ray) -> sahlab::geom::Ray {
    let [origin, direction] = [ray.origin, ray.direction].map(|v| Vec3::from(v).as_dvec3());
    sahlab::geom::Ray::new(Line::new(origin, direction), Span::from(0.0))
}

impl Tracer for Built {
    fn nearest(&mut self, rays: &[Ray], hits: &mut [f32]) {
        for (r, hit) in rays.iter().zip(hits) {
            let found = kd::nearest(&self.tree, &self.objects, &ray(r), &mut self.stack);
            *hit = found.map_or(f32::INFINITY, |h| h.t as f32);
        }
    }

    fn any(&mut self, rays: &[Ray], hits: &mut [bool]) {
        for (r, hit) in rays.iter().zip(hits) {
            *hit = kd::occluded(&self.tree, &self.objects, &ray(r), &mut self.stack);
        }
    }
}
