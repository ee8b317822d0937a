//! What the time of a ray may consist of.

use crate::study::records::{CellRecord, ConstantRecord, StepRecord, WorkRecord};

/// A set of rays in a tree: what was counted of a ray, and its seconds.
pub struct Row<'r> {
    /// The tree.
    pub cell: &'r CellRecord,
    /// Counts of all rays, and what areas predict.
    pub work: &'r WorkRecord,
    /// Steps of the timed rays.
    pub steps: &'r StepRecord,
    /// Nanoseconds a ray.
    pub ns: f64,
    /// Whether the machine was disturbed.
    pub disturbed: bool,
}

impl Row<'_> {
    /// Its group of scenes: all sizes of one.
    pub fn group(&self) -> &str {
        group(&self.work.scene)
    }
}

/// The scene's name without its size; of a file, the name.
fn group(scene: &str) -> &str {
    match scene.rsplit_once(':') {
        Some((group, _)) if group.contains(':') => group,
        _ => scene,
    }
}

/// A share of the time: a number a ray, times a constant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Term {
    /// One: what every ray costs.
    Ray,
    /// Inner nodes.
    Inner,
    /// Leaves.
    Leaf,
    /// Leaves without an object.
    EmptyLeaf,
    /// Object tests of all kinds.
    Test,
    /// Object tests of one kind.
    TestOf(Kind),
    /// Tests of objects of one kind whose own box the ray crosses.
    NearOf(Kind),
    /// Corners of the polygons among these.
    Corner,
    /// Tests that are repeated because objects straddle planes, as far as the share of repeated references tells.
    Repeated,
    /// Inner nodes, the more the further away memory must be: as [`FarMiss`](Self::FarMiss).
    Far,
    /// Branches that the predictor gets wrong.
    Surprise,
    /// Cache lines not in 32 KiB.
    FirstMiss,
    /// Cache lines not in 1 MiB.
    SecondMiss,
    /// These, the more the further away they must be: times log2 of the bytes of tree and objects over 4 MiB, where that is
    /// positive.
    FarMiss,
}

/// Kinds of objects.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Triangle,
    Sphere,
    Cone,
    Polygon,
}

impl Kind {
    fn name(self) -> &'static str {
        match self {
            Self::Triangle => "triangle",
            Self::Sphere => "sphere",
            Self::Cone => "cone",
            Self::Polygon => "polygon",
        }
    }
}

/// Bytes of an object, about: triangles take 72, spheres 32, cones 64, polygons more.
const OBJECT: f64 = 72.0;

/// Bytes up to which memory counts as near: a core's share of the last cache.
const NEAR: f64 = (4 << 20) as f64;

/// How far away the memory of a tree and its objects must be: how often it doubles [`NEAR`].
fn doublings(cell: &CellRecord) -> f64 {
    let memory = cell.bytes as f64 + OBJECT * cell.objects as f64;
    libm::log2(memory / NEAR).max(0.0)
}

impl Term {
    /// Every term: the columns of the fit.
    pub const ALL: [Self; 20] = [
        Self::Ray,
        Self::Inner,
        Self::Leaf,
        Self::EmptyLeaf,
        Self::Test,
        Self::TestOf(Kind::Triangle),
        Self::TestOf(Kind::Sphere),
        Self::TestOf(Kind::Cone),
        Self::TestOf(Kind::Polygon),
        Self::NearOf(Kind::Triangle),
        Self::NearOf(Kind::Sphere),
        Self::NearOf(Kind::Cone),
        Self::NearOf(Kind::Polygon),
        Self::Corner,
        Self::Repeated,
        Self::Far,
        Self::Surprise,
        Self::FirstMiss,
        Self::SecondMiss,
        Self::FarMiss,
    ];

    /// Its column.
    pub fn column(self) -> usize {
        let own = Self::ALL.iter().position(|&term| term == self);
        own.expect("every term is listed")
    }

    /// What one of it is, in tables.
    pub fn name(self) -> String {
        match self {
            Self::Ray => "constant per ray".into(),
            Self::Inner => ConstantRecord::INNER.into(),
            Self::Leaf => ConstantRecord::LEAF.into(),
            Self::EmptyLeaf => "empty leaf".into(),
            Self::Test => ConstantRecord::TEST.into(),
            Self::TestOf(kind) => format!("{} test", kind.name()),
            Self::NearOf(kind) => format!("near {} test", kind.name()),
            Self::Corner => "corner of a near polygon".into(),
            Self::Repeated => "repeated test".into(),
            Self::Far => "inner node, far memory".into(),
            Self::Surprise => ConstantRecord::SURPRISE.into(),
            Self::FirstMiss => "cache miss, 32 KiB".into(),
            Self::SecondMiss => "cache miss, 1 MiB".into(),
            Self::FarMiss => "cache miss of 1 MiB, far memory".into(),
        }
    }

