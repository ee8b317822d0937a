//! STL, text and binary.

use glam::DVec3;

use super::{bad, bad_table, counted, good};

const FACET: &str = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 .5\nendloop\nendfacet\n";

/// A binary file with this header and these triangles.
pub(super) fn binary(header: &str, triangles: &[[[f32; 3]; 3]]) -> Vec<u8> {
    let mut bytes = header.as_bytes().to_vec();
    bytes.resize(80, b' ');
    bytes.extend((triangles.len() as u32).to_le_bytes());
    for corners in triangles {
        let normal = [f32::NAN, 0.0, 1.0];
        for x in normal.iter().chain(corners.iter().flatten()) {
            bytes.extend(x.to_le_bytes());
        }
        bytes.extend([1, 2]);
    }
    bytes
}

/// A text file with these triangles.
pub(super) fn text(triangles: &[[[f32; 3]; 3]]) -> String {
    let mut text = "solid\n".to_owned();
    for corners in triangles {
        text += "  facet normal 0 0 0\n    outer loop\n";
        for [x, y, z] in corners {
            text += &format!("      vertex {x} {y} {z}\n");
        }
        text += "    endloop\n  endfacet\n";
    }
    text + "endsolid\n"
}

const CORNER: [[f32; 3]; 3] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.5]];

#[test]
fn text_of_any_style() {
    let plain = format!("solid a part\n{FACET}{FACET}endsolid a part\n");
    let scene = good("a.stl", &plain);
    assert_eq!(counted(&scene), (2, String::new()));
    assert_eq!(scene.objects.triangles[0].0[2], DVec3::new(0.0, 1.0, 0.5));
    for other in [
        plain.to_uppercase(),
        plain.replace('\n', "\r\n"),
        plain.replace(' ', "\t"),
        plain.replace('\n', "\n\n  "),
        plain.replace("0 0 1", "nan -nan(ind) x"),
        plain.replace(" a part", ""),
    ] {
        assert_eq!(good("a.STL", &other).objects, scene.objects, "{other}");
    }
    // Several solids, one of them empty.
    let solids = format!("{plain}solid\nendsolid\n{plain}");
    assert_eq!(counted(&good("a.stl", solids)).0, 4);
}

#[test]
fn binary_even_if_it_begins_with_solid() {
    for header in ["made by hand", "solid part", ""] {
        let scene = good("a.stl", binary(header, &[CORNER, CORNER]));
        assert_eq!(counted(&scene), (2, String::new()));
        assert_eq!(scene.world.hi, DVec3::new(1.0, 1.0, 0.5));
    }
}

#[test]
fn faults() {
    let lines = r"
        facet normal 0 0 1\nvertex 0 0 0      | :3 | 'vertex' is not expected  | 'outer loop' must come
        facet\nouter loop\nvertex 0 0         | :4 | a vertex with 2 numbers   | 'vertex X Y Z'
        facet\nouter loop\nvertex 0 0 inf     | :4 | 'inf' is not finite       | must be finite
        facet\nouter loop\nvertex 0 0 0\nendloop | :5 | a facet with 1 vertices | three lines 'vertex
        facet\nouter loop\nvertex 0 0 0       | :4 | ends within a solid       | three lines 'vertex
        endfacet                              | :2 | 'endfacet' is not expected | 'facet normal X Y Z' or
                                              | :1 | ends within a solid       | 'endsolid'
        endsolid\nfacet                       | :3 | 'facet' is not expected   | 'solid NAME' must begin
        endsolid                              |    | the scene is empty        | at least one face
    ";
    bad_table("a.stl", "solid\n", lines);
    let four = FACET.replace("endloop", "vertex 1 1 1\nendloop");
    bad(
        "a.stl",
        format!("solid\n{four}"),
        ":8",
        "with 4 vertices",
        "three lines",
    );
    bad(
        "a.stl",
        "hello\n",
        ":1",
        "'hello' is not expected",
        "'solid NAME'",
    );

    let whole = binary("solid", &[CORNER, CORNER]);
    let (wrong, right) = ("2 triangles announced, but 99 bytes", "50 bytes");
    bad("a.stl", &whole[..whole.len() - 1], ": header", wrong, right);
    let more = [&whole[..], b"x"].concat();
    bad(
        "a.stl",
        more,
        ": header",
        "but 101 bytes follow",
        "nothing may follow",
    );
    let nan = binary("", &[CORNER, [[0.0, f32::INFINITY, 0.0]; 3]]);
    bad("a.stl", nan, ": triangle 1", "not finite", "must be finite");
    bad(
        "a.stl",
        binary("", &[]),
        "",
        "the scene is empty",
        "at least one face",
    );
}
