//! The pieces of a run: a group of the catalogue, or a scene's tree with its random and its transformed lines.

use std::fmt;

use crate::kd::Rules;
use crate::scene::Scene;
use crate::study::hits::cell::plant;
use crate::study::identity::{content, digest, line_seed, whole};
use crate::study::incidence::Against;
use crate::study::kernel::Kernel;
use crate::study::pieces::{self, Extent};
use crate::study::records::CaseRecord;
use crate::study::{Plan, SCHEMA, guess};

use super::case::{Case, Check, Finding, Group, Outcome};
use super::catalogue::select;
use super::guard::{guarded, in_plain_threads};
use super::random::Bench;
use super::{Found, Stability, metamorphic};

/// One piece.
pub type Piece<'a> = pieces::Piece<What<'a>>;

/// What is measured. Units of progress: pairs, lines, or what stands for a cell of a hard case.
pub enum What<'a> {
    Cases(Group, Vec<Case>),
    Tree(&'a Scene, Rules, Shares),
}

/// Pairs of each family that fall to a tree, against boxes and against triangles: random ones, aimed ones.
#[derive(Clone, Copy, Debug)]
pub struct Shares {
    boxes: [u64; 2],
    triangles: [u64; 2],
}

/// A cell of a hard case takes about as long as so many pairs.
const CELL: u64 = 10_000;

/// The pieces of a plan.
pub fn pieces<'a>(plan: &Plan, asked: &Stability, scenes: &'a [Scene]) -> Vec<Piece<'a>> {
    let rules = rules(plan, asked);
    let common = format!("{SCHEMA} stability {:?} {rules:?}", asked.kernels);
    // Names were checked with the plan: what is unknown here selects nothing.
    let cases = select(asked.cases.as_deref()).unwrap_or_default();
    let mut pieces = Vec::new();
    for group in Group::ALL {
        let own: Vec<Case> = cases
            .iter()
            .filter(|case| case.group == group)
            .cloned()
            .collect();
        if own.is_empty() {
            continue;
        }
        let names: Vec<&str> = own.iter().map(|case| case.name).collect();
        let cells = own
            .iter()
            .map(|case| cells(case, &rules, &asked.kernels).len());
        let cells = cells.sum::<usize>() as u64;
        pieces.push(piece(
            digest(format!("{common} cases {names:?}").as_bytes()),
            Extent {
                things: 1,
                units: CELL * cells,
                lines: 0,
                seconds: 0.002 * cells as f64,
                bytes: guess::rows(cells as usize),
            },
            What::Cases(group, own),
        ));
    }
    let trees = (scenes.len() * rules.len()) as u64;
    let meshes = scenes.iter().filter(|scene| has_triangles(scene)).count();
    let share = |trees: u64| [asked.random, asked.aimed].map(|pairs| pairs.div_ceil(trees.max(1)));
    for scene in scenes {
        let shares = Shares {
            boxes: share(trees),
            triangles: if has_triangles(scene) {
                share((meshes * rules.len()) as u64)
            } else {
                [0; 2]
            },
        };
        for rules in &rules {
            let text = format!(
                "{common} {} {} {rules:?} seed {} {shares:?} {} lines",
                scene.name,
                whole(scene),
                plan.seed,
                asked.lines
            );
            let pairs: u64 = shares.boxes.iter().chain(&shares.triangles).sum();
            let lines = asked.lines * metamorphic::TRANSFORMS.len() as u64;
            let units = pairs * asked.kernels.len() as u64 + lines;
            pieces.push(piece(
                digest(text.as_bytes()),
                Extent {
                    things: 1,
                    units,
                    lines: units,
                    seconds: guess::tree(scene.bounds.len()) + guess::traced(units),
                    bytes: guess::rows(50),
                },
                What::Tree(scene, *rules, shares),
            ));
        }
    }
    pieces
}

