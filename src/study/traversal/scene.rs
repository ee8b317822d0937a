//! One scene: its tree in both precisions, every set of rays along every way, their seconds and their memory.

use std::ops::Range;

use crate::geom::{Aabb, Cast, Line, Ray, Real, Span, Targets};
use crate::kd::narrow::{NarrowTree, Refusal, narrow_line, narrow_triangles};
use crate::kd::{Ask, NodeKind, Planes, Stack, Tree};
use crate::scene::Scene;
use crate::study::chunks::spread;
use crate::study::hits::cell::{build_tree, on_one_thread, plant};
use crate::study::ray_sets::{Rays, RaysOf, gather};
use crate::study::records::{LinkRecord, PassTiming, TraversalRecord};
use crate::study::timing::BUILD;
use crate::study::{Plan, Watcher};

use super::seconds::{Error, Pass, Trace, seconds};
use super::side::{Memory, Side};
use super::trail::{Follow, Nodes, Set, Tally, Trail};
use super::way::{Point, Way};
use super::{Cell, Found, Traversal, number};

/// Measure a scene; the error tells a fault of the program.
pub fn measure(
    plan: &Plan,
    asked: &Traversal,
    cell: &Cell<'_>,
    watcher: &impl Watcher,
) -> Result<Found, String> {
    let Cell { scene, rules, .. } = cell;
    let (tree, _) = plant(scene, rules)?;
    let sets = gather(scene, &asked.rays, number(asked), &[], plan.seed)?;
    let depths = depths(&tree);
    let job = Job {
        asked,
        cell,
        sets: &sets,
        depths: &depths,
    };
    let narrow = narrow(scene, &tree, watcher);
    let triangles = narrow_triangles(&scene.objects).ok();
    let rays = sets.iter().map(wide_rays).collect();
    let memory = Memory {
        bytes: tree.bytes() as u64,
        thin: thin_leaves(&tree, &tree.boxes, f64::PADDING),
    };
    let wide = Side::new("f64", &tree, memory, Some(&scene.objects), rays);
    let narrow = narrow.as_ref().map(|tree| {
        let rays: Result<_, Refusal> = sets.iter().map(narrow_rays).collect();
        let rays = rays.map_err(|refusal| refusal.to_string())?;
        let triangles = triangles.as_deref();
        let memory = Memory {
            bytes: tree.bytes() as u64,
            thin: thin_leaves(tree, &tree.boxes, f32::PADDING.into()),
        };
        Ok::<_, String>(Side::new("f32", tree, memory, triangles, rays))
    });
    let narrow = narrow.transpose()?;

    let mut found = Found::default();
    let mut most = job.count(&wide, &mut found, watcher);
    if let Some(narrow) = &narrow {
        let own = job.count(narrow, &mut found, watcher);
        most.iter_mut().zip(own).for_each(|(a, b)| *a = a.max(b));
    }
    // The same rays in both precisions.
    let mut passes = job.passes(&wide, &most);
    passes.extend(narrow.iter().flat_map(|side| job.passes(side, &most)));
    let mut builds = vec![Pass::build(BUILD.into(), || build_tree(scene, rules))];
    builds.extend(wide.builds());
    builds.extend(narrow.iter().flat_map(Side::builds));
    let built = on_one_thread(|| seconds(builds, asked.timing.builds, plan.seed, || ()));
    let traced = seconds(passes, asked.timing.rounds, plan.seed, || watcher.done(1));
    let named = |row| PassTiming {
        cell: cell.id.clone(),
        scene: scene.name.clone(),
        strategy: rules.strategy.name(),
        stop: rules.stop.to_string(),
        ..row
    };
    found.timings = built.into_iter().chain(traced).map(named).collect();
    Ok(found)
}

/// The depth of every node.
fn depths(tree: &Tree) -> Vec<u32> {
    let mut depths = vec![0; tree.nodes.len()];
    // Children come after their parent in the arena.
    for (i, node) in tree.nodes.iter().enumerate() {
        if let NodeKind::Inner { left, .. } = node.kind() {
            let below = depths[i] + 1;
            depths[left as usize..][..2].fill(below);
        }
    }
    depths
}

/// Which nodes are leaves whose shortest side is within twice the padding of the root's longest.
fn thin_leaves(tree: &impl Planes, boxes: &[Aabb], padding: f64) -> Vec<bool> {
    let least = 2.0 * padding * boxes[0].extent().max_element();
    let thin = |(number, own): (u32, &Aabb)| {
        let leaf = matches!(tree.node(number), NodeKind::Leaf { .. });
        leaf && own.extent().min_element() <= least
    };
    (0..).zip(boxes).map(thin).collect()
}

/// The tree in single precision; where that is refused, the user is told why.
fn narrow(scene: &Scene, tree: &Tree, watcher: &impl Watcher) -> Option<NarrowTree> {
    let note = |text: String| watcher.note(&format!("{}: {text}", scene.name));
    match NarrowTree::of(tree) {
        Ok((narrow, warning)) => {
            if let Some(warning) = warning {
                note(warning.to_string());
            }
            Some(narrow)
        }
        Err(refusal) => {
            note(refusal.to_string());
            None
        }
    }
}

fn wide_rays(rays: &Rays) -> Vec<Ray> {
    rays.casts.iter().map(Cast::ray).collect()
}

