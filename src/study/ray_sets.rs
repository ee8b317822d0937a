//! Sets of rays by name: a source and what its rays ask, or the rays of a picture by kind, or a user's own.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use crate::geom::Cast;
use crate::kd::{Ask, Rules, StopRule, Strategy, Tree, Work, predict};
use crate::rays::{Source, SourceRays};
use crate::scene::Scene;
use crate::tracer::{RayKind, trace};

use super::hits::cell::build_tree;
use super::lines::check_error;
use super::needed::{Rare, needed};
use super::plan::{Wrong, each_once, wrong_unless};
use crate::cost::CostModel;

/// The name of a set of rays: `SOURCE[:ASK]` such as `lines` or `volume-ray:nearest` (without ASK nothing stops them), or
/// `primary`, `shadow` or `secondary`, the rays of the scene's picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub enum RaysOf {
    /// Rays of a source.
    Source(Source, Ask),
    /// Rays of the picture.
    Traced(RayKind),
    /// A user's own rays, named `own`: only where a file gives them.
    Own(Ask),
}

/// The name of a user's own rays.
const OWN: &str = "own";

impl RaysOf {
    /// What the rays ask.
    pub fn ask(self) -> Ask {
        match self {
            Self::Source(_, ask) | Self::Own(ask) => ask,
            Self::Traced(kind) => kind.ask(),
        }
    }

    /// Sets that an experiment names: each once, at least one.
    pub fn check(sets: &[Self]) -> Result<(), Wrong> {
        each_once("rays", "set of rays", sets)?;
        for set in sets {
            wrong_unless(!matches!(set, Self::Own(_)), "rays", || {
                format!("rays '{OWN}' come from the command line, not from an experiment")
            })?;
        }
        Ok(())
    }
}

impl fmt::Display for RaysOf {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let asks = |name: &str, ask: Ask| match ask {
            Ask::All => name.into(),
            _ => format!("{name}:{ask}"),
        };
        f.pad(&match self {
            Self::Source(source, ask) => asks(source.name(), *ask),
            Self::Traced(kind) => kind.name().into(),
            Self::Own(ask) => asks(OWN, *ask),
        })
    }
}

impl FromStr for RaysOf {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if let Some(kind) = RayKind::ALL.into_iter().find(|kind| kind.name() == text) {
            return Ok(Self::Traced(kind));
        }
        let (name, ask) = text.split_once(':').unwrap_or((text, Ask::All.name()));
        let wrong = |why: String| {
            format!(
                "'{text}' names no rays: {why}; expected SOURCE or SOURCE:ASK, or one of {}",
                RayKind::ALL.map(RayKind::name).join(", ")
            )
        };
        let ask: Ask = ask.parse().map_err(wrong)?;
        if name == OWN {
            return Ok(Self::Own(ask));
        }
        Ok(Self::Source(name.parse().map_err(wrong)?, ask))
    }
}

impl TryFrom<String> for RaysOf {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<RaysOf> for String {
    fn from(rays: RaysOf) -> Self {
        rays.to_string()
    }
}

/// A set of rays.
#[derive(Clone, Debug, PartialEq)]
pub struct Rays {
    /// Its name.
    pub of: RaysOf,
    /// The rays.
    pub casts: Vec<Cast>,
    /// Whether these are all rays there are, so that their counts have no sampling error: of a picture, of a file.
    pub complete: bool,
}

/// Whether a scene can have the rays of these sets; of those of a picture it has none without a look, which is no fault.
///
/// # Errors
/// If it cannot: names the scene.
pub fn check_scene(scene: &Scene, sets: &[RaysOf]) -> Result<(), String> {
    sets.iter().try_for_each(|set| match *set {
        RaysOf::Source(source, _) => SourceRays::new(source, scene, 0).map(|_| ()),
        RaysOf::Traced(_) | RaysOf::Own(_) => Ok(()),
    })
}

/// Whether any of these sets has rays in any of the scenes; the error says why none has.
pub fn check_some(scenes: &[Scene], sets: &[RaysOf]) -> Result<(), String> {
    let pictures = scenes.iter().any(|scene| scene.look.is_some());
    let some = sets
        .iter()
        .any(|set| pictures || !matches!(set, RaysOf::Traced(_)));
    if some {
        return Ok(());
    }
    Err(
        "every set of rays is one of a picture, but no scene has a camera and lights; name a source of rays too, or a scene \
         that has them, such as one named spd:"
            .into(),
    )
}

/// How many rays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Number {
    /// Rays of a source.
    pub rays: u64,
    /// Pixels across and up of the picture; all its rays are taken.
    pub pixels: u32,
    /// Wanted relative error of the cost C in every tree: if given, as many rays of each source as that takes, at least
    /// `rays`.
    pub error: Option<f64>,
}

