//! Scenes of the Standard Procedural Databases: the ten that Havran traced.
//!
//! Haines (1987), A proposal for standard graphics environments, IEEE CG&A 7(11); version 3.14 of the package, in the
//! public domain. The generators are our own, from its closed formulas, in f64; spheres and cones stay analytic. Objects
//! and materials come in the package's order, one material for each of its records. The numbers they must reproduce stand
//! in `data/reference/spd-facts.csv`.

mod balls;
mod gears;
mod jacks;
mod lattice;
mod mount;
mod rings;
mod sombrero;
mod stage;
mod teapot;
mod tetra;
mod tree;
mod turn;

use super::{Draft, Make, Recipe};

/// Havran's groups of the ten scenes: about 10^3, 10^4 and 10^5 objects each.
pub const SPD_GROUPS: [&str; 3] = ["G3", "G4", "G5"];

/// One of the ten scenes.
struct Standard {
    recipe: Recipe,
    /// Its size in each of [`SPD_GROUPS`].
    sizes: [usize; 3],
}

/// The ten scenes: name, description, sizes in the groups, least and largest size, generator.
///
/// The largest sizes are the last with fewer than 2^27 objects; gears, lattice and teapot, whose objects take more memory,
/// end sooner, so that no scene needs more than about 16 GB.
const SCENES: [Standard; 10] = [
    standard(
        "balls",
        "sphereflake: (9^(SIZE+1) - 1)/8 spheres on a floor polygon",
        [3, 4, 5],
        [1, 8],
        balls::draft,
    ),
    standard(
        "gears",
        "SIZE^3 meshing gears of 146 polygons each, two of them of 144 corners, on a ground polygon",
        [2, 4, 9],
        [1, 64],
        gears::draft,
    ),
    standard(
        "jacks",
        "crosses of cylinders with balls at their ends, nested: 9 (8^SIZE - 1)/7 objects",
        [3, 4, 5],
        [1, 8],
        jacks::draft,
    ),
    standard(
        "lattice",
        "(SIZE+1)^3 spheres in a cube, joined by 3 SIZE (SIZE+1)^2 cylinders",
        [6, 12, 29],
        [1, 256],
        lattice::draft,
    ),
    standard(
        "mount",
        "fractal mountain of 2 * 4^SIZE triangles under four glass spheres",
        [4, 6, 8],
        [1, 12],
        mount::draft,
    ),
    standard(
        "rings",
        "pyramid of interlaced pentagons: 5 SIZE (SIZE+1)(2 SIZE+1) cylinders, as many spheres, a wall",
        [3, 7, 17],
        [1, 188],
        rings::draft,
    ),
    standard(
        "sombrero",
        "ripples on a square: 2 (16 * 2^SIZE - 1)^2 triangles",
        [1, 2, 4],
        [1, 9],
        sombrero::draft,
    ),
    standard(
        "teapot",
        "Newell's teapot of 64 SIZE^2 - 8 SIZE triangles on a board of SIZE^2 squares",
        [4, 12, 40],
        [2, 1024],
        teapot::draft,
    ),
    standard(
        "tetra",
        "recursive tetrahedron of 4^SIZE triangles",
        [5, 6, 8],
        [1, 13],
        tetra::draft,
    ),
    standard(
        "tree",
        "binary tree of 2^(SIZE+1) - 1 cones and as many spheres on a field",
        [8, 11, 15],
        [1, 25],
        tree::draft,
    ),
];

/// The size taken when none is given is that of G4.
const fn standard(
    name: &'static str,
    about: &'static str,
    sizes: [usize; 3],
    range: [usize; 2],
    make: fn(usize) -> Draft,
) -> Standard {
    Standard {
        recipe: Recipe {
            group: "spd",
            name,
            about,
            size: sizes[1],
            sizes: range,
            make: Make::Staged(make),
        },
        sizes,
    }
}

/// How to make each of the ten scenes.
pub(super) fn recipes() -> impl Iterator<Item = &'static Recipe> {
    SCENES.iter().map(|s| &s.recipe)
}

/// The group of a scene by its full name, e.g. `G4` for `spd:balls:4`; none for other sizes and scenes.
pub fn spd_group(name: &str) -> Option<&'static str> {
    SPD_GROUPS
        .into_iter()
        .find(|group| spd_scenes(group).iter().any(|scene| scene == name))
}

/// The full names of the ten scenes of a group, one of [`SPD_GROUPS`]; none for any other word.
pub fn spd_scenes(group: &str) -> Vec<String> {
    let Some(column) = SPD_GROUPS.iter().position(|g| *g == group) else {
        return Vec::new();
    };
    let name = |s: &Standard| format!("{}:{}", s.recipe.spec(), s.sizes[column]);
    SCENES.iter().map(name).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{MAX_OBJECTS, Scene};

    /// All but gears, lattice and teapot.
    #[test]
    fn largest_sizes_are_the_last_that_a_scene_may_have() {
        type Count = fn(usize) -> usize;
        let counts: [(&str, Count); 7] = [
            ("balls", |n| (9_usize.pow(n as u32 + 1) - 1) / 8 + 1),
            ("jacks", |n| 9 * (8_usize.pow(n as u32) - 1) / 7),
            ("mount", |n| (2 << (2 * n)) + 4),
            ("rings", |n| 10 * n * (n + 1) * (2 * n + 1) + 1),
            ("sombrero", |n| 2 * ((16 << n) - 1) * ((16 << n) - 1)),
            ("tetra", |n| 1 << (2 * n)),
            ("tree", |n| (4 << n) - 1),
        ];
        for (name, count) in counts {
            let scene = SCENES.iter().find(|s| s.recipe.name == name).expect(name);
            let [_, most] = scene.recipe.sizes;
            assert!(count(most) <= MAX_OBJECTS && count(most + 1) > MAX_OBJECTS);
            let loaded = Scene::load(&format!("spd:{name}:3")).expect(name);
            assert_eq!(loaded.objects.len(), count(3), "{name}");
        }
    }
}
