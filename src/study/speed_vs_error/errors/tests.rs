//! Errors, gains and exponents of made-up replicates, and of real ones on a small scene.

use super::*;
use crate::cost::CostModel;
use crate::kd::{Ask, Rules, Strategy};
use crate::rays::Sampler;
use crate::scene::Scene;
use crate::study::hits::cell::build_tree;
use crate::study::speed_vs_error::exponents::{enough, exponent};
use crate::study::speed_vs_error::method::Method;
use crate::study::speed_vs_error::replicates::Subject;

fn rules() -> Rules {
    Rules {
        strategy: Strategy::Sah,
        stop: "objects:2:16".parse().expect("a stop rule"),
        cost: CostModel::WALD_HAVRAN,
        clipped: false,
    }
}

fn piece(scene: &Scene) -> Piece<'_> {
    Piece {
        scene,
        rules: rules(),
        seed: 1,
        id: "piece".into(),
    }
}

const fn way(method: Method) -> Way {
    Way {
        method,
        ask: Ask::All,
    }
}

const TRUTH: Truth = Truth {
    rates: [2.0, 0.0, 4.0, 10.0],
    errors: None,
};

/// Replicates whose C is off by these shares, and the others by none.
fn off_by(lines: u64, shares: &[f64]) -> (u64, Vec<Replicate>) {
    let replicate = |share: &f64| Replicate {
        rates: [2.0, 0.0, 4.0, 10.0 * (1.0 + share)],
        nodes: Some(share * share),
    };
    (lines, shares.iter().map(replicate).collect())
}

fn series(method: Method, found: &[(u64, Vec<Replicate>)], quantity: &str) -> Series {
    let all = Series::all(way(method), &TRUTH, found);
    let mut named = all.into_iter().filter(|s| s.quantity == quantity);
    named.next().expect("the quantity")
}

#[test]
fn errors_and_gains_by_hand() {
    let scene = Scene::load("simple:uniform:400").expect("a scene");
    let piece = piece(&scene);
    // 32 replicates, half off by 0.1 and half by -0.1; four times the lines halve that.
    let both = |share: f64| [share, -share].repeat(16);
    let random = [off_by(64, &both(0.1)), off_by(256, &both(0.05))];
    let other = [off_by(256, &both(0.025))];
    let random = series(Method::Random, &random, "C");
    let other = series(Method::Sobol, &other, "C");
    let rows = random.rows(&piece, &random);
    assert_eq!(rows.len(), 2);
    assert!((rows[0].rmse - 0.1).abs() < 1e-12 && rows[0].bias.expect("of C").abs() < 1e-12);
    // The interval of 32 degrees of freedom: -20 % to +32 %.
    assert!((rows[0].rmse_lo - 0.0804).abs() < 1e-4 && (rows[0].rmse_hi - 0.1323).abs() < 1e-4);
    assert_eq!(
        (rows[0].gain, rows[0].gain_lo, rows[0].truth),
        (None, None, Some(10.0))
    );
    let row = &other.rows(&piece, &random)[0];
    assert!((row.gain.expect("a gain") - 4.0).abs() < 1e-9);
    let (lo, hi) = (row.gain_lo.expect("lo"), row.gain_hi.expect("hi"));
    assert!(lo < 4.0 && 4.0 < hi && lo > 2.0 && hi < 8.0, "{lo} {hi}");
    // Of nodes all squares are equal, so every draw gives the same.
    let nodes = series(Method::Sobol, &[off_by(256, &both(0.025))], NODES);
    let own = series(Method::Random, &[off_by(256, &both(0.05))], NODES);
    let row = &nodes.rows(&piece, &own)[0];
    assert!((row.rmse_lo - 0.025).abs() + (row.rmse_hi - 0.025).abs() < 1e-12);
    assert_eq!((row.truth, row.bias), (None, None));
    // A truth of 0 has no relative error.
    let names = Series::all(way(Method::Random), &TRUTH, &[off_by(64, &[0.1])]);
    let names: Vec<_> = names.iter().map(|s| s.quantity).collect();
    assert_eq!(names, ["n_K", "n_t", "C", "nodes"]);
}

#[test]
fn a_power_law_has_its_exponent_and_its_lines() {
    let scene = Scene::load("simple:uniform:400").expect("a scene");
    let piece = piece(&scene);
    let level = |log2: u32| {
        let error = 2.0 * libm::pow(f64::from(1 << log2), -0.75);
        off_by(1 << log2, &[error, -error].repeat(16))
    };
    let found: Vec<_> = (8..=12).map(level).collect();
    let sobol = series(Method::Sobol, &found, "C");
    let fit = exponent(&sobol, &piece).expect("a fit");
    assert!((fit.exponent - 0.75).abs() < 1e-9 && (fit.factor - 2.0).abs() < 1e-9);
    assert_eq!((fit.from_lines, fit.to_lines), (256, 4096));
    // 2 N^-0.75 = 0.01 at N = 200^(4/3) = 1169.6, 1e-4 at 542884, 1e-12 beyond every set.
    let rows = enough(&sobol, &fit, &[0.01, 1e-4, 1e-12]);
    let rows: Vec<_> = rows.iter().map(|r| (r.lines, r.extrapolated)).collect();
    assert_eq!(rows, [(2048, false), (1 << 20, true)]);
    // Without an error there is nothing to fit.
    assert_eq!(
        exponent(&series(Method::Sobol, &found, "n_K"), &piece),
        None
    );
}

