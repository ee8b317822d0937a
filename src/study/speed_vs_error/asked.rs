//! What a `speed-vs-error` experiment asks for besides its scenes.

use serde::Deserialize;

use crate::kd::{StopRule, Strategy};
use crate::scene::Scene;
use crate::study::kernel::Kernel;
use crate::study::plan::{Wrong, check_strategies, wrong_unless};

pub use super::method::Method;

/// The keys of this kind. Each part is measured where its section is there.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SpeedVsError {
    /// Strategy of the trees, but for the plane searches'.
    pub strategy: Strategy,
    /// Stop rule of every tree.
    pub stop: StopRule,
    /// How far samplers of lines are off, and how long they take.
    pub samplers: Option<Samplers>,
    /// How far kernels are off, and how long they take.
    pub precision: Option<Precision>,
    /// How dear the trees of plane searches are, and how long they take.
    pub planes: Option<Planes>,
    /// Whether intervals and tests keep their word.
    pub coverage: Option<Coverage>,
    /// What is expected.
    pub expect: Expect,
}

/// Samplers of lines.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Samplers {
    /// Scenes, of the experiment's.
    pub scenes: Vec<String>,
    /// Methods.
    pub methods: Vec<Method>,
    /// Fewest lines of a replicate, a power of two.
    pub from: u64,
    /// Most lines of a replicate, a power of two. Every power of two between is taken, or what the sampler has near it.
    pub to: u64,
    /// Independent replicates of each number of lines, at least 32.
    pub replicates: u32,
    /// Lines of the reference for `lines:nearest`, a power of two; 0: only lines that nothing stops are judged.
    pub reference: u64,
    /// Relative errors of C for which lines and seconds are told.
    pub wanted: Vec<f64>,
    /// Times that every chunk of lines is timed; even.
    pub rounds: u32,
}

/// Kernels.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Precision {
    /// Scenes, of the experiment's.
    pub scenes: Vec<String>,
    /// Kernels.
    pub kernels: Vec<Kernel>,
    /// Offsets of the scene over the longest side of its box.
    pub offsets: Vec<f64>,
    /// Lines of each family.
    pub lines: u64,
    /// Times that every chunk of lines is timed; even.
    pub rounds: u32,
}

/// Plane searches.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Planes {
    /// Scenes, of the experiment's.
    pub scenes: Vec<String>,
    /// Strategies that search; `sah`, the exact one, among them.
    pub strategies: Vec<Strategy>,
    /// Whether objects are clipped to the nodes: one or both.
    pub clipped: Vec<bool>,
    /// Times that every tree is built; even.
    pub builds: u32,
}

/// Runs of one scene by different seeds.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Coverage {
    /// Its scene, of the experiment's.
    pub scene: String,
    /// Runs that judge the slope's interval and the tests.
    pub seeds: u32,
    /// Lines of each.
    pub lines: u64,
    /// Runs of every sampler that judge its intervals of n_K, n_B, n_t and C.
    pub replicates: u32,
    /// Runs of the stopping rule.
    pub stops: u32,
    /// Relative error of C that they ask for.
    pub error: f64,
}

/// Bounds written before the run that they judge.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Expect {
    /// Scrambled Sobol' at the most lines: NRMSE of the nodes times sqrt(N) is at most this.
    pub sobol_nodes: f64,
    /// ... the mean square error of C is at most that of random lines over this.
    pub sobol_gain: f64,
    /// ... the exponent of C's error is at least this.
    pub sobol_exponent: f64,
    /// Scenes on which these hold, of the samplers'; on others they are told, not judged.
    pub judged: Vec<String>,
    /// A plane search that is to be nearly as good as the exact one, if any.
    pub planes: Option<PlaneBound>,
}

/// A plane search that is to be nearly as good as the exact one.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlaneBound {
    /// The strategy.
    pub strategy: Strategy,
    /// Its C is above that of the exact search by at most this share, on every scene, unclipped.
    pub above: f64,
}

/// Fewest replicates: the interval of an RMSE is then -20 % to +32 %.
const FEWEST_REPLICATES: u32 = 32;

