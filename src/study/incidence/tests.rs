//! Pairs against brute force, in both precisions; what a lost leaf costs; how good the aim is; how verdicts are counted.

use super::*;
use crate::cost::CostModel;
use crate::exact::line_box;
use crate::geom::{Line, Ray, Span};
use crate::kd::{Counting, NarrowTree, Planes, Rules, Strategy, Tree, build_objects};
use crate::rays::SurfaceLines;
use crate::scene::Scene;

fn scene_and_tree() -> (Scene, Tree) {
    let scene = Scene::load("simple:soup:300").unwrap();
    let rules = Rules {
        strategy: Strategy::Sah,
        stop: "objects:2:16".parse().unwrap(),
        cost: CostModel::WALD_HAVRAN,
        clipped: false,
    };
    let tree = build_objects(&scene.objects, &scene.bounds, scene.world, &rules);
    (scene, tree)
}

/// A check of a subject in either precision.
trait Check {
    fn check<T: Planes<Vector: Exact>>(&self, aim: &Aim<'_, T>);
}

fn in_both(check: &impl Check) {
    let (scene, tree) = scene_and_tree();
    let lines = SurfaceLines {
        world: scene.world,
        seed: 5,
    };
    let triangles = &scene.objects.triangles;
    let narrow = Narrow::new(NarrowTree::of(&tree).unwrap().0, triangles);
    let (wide, narrow) = (Subject::new(&tree, triangles), narrow.subject());
    check.check(&Aim {
        subject: &wide,
        lines,
    });
    check.check(&Aim {
        subject: &narrow,
        lines,
    });
}

/// Lines of every sort.
fn lines<'a, T: Planes<Vector: Exact>>(
    aim: &'a Aim<'_, T>,
    count: u64,
) -> impl Iterator<Item = Line<T::Vector>> + 'a {
    let aimed = |against| aim.aimed(0..count, move |_| against);
    let drawn = aim.drawn(0..count);
    drawn
        .chain(aimed(Against::Box))
        .chain(aimed(Against::Triangle))
}

/// Targets of the pairs that a line meets, or of those that the kernel says it does; ascending.
fn targets(pairs: &[Pair], of: fn(&Judged) -> bool) -> Vec<u32> {
    let own = pairs.iter().filter(|pair| of(&pair.judged));
    let mut targets: Vec<u32> = own.map(|pair| pair.target).collect();
    targets.sort_unstable();
    targets
}

struct BruteForce;

impl Check for BruteForce {
    fn check<T: Planes<Vector: Exact>>(&self, aim: &Aim<'_, T>) {
        let subject = aim.subject;
        let mut visits = Visits::default();
        let mut hits = 0;
        for line in lines(aim, 200) {
            let visited = visits.follow::<Counting, T>(subject.tree, &line);
            let of_nodes = nodes(subject, &line, visited);
            assert_eq!(targets(&of_nodes, |judged| judged.said), visited);
            let exact = exact_line(&line);
            let meets = |b| line_box(exact.origin, exact.direction, b).hit;
            let all = 0..subject.boxes.len() as u32;
            let met: Vec<u32> = all.filter(|&k| meets(&subject.boxes[k as usize])).collect();
            assert_eq!(targets(&of_nodes, |judged| judged.exact), met);
            assert_eq!(targets(&of_nodes, |_| true).len(), of_nodes.len());

            let of_triangles = triangles(subject, &line, &of_nodes);
            assert!(of_triangles.is_sorted_by(|a, b| a.target < b.target));
            let ray = Ray::new(line, Span::FULL);
            let meets = |k: &u32| Judged::of_triangle(&ray, &subject.triangles[*k as usize]).exact;
            let met: Vec<u32> = (0..subject.triangles.len() as u32).filter(meets).collect();
            assert_eq!(targets(&of_triangles, |judged| judged.exact), met);
            hits += met.len();
        }
        assert!(hits > 500, "{hits}");
    }
}

/// Every box and triangle that a line meets is judged, be it visited or not.
#[test]
fn all_that_is_met_is_judged() {
    in_both(&BruteForce);
}

struct Lost;

