//! Neutral File Format: read, and written back.

use glam::DVec3;
use sahlab::geom::{Cone, Polygon, Sphere, Triangle};
use sahlab::scene::{Scene, catalogue};

use super::{bad_table, counted, good};

/// Every record; the cone once on one line and once on three, as the format's own text has it.
pub(super) const EVERYTHING: &str = "# a scene made by hand
b 0.078 0.361 0.753
v
from 2.1 1.3 1.7
at 0 0 0
up 0 0 1
angle 45
hither 0.01
resolution 512 256
l 4 3 2
l -3 1 5   # the second light
f 1 0.75 0.33 0.8 0 100000 0 1
p 4
12 12 -0.5
-12 12 -0.5
-12 -12 -0.5
12 -12 -0.5
p 3
0 0 0  1 0 0  0 1 0.3333333333333333
f 1 0.9 0.7 0.5 0.5 3.08270 0.1 1.5
s 0 0 0 0.5
c 0 0 0 0.1 1 2 3 0
c
1 0 0 0.25
1 1 0.1 0.25
pp 3
0 0 1 0 0 1
1 0 1 0.1 0 1
0 1 1 0 0.1 1
p 5
0 0 0  2 0 0  2 2 0  1 0.5 0  0 2 0
f 0 0 0 0 0 0 0 0
";

/// A file with these triangles.
pub(super) fn text(triangles: &[[[f32; 3]; 3]]) -> String {
    let mut text = String::new();
    for corners in triangles {
        text += "p 3\n";
        for [x, y, z] in corners {
            text += &format!("{x} {y} {z}\n");
        }
    }
    text
}

#[test]
fn every_record() {
    let scene = good("a.nff", EVERYTHING);
    assert_eq!(scene.notes, [""; 0]);
    assert_eq!(scene.counts(), "2 triangles, 1 sphere, 2 cones, 2 polygons");
    let third = 0.333_333_333_333_333_3;
    let triangle = [DVec3::ZERO, DVec3::X, DVec3::new(0.0, 1.0, third)];
    assert_eq!(scene.objects.triangles[0], Triangle(triangle));
    let ball = Sphere {
        centre: DVec3::ZERO,
        radius: 0.5,
    };
    assert_eq!(scene.objects.spheres, [ball]);
    let cones = [
        Cone {
            base: DVec3::ZERO,
            base_radius: 0.1,
            apex: DVec3::new(1.0, 2.0, 3.0),
            apex_radius: 0.0,
        },
        Cone {
            base: DVec3::X,
            base_radius: 0.25,
            apex: DVec3::new(1.0, 1.0, 0.1),
            apex_radius: 0.25,
        },
    ];
    assert_eq!(scene.objects.cones, cones);
    let areas = scene.objects.polygons.iter().map(Polygon::area);
    assert_eq!(areas.collect::<Vec<_>>(), [576.0, 2.5]);

    let look = scene.look.expect("a look");
    assert_eq!(look.stage.background, DVec3::new(0.078, 0.361, 0.753));
    assert_eq!(look.stage.view.from, DVec3::new(2.1, 1.3, 1.7));
    assert_eq!(look.stage.view.up, DVec3::Z);
    assert_eq!(
        (look.stage.view.angle, look.stage.view.hither),
        (45.0, 0.01)
    );
    assert_eq!(look.stage.view.resolution, [512, 256]);
    let lights = [DVec3::new(4.0, 3.0, 2.0), DVec3::new(-3.0, 1.0, 5.0)];
    assert_eq!(look.stage.lights, lights);
    assert_eq!(look.materials.len(), 3);
    assert_eq!(
        (look.materials[1].shine, look.materials[1].index),
        (3.0827, 1.5)
    );
    // Two triangles, a sphere, two cones, two polygons.
    assert_eq!(look.material_of, [0, 1, 1, 1, 1, 0, 1]);
    let up = [
        DVec3::Z,
        DVec3::new(0.1, 0.0, 1.0),
        DVec3::new(0.0, 0.1, 1.0),
    ];
    assert_eq!(look.normals, [None, Some(up)]);
}

#[test]
fn what_is_missing_is_told() {
    let (_, objects) = EVERYTHING.split_once("f 1 0.75").expect("a material");
    let scene = good("a.nff", format!("f 1 0.75{objects}"));
    assert!(scene.look.is_none());
    assert!(counted(&scene).1.contains("no record 'v'"));
    let (_, view) = EVERYTHING.split_once("0.753\n").expect("a background");
    let scene = good("a.nff", view);
    assert!(
        counted(&scene)
            .1
            .contains("no record 'b': the background is black")
    );
    assert_eq!(scene.look.expect("a look").stage.background, DVec3::ZERO);

    let mixed = "l 0 0 9 1 1 .5\ns 0 0 0 1\nf 1 0 0 1 0 0 0 0\ns 3 0 0 1\n\
                 pp 4 0 0 0 0 0 1 1 0 0 0 0 1 1 1 0 0 0 1 0 1 0 0 0 1\n";
    let (before, _) = EVERYTHING.split_once("f 1 0.75").expect("a material");
    let scene = good("a.nff", format!("{before}{mixed}"));
    let notes = counted(&scene).1;
    assert!(notes.contains("before the first 'f'"), "{notes}");
    assert!(
        notes.contains("1 record 'pp' with more than 3 corners"),
        "{notes}"
    );
    assert!(notes.contains("1 light with a colour"), "{notes}");
    let look = scene.look.expect("a look");
    assert_eq!(look.material_of, [0, 1, 1]);
    assert_eq!(look.materials[0].colour, DVec3::ONE);
}

