//! Simple procedural scenes, in the spirit of the five that MacDonald & Booth (1990) tried.
//!
//! Of theirs we know the types only (Haines, Ray Tracing News 18, 1): two of many small, uniformly distributed objects,
//! three of large overlapping objects that fill space. `greedy` is for a remark of theirs, that choosing each plane by
//! its own cost alone is not best for the tree as a whole. Everything lies in or about the unit cube.

mod flat;
mod greedy;

use glam::DVec3;

use super::{MAX_OBJECTS, Make, Random, Recipe};
use crate::geom::{Objects, Sphere};

/// The simple scenes.
pub(super) const RECIPES: [Recipe; 7] = [
    recipe(
        "uniform",
        "small spheres, uniform in a cube",
        2_000,
        uniform,
    ),
    recipe(
        "soup",
        "equilateral triangles of edge N^(-1/3), uniformly placed and oriented",
        2_000,
        soup,
    ),
    recipe(
        "clustered",
        "spheres and triangles in 20 clusters of very different sizes",
        2_000,
        clustered,
    ),
    recipe(
        "overlapping",
        "large spheres and triangles that overlap and fill space",
        64,
        overlapping,
    ),
    recipe(
        "mixture",
        "a few large objects among many small ones: spheres, triangles, hexagons",
        1_500,
        mixture,
    ),
    Recipe {
        sizes: [greedy::LEAST, MAX_OBJECTS],
        ..recipe(
            "greedy",
            "dense clusters that lure the plane of least cost into cutting a regular lattice",
            1_000,
            greedy::objects,
        )
    },
    recipe(
        "flat",
        "a city in a slab 1 x 1 x 0.05: towers, houses and trees on a floor",
        2_000,
        flat::objects,
    ),
];

const fn recipe(
    name: &'static str,
    about: &'static str,
    size: usize,
    make: fn(usize, Random) -> Objects,
) -> Recipe {
    Recipe {
        group: "simple",
        name,
        about,
        size,
        sizes: [1, MAX_OBJECTS],
        make: Make::Objects(make),
    }
}

/// Mean distance between n objects in the unit cube.
fn spacing(n: usize) -> f64 {
    1.0 / libm::cbrt(n as f64)
}

/// Spheres of one radius, 6.5 % of the cube's volume together, wholly inside the cube.
fn uniform(n: usize, mut random: Random) -> Objects {
    let radius = 0.25 * spacing(n);
    let spheres = (0..n).map(|_| Sphere {
        centre: radius + (1.0 - 2.0 * radius) * random.point(),
        radius,
    });
    Objects {
        spheres: spheres.collect(),
        ..Objects::default()
    }
}

/// Triangles with edges as long as the mean distance; the centres are uniform in the cube.
pub(super) fn soup(n: usize, mut random: Random) -> Objects {
    let radius = spacing(n) / 3_f64.sqrt();
    let triangles = (0..n).map(|_| {
        let centre = random.point();
        random.triangle(centre, radius)
    });
    Objects {
        triangles: triangles.collect(),
        ..Objects::default()
    }
}

/// Bell-shaped clusters of equal numbers, each 0.8 times as wide as the one before: from 0.1 down to 0.0014.
fn clustered(n: usize, mut random: Random) -> Objects {
    const CLUSTERS: usize = 20;
    let mut objects = Objects::default();
    let mut width = 0.1;
    for cluster in 0..CLUSTERS.min(n) {
        let middle = random.point();
        let members = (n - cluster).div_ceil(CLUSTERS);
        let radius = 0.5 * width * spacing(members);
        for i in 0..members {
            let centre = middle + width * random.bell();
            if i % 2 == 0 {
                objects.spheres.push(Sphere { centre, radius });
            } else {
                objects.triangles.push(random.triangle(centre, radius));
            }
        }
        width *= 0.8;
    }
    objects
}

/// Spheres and triangles in turn, of radius 0.2 to 0.4: everywhere inside several of them.
fn overlapping(n: usize, mut random: Random) -> Objects {
    let mut objects = Objects::default();
    for i in 0..n {
        let (centre, radius) = (random.point(), random.between(0.2, 0.4));
        if i % 2 == 0 {
            objects.spheres.push(Sphere { centre, radius });
        } else {
            objects.triangles.push(random.triangle(centre, radius));
        }
    }
    objects
}

/// One object in 50 is large (radius 0.15 to 0.3), the others 0.1 to 0.4 times their mean distance.
fn mixture(n: usize, mut random: Random) -> Objects {
    let mut objects = Objects::default();
    for i in 0..n {
        let centre: DVec3 = random.point();
        let radius = if i % 50 == 0 {
            random.between(0.15, 0.3)
        } else {
            spacing(n) * random.between(0.1, 0.4)
        };
        match i % 3 {
            0 => objects.spheres.push(Sphere { centre, radius }),
            1 => objects.triangles.push(random.triangle(centre, radius)),
            _ => objects.polygons.push(random.hexagon(centre, radius)),
        }
    }
    objects
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::Aabb;
    use crate::scene::Scene;

    #[test]
    fn every_size_has_that_many_objects() {
        for recipe in &RECIPES {
            for n in [1, 2, 3, 7, 19, 20, 21, 69, 333] {
                if n >= recipe.sizes[0] {
                    let spec = format!("simple:{}:{n}", recipe.name);
                    let scene = Scene::load(&spec).expect("a scene of this size");
                    assert_eq!(scene.objects.len(), n, "{spec}");
                }
            }
        }
    }

    #[test]
    fn the_scenes_are_what_they_say() {
        let load = |spec| Scene::load(spec).expect("a simple scene");
        let cube = Aabb::new(DVec3::ZERO, DVec3::ONE);
        let uniform = load("simple:uniform");
        assert!(cube.contains(&uniform.world));
        assert!(uniform.world.volume() > 0.98);
        let soup = load("simple:soup:1000");
        let edge = |t: &crate::geom::Triangle| t.0[0].distance(t.0[1]);
        let triangles = &soup.objects.triangles;
        assert!(triangles.iter().all(|t| (edge(t) - 0.1).abs() < 1e-15));
        assert_eq!(
            load("simple:mixture").counts(),
            "500 triangles, 500 spheres, 500 polygons"
        );
        assert_eq!(
            load("simple:clustered").counts(),
            "1000 triangles, 1000 spheres"
        );
        // A point of the cube lies in about 64 / 2 * (4/3) pi 0.3^3 = 3.6 spheres' volume, less what reaches outside.
        let overlapping = load("simple:overlapping").objects;
        let inside = |p: DVec3| {
            let within = |s: &&Sphere| s.centre.distance(p) < s.radius;
            overlapping.spheres.iter().filter(within).count()
        };
        assert!(inside(DVec3::splat(0.5)) >= 3);
    }
}
