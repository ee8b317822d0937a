//! All that is demanded of a tree and of a kernel's way through it.

use glam::Vec3;

use crate::geom::{Object, Ray, Span, Targets, Vector};
use crate::kd::audit::{audit, audit_clipped};
use crate::kd::hits::nearest_in;
use crate::kd::narrow::{Refusal, narrow_line};
use crate::kd::{
    Counting, Hit, Mode, NarrowTree, NoProbe, Planes, Rules, Stack, Tracing, Tree, build_objects,
    nearest,
};
use crate::scene::Scene;
use crate::study::incidence::{Exact, Narrow, Subject, Tally, Visits, nodes};
use crate::study::kernel::Kernel;
use crate::study::stability::case::{Finding, Outcome};

use super::TreeCase;
use super::hard_rays::hard_rays;

/// Depth up to which a full tree is small: deeper ones must be stopped by their objects.
const SHALLOW: usize = 16;

/// Most nodes an object of a tree that may be deeper.
const MOST_AN_OBJECT: usize = 64;

/// Most references a node, in the mean.
const MOST_A_NODE: usize = 16;

/// Build, and follow the hard rays.
pub fn examine(case: &TreeCase, rules: &Rules, kernel: Kernel) -> Finding {
    let scene = match Scene::load(case.scene) {
        Ok(scene) => scene,
        Err(error) => return Finding::failed("a scene", error),
    };
    let most = rules.stop.depth_bound(scene.bounds.len());
    let expected = format!("depth at most {most}, every visit and nearest hit right");
    let tree = build_objects(&scene.objects, &scene.bounds, scene.world, rules);
    if let Err(fault) = sound(case, &scene, &tree, most) {
        return Finding::failed(expected, fault);
    }
    // Unpadded f32 promises nothing but to refuse what is too coarse for it.
    let demanded = kernel != Kernel::F32 || case.refused_in_f32;
    let narrow = (kernel != Kernel::F64).then(|| NarrowTree::of(&tree));
    let narrow = match narrow.transpose() {
        Ok(Some(_)) if case.refused_in_f32 => {
            return Finding::failed("refused in single precision", "taken");
        }
        Ok(narrow) => narrow.map(|(narrow, _)| Narrow::new(narrow, &scene.objects.triangles)),
        Err(refusal) => {
            return Finding {
                expected: if case.refused_in_f32 {
                    "refused in single precision".into()
                } else {
                    expected
                },
                measured: refusal.to_string(),
                outcome: if case.refused_in_f32 {
                    Outcome::Pass
                } else {
                    Outcome::Refused
                },
                demanded,
            };
        }
    };
    let rays = hard_rays(&scene, &tree);
    let followed = match &narrow {
        None => Ok(in_f64(&scene, &tree, &rays)),
        Some(narrow) if kernel == Kernel::F32 => in_f32::<Counting>(&scene, narrow, &rays),
        Some(narrow) => in_f32::<Tracing>(&scene, narrow, &rays),
    };
    match followed {
        Ok((tally, differing)) => {
            let Tally {
                cases,
                wrong,
                missed,
                ties,
                tied_wrong,
                tied_missed,
                ..
            } = tally;
            let hits = match differing {
                Some(n) => format!(", {n} of {} nearest hits differ", rays.len()),
                None => String::new(),
            };
            let mut measured = format!(
                "depth {}, {cases} visits judged: {wrong} wrong, {missed} missed",
                tree.depth
            );
            if ties > 0 {
                measured += &format!(" ({} and {} of {ties} ties)", tied_wrong, tied_missed);
            }
            Finding {
                expected,
                measured: measured + &hits,
                outcome: judge(kernel, &tally, differing.unwrap_or(0)),
                demanded,
            }
        }
        Err(refusal) => Finding {
            expected,
            measured: refusal.to_string(),
            outcome: Outcome::Refused,
            demanded,
        },
    }
}

/// What a kernel's errors mean: `f64` may err in ties only, padded planes may only visit too much, and both must find each nearest
/// hit; what unpadded `f32` gets wrong is counted.
fn judge(kernel: Kernel, tally: &Tally, differing: u64) -> Outcome {
    let errors = tally.wrong + tally.missed;
    let must = match kernel {
        Kernel::F64 => errors + differing,
        Kernel::F32Padded => tally.missed + tally.tied_missed + differing,
        Kernel::F32 => 0,
    };
    let off = match kernel {
        Kernel::F64 | Kernel::F32Padded => 0,
        Kernel::F32 => errors + tally.tied_wrong + tally.tied_missed + differing,
    };
    match (must, off) {
        (0, 0) => Outcome::Pass,
        (0, off) => Outcome::Off(off as f64),
        _ => Outcome::Failed,
    }
}