#[test]
fn the_reference_tells_its_own_error() {
    let replicates: Vec<Replicate> = off_by(8, &[0.1, -0.1, 0.1, -0.1]).1;
    let truth = Truth::of_reference(&replicates);
    let errors = truth.errors.expect("a reference has errors");
    assert!((truth.rates[3] - 10.0).abs() < 1e-12);
    // Deviations of 1: variance 4/3, of the mean 1/3.
    assert!((errors[3] - (1.0_f64 / 3.0).sqrt()).abs() < 1e-12 && errors[0] == 0.0);
}

/// Of independent lines NRMSE of nodes is 1/sqrt(N) exactly: within four standard errors, which its bootstrap tells. The
/// others do better, the conditional ones by far, and none is biased.
#[test]
fn real_lines_behave_as_theory_says() {
    let scene = Scene::load("simple:uniform:400").expect("a scene");
    let piece = piece(&scene);
    let tree = build_tree(&scene, &rules());
    let subject = Subject::new(&scene, &tree, CostModel::WALD_HAVRAN, 7);
    let p = &subject.prediction;
    let truth = Truth {
        rates: subject.rates([p.n_k, p.n_b, p.n_t]),
        errors: None,
    };
    let lines = 4096;
    let found = |method: Method| {
        let replicates = subject.replicates(way(method), 0, lines, 64, |_| ());
        Series::all(way(method), &truth, &[(lines, replicates)])
    };
    let random = found(Method::Random);
    let scaled = |all: &[Series]| -> [f64; 2] {
        let row = |quantity: &str| {
            let of = |s: &&Series| s.quantity == quantity;
            let [own, against] = [all, &random].map(|all| all.iter().find(of).expect("there"));
            own.rows(&piece, against).remove(0)
        };
        let (nodes, cost) = (row(NODES), row("C"));
        if nodes.sampler == "random" {
            let (lo, hi) = (nodes.rmse_lo * 64.0, nodes.rmse_hi * 64.0);
            assert!(
                (nodes.rmse * 64.0 - 1.0).abs() < 2.0 * (hi - lo) / 2.0,
                "{lo} {hi}"
            );
            assert!(hi - lo < 0.2, "{lo} {hi}");
        }
        let z = cost.bias.expect("of C") / cost.rmse * 8.0;
        assert!(
            z.abs() < 4.5,
            "{}: biased by {z} standard errors",
            cost.sampler
        );
        [nodes.rmse * 64.0, cost.rmse * 64.0]
    };
    let [_, cost] = scaled(&random);
    let [stratified, stratified_cost] = scaled(&found(Method::Stratified));
    assert!(stratified < 0.95 && stratified_cost < 0.9 * cost);
    let [sobol, sobol_cost] = scaled(&found(Method::Sobol));
    assert!(
        sobol < 0.85 && sobol_cost < 0.6 * cost,
        "{sobol} {sobol_cost}"
    );
    let [directions, _] = scaled(&found(Method::Conditional));
    assert!(directions < 0.3, "{directions}");
    let [both, _] = scaled(&found(Method::ConditionalSobol));
    assert!(both < 0.3 * directions, "{both} {directions}");
}

/// The same on one thread as on three, and of what the plain traversal counts.
#[test]
fn replicates_do_not_depend_on_threads() {
    let scene = Scene::load("simple:uniform:400").expect("a scene");
    let tree = build_tree(&scene, &rules());
    let subject = Subject::new(&scene, &tree, CostModel::WALD_HAVRAN, 7);
    for (method, ask) in [
        (Method::Stratified, Ask::All),
        (Method::Sobol, Ask::All),
        (Method::Sobol, Ask::Nearest),
        (Method::ConditionalSobol, Ask::All),
    ] {
        let lines = method.sampler().nearest_size(1 << 15);
        let run = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
            let way = Way { method, ask };
            let count = || subject.replicates(way, 2, lines, 3, |_| ());
            pool.build().expect("threads").install(count)
        };
        assert_eq!(run(1), run(3));
        assert_ne!(run(1)[0], run(1)[1]);
        if ask == Ask::All && !method.is_conditional() {
            let mut counts = crate::kd::Counts::new(&tree);
            let mut stack = crate::kd::Stack::default();
            let set = subject.set(method, 2, 0, lines);
            for line in set.lines(&scene.world, 0..lines) {
                let span = crate::geom::Span::FULL;
                crate::kd::traverse::traverse_line(&tree, &line, span, &mut stack, &mut counts);
            }
            let rate = counts.work.tests as f64 / lines as f64;
            assert_eq!(run(1)[0].rates[2], rate);
        }
    }
    assert_eq!(Method::Conditional.sampler(), Sampler::Random);
}
