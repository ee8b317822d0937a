//! Hard scenes: each stresses one thing that breaks builders, traversals or object tests.
//!
//! They are small, made of whole numbers and powers of two where ties are wanted, and every one is a scene like any other. The
//! kind of experiment `stability` builds all of them by every strategy.

mod extremes;
mod grids;
mod meshes;
mod solids;

use super::{Make, Random, Recipe};
use crate::geom::Objects;

/// The hard scenes.
pub(super) const RECIPES: [Recipe; 30] = [
    // Ties.
    recipe(
        "coplanar",
        "triangles in the planes of a grid, on which all splits lie",
        4,
        grids::coplanar,
    ),
    recipe(
        "terrain",
        "a grid of heights: vertices and edges over regular lines",
        8,
        grids::terrain,
    ),
    recipe(
        "lattice",
        "cubes that share faces, edges and corners",
        3,
        grids::lattice,
    ),
    recipe(
        "equal-areas",
        "equal triangles on a regular grid: thousands of equal areas",
        6,
        grids::equal_areas,
    ),
    recipe(
        "planar",
        "triangles in the plane z = 0: a flat root",
        200,
        grids::planar,
    ),
    recipe(
        "sliver-split",
        "boxes that begin at 1 or at the next number: hardly a plane to choose",
        16,
        grids::sliver_split,
    ),
    recipe(
        "duplicates",
        "the same triangle again and again",
        100,
        grids::duplicates,
    ),
    recipe(
        "touching",
        "tetrahedra that touch at corners alone, on a dyadic grid",
        4,
        grids::touching,
    ),
    // Meshes.
    recipe(
        "octahedron",
        "a closed irregular octahedron, each face cut into four SIZE times",
        2,
        meshes::octahedron,
    ),
    recipe(
        "needles",
        "triangles a million times longer than wide",
        200,
        meshes::needles,
    ),
    recipe(
        "degenerate",
        "points, segments and repeated corners among triangles",
        60,
        meshes::degenerate,
    ),
    recipe("fan", "triangles that share one vertex", 64, meshes::fan),
    recipe(
        "roof",
        "two slopes of 1e-6 that share a long ridge",
        16,
        meshes::roof,
    ),
    Recipe {
        sizes: [1, 1],
        ..recipe("single-triangle", "one triangle", 1, meshes::single)
    },
    // Solids.
    recipe(
        "nested",
        "concentric spheres: nested boxes with equal middles",
        100,
        solids::nested,
    ),
    recipe(
        "tangent-spheres",
        "spheres that touch their neighbours",
        4,
        solids::tangent_spheres,
    ),
    recipe(
        "seams",
        "cylinders joined by spheres of the same radius",
        12,
        solids::seams,
    ),
    recipe(
        "crossing",
        "cylinders whose axes meet in one point",
        16,
        solids::crossing,
    ),
    recipe("apexes", "cones that share their apex", 16, solids::apexes),
    Recipe {
        sizes: [3, 10_000],
        ..recipe(
            "reflex",
            "a polygon with as many reflex corners as others",
            72,
            solids::reflex,
        )
    },
    recipe(
        "stadium",
        "a floor of area 10^4 under small objects on it",
        200,
        solids::stadium,
    ),
    // Extremes.
    recipe(
        "far-offset-1e6",
        "a unit cube of triangles a million away",
        200,
        extremes::far_1e6,
    ),
    recipe(
        "far-offset-1e8",
        "a unit cube of triangles a hundred million away",
        200,
        extremes::far_1e8,
    ),
    recipe("aspect-1e6", "a box of 10^6 x 1 x 1", 200, extremes::aspect),
    recipe(
        "decades",
        "triangles whose areas span twelve decades",
        91,
        extremes::decades,
    ),
    recipe(
        "tiny",
        "triangles in a cube of side 2^-100",
        200,
        extremes::tiny,
    ),
    recipe(
        "huge",
        "triangles in a cube of side 2^100",
        200,
        extremes::huge,
    ),
    recipe(
        "smallest",
        "triangles in a cube of side 2^-460: areas near the least understood",
        200,
        extremes::smallest,
    ),
    recipe(
        "largest",
        "triangles in a cube of side 2^460: areas near the largest understood",
        200,
        extremes::largest,
    ),
    recipe(
        "mixed-scales",
        "a fine cluster in a corner of a cube a million times larger",
        200,
        extremes::mixed_scales,
    ),
];

const fn recipe(
    name: &'static str,
    about: &'static str,
    size: usize,
    make: fn(usize, Random) -> Objects,
) -> Recipe {
    Recipe {
        group: "hard",
        name,
        about,
        size,
        sizes: [1, if size < 20 { 24 } else { 100_000 }],
        make: Make::Objects(make),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    fn load(name: &str) -> Scene {
        Scene::load(&format!("hard:{name}")).expect(name)
    }

    /// Every one loads at its usual, its least and a larger size, with distinct names.
    #[test]
    fn every_hard_scene_can_be_made() {
        let mut names: Vec<_> = RECIPES.iter().map(|r| r.name).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), RECIPES.len());
        for recipe in &RECIPES {
            let [least, most] = recipe.sizes;
            for size in [least, recipe.size, most.min(2 * recipe.size)] {
                load(&format!("{}:{size}", recipe.name));
            }
        }
    }

    /// What a scene's name promises is there to the bit.
    #[test]
    fn the_scenes_are_as_hard_as_they_say() {
        assert_eq!(load("duplicates:1000").objects.triangles.len(), 1_000);
        let duplicates = load("duplicates");
        assert!(duplicates.bounds.iter().all(|b| *b == duplicates.world));
        assert_eq!(load("planar").world.extent().z, 0.0);
        let sliver = load("sliver-split").bounds;
        assert!(sliver.iter().any(|b| b.lo.x == 1.0));
        assert!(
            sliver
                .iter()
                .all(|b| b.lo.x <= 1.0 + f64::EPSILON && b.hi.x == 2.0)
        );
        let nested = load("nested").bounds;
        assert!(
            nested
                .windows(2)
                .all(|w| w[1].contains(&w[0]) && w[0].centre() == w[1].centre())
        );
        let areas = |name| {
            load(name)
                .objects
                .triangles
                .iter()
                .map(|t| t.area())
                .collect::<Vec<_>>()
        };
        let decades = areas("decades");
        let least = decades.iter().copied().fold(f64::INFINITY, f64::min);
        let most = decades.iter().copied().fold(0.0, f64::max);
        assert!((most / least / 1e12 - 1.0).abs() < 1e-9, "{least} {most}");
        let equal = areas("equal-areas");
        assert!(equal.iter().all(|a| *a == equal[0]));
        let aspect = load("aspect-1e6").world.extent();
        assert!((0.9e6..1.1e6).contains(&(aspect.x / aspect.y)), "{aspect}");
        assert_eq!(
            load("degenerate").notes,
            ["30 triangles without area: kept, never hit"]
        );
        for (name, offset) in [("far-offset-1e6", 1e6), ("far-offset-1e8", 1e8)] {
            let world = load(name).world;
            assert!((world.centre() - offset).abs().max_element() < 1.0);
        }
        for (name, exponent) in [
            ("tiny", -100),
            ("huge", 100),
            ("smallest", -460),
            ("largest", 460),
        ] {
            let side = load(name).world.extent().max_element() / 2f64.powi(exponent);
            assert!((0.9..1.2).contains(&side), "{name}: {side}");
        }
    }
}
