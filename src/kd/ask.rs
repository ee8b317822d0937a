//! What a ray asks of a tree.

use std::fmt;
use std::str::FromStr;

use crate::geom::{Ray, Targets, Vector};

use super::hits::{all_watched, any_watched, nearest_watched};
use super::{Hit, Probe, Stack, Walk};

/// What a ray asks, and so how early its traversal ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Ask {
    /// Nothing stops it: every object of every leaf it meets is tested. The metric's own ray (MacDonald & Booth 1990).
    All,
    /// Its nearest hit: it ends where no later leaf can hold a nearer one.
    Nearest,
    /// Any hit: it ends with the first object found, as a shadow ray does.
    Any,
}

impl Ask {
    /// Each of them.
    pub const ALL: [Self; 3] = [Self::All, Self::Nearest, Self::Any];

    /// The name in files and on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::All => "all",
            Self::Nearest => "nearest",
            Self::Any => "any",
        }
    }

    /// Trace a ray; says whether it hits anything within its span.
    #[inline]
    pub fn hits<W: Walk>(
        self,
        walk: &W,
        objects: &(impl Targets<Vector = W::Vector> + ?Sized),
        ray: &Ray<W::Vector>,
        stack: &mut Stack<<W::Vector as Vector>::Real>,
        probe: impl Probe,
    ) -> bool {
        self.trace(walk, objects, ray, stack, probe).is_some()
    }

    /// Trace a ray; gives its nearest hit within its span, or of a ray that asks for any hit the one that ended it. Of a ray
    /// that nothing stops that is the nearest hit too: what is asked sets the work, not the answer.
    #[inline]
    pub fn trace<W: Walk>(
        self,
        walk: &W,
        objects: &(impl Targets<Vector = W::Vector> + ?Sized),
        ray: &Ray<W::Vector>,
        stack: &mut Stack<<W::Vector as Vector>::Real>,
        probe: impl Probe,
    ) -> Option<Hit<<W::Vector as Vector>::Real>> {
        match self {
            Self::All => all_watched(walk, objects, ray, stack, probe),
            Self::Nearest => nearest_watched(walk, objects, ray, stack, probe),
            Self::Any => any_watched(walk, objects, ray, stack, probe),
        }
    }
}

impl FromStr for Ask {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let named = Self::ALL.into_iter().find(|ask| ask.name() == text);
        named.ok_or_else(|| {
            let names = Self::ALL.map(Self::name).join(", ");
            format!("'{text}' is nothing a ray can ask; expected one of {names}")
        })
    }
}

impl fmt::Display for Ask {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}
