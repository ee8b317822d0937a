//! Primary rays: how many of the 513 x 513 through the pixels' corners hit anything, what kind of object, and how far off.
//!
//! The package writes six digits. With them, and with its camera, the counts at the sizes of G4 are those that Havran
//! published in 1999.

use std::collections::HashMap;
use std::ops::Range;

use glam::DVec3;
use rayon::prelude::*;
use sahlab::cost::CostModel;
use sahlab::geom::{Cone, Objects, Polygon, Ray, Span, Sphere, Triangle};
use sahlab::kd::{Hit, Rules, Stack, Strategy, build, nearest};
use sahlab::scene::Scene;
use sahlab::scene::look::View;
use sahlab::tracer::{Camera, PIXELS};

use crate::facts::{Facts, table};

/// The nearest hits of a view's rays, the rows from the top down.
fn hits(scene: &Scene, view: &View) -> Vec<Hit> {
    let rules = Rules {
        strategy: Strategy::Sah,
        stop: "cost-gain".parse().unwrap(),
        cost: CostModel::WALD_HAVRAN,
        clipped: false,
    };
    let tree = build(&scene.bounds, scene.world, &rules);
    let camera = Camera::new(view, PIXELS);
    let row = |j: u32| {
        let mut stack = Stack::default();
        let mut hit = |i| {
            let ray = Ray::new(camera.ray(i, j), Span::from(1e-9));
            nearest(&tree, &scene.objects, &ray, &mut stack)
        };
        (0..camera.corners())
            .filter_map(&mut hit)
            .collect::<Vec<_>>()
    };
    let rows: Vec<_> = (0..camera.corners()).into_par_iter().map(row).collect();
    rows.concat()
}

fn view(scene: &Scene) -> View {
    scene.look.as_ref().unwrap().stage.view
}

#[test]
fn primary_hits() {
    Facts::all().par_iter().for_each(|f| {
        let scene = f.scene();
        let hits = hits(&scene, &view(&scene));
        let three = |_: f64| 3.0;
        let count = |n: usize| Some(n as f64);
        f.check("primary_hits_513", count(hits.len()), three);
        let o = &scene.objects;
        let spheres = o.triangles.len()..o.triangles.len() + o.spheres.len();
        let cones = spheres.end..spheres.end + o.cones.len();
        let of = |kind: &Range<usize>| {
            hits.iter()
                .filter(|h| kind.contains(&(h.object as usize)))
                .count()
        };
        let (on_spheres, on_cones) = (of(&spheres), of(&cones));
        f.check("primary_hits_sphere", count(on_spheres), three);
        f.check("primary_hits_cone", count(on_cones), three);
        let on_faces = hits.len() - on_spheres - on_cones;
        f.check("primary_hits_poly", count(on_faces), three);
        let sum: f64 = hits.iter().map(|h| h.t).sum();
        let mean = sum / hits.len() as f64;
        f.check("primary_mean_hit_t", Some(mean), |fact| 1e-4 * fact);
    });
}

#[test]
fn primary_hits_at_six_digits_are_havrans() {
    let published = table("havran1999-rays.csv");
    let compare = |f: &Facts| {
        let scene = f.scene();
        let six = Scene::new(f.name(), six_digits(&scene.objects), Vec::new()).unwrap();
        let mut view = view(&scene);
        view.from = rounded(view.from);
        view.at = rounded(view.at);
        view.up = rounded(view.up);
        let ours = hits(&six, &view).len();
        f.check("nff6_primary_hits_513", Some(ours as f64), |_| 3.0);
        let same = |p: &&HashMap<String, String>| p["scene"] == f.text("scene");
        let his = published.iter().find(same);
        his.filter(|_| f.text("group") == "G4").is_some_and(|row| {
            let his: usize = row["primary_hits"].parse().unwrap();
            assert!(ours.abs_diff(his) <= 3, "{}: {ours}, not {his}", f.name());
            true
        })
    };
    let all = Facts::all();
    let compared = all.par_iter().filter(|f| compare(f)).count();
    assert_eq!(compared, published.len());
}

fn round(x: f64) -> f64 {
    format!("{x:.5e}").parse().unwrap()
}

fn rounded(p: DVec3) -> DVec3 {
    p.map(round)
}

/// The objects as the package writes them.
fn six_digits(objects: &Objects) -> Objects {
    let polygon = |p: &Polygon| {
        let corners = p.corners().iter().copied().map(rounded);
        Polygon::new(corners.collect()).unwrap()
    };
    Objects {
        triangles: objects
            .triangles
            .iter()
            .map(|t| Triangle(t.0.map(rounded)))
            .collect(),
        spheres: objects
            .spheres
            .iter()
            .map(|s| Sphere {
                centre: rounded(s.centre),
                radius: round(s.radius),
            })
            .collect(),
        cones: objects
            .cones
            .iter()
            .map(|c| Cone {
                base: rounded(c.base),
                base_radius: round(c.base_radius),
                apex: rounded(c.apex),
                apex_radius: round(c.apex_radius),
            })
            .collect(),
        polygons: objects.polygons.iter().map(polygon).collect(),
    }
}
