//! What is hit is what brute force hits, and the work is that of a traversal written apart.

use std::fs;

use sahlab::geom::Cast;
use sahlab::kd::{Ask, Rules, build_objects};
use sahlab::scene::Scene;
use sahlab::study::records::HitRecord;
use tempfile::tempdir;

use crate::common::rules;
use crate::reference::{Walk, brute_force, hard_casts};
use crate::{as_csv, as_npy, numbers, traced};

const TREES: [(&str, &str, &str, bool); 7] = [
    ("spd:tetra:3", "sah", "cost-gain", false),
    ("spd:balls:2", "sah-longest", "objects:1", false),
    ("spd:tree:3", "object-median", "objects:2:12", false),
    ("simple:mixture:300", "spatial-median", "objects:1:14", true),
    ("simple:flat:200", "sah-cyclic", "cost-gain", false),
    (
        "simple:overlapping:40",
        "median-midpoint",
        "automatic",
        false,
    ),
    ("simple:soup:200", "sah", "objects:1", true),
];

#[test]
fn hits_are_brute_forces_and_work_is_the_traversals() {
    for (name, strategy, stop, clipped) in TREES {
        let scene = Scene::load(name).unwrap();
        let rules = Rules {
            clipped,
            ..rules(strategy.parse().unwrap(), stop)
        };
        let tree = build_objects(&scene.objects, &scene.bounds, scene.world, &rules);
        let casts = hard_casts(&scene, &tree, 150);
        let folder = tempdir().unwrap();
        fs::write(folder.path().join("r.csv"), as_csv(&casts)).unwrap();
        for ask in Ask::ALL {
            let mut more = vec!["--ask", ask.name(), "--strategy", strategy, "--stop", stop];
            if clipped {
                more.push("--clipped");
            }
            let (rows, record) = traced(folder.path(), name, "r.csv", &more);
            assert_eq!(rows.len(), casts.len());
            let mut sums = [0; 4];
            for (i, (row, cast)) in rows.iter().zip(&casts).enumerate() {
                let what = format!("{name} {strategy} {ask} ray {i}: {cast:?}");
                let expected = brute_force(&scene, &cast.ray());
                let walk = Walk::new(&scene, &tree, ask, cast);
                let found = row.object.zip(row.t);
                if ask == Ask::Any {
                    // Any of those that can be hit: the one that the traversal comes to first.
                    assert_eq!(found.is_some(), expected.is_some(), "{what}");
                    assert_eq!(found, walk.hit.map(|h| (h.object, h.t)), "{what}");
                } else {
                    assert_eq!(found, expected.map(|h| (h.object, h.t)), "{what}");
                }
                let own = [row.n_k, row.n_b, row.n_t];
                let work = walk.work;
                assert_eq!(own, [work.inner, work.leaves, work.tests], "{what}");
                assert_eq!(row.ray, i as u64);
                for (sum, n) in sums
                    .iter_mut()
                    .zip([&own[..], &[u64::from(found.is_some())]].concat())
                {
                    *sum += n;
                }
            }
            let told = [
                record.inner_visits,
                record.leaf_visits,
                record.object_tests,
                record.hits,
            ];
            assert_eq!(told, sums);
            let hits = record.hits as usize;
            assert!(
                10 * hits > casts.len() && 10 * hits < 9 * casts.len(),
                "{name}: {hits}"
            );
        }
    }
}

/// Directions times a power of two: t is divided by it, and nothing else changes.
#[test]
fn t_counts_in_units_of_the_direction() {
    let folder = tempdir().unwrap();
    for name in ["spd:tree:3", "simple:mixture:300"] {
        let scene = Scene::load(name).unwrap();
        let tree = build_objects(
            &scene.objects,
            &scene.bounds,
            scene.world,
            &rules("sah".parse().unwrap(), "cost-gain"),
        );
        let normal = |cast: &Cast| (0.1..1e3).contains(&cast.direction.abs().max_element());
        let casts: Vec<Cast> = hard_casts(&scene, &tree, 100)
            .into_iter()
            .filter(normal)
            .collect();
        let rows = |scale: f64| -> Vec<HitRecord> {
            let scaled = casts.iter().map(|cast| {
                let mut cast = *cast;
                cast.direction *= scale;
                cast.span.t1 /= scale;
                cast
            });
            let bytes = as_npy(7, scaled.flat_map(|cast| numbers(&cast)));
            fs::write(folder.path().join("r.npy"), bytes).unwrap();
            let (mut rows, _) = traced(folder.path(), name, "r.npy", &[]);
            rows.iter_mut()
                .for_each(|row| row.t = row.t.map(|t| t * scale));
            rows
        };
        let plain = rows(1.0);
        assert!(plain.iter().filter(|row| row.t.is_some()).count() > 100);
        for exponent in [-150, -20, 20, 150] {
            assert_eq!(rows(2.0_f64.powi(exponent)), plain, "2^{exponent}");
        }
    }
}
