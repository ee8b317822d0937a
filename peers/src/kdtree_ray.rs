//! `kdtree-ray`: a kd-tree by the surface area heuristic after Wald & Havran, as here.
//!
//! It names the triangles of every leaf that a ray meets, without an order and whatever the ray has hit: a nearest hit
//! costs as much as all hits. Triangles are tested by [`moller`](crate::moller).

use cgmath::Vector3;
use kdtree_ray::{AABB, Bounded, KDTree};

use crate::moller::Triangle;
use crate::{Mesh, Peer, Ray, Tracer};

/// The default configuration.
pub struct KdTreeRay;

struct Shape([glam::Vec3; 3]);

impl Bounded for Shape {
    fn bound(&self) -> AABB {
        let [a, b, c] = self.0;
        let point = |p: glam::Vec3| Vector3::new(p.x, p.y, p.z);
        AABB::new(point(a.min(b).min(c)), point(a.max(b).max(c)))
    }
}

impl Peer for KdTreeRay {
    fn name(&self) -> &str {
        "kdtree-ray"
    }

    fn build<'a>(&'a self, mesh: &'a Mesh) -> Box<dyn Tracer + 'a> {
        let shapes: Vec<Shape> = mesh.triangles().map(Shape).collect();
        Box::new(Built {
            tree: KDTree::build(&shapes),
            triangles: mesh.triangles().map(Triangle::new).collect(),
        })
    }

    /// A million take more than a minute.
    fn most_triangles(&self) -> usize {
        200_000
    }
}

struct Built {
    tree: KDTree,
    triangles: Vec<Triangle>,
}

impl Built {
    /// The triangles whose leaves the ray meets.
    fn candidates(&self, ray: &Ray) -> impl Iterator<Item = &Triangle> {
        let found = self
            .tree
            .intersect(&ray.origin.into(), &ray.direction.into());
        found.into_iter().map(|i| &self.triangles[i])
    }
}

impl Tracer for Built {
    fn nearest(&mut self, rays: &[Ray], hits: &mut [f32]) {
        for (ray, hit) in rays.iter().zip(hits) {
            let ts = self.candidates(ray).map(|t| t.intersect(ray));
            *hit = ts.fold(f32::INFINITY, f32::min);
        }
    }

    fn any(&mut self, rays: &[Ray], hits: &mut [bool]) {
        for (ray, hit) in rays.iter().zip(hits) {
            let mut candidates = self.candidates(ray);
            *hit = candidates.any(|t| t.intersect(ray) < f32::INFINITY);
        }
    }
}