/// Written with 17 digits and read again, every scene that has a look is the same, bit for bit.
#[test]
fn written_files_read_back() {
    let mut scenes = vec![good("a.nff", EVERYTHING)];
    for (name, _) in catalogue() {
        let small = Scene::load(&format!("{name}:2")).or_else(|_| Scene::load(&name));
        scenes.extend(small.ok().filter(|scene| scene.look.is_some()));
    }
    for scene in &scenes {
        let text = scene.to_nff(17).expect("a look");
        let back = good("b.nff", &text);
        assert_eq!(back.objects, scene.objects, "{}", scene.name);
        assert_eq!(back.look, scene.look, "{}", scene.name);
        assert_eq!(back.notes, [""; 0], "{}", scene.name);
        assert_eq!(back.to_nff(17).expect("a look"), text);
        // Signs of zeros too, which are equal.
        let all = |scene: &Scene| format!("{:?} {:?}", scene.objects, scene.look);
        assert!(all(&back) == all(scene), "{}", scene.name);
    }
    assert!(good("a.nff", "s 0 0 0 1").to_nff(17).is_none());
}

#[test]
fn six_digits_are_the_originals() {
    let scene = good("a.nff", EVERYTHING);
    let text = scene.to_nff(6).expect("a look");
    let expected = "b 0.078 0.361 0.753
v
from 2.1 1.3 1.7
at 0 0 0
up 0 0 1
angle 45
hither 0.01
resolution 512 256
l 4 3 2
l -3 1 5
f 1 0.75 0.33 0.8 0 100000 0 1
p 3
0 0 0
1 0 0
0 1 0.333333
p 4
12 12 -0.5
-12 12 -0.5
-12 -12 -0.5
12 -12 -0.5
f 1 0.9 0.7 0.5 0.5 3.0827 0.1 1.5
pp 3
0 0 1 0 0 1
1 0 1 0.1 0 1
0 1 1 0 0.1 1
s 0 0 0 0.5
c 0 0 0 0.1 1 2 3 0
c 1 0 0 0.25 1 1 0.1 0.25
p 5
0 0 0
2 0 0
2 2 0
1 0.5 0
0 2 0
f 0 0 0 0 0 0 0 0
";
    assert_eq!(text, expected);
    let rounded = good("b.nff", text).objects.triangles[0].0[2].z;
    assert_eq!(rounded, 0.333_333);
}

#[test]
fn faults() {
    let records = r"
        s 0 0 0                  | :2 | ends within a record       | 's X Y Z RADIUS'
        s 0 0\ns 0 0 0 1         | :3 | 's' is not a number        | 's X Y Z RADIUS'
        s 0 0 0 1 1              | :2 | '1' is no record           | b, v, l, f, s, c, p and pp
        s 0 0 0 0                | :2 | radius 0 is not positive   | above zero
        s 0 0 0 -2               | :2 | radius -2 is not positive  | above zero
        s 0 0 0\n\n# x\nnan      | :5 | 'nan' is not finite        | 's X Y Z RADIUS'
        sphere 0 0 0 1           | :2 | 'sphere' is no record      | the records are
        f 1 1 1 1 0              | :2 | ends within a record       | KD KS SHINE T INDEX
        b 1 1 x                  | :2 | 'x' is not a number        | 'b RED GREEN BLUE'
        b 1 1 1 b 0 0 0          | :2 | a record 'b' before        | a file has one
        l 1 2 3 4                | :2 | ends within a record       | 'l X Y Z'
        c 0 0 0 1\n0 0 0 1       | :2 | apex of the cone coincide  | must differ
        c 0 0 0 0 1 0 0 0        | :2 | the radii are 0 and 0      | one is above
        c 0 0 0 1 1 0 0 -1       | :2 | the radii are 1 and -1     | no radius is below
        p 2 0 0 0 1 1 1          | :2 | a face with 2 corners      | at least 3
        p -3                     | :2 | '-3' is not a number of corners | whole number
        p 3\n0 0 0 1 1 1         | :3 | ends within a record       | 'p N' and N times
        p 4 0 0 0 1 0 0 1 1 0 0 1 1 | :2 | not in one plane        | in one plane
        p 4 0 0 0 1 0 0 1 0 0 0 1 0 | :2 | corners of the polygon coincide | differ from their neighbours
        pp 3\n0 0 0 0 0 1\n1 0 0 0 0 | :4 | ends within a record   | a corner and its normal
        v from 0 0 0 up          | :2 | 'up' stands where 'at'     | from X Y Z, at X Y Z
        v from 0 0 0 at 0 0 1 up 0 0 2 angle 9 hither 0 resolution 1 1 | :2 | 'up' points along the view | span a plane
        v from 1e200 0 0 at 0 0 1 up 0 1 0 angle 9 hither 0 resolution 1 1 | :2 | too large or too small | numbers that f64 has
        v from 0 0 0 at 0 0 1e-170 up 0 1 0 angle 9 hither 0 resolution 1 1 | :2 | too large or too small | numbers that f64 has
        v from 0 0 0 at 0 0 1 up 0 1 0 angle 180 hither 0 resolution 1 1 | :2 | angle of view is 180 | between 0 and 180
        v from 0 0 0 at 0 0 1 up 0 1 0 angle 9 hither 0 resolution 1 .5 | :2 | '.5' is not a number of pixels | from 1
        c 0 0 0 1 1e-170 0 0 1   |    | cone 0 is so small or so large | scale the scene
        s 0 0 0 1 s 1e308 0 0 1e308 | | sphere 1 is so small or so large | scale the scene
                                 |    | the scene is empty         | at least one face
    ";
    bad_table("a.nff", "# first\n", records);
}
