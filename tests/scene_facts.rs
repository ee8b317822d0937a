//! The SPD generators against facts measured on the original programs (`data/reference/spd-facts.csv`).
//!
//! Counts are exact; sums, least and largest values hold to 1e-9 relative; the box and the centroids to 1e-9 of the
//! longest box side, as several are zero up to rounding.

use std::collections::HashMap;

use glam::DVec3;
use sahlab::geom::Triangle;
use sahlab::scene::Scene;

/// A row of the file by its column names; an empty cell is absent.
struct Facts {
    row: HashMap<String, String>,
    longest: f64,
}

impl Facts {
    fn number(&self, column: &str) -> Option<f64> {
        let cell = &self.row[column];
        (!cell.is_empty()).then(|| cell.parse().expect("a number"))
    }

    fn check(&self, column: &str, value: Option<f64>, tolerance: impl Fn(f64) -> f64) {
        let scene = format!("{}:{} {column}", self.row["scene"], self.row["size"]);
        match (self.number(column), value) {
            (None, None) => {}
            (Some(fact), Some(ours)) => {
                assert!(
                    (fact - ours).abs() <= tolerance(fact),
                    "{scene}: {ours}, not {fact}"
                );
            }
            (fact, ours) => panic!("{scene}: {ours:?}, not {fact:?}"),
        }
    }

    fn exact(&self, column: &str, value: usize) {
        self.check(column, Some(value as f64), |_| 0.0);
    }

    fn relative(&self, column: &str, value: Option<f64>) {
        self.check(column, value, |fact| 1e-9 * fact.abs());
    }

    fn place(&self, columns: &str, axes: [&str; 3], value: Option<DVec3>) {
        for (k, axis) in axes.into_iter().enumerate() {
            let column = columns.replace('*', axis);
            self.check(&column, value.map(|v| v[k]), |_| 1e-9 * self.longest);
        }
    }
}

fn facts() -> Vec<Facts> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/data/reference/spd-facts.csv");
    let mut reader = csv::Reader::from_path(path).expect("the reference file");
    let rows = reader.deserialize().map(|row| {
        let row: HashMap<String, String> = row.expect("a row");
        let mut facts = Facts { row, longest: 0.0 };
        let side = |axis: &str| {
            let end = |which: &str| facts.number(&format!("bb_{axis}{which}")).expect("a box");
            end("max") - end("min")
        };
        facts.longest = ["x", "y", "z"].map(side).into_iter().fold(0.0, f64::max);
        facts
    });
    rows.collect()
}

fn sum(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().sum()
}

fn least(values: &[f64]) -> Option<f64> {
    values.iter().copied().reduce(f64::min)
}

fn largest(values: &[f64]) -> Option<f64> {
    values.iter().copied().reduce(f64::max)
}

fn mean(points: &[DVec3]) -> Option<DVec3> {
    let total: DVec3 = points.iter().sum();
    (!points.is_empty()).then(|| total / points.len() as f64)
}

fn squares(points: &[DVec3]) -> Option<f64> {
    let total = points.iter().map(|p| p.length_squared()).sum();
    (!points.is_empty()).then_some(total)
}

#[test]
fn generators_reproduce_the_facts() {
    let all = facts();
    assert_eq!(all.len(), 8);
    for f in all {
        let spec = format!("spd:{}:{}", f.row["scene"], f.row["size"]);
        let scene = Scene::load(&spec).expect("an SPD scene");
        let objects = &scene.objects;
        let triangles: Vec<Vec<DVec3>> = objects.triangles.iter().map(|t| t.0.into()).collect();
        let polygons: Vec<Vec<DVec3>> = objects
            .polygons
            .iter()
            .map(|p| p.corners().into())
            .collect();
        let faces = [triangles, polygons].concat();
        let with = |n: usize| faces.iter().filter(|p| p.len() == n).count();
        let corners = faces.concat();
        let areas: Vec<f64> = objects
            .triangles
            .iter()
            .map(Triangle::area)
            .chain(objects.polygons.iter().map(|p| p.area()))
            .collect();
        let centres: Vec<DVec3> = objects.spheres.iter().map(|s| s.centre).collect();
        let radii: Vec<f64> = objects.spheres.iter().map(|s| s.radius).collect();

        f.exact("n_prims", objects.len());
        f.exact("n_sphere", radii.len());
        f.exact("n_poly_p", faces.len());
        f.exact("n_tri", with(3));
        f.exact("n_quad", with(4));
        f.exact("n_poly_vertices", corners.len());
        f.place("bb_*", ["xmin", "ymin", "zmin"], Some(scene.world.lo));
        f.place("bb_*", ["xmax", "ymax", "zmax"], Some(scene.world.hi));
        f.relative("poly_area_sum", Some(sum(areas.iter().copied())));
        f.relative("poly_area_min", least(&areas));
        f.relative("poly_area_max", largest(&areas));
        f.relative("sphere_radius_sum", Some(sum(radii.iter().copied())));
        f.relative("sphere_radius_min", least(&radii));
        f.relative("sphere_radius_max", largest(&radii));
        let xyz = ["x", "y", "z"];
        f.place("poly_vertex_centroid_*", xyz, mean(&corners));
        f.place("sphere_center_centroid_*", xyz, mean(&centres));
        f.relative("vertex_sumsq", squares(&corners));
        f.relative("sphere_center_sumsq", squares(&centres));
    }
}

#[test]
fn balls_4_spot_values() {
    let spheres = Scene::load("spd:balls").expect("balls 4").objects.spheres;
    let expected = [
        (1, [0.272165526976, 0.272165526976, 0.544331053952]),
        (10, [0.494533575223, 0.477074148527, 0.599616460733]),
        (3690, [-0.427755954051, 0.532512514227, -0.243605565526]),
        (7380, [0.436485667399, -0.541242227575, -0.222222222222]),
    ];
    for (i, centre) in expected {
        let c = spheres[i].centre;
        assert!(c.distance(centre.into()) < 2e-12, "sphere {i}: {c}");
    }
    for (i, radius) in [(1, 0.166666666667), (10, 0.00617283950617)] {
        assert!((spheres[i].radius - radius).abs() < 1e-12, "sphere {i}");
    }
}

#[test]
fn tetra_6_spot_value_and_exactness() {
    let scene = Scene::load("spd:tetra").expect("tetra 6");
    let first = [
        [-1.0, -1.0, 1.0],
        [-1.0, -0.9375, 0.9375],
        [-0.9375, -1.0, 0.9375],
    ];
    assert_eq!(scene.objects.triangles[0].0, first.map(DVec3::from));
    // Every coordinate is a multiple of 1/32, so every box is a cube of side 1/16 on a grid.
    for b in &scene.bounds {
        assert_eq!(b.extent(), DVec3::splat(1.0 / 16.0));
        assert_eq!(32.0 * b.lo, (32.0 * b.lo).round());
    }
}

/// The radii of a generation add up to three times those of the one before.
#[test]
fn radii_of_balls_grow_by_half_a_power_of_three() {
    for size in 1..=5 {
        let objects = Scene::load(&format!("spd:balls:{size}"))
            .expect("balls")
            .objects;
        let total = sum(objects.spheres.iter().map(|s| s.radius));
        let exact: f64 = (0..=size).map(|k| 0.5 * 3_f64.powi(k)).sum();
        assert!((total / exact - 1.0).abs() < 1e-12);
    }
}