impl Check for Lost {
    fn check<T: Planes<Vector: Exact>>(&self, aim: &Aim<'_, T>) {
        let (mut total, mut moved) = (Tally::default(), 0);
        for line in lines(aim, 200) {
            // A kernel that goes nowhere.
            let of_nodes = nodes(aim.subject, &line, &[]);
            let pairs = triangles(aim.subject, &line, &of_nodes);
            total += Tally::of_a_line(&pairs);
            let leaf = |k: u32| {
                of_nodes
                    .iter()
                    .find(|pair| pair.target == k)
                    .unwrap()
                    .judged
            };
            let ray = Ray::new(line, Span::FULL);
            for Pair { target, judged } in pairs {
                let own = Judged::of_triangle(&ray, &aim.subject.triangles[target as usize]);
                if !(own.said && own.exact) {
                    assert_eq!(judged.ulps, own.ulps);
                    continue;
                }
                let holds = |k: &u32| match aim.subject.tree.node(*k) {
                    crate::kd::NodeKind::Leaf { first, count } => {
                        aim.subject.tree.objects(first, count).contains(&target)
                    }
                    crate::kd::NodeKind::Inner { .. } => false,
                };
                let met = targets(&of_nodes, |judged| judged.exact);
                let surest = met.iter().filter(|k| holds(k)).map(|&k| leaf(k).ulps);
                assert_eq!(judged.ulps, own.ulps.min(surest.fold(0.0, f64::max)));
                moved += u32::from(judged.ulps < own.ulps);
            }
        }
        assert_eq!(total.wrong + total.tied_wrong, 0);
        assert_eq!(total.missed + total.tied_missed, total.hits);
        assert!(total.missed > 500 && moved > 0, "{total:?}, {moved}");
    }
}

/// Triangles whose leaves were passed by are missed; as near to a tie as the surest of those leaves.
#[test]
fn triangles_of_lost_leaves_are_missed() {
    in_both(&Lost);
}

struct Hard;

impl Check for Hard {
    fn check<T: Planes<Vector: Exact>>(&self, aim: &Aim<'_, T>) {
        const LINES: u64 = 2000;
        let mut visits = Visits::default();
        for against in [Against::Box, Against::Triangle] {
            let mut has_tie = |line: &Line<T::Vector>| {
                let visited = visits.follow::<Counting, T>(aim.subject.tree, line);
                let mut pairs = nodes(aim.subject, line, visited);
                if against == Against::Triangle {
                    pairs = triangles(aim.subject, line, &pairs);
                }
                pairs.iter().any(|pair| pair.judged.is_tie())
            };
            let share = |ties: usize| ties as f64 / LINES as f64;
            let aimed = aim.aimed(0..LINES, |_| against);
            let aimed = share(aimed.filter(&mut has_tie).count());
            let drawn = share(aim.drawn(0..LINES).filter(&mut has_tie).count());
            assert!(aimed > 0.7 && drawn < 0.01, "{against:?}: {aimed}, {drawn}");
        }
        let parallel = |line: &Line<T::Vector>| (0..3).any(|axis| line.is_parallel(axis));
        let aimed = aim.aimed(0..LINES, |_| Against::Box);
        // 3 of 16 lines to one plane, 1 of 16 to two: within 4 standard errors.
        let share = aimed.filter(parallel).count() as f64 / LINES as f64;
        assert!((share - 0.25).abs() < 0.04, "{share}");
        // A line is a function of the seed and its index.
        let all: Vec<_> = lines(aim, 9).collect();
        let part: Vec<_> = aim.aimed(5..9, |_| Against::Box).collect();
        assert_eq!(part, all[9 + 5..2 * 9]);
    }
}

/// Lines that are aimed have ties in either precision, the metric's own have none.
#[test]
fn aimed_lines_are_hard_in_the_kernels_own_numbers() {
    in_both(&Hard);
}

#[test]
fn verdicts_are_counted_by_kind() {
    let pair = |said: bool, exact: bool, ulps: f64| Pair {
        target: 0,
        judged: Judged { said, exact, ulps },
    };
    let first = [
        pair(true, true, 100.0),
        pair(true, false, 8.0),
        pair(false, true, f64::INFINITY),
        pair(true, false, 7.9),
        pair(false, true, 0.0),
        pair(false, true, 1.0),
    ];
    let mut tally = Tally::of_a_line(&first);
    let expected = Tally {
        cases: 6,
        hits: 4,
        wrong: 1,
        missed: 1,
        ties: 3,
        tied_wrong: 1,
        tied_missed: 2,
        squares: 25,
    };
    assert_eq!(tally, expected);
    // Squares are those of lines.
    tally += Tally::of_a_line(&[pair(false, false, 1.0), pair(true, false, 9.0)]);
    assert_eq!((tally.cases, tally.ties, tally.wrong), (8, 4, 2));
    assert_eq!((tally.errors(), tally.squares), (6, 26));
}