fn piece(id: String, extent: Extent, of: What<'_>) -> Piece<'_> {
    Piece {
        id,
        place: of.to_string(),
        extent,
        of,
    }
}

fn rules(plan: &Plan, asked: &Stability) -> Vec<Rules> {
    Rules::crossed(&[asked.stop], &asked.strategies, plan.cost, false)
}

fn has_triangles(scene: &Scene) -> bool {
    !scene.objects.triangles.is_empty()
}

/// The cells of a case: the tree's rules, if there is a tree, and the kernel.
fn cells(case: &Case, rules: &[Rules], kernels: &[Kernel]) -> Vec<(Option<Rules>, Kernel)> {
    match case.check {
        Check::Once(_) => vec![(None, Kernel::F64)],
        Check::Kernels(_) => kernels.iter().map(|&kernel| (None, kernel)).collect(),
        Check::Trees(_) => {
            let by_kernel =
                |&rules: &Rules| kernels.iter().map(move |&kernel| (Some(rules), kernel));
            rules.iter().flat_map(by_kernel).collect()
        }
    }
}

impl What<'_> {
    /// The hard cases in it.
    pub fn cases(&self) -> &[Case] {
        match self {
            Self::Cases(_, cases) => cases,
            Self::Tree(..) => &[],
        }
    }

    /// Measure it; the error tells a fault of the program that no row can tell.
    pub fn measure(&self, plan: &Plan, asked: &Stability) -> Result<Found, String> {
        match self {
            Self::Cases(_, cases) => Ok(Found {
                cases: check(cases, &rules(plan, asked), &asked.kernels),
                ..Found::default()
            }),
            Self::Tree(scene, rules, shares) => tree(plan, asked, scene, rules, shares),
        }
    }
}

impl fmt::Display for What<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Cases(group, cases) => {
                write!(f, "{} hard cases of {}", cases.len(), group.name())
            }
            Self::Tree(scene, rules, _) => write!(f, "{} on {}", rules.strategy.name(), scene.name),
        }
    }
}

/// Every cell of the cases.
fn check(cases: &[Case], rules: &[Rules], kernels: &[Kernel]) -> Vec<CaseRecord> {
    let cell = |case: &Case, rules: Option<Rules>, kernel: Kernel| {
        let check = case.check.clone();
        let finding = guarded(move || match (check, rules) {
            (Check::Once(check), _) => Some(check()),
            (Check::Kernels(check), _) => check(kernel),
            (Check::Trees(check), Some(rules)) => check(&rules, kernel),
            (Check::Trees(_), None) => None,
        })?;
        Some(record(case, rules, kernel, finding))
    };
    let all: Vec<_> = cases
        .iter()
        .flat_map(|case| {
            cells(case, rules, kernels)
                .into_iter()
                .map(move |cell| (case, cell))
        })
        .collect();
    let found = in_plain_threads(&all, |&(case, (rules, kernel))| cell(case, rules, kernel));
    found.into_iter().flatten().collect()
}

fn record(case: &Case, rules: Option<Rules>, kernel: Kernel, finding: Finding) -> CaseRecord {
    CaseRecord {
        case: case.name.into(),
        group: case.group.name().into(),
        stresses: case.stresses.into(),
        strategy: rules.map_or(String::new(), |rules| rules.strategy.name()),
        kernel: kernel.name().into(),
        expected: finding.expected,
        measured: finding.measured,
        outcome: finding.outcome.name().into(),
        off: match finding.outcome {
            Outcome::Off(by) => Some(by),
            _ => None,
        },
        demanded: finding.demanded,
    }
}

/// Random pairs and transforms of one tree.
fn tree(
    plan: &Plan,
    asked: &Stability,
    scene: &Scene,
    rules: &Rules,
    shares: &Shares,
) -> Result<Found, String> {
    let (tree, _) = plant(scene, rules)?;
    let strategy = rules.strategy.name();
    let seed = line_seed(plan.seed, &content(scene));
    let mut found = Found {
        metamorphic: metamorphic::check(scene, &tree, &strategy, seed, asked.lines),
        ..Found::default()
    };
    let bench = Bench {
        scene,
        tree: &tree,
        // No two trees judge the same pairs.
        seed: line_seed(plan.seed, &format!("{} {strategy}", content(scene))),
        strategy,
    };
    for &kernel in &asked.kernels {
        for (against, pairs) in [
            (Against::Box, shares.boxes),
            (Against::Triangle, shares.triangles),
        ] {
            // There is one triangle test in f32.
            if against == Against::Triangle && (kernel == Kernel::F32Padded || pairs[0] == 0) {
                continue;
            }
            for (aimed, pairs) in [false, true].into_iter().zip(pairs) {
                match bench.judge(kernel, against, aimed, pairs) {
                    Ok((row, ties)) => {
                        found.random.push(row);
                        found.ties.extend(ties);
                    }
                    Err(refusal) => {
                        let note = format!("{}, {kernel}: {refusal}", scene.name);
                        if !found.notes.contains(&note) {
                            found.notes.push(note);
                        }
                    }
                }
            }
        }
    }
    Ok(found)
}
