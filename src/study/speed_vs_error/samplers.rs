//! How far samplers of lines are off, how fast their errors fall, and what they take.

use crate::kd::Ask;
use crate::study::Watcher;
use crate::study::hits::cell::plant;
use crate::study::identity::{content, line_seed};

use super::asked::Samplers;
use super::errors::{Series, Truth};
use super::exponents::{enough, exponent};
use super::method::{Method, Way};
use super::replicates::Subject;
use super::sampler_times::times;
use super::{Found, Piece};

pub use super::sampler_verdicts::verdicts;

/// Sets that make up the reference; their scatter tells its error.
const REFERENCES: u32 = 32;

/// The level of the reference: its lines are none of the other replicates'.
const REFERENCE_LEVEL: u32 = u32::MAX;

/// Units of progress of a scene: lines.
pub fn units(asked: &Samplers) -> u64 {
    let passes = u64::from(asked.replicates) + u64::from(asked.rounds);
    asked.reference + passes * lines_of_a_pass(asked)
}

/// Lines of one set of every way and size.
fn lines_of_a_pass(asked: &Samplers) -> u64 {
    let ways = Way::all(asked).into_iter();
    ways.flat_map(|way| way.sizes(asked)).sum()
}

/// Measure a scene.
///
/// # Errors
/// If the tree fails its audit, a bug in the program.
pub fn measure(
    asked: &Samplers,
    piece: &Piece<'_>,
    watcher: &impl Watcher,
) -> Result<Found, String> {
    let (tree, _) = plant(piece.scene, &piece.rules)?;
    let seed = line_seed(piece.seed, &content(piece.scene));
    let subject = Subject::new(piece.scene, &tree, piece.rules.cost, seed);
    let done = |lines: u64| watcher.done(lines);

    let mut found = Found::default();
    let mut sizes = Vec::new();
    let mut random: Vec<Series> = Vec::new();
    // Independent lines first: the others are held against them.
    let mut ways = Way::all(asked);
    ways.sort_by_key(|way| (way.ask != Ask::All, way.method != Method::Random));
    let mut reference = None;
    for way in ways {
        let truth = match way.ask {
            Ask::All => areas(&subject),
            ask => *reference.get_or_insert_with(|| traced(asked, &subject, ask, done)),
        };
        let own = way.sizes(asked);
        let level = |(level, &lines): (usize, &u64)| {
            let replicates = subject.replicates(way, level as u32, lines, asked.replicates, done);
            (lines, replicates)
        };
        let replicates: Vec<_> = own.iter().enumerate().map(level).collect();
        let all = Series::all(way, &truth, &replicates);
        if way.method == Method::Random {
            random.extend(all.iter().cloned());
        }
        for series in &all {
            let same =
                |other: &&Series| other.way.ask == way.ask && other.quantity == series.quantity;
            let random = random.iter().find(same);
            let random = random.expect("random lines have every quantity");
            found.errors.extend(series.rows(piece, random));
            if let Some(fit) = exponent(series, piece) {
                if series.quantity == "C" {
                    found.enough.extend(enough(series, &fit, &asked.wanted));
                }
                found.exponents.push(fit);
            }
        }
        sizes.push((way, own));
    }
    let lines = lines_of_a_pass(asked);
    found.timings = times(&subject, piece, &sizes, asked.rounds, || {
        watcher.done(lines)
    });
    Ok(found)
}

/// What areas say of lines that nothing stops.
fn areas(subject: &Subject<'_>) -> Truth {
    let p = &subject.prediction;
    Truth {
        rates: subject.rates([p.n_k, p.n_b, p.n_t]),
        errors: None,
    }
}

/// What a long reference says of rays that end early.
fn traced(asked: &Samplers, subject: &Subject<'_>, ask: Ask, done: impl Fn(u64) + Sync) -> Truth {
    let way = Way {
        method: Method::Sobol,
        ask,
    };
    let lines = asked.reference / u64::from(REFERENCES);
    Truth::of_reference(&subject.replicates(way, REFERENCE_LEVEL, lines, REFERENCES, done))
}
