//! Single objects of the original programs, by their number within their kind, to twelve digits: they tell scenes apart
//! that agree in every sum.

use sahlab::scene::Scene;

/// Kinds of numbers an object is known by.
#[derive(Clone, Copy, Debug)]
enum Kind {
    /// Centre, radius.
    Sphere,
    /// Base, apex, radius at the base.
    Cone,
    /// Corners.
    Polygon,
    /// Corners.
    Triangle,
    /// Normals at the corners.
    Normals,
}

use Kind::{Cone, Normals, Polygon, Sphere, Triangle};

fn numbers(scene: &Scene, kind: Kind, i: usize) -> Vec<f64> {
    let o = &scene.objects;
    let flat = |points: &[glam::DVec3]| points.iter().flat_map(|p| p.to_array()).collect();
    match kind {
        Sphere => {
            let s = o.spheres[i];
            [&s.centre.to_array()[..], &[s.radius]].concat()
        }
        Cone => {
            let c = o.cones[i];
            let ends = [c.base.to_array(), c.apex.to_array()].concat();
            [&ends[..], &[c.base_radius]].concat()
        }
        Polygon => flat(o.polygons[i].corners()),
        Triangle => flat(&o.triangles[i].0),
        Normals => flat(&scene.look.as_ref().unwrap().normals[i].unwrap()),
    }
}

/// Scene, kind, number, and the first numbers of the object.
#[rustfmt::skip]
const SPOTS: [(&str, Kind, usize, &[f64]); 36] = [
    ("balls:4", Sphere, 1, &[0.272165526976, 0.272165526976, 0.544331053952, 0.166666666667]),
    ("balls:4", Sphere, 10, &[0.494533575223, 0.477074148527, 0.599616460733, 0.00617283950617]),
    ("balls:4", Sphere, 3690, &[-0.427755954051, 0.532512514227, -0.243605565526]),
    ("balls:4", Sphere, 7380, &[0.436485667399, -0.541242227575, -0.222222222222]),
    ("gears:4", Polygon, 1, &[-0.481960268867, -0.748828416233, 1.0, -0.481960268867, -0.731691064287, 1.0, -0.506813874992, -0.728025360878, 1.0]),
    ("gears:4", Polygon, 9344, &[0.996829494862, 0.771308092114, 0.15]),
    ("jacks:4", Cone, 0, &[-0.704769465589, -0.128257553747, -0.222148599545, 0.704769465589, 0.128257553747, 0.222148599545, 0.075]),
    ("jacks:4", Sphere, 0, &[0.704769465589, 0.128257553747, 0.222148599545, 0.15]),
    ("jacks:4", Sphere, 1, &[0.0, 0.649519052838, -0.375]),
    ("jacks:4", Cone, 1754, &[0.555027806214, 1.27447347101, 0.457452804689, 0.490899029341, 1.36256965421, 0.610039869942, 0.009375]),
    ("lattice:12", Cone, 0, &[0.0103125, 0.0, 0.0, 0.0730208333333, 0.0, 0.0, 0.00520833333333]),
    ("lattice:12", Cone, 3042, &[0.5, 0.343645833333, 0.0833333333333, 0.5, 0.406354166667, 0.0833333333333]),
    ("mount:4", Sphere, 0, &[-0.8, 0.8, 1.20820662814, 0.17]),
    ("mount:4", Sphere, 1, &[-0.661195581242, 0.661195581242, 0.930597790621]),
    ("mount:4", Sphere, 2, &[-0.749194056577, 0.989610362181, 0.930597790621]),
    ("mount:4", Sphere, 3, &[-0.989610362181, 0.749194056577, 0.930597790621]),
    ("rings:7", Sphere, 0, &[0.93099467471, 2.61312592975, 0.0]),
    ("rings:7", Cone, 10, &[-0.287693176158, 3.49855448177, 0.0, 0.287693176158, 3.00910161606, -0.791951372614]),
    ("rings:7", Sphere, 4199, &[6.0, 17.8024286426, 5.20804862739]),
    ("sombrero:2", Triangle, 3969, &[-0.0634920634921, -2.62792941928, -0.0634920634921, -0.0634920634921, -2.3759804368, 0.0634920634921, 0.0634920634921, -2.0, 0.0634920634921]),
    ("teapot:12", Triangle, 0, &[1.4, 0.0, 2.4, 1.38742592593, -0.192240740741, 2.4, 1.37518157097, -0.190544171704, 2.430078125]),
    ("teapot:12", Normals, 0, &[-0.902860518824, 0.0, -0.429933580392]),
    ("teapot:12", Triangle, 4560, &[-2.24189814815, 0.0, 0.774826388889]),
    ("teapot:12", Normals, 4560, &[-0.50483559082, 0.0, -0.863215515524]),
    ("teapot:12", Triangle, 9119, &[1.5, 0.0, 0.15]),
    ("teapot:12", Normals, 9119, &[1.0, 0.0, 0.0]),
    ("tetra:6", Triangle, 0, &[-1.0, -1.0, 1.0, -1.0, -0.9375, 0.9375, -0.9375, -1.0, 0.9375]),
    ("tree:11", Sphere, 1, &[0.417811946296, 0.0, 1.49792888803, 0.067335]),
    ("tree:11", Sphere, 10, &[0.752308853181, 0.488116368114, 2.38066276112, 0.00183195199357]),
    ("tree:11", Sphere, 4094, &[-0.306913075912, 0.537714700596, 3.13625919509, 0.00122740783569]),
    // Floors: the corners one sees counter-clockwise, in the package's order.
    ("balls:4", Polygon, 0, &[12.0, 12.0, -0.5, -12.0, 12.0, -0.5]),
    ("gears:4", Polygon, 0, &[2.0, 2.0, 0.0, -2.0, 2.0, 0.0]),
    ("tree:11", Polygon, 0, &[50.0, 50.0, 0.0, -50.0, 50.0, 0.0]),
    ("teapot:12", Polygon, 0, &[-4.0, -10.0 / 3.0, 0.0, -10.0 / 3.0, -10.0 / 3.0, 0.0]),
    ("teapot:12", Polygon, 72, &[-4.0, -4.0, 0.0, -10.0 / 3.0, -4.0, 0.0]),
    ("sombrero:2", Triangle, 0, &[-4.0]),
];