/// Most rays of a set that a wanted error may ask for: each takes 64 bytes.
const MOST_RAYS: u64 = 1 << 22;

impl Number {
    /// Whether the wanted error can be one.
    pub(super) fn check_error(error: Option<f64>) -> Result<(), Wrong> {
        error.map_or(Ok(()), |error| {
            check_error(error).map_err(|message| Wrong {
                key: "error",
                message,
            })
        })
    }

    /// Rays of a source that are enough in each of these trees.
    fn settle(
        &self,
        scene: &Scene,
        trees: &[(Tree, Rare)],
        cost: CostModel,
        source: &SourceRays,
        ask: Ask,
    ) -> u64 {
        let Some(error) = self.error else {
            return self.rays;
        };
        let bounds = [self.rays.min(MOST_RAYS), MOST_RAYS];
        let one = |(tree, rare): &(Tree, Rare)| {
            needed(error, bounds, rare, |i, stack| {
                let mut work = Work::default();
                let ray = source.cast(i).ray();
                ask.hits(tree, &scene.objects, &ray, stack, &mut work);
                // Whoever hits the root's box visits at least the root.
                (work.inner + work.leaves > 0).then(|| work.cost(cost))
            })
        };
        trees.iter().map(one).max().unwrap_or(self.rays)
    }
}

/// The rays of these sets in a scene; `rules` are of the trees they go through. Sets of traced rays are there only if the scene
/// has a look, and if there is any ray of the kind.
///
/// # Errors
/// If the scene cannot have such rays.
pub fn gather(
    scene: &Scene,
    sets: &[RaysOf],
    number: Number,
    rules: &[Rules],
    seed: u64,
) -> Result<Vec<Rays>, String> {
    // Only a wanted error asks for the trees beforehand.
    let asking = number.error.map_or(&[][..], |_| rules);
    let with_rare = |rules: &Rules| {
        let tree = build_tree(scene, rules);
        let rare = Rare::of(&tree, &predict(&tree), rules.cost);
        (tree, rare)
    };
    let trees: Vec<(Tree, Rare)> = asking.iter().map(with_rare).collect();
    let cost = asking
        .first()
        .map_or(CostModel::WALD_HAVRAN, |rules| rules.cost);
    let traces = sets.iter().any(|set| matches!(set, RaysOf::Traced(_)));
    let traced = scene.look.as_ref().filter(|_| traces).map(|look| {
        // The rays are the same whatever tree they are made with.
        let reference = Rules {
            strategy: Strategy::Sah,
            stop: StopRule::CostGain { depth: None },
            cost: CostModel::WALD_HAVRAN,
            clipped: false,
        };
        trace(scene, look, &build_tree(scene, &reference), number.pixels).rays
    });
    let mut all = Vec::new();
    for &of in sets {
        let casts: Vec<Cast> = match of {
            RaysOf::Source(source, ask) => {
                let rays = SourceRays::new(source, scene, seed)?;
                let enough = number.settle(scene, &trees, cost, &rays, ask);
                (0..enough).map(|i| rays.cast(i)).collect()
            }
            RaysOf::Traced(kind) => traced
                .as_ref()
                .map_or_else(Vec::new, |rays| rays.of(kind).rays.clone()),
            RaysOf::Own(_) => Vec::new(),
        };
        if !casts.is_empty() {
            let complete = matches!(of, RaysOf::Traced(_));
            all.push(Rays {
                of,
                casts,
                complete,
            });
        }
    }
    Ok(all)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_read_back() {
        for text in [
            "lines",
            "lines:nearest",
            "volume-segment:any",
            "beam",
            "primary",
            "shadow",
            "own:nearest",
        ] {
            let rays: RaysOf = text.parse().expect(text);
            assert_eq!(rays.to_string(), text);
        }
        assert_eq!("lines:all".parse::<RaysOf>(), "lines".parse());
        for text in ["", "line", "lines:first", "primary:any", ":any"] {
            let wrong = text.parse::<RaysOf>().expect_err(text);
            assert!(wrong.contains("expected SOURCE"), "{wrong}");
        }
    }

    #[test]
    fn pictures_are_complete_and_need_a_look() {
        let sets = ["lines:nearest", "shadow"].map(|t| t.parse().expect("a set"));
        let number = Number {
            rays: 50,
            pixels: 8,
            error: None,
        };
        let with = Scene::load("spd:balls:1").expect("a scene");
        let rays = gather(&with, &sets, number, &[], 1).expect("rays");
        assert_eq!(
            rays.iter().map(|r| r.complete).collect::<Vec<_>>(),
            [false, true]
        );
        assert_eq!(rays[0].casts.len(), 50);
        let without = Scene::load("simple:soup:20").expect("a scene");
        assert_eq!(
            gather(&without, &sets, number, &[], 1).expect("rays").len(),
            1
        );
    }
}
