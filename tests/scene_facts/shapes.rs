//! What must hold between the objects of a scene.

use std::collections::HashMap;

use glam::DVec3;
use sahlab::geom::Objects;
use sahlab::scene::Scene;

fn load(name: &str) -> Scene {
    Scene::load(&format!("spd:{name}")).unwrap()
}

fn objects(name: &str) -> Objects {
    load(name).objects
}

#[test]
fn spheres_of_balls_and_mount_touch_and_never_overlap() {
    for (name, contacts) in [("balls:4", 7380), ("mount:4", 6)] {
        let spheres = objects(name).spheres;
        let mut found = 0;
        for (i, a) in spheres.iter().enumerate() {
            for b in &spheres[..i] {
                let gap = a.centre.distance(b.centre) - a.radius - b.radius;
                assert!(gap > -1e-14, "{name}: overlap {gap}");
                found += usize::from(gap < 1e-14);
            }
        }
        assert_eq!(found, contacts, "{name}");
    }
}

/// The radii of a generation add up to three times those of the one before.
#[test]
fn radii_of_balls_grow_by_half_a_power_of_three() {
    for size in 1..=5 {
        let spheres = objects(&format!("balls:{size}")).spheres;
        let total: f64 = spheres.iter().map(|s| s.radius).sum();
        let exact: f64 = (0..=size).map(|k| 0.5 * 3_f64.powi(k)).sum();
        assert!((total / exact - 1.0).abs() < 1e-12);
    }
}

/// Every coordinate is a multiple of 1/32, so every box is a cube of side 1/16 on a grid.
#[test]
fn tetra_is_exact() {
    let scene = load("tetra:6");
    for b in &scene.bounds {
        assert_eq!(b.extent(), DVec3::splat(1.0 / 16.0));
        assert_eq!(32.0 * b.lo, (32.0 * b.lo).round());
    }
}

#[test]
fn cylinders_of_lattice_end_within_spheres() {
    let objects = objects("lattice:3");
    for cone in &objects.cones {
        for end in [cone.base, cone.apex] {
            let within = |s: &&sahlab::geom::Sphere| {
                end.distance(s.centre).hypot(cone.base_radius) < s.radius
            };
            assert_eq!(objects.spheres.iter().filter(within).count(), 1);
        }
    }
}

/// A ring's tubes and a tree's branches run from the ball at one end to the ball at the other.
#[test]
fn balls_close_the_ends_of_rings_and_branches() {
    for name in ["rings:2", "tree:5"] {
        let objects = objects(name);
        for cone in &objects.cones {
            let ball = |end: DVec3, radius: f64| {
                let fits = |s: &&sahlab::geom::Sphere| {
                    s.centre.distance(end) < 1e-14 && (s.radius - radius).abs() < 1e-15
                };
                objects.spheres.iter().any(|s| fits(&s)) || end == DVec3::ZERO
            };
            assert!(ball(cone.base, cone.base_radius), "{name}");
            assert!(ball(cone.apex, cone.apex_radius), "{name}");
        }
    }
}

/// Up to size 7 a mountain keeps the points of the one before; size 8 is another mountain.
#[test]
fn mount_is_refined() {
    let heights = |size: usize| -> HashMap<[u64; 2], f64> {
        let triangles = objects(&format!("mount:{size}")).triangles;
        let corners = triangles.iter().flat_map(|t| t.0);
        corners
            .map(|c| ([c.x, c.y].map(f64::to_bits), c.z))
            .collect()
    };
    for size in 4..=7 {
        let (coarse, fine) = (heights(size), heights(size + 1));
        assert_eq!(coarse.len(), ((1 << size) + 1) * ((1 << size) + 1));
        let kept = coarse.iter().all(|(place, z)| fine[place] == *z);
        assert_eq!(kept, size < 7, "{size}");
    }
}

#[test]
fn sombrero_peaks_at_one_off_the_middle() {
    let triangles = objects("sombrero:2").triangles;
    let corners = triangles.iter().flat_map(|t| t.0);
    let peak = corners
        .reduce(|a, b| if b.y > a.y { b } else { a })
        .unwrap();
    let middle = -4.0 + 8.0 * 32.0 / 63.0;
    assert_eq!(peak, DVec3::new(middle, -2.0, middle));
    assert!(triangles.iter().all(|t| t.normal().y > 0.0));
}

/// Normals have unit length and look to the side of their triangle; neighbouring patches share their borders.
#[test]
fn teapot_is_smooth() {
    let scene = load("teapot:6");
    let normals = &scene.look.as_ref().unwrap().normals;
    let mut facing = 0;
    for (triangle, normals) in scene.objects.triangles.iter().zip(normals) {
        for n in normals.unwrap() {
            assert!((n.length() - 1.0).abs() < 1e-12);
            facing += usize::from(n.dot(triangle.normal()) > 0.0);
        }
    }
    let all = 3 * normals.len();
    assert!(1000 * facing > 995 * all, "{facing} of {all}");
}

/// A gear's outline is closed: each edge of a face is the edge of one side, run the other way.
#[test]
fn gears_are_closed() {
    let polygons = objects("gears:2").polygons;
    for gear in polygons[1..].chunks(146) {
        let mut edges: HashMap<[[u64; 3]; 2], i32> = HashMap::new();
        for polygon in gear {
            let corners = polygon.corners();
            for (i, a) in corners.iter().enumerate() {
                let b = corners[(i + 1) % corners.len()];
                let bits = |p: &DVec3| p.to_array().map(f64::to_bits);
                *edges.entry([bits(a), bits(&b)]).or_default() += 1;
                *edges.entry([bits(&b), bits(a)]).or_default() -= 1;
            }
        }
        assert_eq!(edges.len(), 2 * (3 * 144));
        assert!(edges.values().all(|&n| n == 0));
    }
}
