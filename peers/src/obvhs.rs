//! `obvhs`: BVHs of two children and of eight compressed ones (CWBVH), with its own triangle test for the CPU.
//!
//! Built as its examples do, by the preset `medium_build`: about the build time of Embree, by its own words.

use std::time::Duration;

use glam::Vec3A;
use obvhs::BvhBuildParams;
use obvhs::bvh2::{Bvh2, builder::build_bvh2_from_tris};
use obvhs::cwbvh::{CwBvh, builder::build_cwbvh_from_tris};
use obvhs::ray::{Ray as ItsRay, RayHit};
use obvhs::rt_triangle::RtTriangle;
use obvhs::triangle::Triangle;

use crate::{Mesh, Peer, Ray, Tracer};

/// The compressed BVH of eight children.
pub struct Wide;

/// The BVH of two children.
pub struct Binary;

struct Built<B> {
    bvh: B,
    /// In the order of the leaves, as its example `cornell_box_cwbvh` has them.
    triangles: Vec<RtTriangle>,
}

fn triangles(mesh: &Mesh) -> Vec<Triangle> {
    let triangle = |t: [glam::Vec3; 3]| {
        let [v0, v1, v2] = t.map(Vec3A::from);
        Triangle { v0, v1, v2 }
    };
    mesh.triangles().map(triangle).collect()
}

fn in_order(triangles: &[Triangle], order: &[u32]) -> Vec<RtTriangle> {
    let number = |&i: &u32| RtTriangle::from(&triangles[i as usize]);
    order.iter().map(number).collect()
}

fn ray(ray: &Ray) -> ItsRay {
    ItsRay::new_inf(ray.origin.into(), ray.direction.into())
}

/// The two kinds have the same methods but no common trait.
macro_rules! peer {
    ($peer:ident, $name:literal, $bvh:ident, $build:ident) => {
        impl Peer for $peer {
            fn name(&self) -> &str {
                $name
            }

            fn build<'a>(&'a self, mesh: &'a Mesh) -> Box<dyn Tracer + 'a> {
                let triangles = triangles(mesh);
                let parameters = BvhBuildParams::medium_build();
                let bvh = $build(&triangles, parameters, &mut Duration::default());
                let triangles = in_order(&triangles, &bvh.primitive_indices);
                Box::new(Built { bvh, triangles })
            }
        }

        impl Tracer for Built<$bvh> {
            fn nearest(&mut self, rays: &[Ray], hits: &mut [f32]) {
                for (r, hit) in rays.iter().zip(hits) {
                    let mut found = RayHit::none();
                    self.bvh
                        .ray_traverse(ray(r), &mut found, |r, i| self.triangles[i].intersect(r));
                    *hit = found.t;
                }
            }

            fn any(&mut self, rays: &[Ray], hits: &mut [bool]) {
                for (r, hit) in rays.iter().zip(hits) {
                    let test = |r: &ItsRay, i: usize| self.triangles[i].intersect(r);
                    *hit = !self.bvh.ray_traverse_miss(ray(r), test);
                }
            }
        }
    };
}

peer!(Wide, "obvhs-cwbvh", CwBvh, build_cwbvh_from_tris);
peer!(Binary, "obvhs-bvh2", Bvh2, build_bvh2_from_tris);