/// What holds of every tree, and what is known of this one.
fn sound(case: &TreeCase, scene: &Scene, tree: &Tree, most: usize) -> Result<(), String> {
    let audited = if case.clipped {
        audit_clipped(tree, &scene.objects, &scene.bounds)
    } else {
        audit(tree, &scene.bounds)
    };
    audited.map_err(|faults| faults.join("; "))?;
    if tree.depth > most {
        return Err(format!("depth {}", tree.depth));
    }
    let bound = if most <= SHALLOW {
        (2 << most) - 1
    } else {
        MOST_AN_OBJECT * (scene.bounds.len() + 1)
    };
    let (nodes, references) = (tree.nodes.len(), tree.references.len());
    if nodes > bound || references > MOST_A_NODE * bound {
        return Err(format!(
            "{nodes} nodes and {references} references, at most {bound} and {MOST_A_NODE} times as many expected"
        ));
    }
    let found = [tree.leaves(), references];
    match case.known {
        Some(known) if known != found => Err(format!(
            "{} leaves and {} references, {} and {} expected",
            found[0], found[1], known[0], known[1]
        )),
        _ => Ok(()),
    }
}

/// Every node that the lines visit or should, judged.
fn visits<M: Mode, T: Planes<Vector: Exact>>(
    subject: &Subject<'_, T>,
    rays: &[Ray<T::Vector>],
) -> Tally {
    let (mut tally, mut visits) = (Tally::default(), Visits::default());
    for ray in rays {
        let visited = visits.follow::<M, T>(subject.tree, &ray.line);
        tally += Tally::of_a_line(&nodes(subject, &ray.line, visited));
    }
    tally
}

/// The verdicts on what a kernel visits, and rays whose nearest hit through the tree is not that of testing every object, bit for
/// bit, or is not a number. The latter `None` where the kernel has no test for the objects.
type Followed = (Tally, Option<u64>);

fn in_f64(scene: &Scene, tree: &Tree, rays: &[Ray]) -> Followed {
    let objects = &scene.objects;
    let mut stack = Stack::default();
    let mut differing = 0;
    for ray in rays {
        let through = nearest(tree, objects, ray, &mut stack);
        let best = brute_force(objects, objects.len(), ray);
        let sane = through.is_none_or(|hit| hit.t.is_finite() && has_area(objects.get(hit.object)));
        differing += u64::from(through != best || !sane);
    }
    let subject = Subject::new(tree, &objects.triangles);
    (visits::<Counting, _>(&subject, rays), Some(differing))
}

fn in_f32<M: Mode>(scene: &Scene, narrow: &Narrow, rays: &[Ray]) -> Result<Followed, Refusal> {
    let subject = narrow.subject();
    let narrow_ray = |ray: &Ray| {
        let span = Span {
            t0: ray.span.t0 as f32,
            t1: ray.span.t1 as f32,
        };
        Ok(Ray::new(narrow_line(&ray.line)?, span))
    };
    let rays: Vec<Ray<Vec3>> = rays.iter().map(narrow_ray).collect::<Result<_, _>>()?;
    let tally = visits::<M, _>(&subject, &rays);
    let triangles = subject.triangles;
    if triangles.len() < scene.objects.len() {
        return Ok((tally, None));
    }
    let mut differing = 0;
    let mut stack = Stack::default();
    for ray in &rays {
        let through = nearest_in::<M, _>(subject.tree, triangles, ray, &mut stack, NoProbe);
        differing += u64::from(through != brute_force(triangles, triangles.len(), ray));
    }
    Ok((tally, Some(differing)))
}

fn has_area(object: Object<'_>) -> bool {
    match object {
        Object::Triangle(triangle) => triangle.normal() != glam::DVec3::ZERO,
        _ => true,
    }
}

/// The nearest hit of all objects tested one after the other; at equal t the lowest number.
fn brute_force<V: Vector>(
    objects: &(impl Targets<Vector = V> + ?Sized),
    n: usize,
    ray: &Ray<V>,
) -> Option<Hit<V::Real>> {
    (0..n as u32).fold(None, |best, number| match objects.intersect(number, ray) {
        Some(t) => Hit::nearer(best, number, t),
        None => best,
    })
}
