//! A traversal of its own, by recursion, and rays that are hard for any.

use glam::DVec3;
use sahlab::geom::{Cast, Line, Ray, Real, Span, Targets};
use sahlab::kd::{Ask, Hit, NodeKind, Tree, Work};
use sahlab::rays::{SurfaceLines, Uniforms};
use sahlab::scene::Scene;

use crate::common::target;

/// The nearest hit of all objects, one after the other; the lowest number at equal t.
pub fn brute_force(scene: &Scene, ray: &Ray) -> Option<Hit> {
    let hits = (0..scene.objects.len() as u32).filter_map(|object| {
        let t = scene.objects.intersect(object, ray)?;
        Some(Hit { object, t })
    });
    // In the order of their numbers; 0 and -0 are the same t.
    hits.reduce(|best, hit| if hit.t < best.t { hit } else { best })
}

/// What a ray finds and does in a tree, from the definition: near child before far child, each with its part of the span,
/// planes widened by the padding; no node is entered beyond what the ray still asks for.
pub struct Walk<'a> {
    scene: &'a Scene,
    tree: &'a Tree,
    ray: Ray,
    ask: Ask,
    /// What was found.
    pub hit: Option<Hit>,
    /// What it took.
    pub work: Work,
}

impl<'a> Walk<'a> {
    pub fn new(scene: &'a Scene, tree: &'a Tree, ask: Ask, cast: &Cast) -> Self {
        let ray = cast.ray();
        let mut walk = Self {
            scene,
            tree,
            ray,
            ask,
            hit: None,
            work: Work::default(),
        };
        if let Some(span) = tree.world.clip_conservative(&ray.line, ray.span) {
            walk.node(0, span);
        }
        walk
    }

    fn node(&mut self, node: u32, Span { t0, t1 }: Span) {
        let still_asked = match (self.ask, self.hit) {
            (Ask::Any, Some(_)) => false,
            (Ask::Nearest, Some(hit)) => t0 <= hit.t,
            _ => true,
        };
        if !still_asked {
            return;
        }
        let line = self.ray.line;
        let tree = self.tree;
        match tree.nodes[node as usize].kind() {
            NodeKind::Leaf { first, count } => {
                self.work.leaves += 1;
                for &object in tree.objects(first, count) {
                    self.work.tests += 1;
                    let Some(t) = self.scene.objects.intersect(object, &self.ray) else {
                        continue;
                    };
                    let better = self.hit.is_none_or(|h| (t, object) < (h.t, h.object));
                    if better {
                        self.hit = Some(Hit { object, t });
                    }
                    if self.ask == Ask::Any {
                        return;
                    }
                }
            }
            NodeKind::Inner { axis, split, left } => {
                self.work.inner += 1;
                let right = left + 1;
                let (d, o) = (line.direction[axis], line.origin[axis]);
                if !d.recip().is_finite() {
                    if o <= split {
                        self.node(left, Span { t0, t1 });
                    }
                    if o >= split {
                        self.node(right, Span { t0, t1 });
                    }
                    return;
                }
                let (near, far) = if d < 0.0 {
                    (right, left)
                } else {
                    (left, right)
                };
                let t = (split - o) * d.recip();
                let (early, late) = (t - f64::PADDING * t.abs(), t + f64::PADDING * t.abs());
                if late >= t0 {
                    let t1 = t1.min(if early > t1 { t1 } else { late });
                    self.node(near, Span { t0, t1 });
                }
                if early <= t1 {
                    let t0 = if late < t0 { t0 } else { t0.max(early) };
                    self.node(far, Span { t0, t1 });
                }
            }
        }
    }
}

/// Rays of every hard family that a file can hold: they begin at t = 0.
pub fn hard_casts(scene: &Scene, tree: &Tree, n: usize) -> Vec<Cast> {
    let world = scene.world;
    let size = world.extent().length();
    let mut uniforms = Uniforms::starting_at(78, 0);
    let mut casts: Vec<Cast> = Vec::new();
    let lines = SurfaceLines { world, seed: 4 }.range(0..n as u64);
    for (
        i,
        Line {
            origin, direction, ..
        },
    ) in lines.enumerate()
    {
        let [x, y, z, w] = uniforms.next4();
        let inside = world.lo + DVec3::new(x, y, z) * world.extent();
        let target = target(&scene.objects, (w * 1e6) as usize + i);
        let mut along = DVec3::ZERO;
        along[i % 3] = if i.is_multiple_of(2) { size } else { -size };
        let mut add = |origin: DVec3, direction: DVec3, end: f64| {
            if direction != DVec3::ZERO {
                let span = Span { t0: 0.0, t1: end };
                casts.push(Cast {
                    origin,
                    direction,
                    span,
                });
            }
        };
        // Isotropic from the surface; from inside; to a corner or an edge; along an axis through it; away from all.
        add(origin, direction, f64::INFINITY);
        add(inside, direction, f64::INFINITY);
        add(origin, target - origin, f64::INFINITY);
        add(target - along, along, f64::INFINITY);
        add(
            world.hi + world.extent() + DVec3::ONE,
            DVec3::new(x, y, z),
            f64::INFINITY,
        );
        // Very short and very long directions; a part whose reciprocal overflows; a segment, and one of no length.
        add(inside, 1e-46 * direction, f64::INFINITY);
        add(inside, 1e46 * direction, f64::INFINITY);
        let mut nearly = direction;
        nearly[i % 3] = 1e-310;
        add(inside, nearly, f64::INFINITY);
        add(inside, target - inside, 1.0);
        add(target, direction, 0.0);
        // In a plane of the tree, slanted and along an axis.
        let node = (w * tree.nodes.len() as f64) as usize;
        if let NodeKind::Inner { axis, split, .. } = tree.nodes[node].kind() {
            let (mut on_plane, mut slanted, mut straight) = (origin, direction, DVec3::ZERO);
            on_plane[axis] = split;
            slanted[axis] = if i.is_multiple_of(2) { 0.0 } else { -0.0 };
            straight[(axis + 1) % 3] = 1.0;
            add(on_plane, slanted, f64::INFINITY);
            add(on_plane, straight, f64::INFINITY);
        }
        // From the surface of an object, on and back; ends at a hit, and the last number before it.
        let whole = Cast {
            origin,
            direction,
            span: Span::from(0.0),
        };
        if let Some(hit) = brute_force(scene, &whole.ray()) {
            let point = whole.ray().line.at(hit.t);
            add(point, direction, f64::INFINITY);
            add(point, inside - point, f64::INFINITY);
            add(origin, direction, hit.t);
            add(origin, direction, hit.t.next_down().max(0.0));
        }
    }
    casts
}
