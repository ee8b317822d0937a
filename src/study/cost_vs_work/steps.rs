//! What rays do in a tree step by step: all that their time may hang on, counted on the very rays that are timed.

use std::ops::Range;

use crate::geom::{Object, Objects, Ray, Span};
use crate::kd::{Node, NodeKind, Probe, Stack, Tree, Turn};
use crate::scene::Scene;
use crate::study::ray_sets::Rays;
use crate::study::records::StepRecord;

use super::processor::{Caches, Gshare};

/// Places of the branches that depend on data.
mod place {
    pub const LEAF: u16 = 1;
    pub const NEAR: u16 = 2;
    pub const FAR: u16 = 3;
    pub const LAST_TEST: u16 = 4;
    /// And one for each kind of object.
    pub const OWN_BOX: u16 = 5;
}

/// Where objects lie in memory, kind after kind, as [`Objects`] keeps them; corners of polygons after them.
struct Memory {
    /// First byte and bytes of each object.
    objects: Vec<(u64, u64)>,
    /// The same of the corners it has elsewhere.
    corners: Vec<(u64, u64)>,
}

/// Regions that never meet: of nodes, references and objects.
const REFERENCES: u64 = 1 << 40;
const OBJECTS: u64 = 1 << 41;

impl Memory {
    fn new(objects: &Objects) -> Self {
        let mut next = OBJECTS;
        let mut place = |bytes: usize| {
            let first = next;
            next += bytes as u64;
            (first, bytes as u64)
        };
        let all = || (0..objects.len() as u32).map(|i| objects.get(i));
        let own = all().map(|object| match object {
            Object::Triangle(triangle) => place(size_of_val(triangle)),
            Object::Sphere(sphere) => place(size_of_val(sphere)),
            Object::Cone(cone) => place(size_of_val(cone)),
            Object::Polygon(polygon) => place(size_of_val(polygon)),
        });
        let own = own.collect();
        let corners = all().map(|object| match object {
            Object::Polygon(polygon) => place(size_of_val(polygon.corners())),
            _ => (0, 0),
        });
        Self {
            objects: own,
            corners: corners.collect(),
        }
    }
}

/// The steps of rays in one tree.
struct Steps<'a> {
    scene: &'a Scene,
    tree: &'a Tree,
    memory: &'a Memory,
    /// The ray at hand.
    ray: Ray,
    /// Objects of the leaf at hand that are still to be tested.
    left: u32,
    predictor: Gshare,
    caches: Caches,
    found: StepRecord,
}

/// Count the steps of these parts of a set of rays, in their order. `named` has the names of the row.
pub fn count(
    scene: &Scene,
    tree: &Tree,
    rays: &Rays,
    chunks: &[Range<usize>],
    named: StepRecord,
) -> StepRecord {
    let memory = Memory::new(&scene.objects);
    let mut casts = chunks
        .iter()
        .flat_map(|chunk| &rays.casts[chunk.clone()])
        .peekable();
    let Some(first) = casts.peek() else {
        return named;
    };
    let mut steps = Steps {
        scene,
        tree,
        memory: &memory,
        ray: first.ray(),
        left: 0,
        predictor: Gshare::new(),
        caches: Caches::new(),
        found: named,
    };
    let ask = rays.of.ask();
    let mut stack = Stack::default();
    for cast in casts {
        let ray = cast.ray();
        steps.ray = ray;
        ask.hits(tree, &scene.objects, &ray, &mut stack, &mut steps);
        steps.found.cast += 1;
    }
    StepRecord {
        surprises: steps.predictor.wrong,
        first_misses: steps.caches.first.misses,
        second_misses: steps.caches.second.misses,
        ..steps.found
    }
}

impl Steps<'_> {
    fn read_node(&mut self, node: u32) {
        let bytes = size_of::<Node>() as u64;
        self.caches.read(bytes * u64::from(node), bytes);
    }
}

impl Probe for Steps<'_> {
    fn inner(&mut self, node: u32) {
        self.found.inner_visits += 1;
        self.read_node(node);
        self.predictor.branch(place::LEAF, false);
    }

    fn turn(&mut self, _: u32, turn: Turn) {
        self.predictor.branch(place::NEAR, turn == Turn::Near);
        if turn != Turn::Near {
            self.predictor.branch(place::FAR, turn == Turn::Far);
        }
    }

    fn leaf(&mut self, node: u32, objects: u32) {
        self.found.leaf_visits += 1;
        self.found.empty_leaf_visits += u64::from(objects == 0);
        self.read_node(node);
        self.predictor.branch(place::LEAF, true);
        if let NodeKind::Leaf { first, count } = self.tree.nodes[node as usize].kind()
            && count > 0
        {
            let address = REFERENCES + 4 * u64::from(first);
            self.caches.read(address, 4 * u64::from(count));
        }
        self.left = objects;
        if objects == 0 {
            self.predictor.branch(place::LAST_TEST, true);
        }
    }

    fn test(&mut self, number: u32) {
        let object = self.scene.objects.get(number);
        let own = &self.scene.bounds[number as usize];
        let span = own.clip_conservative(&self.ray.line, Span::FULL);
        let wanted = self.ray.span;
        let near = span.is_some_and(|own| own.t0 <= wanted.t1 && own.t1 >= wanted.t0);
        let (first, bytes) = self.memory.objects[number as usize];
        self.caches.read(first, bytes);
        let found = &mut self.found;
        let (kind, tests, nears) = match object {
            Object::Triangle(_) => (0, &mut found.triangle_tests, &mut found.near_triangles),
            Object::Sphere(_) => (1, &mut found.sphere_tests, &mut found.near_spheres),
            Object::Cone(_) => (2, &mut found.cone_tests, &mut found.near_cones),
            Object::Polygon(_) => (3, &mut found.polygon_tests, &mut found.near_polygons),
        };
        *tests += 1;
        *nears += u64::from(near);
        if let Object::Polygon(polygon) = object
            && near
        {
            found.near_corners += polygon.corners().len() as u64;
            let (first, bytes) = self.memory.corners[number as usize];
            self.caches.read(first, bytes);
        }
        self.predictor.branch(place::OWN_BOX + kind, near);
        self.left -= 1;
        self.predictor.branch(place::LAST_TEST, self.left == 0);
    }
}
