//! Trees over a few objects whose coordinates tie, vanish or are huge, and a ray through them: what the theory and the
//! traversal promise holds whatever the numbers.

use glam::DVec3;
use sahlab::cost::CostModel;
use sahlab::geom::{Cone, Line, Object, Objects, Polygon, Ray, Span, Sphere, Targets, Triangle};
use sahlab::kd::audit::{audit, audit_clipped};
use sahlab::kd::hits::all_watched;
use sahlab::kd::stream::Streams;
use sahlab::kd::traverse::traverse_line;
use sahlab::kd::{
    Counts, Hit, NoProbe, Probe, Rules, Stack, Strategy, Tracing, Tree, build_objects, nearest,
    occluded, predict, traverse,
};
use sahlab::rays::file::LENGTHS;
use sahlab::scene::Scene;

use super::ways::ways;

/// Objects read from the bytes at most.
const MOST: usize = 24;

/// Stop rules to choose from: shallow, so that a tree of a tangle stays small.
const STOPS: [&str; 8] = [
    "objects:1:10",
    "objects:2",
    "cost-k:0.5:10",
    "cost-gain",
    "automatic",
    "depth:6",
    "octree:1:6",
    "cost-k:0:9",
];

/// Numbers that arithmetic stumbles over.
const HARD: [f64; 24] = [
    -0.0,
    5e-324,
    -5e-324,
    f64::MIN_POSITIVE,
    1e-200,
    1e-140,
    1e-30,
    1e-16,
    1e-9,
    f64::EPSILON,
    1.0 - f64::EPSILON / 2.0,
    1.0 + f64::EPSILON,
    1.0 / 3.0,
    0.1,
    0.3,
    1e7,
    16_777_217.0,
    9_007_199_254_740_991.0,
    1e16,
    1e30,
    -1e30,
    1e75,
    1e130,
    -1e130,
];

/// Reads choices off the bytes; after their end all are the first.
struct Choices<'a>(&'a [u8]);

impl Choices<'_> {
    fn byte(&mut self) -> u8 {
        let (&first, rest) = self.0.split_first().unwrap_or((&0, &[]));
        self.0 = rest;
        first
    }

    fn of<T: Copy>(&mut self, all: &[T]) -> T {
        all[usize::from(self.byte()) % all.len()]
    }

    /// Mostly one of a few halves, so that coordinates tie; else a hard number, or any.
    fn number(&mut self) -> f64 {
        match self.byte() {
            b @ 0..128 => f64::from(b % 9) / 2.0 - 2.0,
            b @ 128..240 => HARD[usize::from(b) % HARD.len()],
            _ => {
                let x = f64::from_be_bytes(std::array::from_fn(|_| self.byte()));
                if x.abs() < 1e150 { x } else { 1.0 }
            }
        }
    }

    fn point(&mut self) -> DVec3 {
        DVec3::new(self.number(), self.number(), self.number())
    }

    fn objects(&mut self) -> Objects {
        let mut objects = Objects::default();
        for _ in 0..=usize::from(self.byte()) % MOST {
            match self.byte() % 8 {
                0..4 => objects
                    .triangles
                    .push(Triangle([(); 3].map(|()| self.point()))),
                4 => objects.spheres.push(Sphere {
                    centre: self.point(),
                    radius: self.number().abs(),
                }),
                5 => objects.cones.push(Cone {
                    base: self.point(),
                    base_radius: self.number().abs(),
                    apex: self.point(),
                    apex_radius: self.number().abs(),
                }),
                // A parallelogram; the triangle of half of it where it has no area.
                _ => {
                    let [a, b, c] = [(); 3].map(|()| self.point());
                    match Polygon::new(vec![a, b, c, a + (c - b)]) {
                        Ok(polygon) => objects.polygons.push(polygon),
                        Err(_) => objects.triangles.push(Triangle([a, b, c])),
                    }
                }
            }
        }
        objects
    }

    fn rules(&mut self) -> Rules {
        Rules {
            strategy: self.of(&Strategy::ALL),
            stop: self.of(&STOPS).parse().expect("a rule"),
            cost: CostModel::WALD_HAVRAN,
            clipped: self.byte() % 2 == 1,
        }
    }

    /// A ray as a file may have it: from a point or a corner of a box, along a direction or to a corner.
    fn ray(&mut self, scene: &Scene) -> Option<Ray> {
        let origin = match self.byte() % 2 {
            0 => self.point(),
            _ => scene.bounds[usize::from(self.byte()) % scene.bounds.len()].lo,
        };
        let direction = match self.byte() % 2 {
            0 => self.point(),
            _ => scene.bounds[usize::from(self.byte()) % scene.bounds.len()].hi - origin,
        };
        let span = match self.byte() % 3 {
            0 => Span::FULL,
            1 => Span::from(0.0),
            _ => Span {
                t0: 0.0,
                t1: self.number().abs(),
            },
        };
        LENGTHS
            .contains(&direction.abs().max_element())
            .then(|| Ray::new(Line::new(origin, direction), span))
    }
}

