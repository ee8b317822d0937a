//! The experiment `split-cost`: the split cost f(b) = LSA(b) L(b) + RSA(b) R(b) across nodes (MacDonald & Booth 1990; Havran
//! 2000). Where it is least, what the two medians cost, and what an octree would be beside strategy 1.

pub mod asked;
pub mod nodes;
pub mod octree;

use serde::{Deserialize, Serialize};

use crate::kd::{Rules, Strategy};
use crate::scene::Scene;

use super::hits::cell::plant;
use super::identity::{content, digest};
use super::pieces::{Extent, Made, Piece, piece_by_piece};
use super::records::{CurveNodeRecord, CurveRecord, MedianRecord, OctreeRecord, Summary, Verdict};
use super::store::{Store, StoreError};
use super::{Plan, RunError, SCHEMA, Watcher, guess};

pub use asked::SplitCost;

/// What was found in one scene.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Found {
    medians: Vec<MedianRecord>,
    drawn: Vec<CurveNodeRecord>,
    curves: Vec<CurveRecord>,
    octree: Option<OctreeRecord>,
}

/// The ranks of the nodes of a scene that are drawn.
fn ranks(asked: &SplitCost, scene: &Scene) -> Vec<u32> {
    let own = asked.curves.iter().filter(|c| c.scene == scene.name);
    own.map(|c| c.rank).collect()
}

/// Identity of a scene's cell, from all that its results depend on.
fn identity(plan: &Plan, asked: &SplitCost, scene: &Scene) -> String {
    let text = format!(
        "{SCHEMA} split-cost by planes inside {} {} seed {} {:?} {:?} {} {:?} {:?}",
        scene.name,
        content(scene),
        plan.seed,
        plan.cost,
        asked.stop,
        asked.samples,
        asked.octree,
        ranks(asked, scene)
    );
    digest(text.as_bytes())
}

/// Measure what is not finished and write the files of the run.
pub(super) fn run(
    plan: &Plan,
    asked: &SplitCost,
    scenes: &[Scene],
    store: &Store,
    watcher: &impl Watcher,
) -> Result<(), RunError> {
    let announce = |left: &[&Piece<&Scene>]| {
        let s = if left.len() == 1 { "" } else { "s" };
        watcher.announce(&format!("looking at the nodes of {} tree{s}", left.len()));
    };
    let measure = |piece: &Piece<&Scene>| {
        watcher.begin(&piece.place);
        let found = measure(plan, asked, piece.of, watcher).map_err(|fault| RunError::Bug {
            place: piece.place.clone(),
            fault,
        })?;
        store.save(&piece.id, &found)?;
        watcher.done(piece.extent.units);
        Ok(Made::untimed(found))
    };
    let pieces = pieces(plan, asked, scenes);
    let found = |piece: &Piece<&Scene>| store.finished(&piece.id);
    let results = piece_by_piece(store, &pieces, "scenes", watcher, found, announce, measure)?;
    if let Some(results) = results {
        write(plan, asked, &results, store)?;
    }
    Ok(())
}

/// The scenes of a plan.
pub(super) fn pieces<'a>(
    plan: &Plan,
    asked: &SplitCost,
    scenes: &'a [Scene],
) -> Vec<Piece<&'a Scene>> {
    let piece = |scene: &'a Scene| {
        let objects = scene.bounds.len();
        let drawn = ranks(asked, scene).len();
        let lines = asked.octree.map_or(0, |octree| octree.lines);
        Piece {
            id: identity(plan, asked, scene),
            place: scene.name.clone(),
            extent: Extent {
                things: 1,
                units: objects as u64,
                lines,
                seconds: 10.0 * guess::tree(objects) + guess::traced(lines),
                bytes: guess::rows(100 + 500 * drawn),
            },
            of: scene,
        }
    };
    scenes.iter().map(piece).collect()
}

fn measure(
    plan: &Plan,
    asked: &SplitCost,
    scene: &Scene,
    watcher: &impl Watcher,
) -> Result<Found, String> {
    let rules = Rules {
        strategy: Strategy::Sah,
        stop: asked.stop,
        cost: plan.cost,
        clipped: false,
    };
    let (tree, _) = plant(scene, &rules)?;
    let ranks = ranks(asked, scene);
    let inner = tree.inner_nodes();
    for rank in ranks.iter().filter(|&&rank| rank as usize > inner) {
        let name = &scene.name;
        watcher.note(&format!(
            "{name} has only {inner} inner nodes; rank {rank} is not drawn"
        ));
    }
    let at = nodes::look(scene, &tree, asked, &ranks);
    let octree = asked
        .octree
        .map(|octree| octree::compare(scene, octree, plan.cost, plan.seed))
        .transpose()?
        .flatten();
    Ok(Found {
        medians: at.medians,
        drawn: at.drawn,
        curves: at.curves,
        octree,
    })
}

