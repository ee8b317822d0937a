//! What a `speed-vs-error` experiment asks for besides its scenes.

use serde::{Deserialize, Serialize};

use crate::kd::{StopRule, Strategy};
use crate::scene::Scene;
use crate::study::kernel::Kernel;

use super::check::LONGER;

pub use super::method::Method;

/// The keys of this kind. Each part is measured where its section is there.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
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
    #[serde(default)]
    pub expect: Expect,
}

/// Samplers of lines.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
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
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
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
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
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
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
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

/// Bounds written before the run that they judge. Kernels and coverage have theirs by nature.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Expect {
    /// Of scrambled Sobol' lines.
    pub sobol: Option<SobolBounds>,
    /// A plane search that is to be nearly as good as the exact one.
    pub planes: Option<PlaneBound>,
}

/// What scrambled Sobol' lines are to reach at the most lines, on these scenes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SobolBounds {
    /// The scenes, of the samplers'; on others it is told, not judged.
    pub scenes: Vec<String>,
    /// NRMSE of the nodes times sqrt(N), at most.
    pub nodes: f64,
    /// Mean square error of C by random lines over that by these, at least.
    pub gain: f64,
    /// Exponent of C's error, at least.
    pub exponent: f64,
}

/// A plane search that is to be nearly as good as the exact one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlaneBound {
    /// The strategy.
    pub strategy: Strategy,
    /// Its C is above that of the exact search by at most this share, on every scene, unclipped.
    pub above: f64,
}

impl SpeedVsError {
    /// Take so many lines: at most, by samplers; of each family, by kernels.
    pub fn set_lines(&mut self, lines: u64) -> Result<(), String> {
        if let Some(part) = &mut self.samplers {
            part.to = lines;
            if part.reference > 0 {
                part.reference = part.reference.max(LONGER * lines);
            }
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
            self.expect.sobol.as_ref().map(|bounds| &bounds.scenes),
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
            self.expect.sobol.as_mut().map(|bounds| &mut bounds.scenes),
        ];
        let one = self.coverage.as_mut().map(|part| &mut part.scene);
        let all = lists.into_iter().flatten().flatten().chain(one);
        for scene in all.filter(|scene| *scene == old) {
            *scene = name.into();
        }
    }
}