fn narrow_rays(rays: &Rays) -> Result<Vec<Ray<glam::Vec3>>, Refusal> {
    let narrow = |cast: &Cast| {
        let line = narrow_line(&Line::new(cast.origin, cast.direction))?;
        let Span { t0, t1 } = cast.span;
        let span = Span {
            t0: t0 as f32,
            t1: t1 as f32,
        };
        Ok(Ray::new(line, span))
    };
    rays.casts.iter().map(narrow).collect()
}

/// A scene with its rays.
struct Job<'a> {
    asked: &'a Traversal,
    cell: &'a Cell<'a>,
    sets: &'a [Rays],
    depths: &'a [u32],
}

impl Job<'_> {
    /// The rows of one precision. Gives the most visits and tests of a ray, by set.
    fn count<T: Planes<Vector: Point> + Sync, O: Targets<Vector = T::Vector> + Sync + ?Sized>(
        &self,
        side: &Side<'_, T, O>,
        found: &mut Found,
        watcher: &impl Watcher,
    ) -> Vec<f64> {
        found.links.push(self.memory(side));
        let of_set = |(number, rays): (usize, &Rays)| {
            let Some(set) = side.set(number, rays.of.ask()) else {
                return 0.0;
            };
            let nodes = Nodes {
                depths: self.depths,
                thin: &side.memory.thin,
            };
            let follow = |way| {
                let trails: Vec<Trail<_>> = side.walks.take(way, Follow { set, nodes });
                watcher.done(1);
                trails
            };
            let stack = follow(Way::Stack);
            let mut most = 0;
            for way in Way::ALL {
                let tally = match way {
                    Way::Stack => Tally::of(way, &stack, &stack),
                    _ => Tally::of(way, &follow(way), &stack),
                };
                let work = tally.work;
                most = most.max(work.inner + work.leaves + work.tests);
                found.walks.push(self.row(side.precision, rays, way, tally));
            }
            most as f64 / rays.casts.len() as f64
        };
        self.sets.iter().enumerate().map(of_set).collect()
    }

    /// What is timed of one precision, given the most visits and tests of a ray, by set.
    fn passes<
        's,
        T: Planes<Vector: Point> + Sync,
        O: Targets<Vector = T::Vector> + Sync + ?Sized,
    >(
        &self,
        side: &'s Side<'_, T, O>,
        most: &[f64],
    ) -> Vec<Pass<'s>> {
        let mut passes = Vec::new();
        for (number, (rays, &most)) in self.sets.iter().zip(most).enumerate() {
            let Some(set) = side.set(number, rays.of.ask()) else {
                continue;
            };
            let timing = &self.asked.timing;
            let affordable = (timing.work as f64 / most.max(1.0)) as u64;
            let chunks = spread(set.rays.len(), timing.rays.min(affordable) as usize);
            for way in Way::ALL {
                let mut stack = Stack::default();
                let trace = move |chunk: Range<usize>| {
                    let rays = &set.rays[chunk];
                    let stack = &mut stack;
                    let set = Set { rays, ..set };
                    side.walks.take(way, Trace { set, stack })
                };
                let what = format!("{} {} {way}", rays.of, side.precision);
                let error = match way {
                    Way::Stack => Error::OfRays,
                    _ => Error::OfRatio,
                };
                let rays = (set.rays.len(), chunks.clone());
                passes.push(Pass::new(what, rays, error, trace));
            }
        }
        passes
    }

    fn row(&self, precision: &str, rays: &Rays, way: Way, tally: Tally) -> TraversalRecord {
        let tested = |count: u64| (rays.of.ask() != Ask::All).then_some(count);
        let Cell { id, scene, rules } = self.cell;
        TraversalRecord {
            cell: id.clone(),
            scene: scene.name.clone(),
            strategy: rules.strategy.name(),
            stop: rules.stop.to_string(),
            rays: rays.of.to_string(),
            random: matches!(rays.of, RaysOf::Source(..)),
            precision: precision.into(),
            way: way.name().into(),
            cast: rays.casts.len() as u64,
            entered: tally.entered,
            hits: tested(tally.hits),
            inner_visits: tally.work.inner,
            leaf_visits: tally.work.leaves,
            object_tests: tested(tally.work.tests),
            links: tally.links,
            fall_backs: tally.fall_backs,
            thin_fall_backs: tally.thin_fall_backs,
            differing_hits: tested(tally.differing_hits),
            differing_leaves: tally.differing_leaves,
            broken: tally.broken,
        }
    }

    fn memory<T: Planes, O: ?Sized>(&self, side: &Side<'_, T, O>) -> LinkRecord {
        let Cell { id, scene, rules } = self.cell;
        let nodes = self.depths.len() as u64;
        let facts = side.walks.links.facts();
        LinkRecord {
            cell: id.clone(),
            scene: scene.name.clone(),
            strategy: rules.strategy.name(),
            stop: rules.stop.to_string(),
            precision: side.precision.into(),
            objects: scene.bounds.len() as u64,
            depth: self.depths.iter().max().copied().unwrap_or(0).into(),
            inner_nodes: nodes / 2,
            leaves: nodes.div_ceil(2),
            thin_leaves: side.memory.thin.iter().filter(|&&thin| thin).count() as u64,
            tree_bytes: side.memory.bytes,
            links_to_leaves: facts.to_leaves as u64,
            links_to_inner: facts.to_inner as u64,
            links_outside: facts.outside as u64,
            link_bytes: side.walks.links.bytes() as u64,
            face_tree_bytes: side.walks.face_trees.bytes() as u64,
        }
    }
}
