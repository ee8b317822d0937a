//! Objects and rays of any bits: NaN, infinities, numbers without a reciprocal.
//!
//! Who refuses what: a scene its objects, a file of rays its rows, a tree in single precision what would be useless there, each with one
//! message; all that they let pass is finite, and has a sound tree that every way through it agrees on. [`Line::new`] leaves it to its
//! caller that numbers are finite: of a line that is not, a walk promises no more than to end.

use glam::DVec3;
use sahlab::cost::CostModel;
use sahlab::geom::{Cast, Cone, Line, Objects, Polygon, Ray, Span, Sphere, Triangle};
use sahlab::kd::audit::audit;
use sahlab::kd::{
    Counting, FaceTrees, Links, NarrowTree, NoProbe, Restart, Rules, Stack, Strategy, Tracing,
    Tree, Walk, build,
};
use sahlab::rays::file;
use sahlab::scene::Scene;

use super::ways::ways;
use super::{LONGEST, a_ray, clear};

/// Objects read from the bytes at most.
const MOST: usize = 8;

/// Reads numbers off the bytes; after their end all are -2.
struct Bits<'a>(&'a [u8]);

impl Bits<'_> {
    fn byte(&mut self) -> u8 {
        let (&first, rest) = self.0.split_first().unwrap_or((&0, &[]));
        self.0 = rest;
        first
    }

    /// Mostly one of a few halves, so that a scene may pass; else any eight bytes.
    fn number(&mut self) -> f64 {
        match self.byte() {
            b @ 0..224 => f64::from(b % 9) / 2.0 - 2.0,
            _ => f64::from_be_bytes(std::array::from_fn(|_| self.byte())),
        }
    }

    fn point(&mut self) -> DVec3 {
        DVec3::new(self.number(), self.number(), self.number())
    }

    fn objects(&mut self) -> Objects {
        let mut objects = Objects::default();
        for _ in 0..=usize::from(self.byte()) % MOST {
            match self.byte() % 8 {
                0..5 => objects
                    .triangles
                    .push(Triangle([(); 3].map(|()| self.point()))),
                5 => objects.spheres.push(Sphere {
                    centre: self.point(),
                    radius: self.number(),
                }),
                6 => objects.cones.push(Cone {
                    base: self.point(),
                    base_radius: self.number(),
                    apex: self.point(),
                    apex_radius: self.number(),
                }),
                _ => {
                    let corners = [(); 4].map(|()| self.point());
                    objects.polygons.extend(Polygon::new(corners.into()));
                }
            }
        }
        objects
    }

    /// A file of rays.
    fn rays(&mut self) -> String {
        let mut text = file::COLUMNS.join(",");
        for _ in 0..=self.byte() % 4 {
            let numbers = [(); 7].map(|()| self.number().to_string());
            text += &format!("\n{}", numbers.join(","));
        }
        text
    }
}

/// Through the checks that a user's scene and rays pass.
pub fn bits(bytes: &[u8]) {
    let mut bits = Bits(bytes);
    let strategy = Strategy::ALL[usize::from(bits.byte()) % Strategy::ALL.len()];
    let scene = match Scene::new("x", bits.objects(), Vec::new()) {
        Ok(scene) => scene,
        Err(error) => return clear(error, "x"),
    };
    let rules = Rules {
        strategy,
        stop: "objects:1:8".parse().expect("a rule"),
        cost: CostModel::WALD_HAVRAN,
        clipped: false,
    };
    let tree = build(&scene.bounds, scene.world, &rules);
    assert!(scene.world.is_valid());
    assert_eq!(audit(&tree, &scene.bounds), Ok(()));
    if let Err(refusal) = NarrowTree::of(&tree) {
        let message = refusal.to_string();
        assert!(
            message.contains("; ") && message.len() <= LONGEST,
            "{message}"
        );
    }
    match file::parse("x.csv", bits.rays().as_bytes()) {
        Ok(casts) => {
            casts.iter().for_each(a_ray);
            let rays: Vec<Ray> = casts.iter().map(Cast::ray).collect();
            ways(&tree, &scene, &rays);
        }
        Err(error) => clear(error, "x.csv"),
    }
    let line = Line {
        origin: bits.point(),
        direction: bits.point(),
        inverse: bits.point(),
    };
    let (t0, t1) = (bits.number(), bits.number());
    ends(&tree, &line, Span { t0, t1 });
}

/// A walk ends, whatever the line.
fn ends(tree: &Tree, line: &Line, span: Span) {
    fn walk<W: Walk<Vector = DVec3>>(walk: &W, line: &Line, span: Span) {
        let mut stack = Stack::default();
        let on = |_: &[u32], _: &mut NoProbe| f64::INFINITY;
        walk.walk::<Counting, _>(line, span, &mut stack, &mut NoProbe, on);
        walk.walk::<Tracing, _>(line, span, &mut stack, &mut NoProbe, on);
    }
    let links = Links::of(tree);
    walk(tree, line, span);
    walk(&links.walk(tree), line, span);
    walk(&FaceTrees::of(tree, &links).walk(tree), line, span);
    walk(&Restart(tree), line, span);
}
