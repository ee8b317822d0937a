//! What rays hit: the nearest object, any, or all of them along the way, by any [`Walk`] and in the numbers of its tree.

use crate::geom::{Ray, Real, Targets, Vector};

use super::{Mode, NoProbe, Probe, Stack, Tracing, Walk};

/// The numbers of a walk's tree.
type RealOf<W> = <<W as Walk>::Vector as Vector>::Real;

/// A hit of a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit<T = f64> {
    /// Number of the object hit.
    pub object: u32,
    /// Parameter of the hit.
    pub t: T,
}

impl<T: Real> Hit<T> {
    /// The nearer of two hits; at equal t the lower object number.
    #[inline]
    pub fn nearer(best: Option<Self>, object: u32, t: T) -> Option<Self> {
        match best {
            Some(b) if (b.t, b.object) <= (t, object) => best,
            _ => Some(Self { object, t }),
        }
    }

    /// The hit to the last bit, to be compared: equal t may be zeros of either sign. An f64 holds the bits of an f32.
    pub fn bits(self) -> (u32, u64) {
        (self.object, self.t.to_f64().to_bits())
    }
}

/// The nearest hit of a ray; at equal t the lowest object number.
///
/// ```
/// use glam::DVec3;
/// use sahlab::cost::CostModel;
/// use sahlab::geom::{Line, Ray, Span, Targets};
/// use sahlab::kd::{Rules, Stack, StopRule, Strategy, build, nearest, occluded};
/// use sahlab::scene::Scene;
///
/// let scene = Scene::load("spd:balls:2")?;
/// let (strategy, stop) = (Strategy::Sah, StopRule::CostGain { depth: None });
/// let rules = Rules { strategy, stop, cost: CostModel::WALD_HAVRAN, clipped: false };
/// let tree = build(&scene.bounds, scene.world, &rules);
///
/// let line = Line::new(DVec3::new(2.0, 2.0, 2.0), DVec3::new(-1.0, -1.0, -0.9));
/// let ray = Ray::new(line, Span::from(0.0));
/// let mut stack = Stack::default();
/// let hit = nearest(&tree, &scene.objects, &ray, &mut stack).expect("it looks at the balls");
/// // The same without a tree.
/// let all = (0..scene.objects.len() as u32).filter_map(|object| scene.objects.intersect(object, &ray));
/// assert_eq!(hit.t, all.fold(f64::INFINITY, f64::min));
/// // What lies before the hit is free.
/// let before = Ray::new(line, Span { t0: 0.0, t1: 0.99 * hit.t });
/// assert!(occluded(&tree, &scene.objects, &ray, &mut stack));
/// assert!(!occluded(&tree, &scene.objects, &before, &mut stack));
/// # Ok::<(), sahlab::scene::SceneError>(())
/// ```
pub fn nearest<W: Walk>(
    walk: &W,
    objects: &(impl Targets<Vector = W::Vector> + ?Sized),
    ray: &Ray<W::Vector>,
    stack: &mut Stack<RealOf<W>>,
) -> Option<Hit<RealOf<W>>> {
    nearest_watched(walk, objects, ray, stack, NoProbe)
}

/// As [`nearest`], with a probe.
#[inline]
pub fn nearest_watched<W: Walk>(
    walk: &W,
    objects: &(impl Targets<Vector = W::Vector> + ?Sized),
    ray: &Ray<W::Vector>,
    stack: &mut Stack<RealOf<W>>,
    probe: impl Probe,
) -> Option<Hit<RealOf<W>>> {
    nearest_in::<Tracing, W>(walk, objects, ray, stack, probe)
}

/// As [`nearest_watched`], in a mode that may lose hits to rounding ([`Counting`](super::Counting)).
#[inline]
pub fn nearest_in<M: Mode, W: Walk>(
    walk: &W,
    objects: &(impl Targets<Vector = W::Vector> + ?Sized),
    ray: &Ray<W::Vector>,
    stack: &mut Stack<RealOf<W>>,
    probe: impl Probe,
) -> Option<Hit<RealOf<W>>> {
    best_watched::<M, W>(walk, objects, ray, stack, probe, |best| best.t)
}

/// The nearest hit of a ray that nothing stops: every object of every leaf it meets is tested, one in several leaves each
/// time. At equal t the lowest object number.
#[inline]
pub fn all_watched<W: Walk>(
    walk: &W,
    objects: &(impl Targets<Vector = W::Vector> + ?Sized),
    ray: &Ray<W::Vector>,
    stack: &mut Stack<RealOf<W>>,
    probe: impl Probe,
) -> Option<Hit<RealOf<W>>> {
    best_watched::<Tracing, W>(walk, objects, ray, stack, probe, |_| RealOf::<W>::INFINITY)
}

/// The nearest hit, if the best one so far makes nodes matter up to `limit` only.
#[inline(always)]
fn best_watched<M: Mode, W: Walk>(
    walk: &W,
    objects: &(impl Targets<Vector = W::Vector> + ?Sized),
    ray: &Ray<W::Vector>,
    stack: &mut Stack<RealOf<W>>,
    mut probe: impl Probe,
    limit: impl Fn(Hit<RealOf<W>>) -> RealOf<W>,
) -> Option<Hit<RealOf<W>>> {
    let mut best = None;
    walk.walk::<M, _>(&ray.line, ray.span, stack, &mut probe, |in_leaf, probe| {
        for &object in in_leaf {
            probe.test(object);
            if let Some(t) = objects.intersect(object, ray) {
                best = Hit::nearer(best, object, t);
            }
        }
        best.map_or(RealOf::<W>::INFINITY, &limit)
    });
    best
}

/// Whether the ray hits any object within its span: what a shadow ray asks.
pub fn occluded<W: Walk>(
    walk: &W,
    objects: &(impl Targets<Vector = W::Vector> + ?Sized),
    ray: &Ray<W::Vector>,
    stack: &mut Stack<RealOf<W>>,
) -> bool {
    any_watched(walk, objects, ray, stack, NoProbe).is_some()
}

/// The first hit that is found, which need not be the nearest: what ends a shadow ray. Leaves come front to back, their
/// objects in the order of the references; the first object hit ends it, however far its hit.
#[inline]
pub fn any_watched<W: Walk>(
    walk: &W,
    objects: &(impl Targets<Vector = W::Vector> + ?Sized),
    ray: &Ray<W::Vector>,
    stack: &mut Stack<RealOf<W>>,
    mut probe: impl Probe,
) -> Option<Hit<RealOf<W>>> {
    let mut found = None;
    let mut untested = 0;
    walk.walk::<Tracing, _>(&ray.line, ray.span, stack, &mut probe, |in_leaf, probe| {
        if found.is_none() {
            for (i, &object) in in_leaf.iter().enumerate() {
                probe.test(object);
                if let Some(t) = objects.intersect(object, ray) {
                    found = Some(Hit { object, t });
                    untested = in_leaf.len() - 1 - i;
                    break;
                }
            }
        } else {
            // A span that begins at -infinity goes on.
            untested += in_leaf.len();
        }
        match found {
            Some(_) => RealOf::<W>::NEG_INFINITY,
            None => RealOf::<W>::INFINITY,
        }
    });
    if found.is_some() {
        probe.untested(untested as u32);
    }
    found
}