impl SpeedVsError {
    /// Whether the values make sense together and with the scenes.
    pub fn check(&self, scenes: &[String]) -> Result<(), Wrong> {
        let known = |key: &'static str, own: &[String]| {
            wrong_unless(!own.is_empty(), key, || {
                format!("{key} must name at least one scene")
            })?;
            own.iter().try_for_each(|scene| {
                wrong_unless(scenes.contains(scene), key, || {
                    format!("{key}: '{scene}' is not among the experiment's scenes")
                })
            })
        };
        let rounds = |key: &'static str, times: u32| {
            wrong_unless(times >= 2 && times.is_multiple_of(2), key, || {
                format!("{key} = {times}, but it must be even and at least 2, for two halves")
            })
        };
        if let Some(part) = &self.samplers {
            known("samplers.scenes", &part.scenes)?;
            known("expect.judged", &self.expect.judged)?;
            wrong_unless(
                part.methods.contains(&Method::Random),
                "samplers.methods",
                || "samplers.methods must name 'random', which the others are held against".into(),
            )?;
            let powers = part.from.is_power_of_two() && part.to.is_power_of_two();
            let range = 64 <= part.from && part.from < part.to && part.to <= 1 << 24;
            wrong_unless(powers && range, "samplers.from", || {
                format!(
                    "samplers.from = {}, samplers.to = {}, but they must be powers of two, from at least 64, to above it and at \
                     most 2^24",
                    part.from, part.to
                )
            })?;
            wrong_unless(
                part.replicates >= FEWEST_REPLICATES,
                "samplers.replicates",
                || {
                    format!(
                        "samplers.replicates = {}, but it must be at least {FEWEST_REPLICATES}",
                        part.replicates
                    )
                },
            )?;
            let long = part.reference == 0
                || part.reference.is_power_of_two() && part.reference >= 32 * part.to;
            wrong_unless(
                long && part.reference <= 1 << 30,
                "samplers.reference",
                || {
                    format!(
                        "samplers.reference = {}, but it must be 0 or a power of two, at least 32 times samplers.to and at most 2^30",
                        part.reference
                    )
                },
            )?;
            let shares = part.wanted.iter().all(|e| *e > 0.0 && *e < 1.0);
            wrong_unless(shares, "samplers.wanted", || {
                "samplers.wanted must be relative errors between 0 and 1".into()
            })?;
            let once =
                (1..part.methods.len()).all(|i| !part.methods[..i].contains(&part.methods[i]));
            wrong_unless(once, "samplers.methods", || {
                "samplers.methods names a method twice".into()
            })?;
            rounds("samplers.rounds", part.rounds)?;
        }
        if let Some(part) = &self.precision {
            known("precision.scenes", &part.scenes)?;
            wrong_unless(!part.kernels.is_empty(), "precision.kernels", || {
                "precision.kernels must name at least one".into()
            })?;
            let offsets = part.offsets.iter().all(|o| (0.0..=1e12).contains(o));
            wrong_unless(
                offsets && !part.offsets.is_empty(),
                "precision.offsets",
                || "precision.offsets must be at least one number of 0 to 1e12".into(),
            )?;
            wrong_unless(
                (64..=1 << 28).contains(&part.lines),
                "precision.lines",
                || {
                    format!(
                        "precision.lines = {}, but it must be 64 to 2^28",
                        part.lines
                    )
                },
            )?;
            rounds("precision.rounds", part.rounds)?;
        }
        if let Some(part) = &self.planes {
            known("planes.scenes", &part.scenes)?;
            check_strategies(&part.strategies)?;
            let exact = part.strategies.contains(&Strategy::Sah);
            wrong_unless(exact, "planes.strategies", || {
                "planes.strategies must name 'sah', the exact search".into()
            })?;
            let once = part.clipped.contains(&false)
                && part.clipped.len() <= 2
                && part.clipped.iter().filter(|c| **c).count() <= 1;
            wrong_unless(once, "planes.clipped", || {
                "planes.clipped must be [false] or [false, true]".into()
            })?;
            rounds("planes.builds", part.builds)?;
            if let Some(bound) = &self.expect.planes {
                let there = part.strategies.contains(&bound.strategy);
                wrong_unless(there && bound.above >= 0.0, "expect.planes", || {
                    format!(
                        "expect.planes: '{}' must be among planes.strategies, and above a number, 0 or more",
                        bound.strategy
                    )
                })?;
            }
        }
        if let Some(part) = &self.coverage {
            known("coverage.scene", std::slice::from_ref(&part.scene))?;
            wrong_unless(
                part.error > 0.0 && part.error < 1.0,
                "coverage.error",
                || {
                    format!(
                        "coverage.error = {}, but it must be between 0 and 1",
                        part.error
                    )
                },
            )?;
        }
        Ok(())
    }

    /// Take so many lines: at most, by samplers; of each family, by kernels.
    pub fn set_lines(&mut self, lines: u64) -> Result<(), String> {
        if let Some(part) = &mut self.samplers {
            part.to = lines;
            part.reference = part.reference.max(32 * lines).min(part.reference * lines);
        }
        if let Some(part) = &mut self.precision {
            part.lines = lines;
        }
        let scenes: Vec<String> = self.named().cloned().collect();
        self.check(&scenes).map_err(|wrong| wrong.message)
    }

    /// Every scene that a part names.
    fn named(&self) -> impl Iterator<Item = &String> {
        let lists = [
            self.samplers.as_ref().map(|part| &part.scenes),
            self.precision.as_ref().map(|part| &part.scenes),
            self.planes.as_ref().map(|part| &part.scenes),
            Some(&self.expect.judged),
        ];
        let one = self.coverage.as_ref().map(|part| &part.scene);
        lists.into_iter().flatten().flatten().chain(one)
    }

    /// Whether the scenes have what the parts need: in f32 only triangles have a test.
    pub fn check_scenes(&self, scenes: &[Scene]) -> Result<(), String> {
        let Some(part) = &self.precision else {
            return Ok(());
        };
        let own = scenes.iter().filter(|s| part.scenes.contains(&s.name));
        for scene in own {
            let others = scene.objects.len() - scene.objects.triangles.len();
            if others > 0 {
                return Err(format!(
                    "{}: {others} of its objects are no triangles, but [precision] takes scenes of triangles alone, as only these \
                     have a test in f32",
                    scene.name
                ));
            }
        }
        Ok(())
    }

    /// Give a scene its full name, wherever a part names it.
    pub fn rename_scene(&mut self, old: &str, name: &str) {
        let lists = [
            self.samplers.as_mut().map(|part| &mut part.scenes),
            self.precision.as_mut().map(|part| &mut part.scenes),
            self.planes.as_mut().map(|part| &mut part.scenes),
            Some(&mut self.expect.judged),
        ];
        let one = self.coverage.as_mut().map(|part| &mut part.scene);
        let all = lists.into_iter().flatten().flatten().chain(one);
        for scene in all.filter(|scene| *scene == old) {
            *scene = name.into();
        }
    }
}