/// Put the run's files together.
fn write(plan: &Plan, asked: &SplitCost, found: &[Found], store: &Store) -> Result<(), StoreError> {
    let medians: Vec<&MedianRecord> = found.iter().flat_map(|f| &f.medians).collect();
    let octrees: Vec<&OctreeRecord> = found.iter().filter_map(|f| f.octree.as_ref()).collect();
    store.write_rows("medians.csv", &medians)?;
    store.write_rows("curve-nodes.csv", found.iter().flat_map(|f| &f.drawn))?;
    store.write_rows("curves.csv", found.iter().flat_map(|f| &f.curves))?;
    store.write_rows("octree.csv", &octrees)?;
    let mut verdicts = vec![equal(asked, &medians), between(&medians)];
    verdicts.extend((!octrees.is_empty()).then(|| same_cells(&octrees)));
    store.write_summary(&Summary {
        stop: Some(asked.stop.to_string()),
        verdicts,
        ..plan.summary()
    })
}

/// Rows of all axes and all sizes.
fn whole<'r>(medians: &[&'r MedianRecord]) -> Vec<&'r MedianRecord> {
    let whole =
        |row: &&MedianRecord| row.axis == "all" && row.objects_lo == 2 && row.objects_hi.is_none();
    medians.iter().copied().filter(whole).collect()
}

/// The least cost lies between the medians where each object counts once.
///
/// With L + R = n, f = n/2 (LSA + RSA) + (n/2 - L)(RSA - LSA), whose first term is constant along b and the cost of either
/// median. Left of both medians both factors of the second are positive, right of both they are negative: f is no less.
fn between(medians: &[&MedianRecord]) -> Verdict {
    let whole = whole(medians);
    let sum = |part: fn(&MedianRecord) -> u64| whole.iter().map(|row| part(row)).sum::<u64>();
    let (nodes, once, straddling) = (
        sum(|row| row.nodes),
        sum(|row| row.between_centres),
        sum(|row| row.between),
    );
    Verdict {
        name: "between".into(),
        held: once == nodes,
        message: format!(
            "counting each object once, by its centre, f is least between the medians in {once} of {nodes} cases (inner nodes \
             by axes), as theory says; with straddlers on both sides in {straddling}"
        ),
    }
}

/// Both medians cost the same where nothing straddles.
fn equal(asked: &SplitCost, medians: &[&MedianRecord]) -> Verdict {
    let whole = whole(medians);
    let even: u64 = whole.iter().map(|row| row.even).sum();
    let nodes: u64 = whole.iter().map(|row| row.nodes).sum();
    let worst = whole.iter().filter_map(|row| row.even_apart);
    let worst = worst.fold(0.0, f64::max);
    let within = asked.expect.equal_within;
    Verdict {
        name: "medians-equal".into(),
        held: worst <= within,
        message: format!(
            "f at the object median is f at the spatial median in the {even} of {nodes} cases (inner nodes by axes) where \
             nothing straddles either and the objects are parted evenly: largest difference {worst:.1e}, at most {within:e} \
             wanted"
        ),
    }
}

/// A line that visits other leaves ends the run with an error, so a finished run has none.
fn same_cells(octrees: &[&OctreeRecord]) -> Verdict {
    let lines: u64 = octrees.iter().map(|row| row.lines).sum();
    Verdict {
        name: "octree".into(),
        held: octrees
            .iter()
            .all(|row| row.kd_inner_nodes == 7 * row.octree_inner_nodes),
        message: format!(
            "strategy 1, stopped at every third level, and an octree have equally many leaves on {} scenes; each of {lines} \
             lines visits equally many leaves and tests equally many objects in both; seven kd-nodes make an octree's",
            octrees.len()
        ),
    }
}

/// The scenes of a dry run, a line each.
pub(super) fn describe(plan: &Plan, asked: &SplitCost, scenes: &[Scene]) -> String {
    let line = |scene: &Scene| {
        format!(
            "{}  {:24} {:>9} objects, {} nodes drawn\n",
            identity(plan, asked, scene),
            scene.name,
            scene.bounds.len(),
            ranks(asked, scene).len()
        )
    };
    let head = format!("stop {}, seed {}\n", asked.stop, plan.seed);
    head + &scenes.iter().map(line).collect::<String>()
}
