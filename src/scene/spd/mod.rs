//! Scenes of the Standard Procedural Databases.
//!
//! Haines (1987), A proposal for standard graphics environments, IEEE CG&A 7(11); version 3.14 of the package, in the
//! public domain. The generators are our own, from its closed formulas, in f64; spheres stay analytic. The numbers
//! they must reproduce stand in `data/reference/spd-facts.csv`. Sizes without a number are those of Havran's group G4.

mod balls;
mod tetra;

use super::{Make, Recipe};

/// The SPD scenes. The largest sizes are the last with fewer than 2^27 objects.
pub(super) const RECIPES: [Recipe; 2] = [
    Recipe {
        group: "spd",
        name: "balls",
        about: "sphereflake of (9^(SIZE+1) - 1)/8 spheres on a floor polygon",
        size: 4,
        sizes: [1, 8],
        make: Make::Objects(|size, _| balls::objects(size)),
    },
    Recipe {
        group: "spd",
        name: "tetra",
        about: "recursive tetrahedron of 4^SIZE triangles",
        size: 6,
        sizes: [1, 13],
        make: Make::Objects(|size, _| tetra::objects(size)),
    },
];
