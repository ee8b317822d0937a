//! Hard cases of trees: a scene `hard:NAME`, built and traversed by every strategy and kernel.

mod examine;
mod hard_rays;

use std::sync::Arc;

use crate::kd::Rules;
use crate::study::kernel::Kernel;

use super::case::{Case, Check, Finding, Group};
use examine::examine;

/// A scene that is hard to build a tree of, or to follow rays through it.
struct TreeCase {
    name: &'static str,
    scene: &'static str,
    stresses: &'static str,
    /// The rule in place of the experiment's.
    stop: Option<&'static str>,
    clipped: bool,
    /// Leaves and references that every strategy must make, where they are known.
    known: Option<[usize; 2]>,
    /// Whether single precision must refuse it.
    refused_in_f32: bool,
}

const fn case(name: &'static str, scene: &'static str, stresses: &'static str) -> TreeCase {
    TreeCase {
        name,
        scene,
        stresses,
        stop: None,
        clipped: false,
        known: None,
        refused_in_f32: false,
    }
}

const CASES: &[TreeCase] = &[
    case(
        "tree-coplanar",
        "hard:coplanar:3",
        "objects that lie in split planes, and rays in them",
    ),
    case(
        "tree-terrain",
        "hard:terrain:8",
        "axis-parallel rays through vertices of a grid",
    ),
    case(
        "tree-lattice",
        "hard:lattice:3",
        "faces that are there twice: equal t, and the lower number wins",
    ),
    case(
        "tree-equal-areas",
        "hard:equal-areas:5",
        "thousands of equal areas and costs",
    ),
    case(
        "tree-planar",
        "hard:planar:200",
        "a flat root: no volume, boxes of two zero extents",
    ),
    case(
        "tree-sliver-split",
        "hard:sliver-split:16",
        "planes only between neighbouring numbers",
    ),
    TreeCase {
        stop: Some("objects:1:128"),
        ..case(
            "tree-sliver-split-deep",
            "hard:sliver-split:16",
            "the same with room for 128 levels: building ends",
        )
    },
    TreeCase {
        known: Some([1, 1_000]),
        ..case(
            "tree-duplicates",
            "hard:duplicates:1000",
            "a thousand equal triangles: building ends in one leaf",
        )
    },
    TreeCase {
        stop: Some("objects:1:128"),
        known: Some([1, 100]),
        ..case(
            "tree-duplicates-deep",
            "hard:duplicates:100",
            "the same with room for 128 levels",
        )
    },
    case(
        "tree-touching",
        "hard:touching:4",
        "objects that touch in corners alone",
    ),
    case(
        "tree-octahedron",
        "hard:octahedron:2",
        "rays from inside a closed mesh",
    ),
    case(
        "tree-needles",
        "hard:needles:40",
        "triangles of 10^6 : 1 in large boxes",
    ),
    TreeCase {
        clipped: true,
        ..case(
            "tree-needles-clipped",
            "hard:needles:40",
            "the same, clipped to the nodes",
        )
    },
    case(
        "tree-degenerate",
        "hard:degenerate:24",
        "objects without area, never hit",
    ),
    TreeCase {
        clipped: true,
        ..case(
            "tree-degenerate-clipped",
            "hard:degenerate:24",
            "the same, clipped to the nodes",
        )
    },
    case(
        "tree-fan",
        "hard:fan:64",
        "a vertex that 64 triangles share",
    ),
    case(
        "tree-roof",
        "hard:roof:16",
        "shared edges at a slope of 1e-6",
    ),
    TreeCase {
        known: Some([1, 1]),
        ..case(
            "tree-single-triangle",
            "hard:single-triangle:1",
            "one object, one node: C = c_B + c_t",
        )
    },
    case(
        "tree-nested",
        "hard:nested:100",
        "boxes with equal middles: no object median parts them",
    ),
    TreeCase {
        stop: Some("objects:1:128"),
        ..case(
            "tree-nested-deep",
            "hard:nested:24",
            "the same with room for 128 levels: building ends",
        )
    },
    case(
        "tree-tangent-spheres",
        "hard:tangent-spheres:4",
        "boxes that share faces, spheres that share points",
    ),
    case(
        "tree-seams",
        "hard:seams:12",
        "spheres and cylinders of one radius: nearly equal t",
    ),
    case(
        "tree-crossing",
        "hard:crossing:16",
        "cylinders through one point",
    ),
    case("tree-apexes", "hard:apexes:16", "cones with one apex"),
    case(
        "tree-reflex",
        "hard:reflex:72",
        "polygons of 144 corners across each other",
    ),
    case(
        "tree-stadium",
        "hard:stadium:200",
        "a huge flat floor under small objects",
    ),
    TreeCase {
        refused_in_f32: true,
        ..case(
            "tree-far-offset-1e6",
            "hard:far-offset-1e6:200",
            "a million times its size away",
        )
    },
    TreeCase {
        refused_in_f32: true,
        ..case(
            "tree-far-offset-1e8",
            "hard:far-offset-1e8:200",
            "a hundred million times its size away",
        )
    },
    case(
        "tree-aspect-1e6",
        "hard:aspect-1e6:200",
        "a box of 10^6 : 1 : 1",
    ),
    case(
        "tree-decades",
        "hard:decades:91",
        "areas over twelve decades",
    ),
    case(
        "tree-mixed-scales",
        "hard:mixed-scales:200",
        "a cluster of a millionth of the scene's size",
    ),
    TreeCase {
        refused_in_f32: true,
        ..case("tree-tiny", "hard:tiny:200", "coordinates of 10^-30")
    },
    TreeCase {
        refused_in_f32: true,
        ..case("tree-huge", "hard:huge:200", "coordinates of 10^30")
    },
    TreeCase {
        refused_in_f32: true,
        ..case("tree-smallest", "hard:smallest:200", "areas of 10^-277")
    },
    TreeCase {
        refused_in_f32: true,
        ..case("tree-largest", "hard:largest:200", "areas of 10^277")
    },
];

impl TreeCase {
    fn check(&self, rules: &Rules, kernel: Kernel) -> Finding {
        let mut rules = Rules {
            clipped: self.clipped,
            ..*rules
        };
        if let Some(stop) = self.stop {
            match stop.parse() {
                Ok(stop) => rules.stop = stop,
                Err(wrong) => return Finding::failed("a stop rule", wrong),
            }
        }
        examine(self, &rules, kernel)
    }
}

/// The cases of this group.
pub fn cases() -> Vec<Case> {
    let one = |case: &'static TreeCase| Case {
        name: case.name,
        group: Group::Trees,
        stresses: case.stresses,
        check: Check::Trees(Arc::new(|rules, kernel| Some(case.check(rules, kernel)))),
    };
    CASES.iter().map(one).collect()
}