    /// How many of it a ray meets.
    pub fn of(self, row: &Row) -> f64 {
        let s = row.steps;
        let per_ray = |count: u64| count as f64 / s.cast as f64;
        let tests = s.triangle_tests + s.sphere_tests + s.cone_tests + s.polygon_tests;
        match self {
            Self::Ray => 1.0,
            Self::Inner => per_ray(s.inner_visits),
            Self::Leaf => per_ray(s.leaf_visits),
            Self::EmptyLeaf => per_ray(s.empty_leaf_visits),
            Self::Test => per_ray(tests),
            Self::TestOf(kind) => per_ray(match kind {
                Kind::Triangle => s.triangle_tests,
                Kind::Sphere => s.sphere_tests,
                Kind::Cone => s.cone_tests,
                Kind::Polygon => s.polygon_tests,
            }),
            Self::NearOf(kind) => per_ray(match kind {
                Kind::Triangle => s.near_triangles,
                Kind::Sphere => s.near_spheres,
                Kind::Cone => s.near_cones,
                Kind::Polygon => s.near_polygons,
            }),
            Self::Corner => per_ray(s.near_corners),
            Self::Repeated => {
                let once = row.cell.objects as f64 / row.cell.references.max(1) as f64;
                per_ray(tests) * (1.0 - once).max(0.0)
            }
            Self::Far => per_ray(s.inner_visits) * doublings(row.cell),
            Self::Surprise => per_ray(s.surprises),
            Self::FirstMiss => per_ray(s.first_misses),
            Self::SecondMiss => per_ray(s.second_misses),
            Self::FarMiss => per_ray(s.second_misses) * doublings(row.cell),
        }
    }
}

/// Terms that may be added to a model, in place of others.
pub struct Candidate {
    /// What they are, in tables.
    pub name: &'static str,
    /// The terms.
    pub adds: &'static [Term],
    /// Those whose place they take.
    pub replaces: &'static [Term],
}

/// All candidates, to be added to n_K and n_t.
pub const CANDIDATES: [Candidate; 11] = [
    Candidate {
        name: "constant per ray",
        adds: &[Term::Ray],
        replaces: &[],
    },
    Candidate {
        name: "leaves",
        adds: &[Term::Leaf],
        replaces: &[],
    },
    Candidate {
        name: "empty leaves",
        adds: &[Term::EmptyLeaf],
        replaces: &[],
    },
    Candidate {
        name: "tests by kind of object",
        adds: &[
            Term::TestOf(Kind::Triangle),
            Term::TestOf(Kind::Sphere),
            Term::TestOf(Kind::Cone),
            Term::TestOf(Kind::Polygon),
            Term::Corner,
        ],
        replaces: &[Term::Test],
    },
    Candidate {
        name: "tests whose object's box is crossed",
        adds: &[
            Term::NearOf(Kind::Triangle),
            Term::NearOf(Kind::Sphere),
            Term::NearOf(Kind::Cone),
            Term::NearOf(Kind::Polygon),
        ],
        replaces: &[],
    },
    Candidate {
        name: "repeated tests (straddlers)",
        adds: &[Term::Repeated],
        replaces: &[],
    },
    Candidate {
        name: "inner nodes, by memory",
        adds: &[Term::Far],
        replaces: &[],
    },
    Candidate {
        name: "mispredicted branches",
        adds: &[Term::Surprise],
        replaces: &[],
    },
    Candidate {
        name: "misses of a 32 KiB cache",
        adds: &[Term::FirstMiss],
        replaces: &[],
    },
    Candidate {
        name: "misses of a 1 MiB cache",
        adds: &[Term::SecondMiss],
        replaces: &[],
    },
    Candidate {
        name: "misses of a 1 MiB cache, by memory",
        adds: &[Term::FarMiss],
        replaces: &[],
    },
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_of_a_scene_are_one_group() {
        assert_eq!(group("spd:balls:4"), "spd:balls");
        assert_eq!(group("simple:soup"), "simple:soup");
        assert_eq!(group("models/x.obj"), "models/x.obj");
    }

    #[test]
    fn candidates_are_terms_of_their_own() {
        let mut seen = vec![Term::Inner, Term::Test];
        for candidate in &CANDIDATES {
            for term in candidate.adds {
                assert!(!seen.contains(term), "{term:?} twice");
                seen.push(*term);
            }
            assert!(candidate.replaces.iter().all(|term| seen.contains(term)));
        }
        assert_eq!(seen.len(), Term::ALL.len());
    }
}
