//! Camera, lights and materials. The file gives nine digits.

use glam::DVec3;
use rayon::prelude::*;
use sahlab::scene::Look;
use sahlab::scene::look::Material;

use crate::facts::Facts;

/// The numbers of a cell, which stand between spaces.
fn numbers(cell: &str) -> Vec<f64> {
    cell.split_whitespace()
        .map(|n| n.parse().unwrap())
        .collect()
}

/// Triples between bars.
fn points(cell: &str) -> Vec<DVec3> {
    let triple = |t| DVec3::from_slice(&numbers(t));
    cell.split('|').map(triple).collect()
}

fn assert_near(f: &Facts, column: &str, ours: &[DVec3]) {
    let facts = points(f.text(column));
    let near = |(a, b): (&DVec3, &DVec3)| (a - b).abs().max_element() <= 1e-8;
    assert!(
        facts.len() == ours.len() && facts.iter().zip(ours).all(near),
        "{} {column}: {ours:?}, not {facts:?}",
        f.name()
    );
}

#[test]
fn looks_are_those_of_the_package() {
    Facts::all().par_iter().for_each(|f| {
        let scene = f.scene();
        let look = scene.look.as_ref().unwrap();
        let view = look.stage.view;
        f.exact("n_lights", look.stage.lights.len());
        assert_near(f, "lights", &look.stage.lights);
        assert_near(f, "background", &[look.stage.background]);
        assert_near(f, "cam_from", &[view.from]);
        assert_near(f, "cam_at", &[view.at]);
        assert_near(f, "cam_up", &[view.up]);
        f.check("cam_angle", Some(view.angle), |_| 0.0);
        f.check("cam_hither", Some(view.hither), |_| 0.0);
        let resolution = view.resolution.map(f64::from);
        assert_eq!(numbers(f.text("cam_resolution")), resolution);

        // Every record is some object's material.
        f.exact("n_material_records", look.materials.len());
        assert_eq!(look.material_of.len(), scene.objects.len());
        let mut used = vec![false; look.materials.len()];
        for &m in &look.material_of {
            used[m as usize] = true;
        }
        assert!(used.iter().all(|&u| u), "{}", f.name());
        let triangles = scene.objects.triangles.len();
        assert!(look.normals.is_empty() || look.normals.len() == triangles);
    });
}

fn look(name: &str) -> Look {
    let scene = sahlab::scene::Scene::load(name).unwrap();
    scene.look.unwrap()
}

fn is_glass(material: &&Material) -> bool {
    material.transmittance > 0.0
}

#[test]
fn glass_is_where_the_package_has_it() {
    for (name, glass) in [
        ("spd:gears:2", 2),
        ("spd:gears:4", 13),
        ("spd:gears:9", 146),
        ("spd:mount:4", 1),
        ("spd:balls:3", 0),
    ] {
        assert_eq!(
            look(name).materials.iter().filter(is_glass).count(),
            glass,
            "{name}"
        );
    }
    // The four spheres, which come after the triangles, are of glass.
    let mount = look("spd:mount:4");
    let (mountain, spheres) = mount.material_of.split_at(512);
    assert!(mountain.iter().all(|&m| m == 1) && spheres == [0; 4]);
    let glass = mount.materials[0];
    assert_eq!([glass.transmittance, glass.index], [0.9, 1.5]);
    assert!((glass.shine - 101.148).abs() < 5e-4);
}

/// Cylinders have the colour of their axis; a ring's five tubes and balls are of one colour.
#[test]
fn colours_follow_the_objects() {
    let scene = sahlab::scene::Scene::load("spd:lattice:6").unwrap();
    let look = scene.look.as_ref().unwrap();
    let colour = |object: usize| look.materials[look.material_of[object] as usize].colour;
    let spheres = scene.objects.spheres.len();
    for (i, cone) in scene.objects.cones.iter().enumerate() {
        let axis = (cone.apex - cone.base).normalize();
        let wanted = DVec3::splat(0.1) + 0.8 * axis;
        assert!(colour(spheres + i).distance(wanted) < 1e-12);
    }
    assert!((0..spheres).all(|i| colour(i) == DVec3::splat(0.9)));

    let scene = sahlab::scene::Scene::load("spd:rings:3").unwrap();
    let look = scene.look.as_ref().unwrap();
    let n = scene.objects.spheres.len();
    for i in 0..n {
        let ring = 1 + (i / 5) as u32;
        assert_eq!([look.material_of[i], look.material_of[n + i]], [ring; 2]);
    }
    assert_eq!(look.materials[3].colour, DVec3::Z);
    assert_eq!(look.materials[10].colour, look.materials[4].colour);
}
