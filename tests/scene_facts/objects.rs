//! Counts are exact; sums, least and largest values hold to 1e-9 relative; the box and the centroids to 1e-9 of the
//! longest box side, as several are zero up to rounding.

use glam::DVec3;
use rayon::prelude::*;
use sahlab::geom::{Aabb, Cone, Triangle};
use sahlab::scene::{SPD_GROUPS, Scene, catalogue, spd_group, spd_scenes};

use crate::facts::Facts;

#[test]
fn generators_reproduce_the_facts() {
    let all = Facts::all();
    assert_eq!(all.len(), 41);
    all.par_iter().for_each(|f| check(f, &f.scene()));
}

fn check(f: &Facts, scene: &Scene) {
    let o = &scene.objects;
    let triangles = o.triangles.iter().map(|t| &t.0[..]);
    let faces: Vec<&[DVec3]> = triangles
        .chain(o.polygons.iter().map(|p| p.corners()))
        .collect();
    let with = |n: usize| faces.iter().filter(|p| p.len() == n).count();
    let corners = faces.concat();
    let areas = o.triangles.iter().map(Triangle::area);
    let areas: Vec<f64> = areas.chain(o.polygons.iter().map(|p| p.area())).collect();
    let centres: Vec<DVec3> = o.spheres.iter().map(|s| s.centre).collect();
    let radii: Vec<f64> = o.spheres.iter().map(|s| s.radius).collect();
    let ends: Vec<DVec3> = o.cones.iter().flat_map(|c| [c.base, c.apex]).collect();
    let straight = |c: &&Cone| c.base_radius == c.apex_radius;
    let cylinders = o.cones.iter().filter(straight).count();
    let normals = &scene.look.as_ref().unwrap().normals;
    let patches = normals.iter().flatten().count();

    f.exact("n_prims", o.len());
    f.exact("n_sphere", radii.len());
    f.exact("n_cone_records", o.cones.len());
    f.exact("n_cylinder", cylinders);
    f.exact("n_true_cone", o.cones.len() - cylinders);
    f.exact("n_poly_p", faces.len() - patches);
    f.exact("n_patch_pp", patches);
    f.exact("n_tri", with(3));
    f.exact("n_quad", with(4));
    f.exact("n_ngon", faces.len() - with(3) - with(4));
    f.exact("n_poly_vertices", corners.len());

    let (low, high) = (["xmin", "ymin", "zmin"], ["xmax", "ymax", "zmax"]);
    f.place("bb_*", low, Some(scene.world.lo));
    f.place("bb_*", high, Some(scene.world.hi));
    let whole = whole_ends(scene);
    f.place("bbcons_*", low, Some(whole.lo));
    f.place("bbcons_*", high, Some(whole.hi));

    f.relative("poly_area_sum", Some(areas.iter().sum()));
    f.relative("poly_area_min", areas.iter().copied().reduce(f64::min));
    f.relative("poly_area_max", areas.iter().copied().reduce(f64::max));
    f.relative("sphere_radius_sum", Some(radii.iter().sum()));
    f.relative("sphere_radius_min", radii.iter().copied().reduce(f64::min));
    f.relative("sphere_radius_max", radii.iter().copied().reduce(f64::max));
    let lengths = o.cones.iter().map(Cone::length).sum();
    f.relative("cone_axis_len_sum", Some(lengths));
    let lateral = o.cones.iter().map(Cone::area).sum();
    f.relative("cone_lateral_area_sum", Some(lateral));
    let xyz = ["x", "y", "z"];
    f.place("poly_vertex_centroid_*", xyz, mean(&corners));
    f.place("sphere_center_centroid_*", xyz, mean(&centres));
    f.place("cone_endpoint_centroid_*", xyz, mean(&ends));
    f.relative("vertex_sumsq", squares(&corners));
    f.relative("sphere_center_sumsq", squares(&centres));
}

/// The box with a whole sphere at either end of every cone.
fn whole_ends(scene: &Scene) -> Aabb {
    let ends = scene.objects.cones.iter().flat_map(|c| {
        [(c.base, c.base_radius), (c.apex, c.apex_radius)]
            .map(|(end, radius)| Aabb::new(end - radius, end + radius))
    });
    ends.fold(scene.world, Aabb::union)
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
fn groups_are_those_of_the_facts() {
    let mut grouped = 0;
    for f in Facts::all() {
        let group = f.text("group");
        assert_eq!(spd_group(&f.name()).unwrap_or(""), group, "{}", f.name());
        grouped += usize::from(!group.is_empty());
    }
    assert_eq!(grouped, 30);
    for group in SPD_GROUPS {
        let scenes = spd_scenes(group);
        assert_eq!(scenes.len(), 10);
        assert!(scenes.iter().all(|s| spd_group(s) == Some(group)));
    }
    assert!(spd_scenes("G6").is_empty() && spd_group("spd:balls").is_none());
    // Without a size one gets that of G4.
    for (spec, _) in catalogue().iter().filter(|(s, _)| s.starts_with("spd:")) {
        let name = Scene::load(spec).unwrap().name;
        assert!(spd_scenes("G4").contains(&name), "{name}");
    }
}

/// Sizes that the file has no row of.
#[test]
fn any_size_has_the_objects_of_its_formula() {
    for (name, objects) in [
        ("gears:3", 146 * 27 + 1),
        ("lattice:5", 756),
        ("lattice:28", 95_033),
        ("lattice:1", 20),
        ("mount:5", 2052),
        ("mount:7", 32_772),
        ("rings:16", 89_761),
        ("sombrero:3", 32_258),
        ("teapot:3", 65 * 9 - 24),
        ("teapot:39", 98_553),
        ("tetra:7", 16_384),
        ("tree:12", 16_383),
        ("tree:14", 65_535),
    ] {
        let scene = Scene::load(&format!("spd:{name}")).unwrap();
        assert_eq!(scene.objects.len(), objects, "{name}");
        assert_eq!(scene.notes, [""; 0], "{name}");
    }
}
