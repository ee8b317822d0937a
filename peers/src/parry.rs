//! `parry3d`: the BVH of its `TriMesh`, with its own triangle test.

use parry3d::math::Vector;
use parry3d::query::{Ray as ItsRay, RayCast};
use parry3d::shape::TriMesh;

use crate::{Mesh, Peer, Ray, Tracer};

/// A triangle mesh with its BVH.
pub struct Parry;

impl Peer for Parry {
    fn name(&self) -> &str {
        "parry3d"
    }

    fn build<'a>(&'a self, mesh: &'a Mesh) -> Box<dyn Tracer + 'a> {
        let corner = |p: glam::Vec3| Vector::new(p.x, p.y, p.z);
        let corners = mesh.triangles().flatten().map(corner).collect();
        let numbers = (0..mesh.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]);
        let built = TriMesh::new(corners, numbers.collect());
        Box::new(Built(built.expect("a mesh has triangles")))
    }
}

struct Built(TriMesh);

fn ray(ray: &Ray) -> ItsRay {
    ItsRay::new(
        Vector::from_array(ray.origin),
        Vector::from_array(ray.direction),
    )
}

impl Tracer for Built {
    fn nearest(&mut self, rays: &[Ray], hits: &mut [f32]) {
        for (r, hit) in rays.iter().zip(hits) {
            let found = self.0.cast_local_ray(&ray(r), f32::MAX, false);
            *hit = found.unwrap_or(f32::INFINITY);
        }
    }

    /// Its own `intersects_local_ray` looks for the nearest hit; a search that takes every hit for one at 0 ends with the
    /// first.
    fn any(&mut self, rays: &[Ray], hits: &mut [bool]) {
        for (r, hit) in rays.iter().zip(hits) {
            let ray = ray(r);
            let test = |i, _| {
                let found = self.0.triangle(i).cast_local_ray(&ray, f32::MAX, false);
                found.map(|_| 0.0)
            };
            *hit = self.0.bvh().cast_ray(&ray, f32::MAX, test).is_some();
        }
    }
}
