//! The clock: jobs of one contest run in rounds of random order, on one thread.

use std::time::Instant;

use rand::SeedableRng;
use rand::rngs::ChaCha8Rng;
use rand::seq::SliceRandom;

use crate::ratio::Times;
use crate::{Mesh, Peer, Ray, Tracer};

/// What is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Work {
    /// From flat corners to something that traces; triangles per second.
    Build,
    /// Nearest hits; rays per second.
    Nearest,
    /// Any hits; rays per second.
    Any,
    /// Hits of every node by lines that nothing stops; visits per second.
    Count,
    /// Making isotropic lines; lines per second.
    Lines,
}

impl Work {
    /// The name in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Build => "build",
            Self::Nearest => "nearest",
            Self::Any => "any",
            Self::Count => "count",
            Self::Lines => "lines",
        }
    }
}

/// A job: its name, and a pass that gives the seconds of its chunks.
pub type Job<'a> = (String, Box<dyn FnMut() -> Vec<f64> + 'a>);

/// What the jobs of one work on one scene took.
pub struct Contest {
    /// The work.
    pub work: Work,
    /// The scene, after a colon the rays if they are not isotropic ones.
    pub scene: String,
    /// What a pass does, in the units of the work.
    pub amount: f64,
    /// Times by job.
    pub times: Vec<(String, Times)>,
}

impl Contest {
    /// Run all jobs, in a fresh random order every round.
    pub fn run(
        work: Work,
        scene: impl Into<String>,
        amount: f64,
        rounds: usize,
        mut jobs: Vec<Job>,
    ) -> Self {
        let mut generator = ChaCha8Rng::seed_from_u64(1);
        let mut order: Vec<usize> = (0..jobs.len()).collect();
        let mut times = vec![Times::default(); jobs.len()];
        for _ in 0..rounds {
            order.shuffle(&mut generator);
            for &i in &order {
                times[i].add_round(jobs[i].1());
            }
        }
        let names = jobs.into_iter().map(|job| job.0);
        Self {
            work,
            scene: scene.into(),
            amount,
            times: names.zip(times).collect(),
        }
    }
}

/// Seconds of a job as a whole; what it makes is dropped after the clock has stopped.
pub fn seconds<T>(job: impl FnOnce() -> T) -> Vec<f64> {
    let started = Instant::now();
    let made = std::hint::black_box(job());
    let seconds = started.elapsed().as_secs_f64();
    drop(made);
    vec![seconds]
}

/// All that build a mesh of this size in a sensible time build it.
pub fn builds(peers: &[Box<dyn Peer>], scene: &str, mesh: &Mesh, rounds: usize) -> Contest {
    let able = peers.iter().filter(|p| mesh.len() <= p.most_triangles());
    let job = |peer| -> Job {
        let peer: &dyn Peer = peer;
        (
            peer.name().into(),
            Box::new(|| seconds(|| peer.build(mesh))),
        )
    };
    let jobs = able.map(|peer| job(peer.as_ref())).collect();
    Contest::run(Work::Build, scene, mesh.len() as f64, rounds, jobs)
}

/// Rays of which the least time is taken one by one.
const CHUNK: usize = 4096;

/// Each chunk's seconds. The first rays are traced before the clock starts, as another peer's data filled the caches.
fn chunks<T: Clone>(rays: &[Ray], none: T, mut trace: impl FnMut(&[Ray], &mut [T])) -> Vec<f64> {
    let mut hits = vec![none; CHUNK];
    for chunk in rays.chunks(CHUNK).take(2) {
        trace(chunk, &mut hits[..chunk.len()]);
    }
    let time = |chunk: &[Ray]| seconds(|| trace(chunk, &mut hits[..chunk.len()]));
    rays.chunks(CHUNK).flat_map(time).collect()
}

/// The same rays through everything that has been built: nearest hits, and any hits.
pub fn traces(
    built: &mut [(String, Box<dyn Tracer + '_>)],
    scene: &str,
    rays: &[Ray],
    rounds: usize,
) -> [Contest; 2] {
    let amount = rays.len() as f64;
    let jobs = built.iter_mut().map(|(name, tracer)| -> Job {
        let nearest = || chunks(rays, 0.0, |rays, hits| tracer.nearest(rays, hits));
        (name.clone(), Box::new(nearest))
    });
    let nearest = Contest::run(Work::Nearest, scene, amount, rounds, jobs.collect());
    let jobs = built.iter_mut().map(|(name, tracer)| -> Job {
        let any = || chunks(rays, false, |rays, hits| tracer.any(rays, hits));
        (name.clone(), Box::new(any))
    });
    [
        nearest,
        Contest::run(Work::Any, scene, amount, rounds, jobs.collect()),
    ]
}

/// How many rays have a nearest hit, or any, that differs from the first contestant's.
#[derive(Clone, Debug)]
pub struct Disagreement {
    /// Who differs.
    pub peer: String,
    /// The scene and rays.
    pub scene: String,
    /// Rays asked.
    pub rays: usize,
    /// Nearest hits lost, found where there is none, or at another t.
    pub nearest: usize,
    /// Hits lost, or found where there is none.
    pub any: usize,
}

/// Compare everybody's hits with the first one's: t may differ by 1e-4 of itself and 1e-6 of the world's diagonal.
pub fn compare(
    built: &mut [(String, Box<dyn Tracer + '_>)],
    scene: &str,
    rays: &[Ray],
    mesh: &Mesh,
) -> Vec<Disagreement> {
    let slack = 1e-6 * (mesh.world.hi - mesh.world.lo).length() as f32;
    let same = |a: f32, b: f32| a == b || (a - b).abs() <= 1e-4 * a.abs() + slack;
    let mut answers = built.iter_mut().map(|(name, tracer)| {
        let mut nearest = vec![0.0; rays.len()];
        let mut any = vec![false; rays.len()];
        tracer.nearest(rays, &mut nearest);
        tracer.any(rays, &mut any);
        (name.clone(), nearest, any)
    });
    let Some((_, nearest, any)) = answers.next() else {
        return Vec::new();
    };
    let differing = answers.map(|(peer, its_nearest, its_any)| Disagreement {
        peer,
        scene: scene.into(),
        rays: rays.len(),
        nearest: nearest
            .iter()
            .zip(&its_nearest)
            .filter(|(a, b)| !same(**a, **b))
            .count(),
        any: any.iter().zip(&its_any).filter(|(a, b)| a != b).count(),
    });
    differing.collect()
}
