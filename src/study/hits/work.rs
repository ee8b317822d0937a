//! Sets of rays that are traced through every tree, beside the lines that are counted.

use serde::{Deserialize, Serialize};

use crate::geom::Cast;
use crate::kd::{Ask, Rules};
use crate::scene::Scene;
use crate::study::plan::{Wrong, wrong_unless};
use crate::study::ray_sets::{Number, Rays, RaysOf, gather};
use crate::study::{guess, identity};

/// Which rays: the section `[work]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Work {
    /// Sets of rays by name; those of a picture are met by scenes that have a look.
    pub rays: Vec<RaysOf>,
    /// Rays of each set that has no end of them.
    pub number: u64,
    /// Wanted relative error of the cost C in every tree by the rays of every source: as many as that takes, at least `number`.
    pub error: Option<f64>,
    /// Pixels across and up of the picture whose rays are taken.
    pub pixels: u32,
    /// A user's own rays, from the command line.
    #[serde(skip)]
    pub own: Option<Own>,
}

/// Fewest rays of a set: standard errors need a few.
const FEWEST: u64 = 16;
/// Most rays of a set: each takes 64 bytes.
const MOST: u64 = 1 << 26;
/// Most pixels across.
const MOST_PIXELS: u32 = 2048;

impl Work {
    /// Whether the values make sense.
    pub fn check(&self) -> Result<(), Wrong> {
        RaysOf::check(&self.rays).map_err(|wrong| Wrong {
            key: "work.rays",
            message: wrong.message,
        })?;
        wrong_unless(
            (FEWEST..=MOST).contains(&self.number),
            "work.number",
            || {
                format!(
                    "work.number = {}, but it must be {FEWEST} to {MOST}",
                    self.number
                )
            },
        )?;
        Number::check_error(self.error)?;
        wrong_unless(
            (1..=MOST_PIXELS).contains(&self.pixels),
            "work.pixels",
            || {
                format!(
                    "work.pixels = {}, but it must be 1 to {MOST_PIXELS}",
                    self.pixels
                )
            },
        )
    }

    /// What the counts depend on besides the tree and the scene.
    pub fn identity(&self) -> String {
        let rays: Vec<String> = self.rays.iter().map(RaysOf::to_string).collect();
        let own = self.own.as_ref().map(|own| (own.rays.of, &own.content));
        format!(
            "rays {rays:?} {} {:?} pixels {} own {own:?}",
            self.number, self.error, self.pixels
        )
    }

    /// Rays through each tree of a scene; where a wanted error settles how many, the fewest.
    pub fn size(&self, scene: &Scene) -> u64 {
        let own = self.own.as_ref().map_or(0, |own| own.rays.casts.len());
        guess::rays_of(scene, &self.rays, self.sizes()) + own as u64
    }

    /// How many rays of each set.
    fn sizes(&self) -> Number {
        Number {
            rays: self.number,
            pixels: self.pixels,
            error: self.error,
        }
    }

    /// The sets in words.
    pub fn describe(&self) -> String {
        let own = self.own.iter();
        let own = own.map(|own| format!("{} ({})", own.rays.of, own.rays.casts.len()));
        let others = self.rays.iter().map(RaysOf::to_string);
        let sets: Vec<String> = own.chain(others).collect();
        format!(
            "through each tree: rays {} ({} of a set, a picture of {} pixels across)",
            sets.join(", "),
            self.number,
            self.pixels
        )
    }
}

/// A user's own rays.
#[derive(Clone, Debug, PartialEq)]
pub struct Own {
    /// The rays: all there are.
    rays: Rays,
    /// Digest of them.
    content: String,
}

impl Own {
    /// These rays, asking this.
    pub fn new(casts: Vec<Cast>, ask: Ask) -> Self {
        Self {
            content: identity::rays(&casts),
            rays: Rays {
                of: RaysOf::Own(ask),
                casts,
                complete: true,
            },
        }
    }
}

/// The rays of one scene after the other, whose trees have these rules, gathered when the first tree that needs them comes.
pub(super) struct Gathered<'a> {
    asked: Option<&'a Work>,
    scene: Option<String>,
    rays: Vec<Rays>,
}

impl<'a> Gathered<'a> {
    pub(super) fn new(asked: Option<&'a Work>) -> Self {
        Self {
            asked,
            scene: None,
            rays: Vec::new(),
        }
    }

    /// The sets of a scene, own rays first.
    pub(super) fn of(
        &mut self,
        scene: &Scene,
        rules: &[Rules],
        seed: u64,
    ) -> Result<Vec<&Rays>, String> {
        let Some(asked) = self.asked else {
            return Ok(Vec::new());
        };
        if self.scene.as_ref() != Some(&scene.name) {
            self.rays = gather(scene, &asked.rays, asked.sizes(), rules, seed)?;
            self.scene = Some(scene.name.clone());
        }
        let own = asked.own.iter().map(|own| &own.rays);
        Ok(own.chain(&self.rays).collect())
    }
}
