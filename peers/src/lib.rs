//! sahlab beside other ray tracing libraries: one mesh, one set of rays, one way to ask, and the clock.
//!
//! Every contestant gets the same numbers in single precision, builds from the same flat list of corners, and answers
//! the same rays on one thread. `benches/peers.rs` says how to run it.

mod bvh;
mod embree;
mod kdtree_ray;
mod moller;
mod obvhs;
mod ours;
mod own_ways;
mod parry;
pub mod ratio;
mod rays;
pub mod report;
pub mod trial;
mod waiting;

use glam::Vec3;
use sahlab::geom::Aabb;
use sahlab::scene::Scene;

pub use own_ways::OwnWays;
pub use rays::{camera, isotropic};
pub use waiting::Waiting;

/// A ray from t = 0 on that never ends; t counts in units of the direction's length.
#[derive(Clone, Copy, Debug)]
pub struct Ray {
    /// Point at t = 0.
    pub origin: [f32; 3],
    /// Direction, of unit length up to rounding.
    pub direction: [f32; 3],
}

/// Triangles that share no corners, in single precision.
pub struct Mesh {
    /// Nine coordinates a triangle, and one number more: Embree may read 4 bytes past the last.
    corners: Vec<f32>,
    /// The smallest box around them.
    pub world: Aabb,
}

impl Mesh {
    /// The triangles of a scene that has at least one, rounded.
    pub fn new(scene: &Scene) -> Self {
        let points = || scene.objects.triangles.iter().flat_map(|t| t.0);
        let mut corners: Vec<f32> = points().flat_map(|p| p.as_vec3().to_array()).collect();
        let boxes = points().map(|p| p.as_vec3().as_dvec3());
        let world = boxes.fold(Aabb::EMPTY, |b, p| b.union(Aabb::new(p, p)));
        corners.push(0.0);
        Self { corners, world }
    }

    /// Number of triangles.
    pub fn len(&self) -> usize {
        self.corners.len() / 9
    }

    /// Whether there is no triangle.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Every triangle by its corners.
    fn triangles(&self) -> impl Iterator<Item = [Vec3; 3]> {
        let corner = |c: &[f32]| Vec3::new(c[0], c[1], c[2]);
        let nines = self.corners.chunks_exact(9);
        nines.map(move |c| [corner(&c[..3]), corner(&c[3..6]), corner(&c[6..])])
    }
}

/// A library, or one of its ways, that can build something to trace rays through.
pub trait Peer {
    /// The name in files.
    fn name(&self) -> &str;

    /// Build from the flat corners, whatever input of its own that needs. It may keep what it needs of the mesh.
    fn build<'a>(&'a self, mesh: &'a Mesh) -> Box<dyn Tracer + 'a>;

    /// The most triangles it builds in a sensible time.
    fn most_triangles(&self) -> usize {
        usize::MAX
    }
}

/// What has been built. What it makes of a ray before it can trace it is part of tracing.
pub trait Tracer {
    /// t of each ray's nearest hit, infinity without one.
    fn nearest(&mut self, rays: &[Ray], hits: &mut [f32]);

    /// Whether each ray hits anything.
    fn any(&mut self, rays: &[Ray], hits: &mut [bool]);

    /// Whether it gains from many rays at once: it gets the whole set, not a sample of it in chunks.
    fn takes_all(&self) -> bool {
        false
    }
}

/// All contestants in the order of tables: our own ways first, then Embree where it is found, then crates.
///
/// What is missing is told in `notes`.
pub fn contestants(notes: &mut Vec<String>) -> Vec<Box<dyn Peer>> {
    let mut all = ours::ways();
    let embrees = embree::found(notes).into_iter();
    all.extend(embrees.map(|e| Box::new(e) as Box<dyn Peer>));
    all.extend([
        Box::new(obvhs::Wide) as Box<dyn Peer>,
        Box::new(obvhs::Binary),
        Box::new(parry::Parry),
        Box::new(bvh::Bvh),
        Box::new(kdtree_ray::KdTreeRay),
    ]);
    all
}
