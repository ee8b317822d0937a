//! A user's own rays through one tree: what each hits, and what it costs.

use std::io::{self, Write};
use std::time::Instant;

use rayon::prelude::*;

use crate::geom::Cast;
use crate::kd::{Ask, Rules, Stack, Tree, Work, predict};
use crate::scene::Scene;

use super::hits::cell::plant;
use super::records::{HitRecord, TraceRecord};
use super::store::Store;
use super::{RunError, Watcher, identity};

/// What is to be traced.
pub struct Trace<'a> {
    /// The objects.
    pub scene: &'a Scene,
    /// The tree.
    pub rules: Rules,
    /// What the rays ask.
    pub ask: Ask,
    /// Where the rays come from.
    pub file: String,
    /// The rays.
    pub casts: &'a [Cast],
}

/// Wall seconds of a trace.
#[derive(Clone, Copy, Debug)]
pub struct Seconds {
    /// Building the tree, one thread.
    pub build: f64,
    /// Tracing all rays and writing what they hit.
    pub trace: f64,
}

/// What rays did together.
#[derive(Clone, Copy, Default)]
struct Sums {
    entered: u64,
    hits: u64,
    work: Work,
}

/// The rows of the hits of some rays as CSV, and their sums.
type Piece = (Vec<u8>, Sums);

/// Rays of one piece of work.
const PIECE: usize = 1024;
/// Rays whose rows are held at once.
const HELD: usize = 256 * PIECE;

/// Build the tree, trace the rays and write `hits.csv` and `trace.json`: the same bytes for any number of threads.
///
/// # Errors
/// If a file cannot be written, or if the tree fails its audit, which is a bug.
pub fn trace(
    asked: &Trace<'_>,
    store: &Store,
    watcher: &impl Watcher,
) -> Result<(TraceRecord, Seconds), RunError> {
    watcher.expect(asked.casts.len() as u64);
    watcher.begin(&format!("{} {}", asked.scene.name, asked.rules.strategy));
    let bug = |fault| RunError::Bug {
        place: asked.scene.name.clone(),
        fault,
    };
    let (tree, build) = plant(asked.scene, &asked.rules).map_err(bug)?;
    let started = Instant::now();
    let mut sums = Sums::default();
    store.write_with("hits.csv", |file| {
        sums = asked.write_hits(&tree, file, watcher)?;
        Ok(())
    })?;
    let trace = started.elapsed().as_secs_f64();
    let record = asked.record(&tree, sums);
    let mut json = serde_json::to_vec_pretty(&record).expect("records are plain data");
    json.push(b'\n');
    store.write("trace.json", &json)?;
    Ok((record, Seconds { build, trace }))
}

impl Trace<'_> {
    /// A row for every ray, in the order of the rays.
    fn write_hits(
        &self,
        tree: &Tree,
        to: &mut impl Write,
        watcher: &impl Watcher,
    ) -> io::Result<Sums> {
        let mut all = Sums::default();
        for (held, casts) in self.casts.chunks(HELD).enumerate() {
            let pieces = casts.par_chunks(PIECE).enumerate().map(|(piece, casts)| {
                let traced = self.trace_piece(tree, held * HELD + piece * PIECE, casts);
                watcher.done(casts.len() as u64);
                traced
            });
            for (rows, sums) in pieces.collect::<Vec<Piece>>() {
                to.write_all(&rows)?;
                all.entered += sums.entered;
                all.hits += sums.hits;
                all.work += sums.work;
            }
        }
        Ok(all)
    }

    /// Rays from the one with number `first` on.
    fn trace_piece(&self, tree: &Tree, first: usize, casts: &[Cast]) -> Piece {
        let mut rows = csv::WriterBuilder::new()
            .has_headers(first == 0)
            .from_writer(Vec::new());
        let mut sums = Sums::default();
        let mut stack = Stack::default();
        for (i, cast) in casts.iter().enumerate() {
            let mut work = Work::default();
            let objects = &self.scene.objects;
            let hit = self
                .ask
                .trace(tree, objects, &cast.ray(), &mut stack, &mut work);
            let row = HitRecord {
                ray: (first + i) as u64,
                object: hit.map(|hit| hit.object),
                t: hit.map(|hit| hit.t),
                n_k: work.inner,
                n_b: work.leaves,
                n_t: work.tests,
            };
            rows.serialize(row).expect("records are flat");
            sums.entered += u64::from(work.leaves > 0);
            sums.hits += u64::from(hit.is_some());
            sums.work += work;
        }
        (rows.into_inner().expect("writing to memory"), sums)
    }

    fn record(&self, tree: &Tree, sums: Sums) -> TraceRecord {
        let Rules {
            strategy,
            stop,
            cost,
            clipped,
        } = self.rules;
        let predicted = predict(tree);
        let rays = self.casts.len() as u64;
        let Work {
            inner,
            leaves,
            tests,
        } = sums.work;
        let [n_k, n_b, n_t] = [inner, leaves, tests].map(|n| n as f64 / rays as f64);
        TraceRecord {
            scene: self.scene.name.clone(),
            objects: self.scene.bounds.len() as u64,
            file: self.file.clone(),
            content: identity::rays(self.casts),
            ask: self.ask.to_string(),
            strategy: strategy.name(),
            stop: stop.to_string(),
            clipped,
            c_k: cost.c_k,
            c_b: cost.c_b,
            c_t: cost.c_t,
            revision: crate::REVISION.into(),
            rays,
            entered: sums.entered,
            hits: sums.hits,
            inner_visits: inner,
            leaf_visits: leaves,
            object_tests: tests,
            n_k_predicted: predicted.n_k,
            n_k_counted: n_k,
            n_b_predicted: predicted.n_b,
            n_b_counted: n_b,
            n_t_predicted: predicted.n_t,
            n_t_counted: n_t,
            c_predicted: cost.cost(predicted.n_k, predicted.n_b, predicted.n_t),
            c_counted: cost.cost(n_k, n_b, n_t),
        }
    }
}
