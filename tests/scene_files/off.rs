//! Object File Format.

use super::{OFF_SQUARE, bad_table, counted, good};

#[test]
fn headers() {
    for head in [
        "OFF\n4 2 0\n",
        "off\n4 2 0\n",
        "Off 4 2\n",
        "OFF 4 2 5\n",
        "4 2 0\n",
        "# first\n\nOFF # here\n# counts\n4 2\n",
        "\u{FEFF}OFF\r\n4 2 0\r\n",
    ] {
        let text = format!("{head}{OFF_SQUARE}3 0 1 2\n\n3 0 2 3 # last\n");
        assert_eq!(counted(&good("a.off", text)), (2, String::new()), "{head}");
    }
}

#[test]
fn colours_and_normals() {
    let vertices = "0 0 0 0 0 1\n1 0 0 0 0 1\n1 1 0 0 0 1\n";
    for head in ["COFF", "NOFF"] {
        let text = format!("{head}\n3 1 0\n{vertices}3 0 1 2\n");
        assert_eq!(counted(&good("a.off", text)).0, 1);
    }
    let vertices = vertices.replace('\n', " 1\n");
    let text = format!("COFF 3 1 0\n{vertices}3 0 1 2\n");
    assert_eq!(counted(&good("a.off", text)).0, 1);

    let faces = "3 0 1 2 255 0 0\n4 0 1 2 3 .1 .2 .3 1\n3 1 1 2 7\n";
    let (triangles, notes) = counted(&good("a.Off", format!("OFF 4 3 0\n{OFF_SQUARE}{faces}")));
    assert_eq!(triangles, 4);
    assert!(notes.contains("1 face with more than 3 corners split into 2 triangles"));
    assert!(notes.contains("1 triangle without area"));
}

#[test]
fn faults() {
    let faces = r"
        3 0 1 4               | :7 | no vertex 4                | run from 0 to 3
        3 0 1 -1              | :7 | '-1' is not a vertex number | a whole number from 0
        2 0 1                 | :7 | a face with 2 corners      | at least 3
        4 0 1 2               | :7 | 4 corners names 3          | its number of corners
        4 0 1 2 0             | :7 | vertex 0 stands twice      | must differ
        3 0 1 2 1 2 3 4 5     | :7 | 5 numbers follow           | at most 4
        3 0 1 2 red           | :7 | 'red' is not a number      | a number such as
        x 0 1 2               | :7 | 'x' is not a number of corners | a whole number
                              | :6 | ends before face 0 of 1    | must all be there
        3 0 1 2\n3 0 2 3\n    | :8 | more after the last        | counts in the header must match
    ";
    bad_table("a.off", &format!("OFF\n4 1 0\n{OFF_SQUARE}"), faces);
    let files = r"
        OFF\n4 1 0\n0 0 0\n   | :3 | ends before vertex 1 of 4  | must all be there
        OFF\n                 | :1 | ends before the counts     | must all be there
                              | :1 | ends before the counts     | must all be there
        OFF\n3 x 0\n          | :2 | 'x' is not a count         | a whole number
        OFF\n3\n              | :2 | 1 counts                   | vertices, faces and edges
        OFF 1 0 0\n0 0 0 9\n  | :2 | vertex 0 of 1 has 4 numbers | announces 3
        COFF 1 0 0\n0 0 0\n   | :2 | vertex 0 of 1 has 3 numbers | announces 6 or 7
        OFF 1 0 0\n0 0 inf\n  | :2 | 'inf' is not finite        | must be finite
        4OFF\n1 0 0\n         | :1 | '4OFF' is not known        | must start with OFF
        OFF BINARY\n          | :1 | 'BINARY' is not a count    | a whole number
        OFF 0 0 0\n           |    | the scene is empty         | at least one face
    ";
    bad_table("a.off", "", files);
}
