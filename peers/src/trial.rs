//! The clock: jobs run in rounds of random order, on one thread.

use std::cell::RefCell;
use std::time::Instant;

use rand::SeedableRng;
use rand::rngs::ChaCha8Rng;
use rand::seq::SliceRandom;

use crate::ratio::Times;
use crate::{Mesh, Peer, Ray, Tracer, ours};

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

/// The jobs of one work on one scene.
pub struct Plan<'a> {
    /// The work.
    pub work: Work,
    /// The scene, after a colon the rays if they are not isotropic ones.
    pub scene: String,
    /// What a pass does, in the units of the work.
    pub amount: f64,
    /// Who does it.
    pub jobs: Vec<Job<'a>>,
}

/// What the jobs of a plan took.
pub struct Contest {
    /// As in the plan.
    pub work: Work,
    /// As in the plan.
    pub scene: String,
    /// As in the plan.
    pub amount: f64,
    /// Times by job.
    pub times: Vec<(String, Times)>,
}

/// Run all plans, one after the other in every round, so that no plan has all its rounds in one bad minute. A plan's jobs
/// follow each other in a fresh random order every round.
pub fn run(mut plans: Vec<Plan>, rounds: usize) -> Vec<Contest> {
    let mut generator = ChaCha8Rng::seed_from_u64(1);
    let none = |plan: &Plan| vec![Times::default(); plan.jobs.len()];
    let mut times: Vec<Vec<Times>> = plans.iter().map(none).collect();
    for _ in 0..rounds {
        for (plan, times) in plans.iter_mut().zip(&mut times) {
            let mut order: Vec<usize> = (0..plan.jobs.len()).collect();
            order.shuffle(&mut generator);
            for i in order {
                times[i].add_round(plan.jobs[i].1());
            }
        }
    }
    let contest = |(plan, times): (Plan, Vec<Times>)| Contest {
        work: plan.work,
        scene: plan.scene,
        amount: plan.amount,
        times: plan.jobs.into_iter().map(|job| job.0).zip(times).collect(),
    };
    plans.into_iter().zip(times).map(contest).collect()
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
pub fn builds<'a>(peers: &'a [Box<dyn Peer>], scene: &str, mesh: &'a Mesh) -> Plan<'a> {
    let able = all(peers).filter(|p| mesh.len() <= p.most_triangles());
    let job = |peer: &'a dyn Peer| -> Job<'a> {
        let build = move || seconds(|| peer.build(mesh));
        (peer.name().into(), Box::new(build))
    };
    Plan {
        work: Work::Build,
        scene: scene.into(),
        amount: mesh.len() as f64,
        jobs: able.map(job).collect(),
    }
}

/// What everybody has built of a mesh, by name; asked by several plans in turn.
pub type Built<'a> = Vec<(String, RefCell<Box<dyn Tracer + 'a>>)>;

/// Build once.
pub fn build_all<'a>(peers: &'a [Box<dyn Peer>], mesh: &'a Mesh) -> Built<'a> {
    let named = |peer: &'a dyn Peer| (peer.name().into(), RefCell::new(peer.build(mesh)));
    all(peers).map(named).collect()
}

fn all(peers: &[Box<dyn Peer>]) -> impl Iterator<Item = &dyn Peer> {
    peers.iter().map(Box::as_ref)
}

/// Rays of which the least time is taken one by one.
const CHUNK: usize = 4096;

/// One chunk of so many is traced by those who take rays one after the other: their rates do not depend on how many there
/// are.
const EVERY: usize = 16;

/// Each chunk's seconds. The first rays are traced before the clock starts, as another peer's data filled the caches.
fn chunks<T: Clone>(
    rays: &[Ray],
    takes_all: bool,
    none: T,
    mut trace: impl FnMut(&[Ray], &mut [T]),
) -> Vec<f64> {
    let (size, every) = if takes_all {
        (rays.len(), 1)
    } else {
        (CHUNK, EVERY)
    };
    let mut hits = vec![none; size];
    for chunk in rays.chunks(CHUNK).take(2) {
        trace(chunk, &mut hits[..chunk.len()]);
    }
    let time = |chunk: &[Ray]| {
        let traced = seconds(|| trace(chunk, &mut hits[..chunk.len()]));
        traced.into_iter().map(|s| s * every as f64)
    };
    rays.chunks(size).step_by(every).flat_map(time).collect()
}

/// The same rays through everything that has been built: nearest hits, and any hits.
///
/// # Panics
/// If the rays are no multiple of what is traced of them.
pub fn traces<'a>(built: &'a Built, scene: &str, rays: &'a [Ray]) -> [Plan<'a>; 2] {
    assert_eq!(rays.len() % (CHUNK * EVERY), 0, "whole chunks");
    let nearest = built.iter().map(|(name, tracer)| -> Job<'a> {
        let nearest = || {
            let mut tracer = tracer.borrow_mut();
            let all = tracer.takes_all();
            chunks(rays, all, 0.0, |rays, hits| tracer.nearest(rays, hits))
        };
        (name.clone(), Box::new(nearest))
    });
    let any = built.iter().map(|(name, tracer)| -> Job<'a> {
        let any = || {
            let mut tracer = tracer.borrow_mut();
            let all = tracer.takes_all();
            chunks(rays, all, false, |rays, hits| tracer.any(rays, hits))
        };
        (name.clone(), Box::new(any))
    });
    [
        (Work::Nearest, nearest.collect()),
        (Work::Any, any.collect()),
    ]
    .map(|(work, jobs)| Plan {
        work,
        scene: scene.into(),
        amount: rays.len() as f64,
        jobs,
    })
}

/// How many rays have a nearest hit, or any, that differs from those of our plain loop ([`ours::UNCLIPPED`]).
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

/// Compare everybody's hits of the rays that all are timed with with those of our plain loop: t may differ by 1e-4 of itself and 1e-6 of
/// the world's diagonal.
///
/// # Panics
/// If our plain loop is not among them.
pub fn compare(built: &Built, scene: &str, rays: &[Ray], mesh: &Mesh) -> Vec<Disagreement> {
    let slack = 1e-6 * (mesh.world.hi - mesh.world.lo).length() as f32;
    let same = |a: f32, b: f32| a == b || (a - b).abs() <= 1e-4 * a.abs() + slack;
    let rays: Vec<Ray> = rays
        .chunks(CHUNK)
        .step_by(EVERY)
        .flatten()
        .copied()
        .collect();
    let rays = &rays[..];
    let answer = |tracer: &RefCell<Box<dyn Tracer + '_>>| {
        let mut tracer = tracer.borrow_mut();
        let mut nearest = vec![0.0; rays.len()];
        let mut any = vec![false; rays.len()];
        tracer.nearest(rays, &mut nearest);
        tracer.any(rays, &mut any);
        (nearest, any)
    };
    let plain = built.iter().find(|(name, _)| name == ours::UNCLIPPED);
    let (_, plain) = plain.expect("our plain loop is among them");
    let (nearest, any) = answer(plain);
    let others = built.iter().filter(|(name, _)| name != ours::UNCLIPPED);
    let differing = others.map(|(peer, tracer)| {
        let (its_nearest, its_any) = answer(tracer);
        let unlike = nearest.iter().zip(&its_nearest);
        Disagreement {
            peer: peer.clone(),
            scene: scene.into(),
            rays: rays.len(),
            nearest: unlike.filter(|(a, b)| !same(**a, **b)).count(),
            any: any.iter().zip(&its_any).filter(|(a, b)| a != b).count(),
        }
    });
    differing.collect()
}
