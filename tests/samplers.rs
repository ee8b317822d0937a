//! The sampler's law, checked five ways; every look-alike must be caught.
#![allow(clippy::unwrap_used, missing_docs)]

use glam::DVec3;
use sahlab::geom::{Aabb, Span};
use sahlab::rays::checks::{SamplerChecks, check_sampler};
use sahlab::rays::{LineLaw, SurfaceLines};

const SEED: u64 = 20_260_611;
const LINES: u64 = 1 << 20;

fn root() -> Aabb {
    Aabb::new(DVec3::ZERO, DVec3::new(1.0, 0.8, 0.5))
}

fn of_law(law: LineLaw, lines: u64) -> SamplerChecks {
    let world = root();
    check_sampler(&world, SEED, lines, |i| law.sample(&world, SEED, i))
}

/// The smallest p-value there is.
fn least(checks: &SamplerChecks) -> f64 {
    checks.values().into_iter().flatten().fold(1.0, f64::min)
}

fn show(name: &str, checks: &SamplerChecks) {
    let show = |p: Option<f64>| p.map_or(format!("{:>9}", "-"), |p| format!("{p:9.2e}"));
    println!("{name:>20}  {}", checks.values().map(show).join(" "));
}

/// False alarm: five p-values for each of four samplers, each below 1e-4 with that chance, so 0.2 % for the test.
#[test]
fn exact_laws_pass() {
    let world = root();
    let lines: Vec<_> = (SurfaceLines { world, seed: SEED })
        .range(0..LINES)
        .collect();
    let ours = check_sampler(&world, SEED, LINES, |i| (lines[i as usize], Span::FULL));
    show("the study's lines", &ours);
    assert!(least(&ours) >= 1e-4);
    for law in LineLaw::EXACT {
        let checks = of_law(law, LINES);
        show(law.name(), &checks);
        assert!(checks.values().iter().all(Option::is_some));
        assert!(least(&checks) >= 1e-4, "{}", law.name());
    }
}

#[test]
fn every_wrong_law_is_caught() {
    for law in LineLaw::WRONG {
        let checks = of_law(law, LINES);
        show(law.name(), &checks);
        assert!(least(&checks) < 1e-6, "{} passed", law.name());
    }
}

/// Why five checks: boxes see nothing wrong with lines along the axes.
#[test]
fn boxes_alone_are_blind_to_axis_parallel_lines() {
    let checks = of_law(LineLaw::AxesOnly, LINES);
    assert!(checks.boxes.unwrap() > 1e-4);
    assert!(
        checks.mean_chord.unwrap() < 1e-6
            && checks.directions.unwrap() < 1e-6
            && checks.triangles.unwrap() < 1e-6
    );
}

/// Other boxes: far from cubic, flat, far from the origin, large and small. The exact values hold for all of them; chords
/// are left out for needles and sheets.
#[test]
fn the_law_holds_for_any_box() {
    let mut without_fourth = 0;
    for (lo, extent) in [
        (DVec3::ZERO, DVec3::new(1.0, 1.0, 0.01)),
        (DVec3::splat(1e6), DVec3::new(3.0, 1.0, 2.0)),
        (DVec3::ZERO, DVec3::new(100.0, 1.0, 1.0)),
        (DVec3::ZERO, DVec3::new(1.0, 1.0, 1e-4)),
        (DVec3::ZERO, DVec3::new(1e6, 1.0, 1.0)),
        (DVec3::ZERO, DVec3::new(1.0, 2.0, 0.0)),
        (DVec3::splat(-1e120), 1e120 * DVec3::new(1.0, 0.8, 0.5)),
        (DVec3::splat(1e-120), 1e-120 * DVec3::new(1.0, 0.8, 0.5)),
    ] {
        let world = Aabb::new(lo, lo + extent);
        for seed in 0..4 {
            let lines: Vec<_> = (SurfaceLines { world, seed }).range(0..1 << 16).collect();
            let checks = check_sampler(&world, seed, 1 << 16, |i| (lines[i as usize], Span::FULL));
            show(&format!("{extent}"), &checks);
            assert!(least(&checks) >= 1e-5, "{world:?} seed {seed}");
            without_fourth += usize::from(checks.fourth_chord.is_none());
            assert!(checks.boxes.is_some() && checks.directions.is_some());
        }
    }
    assert!(
        without_fourth >= 8,
        "needles and sheets have no fourth moment to speak of"
    );
}