/// Nodes visited, each at most once.
struct Visited(Vec<bool>);

impl Probe for Visited {
    fn inner(&mut self, node: u32) {
        assert!(!self.0[node as usize], "node {node} is visited twice");
        self.0[node as usize] = true;
    }

    fn leaf(&mut self, node: u32, _: u32) {
        self.inner(node);
    }
}

/// A tree of any strategy and rule, and rays through it.
pub fn tree(bytes: &[u8]) {
    let mut choices = Choices(bytes);
    let rules = choices.rules();
    let Ok(scene) = Scene::new("x", choices.objects(), Vec::new()) else {
        return;
    };
    let (objects, bounds) = (&scene.objects, &scene.bounds);
    let tree = build_objects(objects, bounds, scene.world, &rules);
    let audited = match rules.clipped {
        true => audit_clipped(&tree, objects, bounds),
        false => audit(&tree, bounds),
    };
    assert_eq!(audited, Ok(()), "{rules:?}");
    assert!(tree.depth <= rules.stop.depth_bound(bounds.len()));
    let prediction = predict(&tree);
    let above_one = 1.0 + 1e-12;
    assert!(
        prediction.p.iter().all(|p| (0.0..=above_one).contains(p)),
        "{prediction:?}"
    );
    let rays = [(); 4].map(|()| choices.ray(&scene));
    let rays: Vec<Ray> = rays.into_iter().flatten().collect();
    for ray in &rays {
        counts(&tree, ray);
        hits(&tree, &scene, ray, rules.clipped);
    }
    ways(&tree, &scene, &rays);
}

/// Counting visits the nodes whose boxes pass the slab test and no other, alone and in streams; tracing none fewer.
fn counts(tree: &Tree, ray: &Ray) {
    let mut stack = Stack::default();
    let visits = |stack: &mut Stack, span| {
        let mut visited = Visited(vec![false; tree.nodes.len()]);
        traverse_line(tree, &ray.line, span, stack, &mut visited);
        visited.0
    };
    for span in [Span::FULL, ray.span] {
        let visited = visits(&mut stack, span);
        let boxes = tree.boxes.iter();
        let met: Vec<bool> = boxes.map(|b| b.clip(&ray.line, span).is_some()).collect();
        assert_eq!(visited, met, "{ray:?} within {span:?}");

        let mut widened = Visited(vec![false; tree.nodes.len()]);
        traverse::<Tracing, _, _>(tree, &ray.line, span, &mut stack, &mut widened, |_, _| {
            f64::INFINITY
        });
        assert!(met.iter().zip(&widened.0).all(|(&met, &seen)| seen || !met));
    }
    let met = visits(&mut stack, Span::FULL);
    let mut counts = Counts::new(tree);
    Streams::default().count(tree, &[ray.line], &mut counts);
    let met: Vec<u64> = met.into_iter().map(u64::from).collect();
    assert_eq!(counts.hits, met, "{ray:?}");
    if met[0] == 1 {
        assert_eq!(counts.check(tree), Ok(()));
    }
}

/// The nearest hit through the tree is that of trying every object, bit for bit.
fn hits(tree: &Tree, scene: &Scene, ray: &Ray, clipped: bool) {
    let mut stack = Stack::default();
    let objects = &scene.objects;
    let each = (0..objects.len() as u32)
        .filter_map(|object| Some((object, objects.intersect(object, ray)?)));
    let best = each.fold(None, |best, (object, t)| Hit::nearer(best, object, t));
    assert!(best.is_none_or(|hit| !hit.t.is_nan() && hit.t >= ray.span.t0 && hit.t <= ray.span.t1));
    if clipped && !clearly_hit(scene, ray) {
        return;
    }
    let found = nearest(tree, objects, ray, &mut stack);
    let bits = |hit: Option<Hit>| hit.map(Hit::bits);
    assert_eq!(bits(found), bits(best), "{found:?}, {best:?}: {ray:?}");
    let all = all_watched(tree, objects, ray, &mut stack, NoProbe);
    assert_eq!(bits(all), bits(best), "{ray:?}");
    assert_eq!(occluded(tree, objects, ray, &mut stack), best.is_some());
}

/// Whether the ray keeps clear of what clipping leaves open: it starts near the scene, and runs in no object's plane up to
/// rounding.
fn clearly_hit(scene: &Scene, ray: &Ray) -> bool {
    let largest = |v: DVec3| v.abs().max_element();
    let reach = largest(scene.world.lo).max(largest(scene.world.hi));
    if largest(ray.line.origin) > 100.0 * reach {
        return false;
    }
    let direction = ray.line.direction / largest(ray.line.direction);
    (0..scene.objects.len() as u32).all(|number| {
        let normal = match scene.objects.get(number) {
            Object::Triangle(triangle) => triangle.normal(),
            Object::Polygon(polygon) => polygon.normal(),
            Object::Sphere(_) | Object::Cone(_) => return true,
        };
        let size = largest(normal);
        size > 0.0 && (normal / size).dot(direction).abs() > 1e-6
    })
}