#[test]
fn objects_are_where_the_package_has_them() {
    for (name, kind, i, expected) in SPOTS {
        let scene = Scene::load(&format!("spd:{name}")).unwrap();
        let ours = numbers(&scene, kind, i);
        for (a, b) in ours.iter().zip(expected) {
            assert!(
                (a - b).abs() <= 1e-11 * b.abs().max(1.0),
                "{name} {kind:?} {i}: {ours:?}"
            );
        }
        assert!(ours.len() >= expected.len());
    }
}

/// Heights at points of mount's grid.
#[test]
fn heights_of_mount() {
    let heights_6 = [
        ([32, 0], -0.5481000797238879),
        ([64, 32], 0.6572436877421761),
        ([32, 64], -0.002949015877239101),
        ([0, 32], -0.3147424340454854),
        ([32, 32], 0.52955070721884),
        ([16, 16], 0.34363894892653657),
        ([1, 1], -0.007322020214298092),
        ([5, 40], -0.28084443003869913),
    ];
    let heights_8 = [
        ([128, 0], -0.09733032347123609),
        ([256, 128], -0.3147424340454854),
        ([0, 128], -0.3147424340454854),
        ([128, 256], 0.15771772865955616),
        ([128, 128], -0.4451130307242285),
        ([64, 64], -0.030354508754508402),
        ([255, 255], 0.015509309728626334),
    ];
    for (size, heights) in [(6, &heights_6[..]), (8, &heights_8)] {
        let objects = Scene::load(&format!("spd:mount:{size}")).unwrap().objects;
        let mut corners = objects.triangles.iter().flat_map(|t| t.0);
        for &(at, height) in heights {
            let [x, y] = at.map(|k| -1.0 + 2.0 * f64::from(k) / f64::from(1 << size));
            let z = corners.clone().find(|c| c.x == x && c.y == y).unwrap().z;
            assert!((z - height).abs() < 1e-15, "mount {size} {at:?}: {z}");
        }
        assert_eq!(corners.find(|c| c.x == 1.0 && c.y == 1.0).unwrap().z, 0.0);
    }
}
