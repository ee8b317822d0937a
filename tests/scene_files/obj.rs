//! Wavefront OBJ.

use glam::DVec3;

use super::{SQUARE, bad, bad_table, counted, good};

#[test]
fn corners_in_all_spellings() {
    let text = format!(
        "# a square\nmtllib a.mtl\n{SQUARE}vt 0 0\nvn 0 0 1\no thing\ng side\ns off\nusemtl red\n\
         f 1 2 3\nf 1/1 3/1 4/1\n  f 1//1 2//1 3//1\nf\t1/1/1 2/1/1 3/1/1\nf -4 -3 -2\nl 1 2\np 1\n"
    );
    let scene = good("a.OBJ", text.replace('\n', "\r\n"));
    assert_eq!(counted(&scene), (5, String::new()));
    assert_eq!(scene.objects.triangles[4], scene.objects.triangles[0]);
    assert_eq!(scene.world.hi, DVec3::new(1.0, 1.0, 0.0));
    assert_eq!(scene.counts(), "5 triangles");
}

#[test]
fn faces_split_into_fans() {
    let scene = good("a.obj", format!("{SQUARE}f 1 2 3 4\nf 4 3 2 1\n"));
    let (triangles, notes) = counted(&scene);
    assert_eq!(triangles, 4);
    assert!(notes.contains("2 faces with more than 3 corners split into 4 triangles"));
    let corners = [[0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    assert_eq!(scene.objects.triangles[1].0, corners.map(DVec3::from));
}

#[test]
fn continued_lines_comments_and_later_vertices() {
    let text = "f 1 \\\n 2 \\  \n3 # the end \\\nv 0 0 \\\r\n0\nv 1 0 0 0.5 0.5 0.5 # grey\n\
                v 0 1 0 1.0\n# a path C:\\\nf 3 2 1\n";
    assert_eq!(counted(&good("a.obj", text)), (2, String::new()));
}

#[test]
fn bytes_that_are_not_utf8_do_no_harm() {
    let mut text = b"\xEF\xBB\xBF# caf\xE9\ng M\xFCller\n".to_vec();
    text.extend(format!("{SQUARE}f 1 2 3\n").bytes());
    assert_eq!(counted(&good("a.obj", text)).0, 1);
}

#[test]
fn unknown_keywords_are_told() {
    let text = format!("{SQUARE}curv 0 1\nf 1 2 3\ncurv 1 2\nF 1 2 3\n");
    let (triangles, notes) = counted(&good("a.obj", text));
    assert_eq!(triangles, 1);
    let told = "2 lines with the unknown keyword 'curv' passed over, the first at line 5";
    assert!(notes.contains(told), "{notes}");
    let told = "1 line with the unknown keyword 'F' passed over, the first at line 8";
    assert!(notes.contains(told), "{notes}");
}

#[test]
fn unused_vertices_do_not_count_for_the_box() {
    let scene = good("a.obj", format!("{SQUARE}v 9 9 9\nf 1 2 3\n"));
    assert_eq!(scene.world.hi, DVec3::new(1.0, 1.0, 0.0));
}

#[test]
fn degenerate_triangles_are_kept_and_told() {
    let scene = good("a.obj", format!("{SQUARE}f 1 2 3\nf 1 1 2\nf 4 4 4\n"));
    let told = "2 triangles without area: kept, never hit";
    assert_eq!(counted(&scene), (3, told.into()));
}

#[test]
fn carriage_returns_alone_end_lines() {
    let scene = good("a.obj", format!("{SQUARE}f 1 2 3\n").replace('\n', "\r"));
    assert_eq!(counted(&scene).0, 1);
}

#[test]
fn faults() {
    let faces = r"
        f 1 2          | :5 | a face with 2 corners  | at least 3
        f              | :5 | a face with 0 corners  | at least 3
        f 1 2 5        | :5 | no vertex 5            | run from 1 to 4
        f 1 2 -5       | :5 | no vertex -5           | 4 v lines before
        f 1 0 2        | :5 | no vertex 0            | count from 1
        f 1 2 3 1      | :5 | vertex 1 stands twice  | must differ
        f 1 2 x        | :5 | 'x' is not a corner    | v, v/vt, v//vn or v/vt/vn
        f 1/x 2 3      | :5 | '1/x' is not a corner  | whole numbers
        f 1/1/1/1 2 3  | :5 | '1/1/1/1' is not       | whole numbers
        f 1.0 2 3      | :5 | '1.0' is not a corner  | whole numbers
        f 99999999999999999999 2 3 | :5 | is not a corner | whole numbers
        f 9223372036854775807 2 3 | :5 | there is no vertex 9223372036854775807 | run from 1 to 4
        f -9223372036854775808 2 3 | :5 | there is no vertex -9223372036854775808 | 4 v lines
        f 1 1 1        |    | surface area 0         | must lie within
                       |    | the scene is empty     | at least one face
    ";
    bad_table("a.obj", SQUARE, faces);
    let files = r"
        f 1 2 3\n            | :1 | no vertex 1             | there are no vertices
        v 0 0\n              | :1 | a vertex with 2 numbers | v x y z
        v 0 0 0 0 0\n        | :1 | a vertex with 5 numbers | v x y z
        \n\nv 0 0,5 0\n      | :3 | '0,5' is not a number   | a number such as
        v 0 nan 0\n          | :1 | 'nan' is not finite     | must be finite
        v 0 1e400 0\n        | :1 | '1e400' is not finite   | must be finite
        v 0 0 0 \\n\nv 1 x 0 | :3 | 'x' is not a number     | a number such as
                             |    | the scene is empty      | at least one face
    ";
    bad_table("a.obj", "", files);
    bad("a.obj", b"\xFF\xFEv\0", ":1", "UTF-16", "UTF-8");
}
