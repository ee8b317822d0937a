//! What a hard case is: a name, the property it stresses, and a check that tells what is right and what came out.

use std::sync::Arc;

use crate::kd::Rules;
use crate::study::kernel::Kernel;

/// What a case is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Group {
    /// Lines and rays.
    Lines,
    /// Boxes.
    Boxes,
    /// Triangles.
    Triangles,
    /// Spheres.
    Spheres,
    /// Cones and cylinders.
    Cones,
    /// Polygons.
    Polygons,
    /// Building and traversal of trees.
    Trees,
    /// Scene, ray and experiment files.
    Files,
    /// Statistics.
    Statistics,
}

impl Group {
    /// Each of them.
    pub const ALL: [Self; 9] = [
        Self::Lines,
        Self::Boxes,
        Self::Triangles,
        Self::Spheres,
        Self::Cones,
        Self::Polygons,
        Self::Trees,
        Self::Files,
        Self::Statistics,
    ];

    /// The name in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Lines => "lines",
            Self::Boxes => "boxes",
            Self::Triangles => "triangles",
            Self::Spheres => "spheres",
            Self::Cones => "cones",
            Self::Polygons => "polygons",
            Self::Trees => "trees",
            Self::Files => "files",
            Self::Statistics => "statistics",
        }
    }
}

/// A hard case.
#[derive(Clone)]
pub struct Case {
    /// Its name, e.g. `corner-touch`: on the command line, in files, in the matrix.
    pub name: &'static str,
    /// What it is about.
    pub group: Group,
    /// The property it stresses, in a few words.
    pub stresses: &'static str,
    /// How it is checked.
    pub check: Check,
}

/// A check by a kernel.
pub type ByKernel = dyn Fn(Kernel) -> Option<Finding> + Send + Sync;

/// A check in a tree by a kernel.
pub type ByTree = dyn Fn(&Rules, Kernel) -> Option<Finding> + Send + Sync;

/// How a case is checked: once, by every kernel, or through the tree of every strategy by every kernel.
#[derive(Clone)]
pub enum Check {
    /// Depends neither on a kernel nor on a tree.
    Once(fn() -> Finding),
    /// By a kernel; `None` where it is not for this one.
    Kernels(Arc<ByKernel>),
    /// In a tree of these rules by a kernel; `None` where it is not for this one.
    Trees(Arc<ByTree>),
}

/// What came of a check.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// What is exactly right, as told in tables: a few words or numbers.
    pub expected: String,
    /// What came out, told likewise.
    pub measured: String,
    /// What that means.
    pub outcome: Outcome,
    /// Whether the verdict demands that it passes or is off. A case and a kernel fix it, not what came out; that no check
    /// panics or hangs and that every tree is sound is demanded of all.
    pub demanded: bool,
}

/// What a check's result means.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outcome {
    /// As expected; a refusal that is expected is one.
    Pass,
    /// Off by so many units in the last place, or as the case says, and no more than is allowed where it is demanded.
    Off(f64),
    /// Refused with a message, where an answer is expected.
    Refused,
    /// Wrong.
    Failed,
}

impl Outcome {
    /// The name in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Pass => "pass",
            Self::Off(_) => "off",
            Self::Refused => "refused",
            Self::Failed => "failed",
        }
    }
}

impl Finding {
    /// Demanded, and failed for a reason that is told.
    pub fn failed(expected: impl ToString, measured: impl ToString) -> Self {
        Self {
            expected: expected.to_string(),
            measured: measured.to_string(),
            outcome: Outcome::Failed,
            demanded: true,
        }
    }

    /// Demanded: what came out must read as what is expected.
    pub fn of(expected: impl ToString, measured: impl ToString) -> Self {
        let (expected, measured) = (expected.to_string(), measured.to_string());
        let right = expected == measured;
        Self::judged(expected, measured, right)
    }

    /// Demanded, with what came out and whether that is right.
    pub fn judged(expected: impl ToString, measured: impl ToString, right: bool) -> Self {
        Self {
            expected: expected.to_string(),
            measured: measured.to_string(),
            outcome: if right {
                Outcome::Pass
            } else {
                Outcome::Failed
            },
            demanded: true,
        }
    }
}
