//! `bvh`: a binary BVH that names the shapes whose boxes a ray meets.
//!
//! Its own triangle test leaves out back faces and has an absolute threshold that loses small triangles: ours of
//! [`moller`](crate::moller) stands in.

use bvh::aabb::{Aabb, Bounded};
use bvh::bounding_hierarchy::BHShape;
use bvh::bvh::Bvh as Tree;
use bvh::ray::Ray as ItsRay;
use nalgebra::{Point3, Vector3};

use crate::moller::Triangle;
use crate::{Mesh, Peer, Ray, Tracer};

/// The serial build.
pub struct Bvh;

struct Shape {
    triangle: Triangle,
    own: Aabb<f32, 3>,
    node: usize,
}

impl Bounded<f32, 3> for Shape {
    fn aabb(&self) -> Aabb<f32, 3> {
        self.own
    }
}

impl BHShape<f32, 3> for Shape {
    fn set_bh_node_index(&mut self, node: usize) {
        self.node = node;
    }

    fn bh_node_index(&self) -> usize {
        self.node
    }
}

impl Peer for Bvh {
    fn name(&self) -> &str {
        "bvh"
    }

    fn build<'a>(&'a self, mesh: &'a Mesh) -> Box<dyn Tracer + 'a> {
        let point = |p: glam::Vec3| Point3::from(p.to_array());
        let shape = |[a, b, c]: [glam::Vec3; 3]| Shape {
            triangle: Triangle::new([a, b, c]),
            own: Aabb::with_bounds(point(a.min(b).min(c)), point(a.max(b).max(c))),
            node: 0,
        };
        let mut shapes: Vec<Shape> = mesh.triangles().map(shape).collect();
        let tree = Tree::build(&mut shapes);
        Box::new(Built { tree, shapes })
    }
}

struct Built {
    tree: Tree<f32, 3>,
    shapes: Vec<Shape>,
}

fn ray(ray: &Ray) -> ItsRay<f32, 3> {
    ItsRay::new(Point3::from(ray.origin), Vector3::from(ray.direction))
}

impl Tracer for Built {
    /// Shapes come in the order in which the ray enters their boxes, so that the first box beyond the best hit ends it.
    fn nearest(&mut self, rays: &[Ray], hits: &mut [f32]) {
        for (r, hit) in rays.iter().zip(hits) {
            let ray = ray(r);
            *hit = f32::INFINITY;
            for shape in self.tree.nearest_traverse_iterator(&ray, &self.shapes) {
                let entry = ray.intersection_slice_for_aabb(&shape.own);
                if entry.is_some_and(|(t, _)| t > *hit) {
                    break;
                }
                *hit = hit.min(shape.triangle.intersect(r));
            }
        }
    }

    fn any(&mut self, rays: &[Ray], hits: &mut [bool]) {
        for (r, hit) in rays.iter().zip(hits) {
            let ray = ray(r);
            let mut shapes = self.tree.traverse_iterator(&ray, &self.shapes);
            *hit = shapes.any(|shape| shape.triangle.intersect(r) < f32::INFINITY);
        }
    }
}
