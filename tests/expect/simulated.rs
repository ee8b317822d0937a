//! Rays of every metric's law, counted.

use std::f64::consts::TAU;

use glam::DVec3;
use rayon::prelude::*;
use sahlab::geom::{Aabb, Line, Object, Ray, Span, Sphere, Triangle};
use sahlab::kd::expect::{Expected, Metric};
use sahlab::kd::hits::nearest_watched;
use sahlab::kd::traverse::traverse_line;
use sahlab::kd::{Counting, Stack, Tree, Work, traverse};
use sahlab::rays::{LineLaw, SurfaceLines, Uniforms};
use sahlab::scene::Scene;

/// Rays counted for each comparison: the mean cost of such a sample is known to about 1 %.
pub const RAYS: u64 = 1 << 14;

/// The mean work of `RAYS` rays.
pub fn counted(one: impl Fn(u64, &mut Stack) -> Work + Sync) -> Expected {
    const PIECE: u64 = 1024;
    let pieces: Vec<Work> = (0..RAYS / PIECE)
        .into_par_iter()
        .map(|piece| {
            let mut stack = Stack::default();
            let mut sum = Work::default();
            for i in piece * PIECE..(piece + 1) * PIECE {
                sum += one(i, &mut stack);
            }
            sum
        })
        .collect();
    let mut sum = Work::default();
    pieces.into_iter().for_each(|work| sum += work);
    let mean = |count: u64| count as f64 / RAYS as f64;
    Expected {
        n_k: mean(sum.inner),
        n_b: mean(sum.leaves),
        n_t: mean(sum.tests),
    }
}

/// Isotropic line i.
pub fn line(world: Aabb, i: u64) -> Line {
    let lines = SurfaceLines { world, seed: 1990 };
    lines.range(i..i + 1).next().unwrap()
}

/// The piece of a line that begins at a uniform point of the scene's surfaces; triangles, convex polygons and spheres.
pub struct Starts<'a> {
    scene: &'a Scene,
    /// Areas up to each piece, and the piece: a triangle, or a sphere.
    pieces: Vec<(f64, Result<Triangle, Sphere>)>,
}

impl<'a> Starts<'a> {
    pub fn of(scene: &'a Scene) -> Self {
        let mut pieces = Vec::new();
        let mut sum = 0.0;
        let mut push = |area: f64, piece| {
            sum += area;
            pieces.push((sum, piece));
        };
        for number in 0..scene.objects.len() as u32 {
            match scene.objects.get(number) {
                Object::Triangle(t) => push(t.area(), Ok(*t)),
                Object::Sphere(s) => push(s.area(), Err(*s)),
                Object::Polygon(p) => {
                    let c = p.corners();
                    for i in 1..c.len() - 1 {
                        let t = Triangle([c[0], c[i], c[i + 1]]);
                        push(t.area(), Ok(t));
                    }
                }
                Object::Cone(_) => panic!("no cones here"),
            }
        }
        Self { scene, pieces }
    }

    pub fn ray(&self, i: u64) -> Ray {
        let mut uniforms = Uniforms::starting_at(2009, 64 * i);
        loop {
            let [a, b, c, side] = uniforms.next4();
            let at = a * self.pieces.last().unwrap().0;
            let piece = self.pieces.partition_point(|p| p.0 < at);
            let (point, normal) = match self.pieces[piece].1 {
                Ok(triangle) => {
                    let [p, q, r] = triangle.0;
                    let (b, c) = if b + c > 1.0 {
                        (1.0 - b, 1.0 - c)
                    } else {
                        (b, c)
                    };
                    (p + b * (q - p) + c * (r - p), triangle.normal().normalize())
                }
                Err(sphere) => {
                    let (z, angle) = (2.0 * b - 1.0, TAU * c);
                    let r = (1.0 - z * z).sqrt();
                    let normal = DVec3::new(r * angle.cos(), r * angle.sin(), z);
                    (sphere.centre + sphere.radius * normal, normal)
                }
            };
            let normal = if side < 0.5 { normal } else { -normal };
            let [a, b, _, _] = uniforms.next4();
            let (x, y) = normal.any_orthonormal_pair();
            let (r, angle) = (a.sqrt(), TAU * b);
            let direction = r * angle.cos() * x + r * angle.sin() * y + (1.0 - a).sqrt() * normal;
            let world = self.scene.world;
            let span = Span::from(1e-9 * world.extent().length());
            let line = Line::new(point, direction);
            // What starts in a face of the world starts on its inner side.
            if world.clip(&line, span).is_some() {
                return Ray::new(line, span);
            }
        }
    }
}

/// What rays of a metric's law do, by counting.
pub fn simulated(metric: Metric, scene: &Scene, tree: &Tree) -> Expected {
    let world = scene.world;
    let stopped = |ray: &Ray, stack: &mut Stack| {
        let mut work = Work::default();
        nearest_watched(tree, &scene.objects, ray, stack, &mut work);
        work
    };
    let inside = |i| LineLaw::VolumeRay.sample(&world, 7, i);
    match metric {
        Metric::Area => counted(|i, stack| {
            let mut work = Work::default();
            traverse_line(tree, &line(world, i), Span::FULL, stack, &mut work);
            work
        }),
        Metric::Occlusion => {
            counted(|i, stack| stopped(&Ray::new(line(world, i), Span::FULL), stack))
        }
        Metric::Interior => counted(|i, stack| {
            let (line, span) = inside(i);
            let mut work = Work::default();
            traverse_line(tree, &line, span, stack, &mut work);
            work
        }),
        Metric::InteriorOcclusion => counted(|i, stack| {
            let (line, span) = inside(i);
            stopped(&Ray::new(line, span), stack)
        }),
        Metric::Surface => {
            let starts = Starts::of(scene);
            counted(|i, stack| stopped(&starts.ray(i), stack))
        }
        Metric::Mailbox => counted(|i, stack| {
            let mut work = Work::default();
            let mut met = Vec::new();
            let line = line(world, i);
            traverse::<Counting, _, _>(
                tree,
                &line,
                Span::FULL,
                stack,
                &mut work,
                |objects: &[u32], _| {
                    met.extend_from_slice(objects);
                    f64::INFINITY
                },
            );
            met.sort_unstable();
            met.dedup();
            work.tests = met.len() as u64;
            work
        }),
    }
}
