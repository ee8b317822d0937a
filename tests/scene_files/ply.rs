//! PLY, text and binary.

use glam::DVec3;

use super::{CORNERS, PLY_SQUARE, bad, bad_table, binary, counted, good, header};

#[test]
fn text() {
    let text = header("ascii", 4, 3) + PLY_SQUARE + "3 0 1 2\n4 0 1 2 3\n3 1 1 2\n\n";
    let (triangles, notes) = counted(&good("a.PLY", &text));
    assert_eq!(triangles, 4);
    assert!(notes.contains("1 face with more than 3 corners split into 2"));
    assert!(notes.contains("1 triangle without area"));
    let other = text.replace('\n', "\r\n").replace("_indices", "_index");
    assert_eq!(counted(&good("a.ply", other)).0, 4);
    // A byte of a comment that is not UTF-8.
    let hand = text.find("hand").expect("the comment");
    let mut marked = text.into_bytes();
    marked[hand] = 0xE9;
    assert_eq!(counted(&good("a.ply", marked)).0, 4);
}

#[test]
fn other_elements_are_passed_over() {
    let text = "ply\nformat ascii 1.0\nelement camera 1\nproperty float x\nelement face 1\n\
                property uchar flags\nproperty list uchar uint vertex_index\n\
                property list uchar float uv\nelement nothing 5\nelement vertex 3\n\
                property float z\nproperty float y\nproperty float x\nproperty float quality\n\
                end_header\n7\n9 3 0 1 2 2 .5 .5\n0 0 0 nan\n0 0 1 nan\n0 1 0 nan\n";
    let scene = good("a.ply", text);
    assert_eq!(counted(&scene), (1, String::new()));
    assert_eq!(scene.objects.triangles[0].0[1], DVec3::X);
}

/// A number of one of the two names that the list of corners may have is no list.
#[test]
fn numbers_named_like_corners_are_passed_over() {
    for (list, number) in [
        ("vertex_index", "vertex_indices"),
        ("vertex_indices", "vertex_index"),
    ] {
        let text = header("ascii", 4, 1) + PLY_SQUARE + "7 3 0 1 2\n";
        let both = format!("property int {number}\nproperty list uchar int {list}\n");
        let text = text.replace("property list uchar int vertex_indices\n", &both);
        assert!(text.contains(&both), "{text}");
        assert_eq!(counted(&good("a.ply", text)).0, 1);
    }
}

#[test]
fn binary_of_both_kinds() {
    let faces = [vec![0, 1, 2], vec![0, 1, 2, 3]];
    for big in [false, true] {
        let scene = good("a.ply", binary(big, &CORNERS, &faces));
        assert_eq!(counted(&scene).0, 3);
        assert_eq!(scene.world.hi, DVec3::new(1.0, 1.0, 0.5));
    }
}

#[test]
fn binary_faults() {
    for big in [false, true] {
        let with = |face: &[i32]| binary(big, &CORNERS, &[vec![0, 1, 2], face.to_vec()]);
        let faces: [(&[i32], _, _); 5] = [
            (&[0, 1, 4], "no vertex 4", "run from 0 to 3"),
            (&[0, 1, -1], "no vertex -1", "numbered from 0"),
            (&[0, 1], "a face with 2 corners", "at least 3"),
            (&[], "a face with 0 corners", "at least 3"),
            (&[0, 1, 2, 1], "vertex 1 stands twice", "must differ"),
        ];
        for (face, wrong, right) in faces {
            bad("a.ply", with(face), ": face 1", wrong, right);
        }
        let whole = with(&[1, 2, 3]);
        let cut = &whole[..whole.len() - 1];
        let (wrong, right) = ("the file ends within it", "declares 2 of kind face");
        bad("a.ply", cut, ": face 1", wrong, right);
        let more = [&whole[..], b"abc"].concat();
        let place = ": after the last element";
        bad("a.ply", more, place, "3 bytes", "must match");
        let nan = binary(big, &[[f32::NAN, 0.0, 0.0]], &[]);
        bad("a.ply", nan, ": vertex 0", "not finite", "must be finite");
        let none = binary(big, &CORNERS, &[]);
        bad("a.ply", none, "", "the scene is empty", "at least one face");
    }
}

#[test]
fn text_faults() {
    let faces = r"
        3 0 1 2\n3 0 1 9      | :18 | face 1: there is no vertex 9  | run from 0 to 3
        3 0 1 2               | :17 | face 1: the file ends before  | declares 2 of kind face
        3 0 1 2\n3 0 1        | :18 | face 1: the line ends before  | every declared property
        3 0 1 2 3             | :17 | face 0: '3' stands after      | as many as its count says
        3 0 1 2.0             | :17 | '2.0' is not a vertex number  | a whole number from 0
        3 0 1 -2              | :17 | face 0: there is no vertex -2 | numbered from 0
        -3 0 1 2              | :17 | '-3' is not a count           | a whole number from 0
        2 0 1\n3 0 1 2        | :17 | a face with 2 corners         | at least 3
        3 0 1 2\n3 0 1 2\nx   | :19 | more after the last           | counts in the header must match
    ";
    bad_table("a.ply", &(header("ascii", 4, 2) + PLY_SQUARE), faces);
    let vertices = r"
        0 zero 0 1            | :13 | vertex 0: 'zero' is not a number | a number such as
        0 nan 0 1             | :13 | vertex 0: 'nan' is not finite | must be finite
        0 0                   | :13 | the line ends before 'z'      | every declared property
    ";
    bad_table("a.ply", &header("ascii", 1, 0), vertices);
}

#[test]
fn header_faults() {
    let text = header("ascii", 4, 1) + PLY_SQUARE + "3 0 1 2\n";
    // A part of the good file, what stands there instead, and the message.
    let table = r"
        ply\n              |                  | :1  | not a PLY file              | first line must be 'ply'
        end_header\n       |                  | :16 | ends before its header      | 'end_header'
        format ascii 1.0\n |                  | :11 | no line 'format'            | ascii 1.0
        property float x\n |                  | :11 | no number 'x'               | property float
        comment made       | made             | :3  | header line 'made by hand'  | 'comment ...'
        format ascii 1.0   | format text 1.0  | :2  | header line 'format text 1.0' | format ENCODING 1.0
        float z            | flaot z          | :8  | header line 'property flaot z' | property TYPE NAME
        element face       | element tristrips | :12 | no element 'face'          | strips are not read
        element vertex     | element point    | :12 | no element 'vertex'         | 'vertex' and 'face'
        vertex_indices     | corners          | :12 | no list of corners          | vertex_indices
        uchar int          | uchar float      | :12 | not whole numbers           | list of int or uint
        float z            | float x          | :8  | 'property float x' declares a name again | must differ
        element face 1     | element vertex 1 | :10 | declares a name again       | must differ
        end_header | property list uchar int vertex_index\nend_header | :12 | a second list of corners | a face has one
    ";
    for row in table.trim().lines() {
        let cell = |c: &str| c.trim().replace("\\n", "\n");
        let cells: Vec<String> = row.split('|').map(cell).collect();
        let [old, new, place, wrong, right] = &cells[..] else {
            panic!("not a row of five: {row}");
        };
        assert!(text.contains(old), "{old}");
        bad("a.ply", text.replacen(old, new, 1), place, wrong, right);
    }
    bad("a.ply", "", ":1", "ends before its header", "end_header");
    bad(
        "a.ply",
        "solid x\n",
        ":1",
        "not a PLY file",
        "must be 'ply'",
    );
}
