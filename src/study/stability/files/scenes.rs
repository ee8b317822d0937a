//! Scenes in files of each format, and worlds of any size and place.

use super::case;
use crate::scene::Scene;
use crate::study::stability::case::{Case, Finding};

/// The cases of scene files.
pub(super) fn cases() -> Vec<Case> {
    vec![
        case("obj-vertex-past-the-last", "numbers of vertices", || {
            told(
                "a.obj",
                b"v 0 0 0\nf 1 2 9\n",
                "a.obj:2: there is no vertex 2; vertices run from 1 to 1",
            )
        }),
        case("obj-vertex-zero", "numbers of vertices", || {
            told(
                "a.obj",
                b"v 0 0 0\nf 0 1 1\n",
                "a.obj:2: there is no vertex 0; vertices count from 1, or from -1 backwards",
            )
        }),
        case("obj-vertex-before-the-first", "numbers of vertices", || {
            told(
                "a.obj",
                b"v 0 0 0\nf -1 -2 1\n",
                "a.obj:2: there is no vertex -2; 1 v line before this line",
            )
        }),
        case("obj-least-integer", "overflow", || {
            told(
                "a.obj",
                b"v 0 0 0\nf -9223372036854775808 1 1\n",
                "a.obj:2: there is no vertex -9223372036854775808; 1 v line before this line",
            )
        }),
        case("obj-integer-too-long", "overflow", || {
            told(
                "a.obj",
                b"v 0 0 0\nf 18446744073709551616 1 1\n",
                "a.obj:2: '18446744073709551616' is not a corner of a face; a corner is v, v/vt, v//vn or v/vt/vn with whole numbers",
            )
        }),
        case("obj-not-a-number", "numbers", || {
            told(
                "a.obj",
                b"v 0 nan 0\n",
                "a.obj:1: 'nan' is not finite; every number must be finite",
            )
        }),
        case("obj-number-too-large", "overflow", || {
            told(
                "a.obj",
                b"v 0 1e309 0\n",
                "a.obj:1: '1e309' is not finite; every number must be finite",
            )
        }),
        case("obj-face-of-two", "corners", || {
            told(
                "a.obj",
                b"v 0 0 0\nv 1 0 0\nf 1 2\n",
                "a.obj:3: a face with 2 corners; a face needs at least 3",
            )
        }),
        case("obj-corner-twice", "corners", || {
            told(
                "a.obj",
                b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 1 3\n",
                "a.obj:4: vertex 1 stands twice in a face with 4 corners; the corners of a face must differ",
            )
        }),
        case("obj-escape-sequence", "control characters", || {
            told(
                "a.obj",
                b"v 0 \x1b[2J\0 0\n",
                "a.obj:1: '\\u{1b}[2J\\u{0}' is not a number; a number such as -1.5 or 2e-3 must stand here",
            )
        }),
        case("obj-unknown-keywords", "length of messages", || {
            short(
                "a.obj",
                (0..2000).map(|i| format!("k{i}\n")).collect::<String>(),
            )
        }),
        case("obj-long-word", "length of messages", || {
            short("a.obj", format!("v 0 0 {}\n", "9a".repeat(100_000)))
        }),
        case("obj-continued-without-end", "time", || {
            told(
                "a.obj",
                "v \\\n".repeat(100_000),
                "a.obj:1: 'v' is not a number; a number such as -1.5 or 2e-3 must stand here",
            )
        }),
        case("obj-utf-16", "encoding", || {
            told(
                "a.obj",
                b"\xff\xfev\0 \x000\0",
                "a.obj:1: the text is in UTF-16; save it as UTF-8 or ASCII",
            )
        }),
        case("obj-without-faces", "emptiness", || {
            told(
                "a.obj",
                b"v 0 0 0\n",
                "a.obj: the scene is empty; it needs at least one face or object",
            )
        }),
        case("ply-no-ply", "magic", || {
            told(
                "a.ply",
                b"plyx\n",
                "a.ply:1: this is not a PLY file; its first line must be 'ply', ended by a line feed",
            )
        }),
        case("ply-endless-header", "truncation", || {
            told(
                "a.ply",
                b"ply\nformat ascii 1.0\n",
                "a.ply:2: the file ends before its header does; a line 'end_header' must end the header",
            )
        }),
        case("ply-quintillion-vertices", "allocation", || {
            told(
                "a.ply",
                ply("ascii", 1 << 60, "uchar", b"0 0 0\n"),
                "a.ply:10: vertex 1: the file ends before it; the header declares 1152921504606846976 of kind vertex",
            )
        }),
        case("ply-quintillion-binary-vertices", "allocation", || {
            told(
                "a.ply",
                ply("binary_little_endian", 1 << 60, "uchar", &[0; 12]),
                "a.ply: vertex 1: the file ends within it; the header declares 1152921504606846976 of kind vertex",
            )
        }),
        case("ply-count-too-long", "overflow", || {
            told(
                "a.ply",
                b"ply\nformat ascii 1.0\nelement vertex 18446744073709551616\nend_header\n",
                "a.ply:3: cannot read the header line 'element vertex 18446744073709551616'; header lines are 'format ENCODING 1.0', 'comment ...', 'obj_info ...', 'element NAME COUNT', 'property TYPE NAME' and 'property list TYPE TYPE NAME'",
            )
        }),
        case("ply-face-of-four-thousand-million", "allocation", || {
            told(
                "a.ply",
                ply(
                    "binary_little_endian",
                    1,
                    "uint",
                    &[&[0; 12][..], &[0xff; 8]].concat(),
                ),
                "a.ply: face 0: the file ends within it; the header declares 1 of kind face",
            )
        }),
        case("ply-negative-vertex", "numbers of vertices", || {
            told(
                "a.ply",
                ply("ascii", 1, "uchar", b"0 0 0\n3 0 0 -1\n"),
                "a.ply:11: face 0: there is no vertex -1; vertices are numbered from 0",
            )
        }),
        case("ply-not-a-number", "numbers", || {
            told(
                "a.ply",
                ply(
                    "binary_big_endian",
                    1,
                    "uchar",
                    &f32::NAN.to_be_bytes().repeat(3),
                ),
                "a.ply: vertex 0: a coordinate is not finite; every coordinate must be finite",
            )
        }),
        case("ply-left-over", "counts", || {
            told(
                "a.ply",
                ply("binary_big_endian", 0, "uchar", b"\0more"),
                "a.ply: after the last element: 4 bytes are left over; the counts in the header must match",
            )
        }),
        case("ply-name-twice", "headers", || {
            told("a.ply", b"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float x\nend_header\n0 0\n", "a.ply:5: 'property float x' declares a name again; the names of elements must differ, and so must those of an element's properties")
        }),
        case("ply-corners-twice", "headers", || {
            let once = String::from_utf8_lossy(&ply("ascii", 3, "uchar", b"")).into_owned();
            let list = "property list uchar int vertex_indices\nend_header";
            told(
                "a.ply",
                once.replace("end_header", list) + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2 3 0 2 1\n",
                "a.ply:9: 'property list uchar int vertex_indices' declares a second list of corners; a face has one, 'vertex_indices' or 'vertex_index'",
            )
        }),
        case("stl-more-announced", "allocation", || {
            told(
                "a.stl",
                [&[0; 80][..], &[0xff; 4], &[0; 50]].concat(),
                "a.stl: header: 4294967295 triangles announced, but 50 bytes follow the header; each triangle takes 50 bytes, and nothing may follow the last",
            )
        }),
        case("stl-not-a-number", "numbers", || {
            told(
                "a.stl",
                [&[0; 80][..], &[1, 0, 0, 0], &[0xff; 50]].concat(),
                "a.stl: triangle 0: a coordinate is not finite; every number must be finite",
            )
        }),
        case("stl-within-a-facet", "truncation", || {
            told(
                "a.stl",
                b"solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n",
                "a.stl:4: the file ends within a solid; three lines 'vertex X Y Z' and 'endloop' make a triangle",
            )
        }),
        case("stl-two-vertices", "corners", || {
            told(
                "a.stl",
                b"solid\nfacet\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\n",
                "a.stl:6: a facet with 2 vertices; three lines 'vertex X Y Z' and 'endloop' make a triangle",
            )
        }),
        case("off-quintillion-vertices", "allocation", || {
            told(
                "a.off",
                b"OFF\n1152921504606846976 1 0\n0 0 0\n",
                "a.off:3: the file ends before vertex 1 of 1152921504606846976; counts, vertices and faces must all be there",
            )
        }),
        case("off-too-few-corners", "corners", || {
            told(
                "a.off",
                b"OFF\n1 1 0\n0 0 0\n18446744073709551615 0 0 0\n",
                "a.off:4: a face of 18446744073709551615 corners names 3; a face is its number of corners, its corners, and at most 4 numbers of colour",
            )
        }),
        case("off-unknown-header", "magic", || {
            told(
                "a.off",
                b"4OFF\n1 1 0\n",
                "a.off:1: the header '4OFF' is not known; the file must start with OFF, COFF, NOFF, CNOFF or STOFF, or with its counts",
            )
        }),
        case("nff-countless-corners", "allocation", || {
            told(
                "a.nff",
                b"p 18446744073709551615\n0 0 0\n",
                "a.nff:2: the file ends within a record; a polygon is 'p N' and N times X Y Z",
            )
        }),
        case("nff-radius-below-zero", "radii", || {
            told(
                "a.nff",
                b"s 0 0 0 -1\n",
                "a.nff:1: the radius -1 is not positive; a radius is above zero",
            )
        }),
        case("nff-bent-polygon", "planes", || {
            told(
                "a.nff",
                b"p 4\n0 0 0\n1 0 0\n1 1 1\n0 1 0\n",
                "a.nff:1: the corners of the polygon are not in one plane; corners lie in one plane and differ from their neighbours, and there is an area",
            )
        }),
        case("nff-up-along-the-view", "views", || {
            told(
                "a.nff",
                b"v\nfrom 0 0 1\nat 0 0 0\nup 0 0 1\nangle 45\nhither 0\nresolution 1 1\n",
                "a.nff:1: 'up' points along the view, or 'from' and 'at' coincide; the eye, the point looked at and 'up' must span a plane",
            )
        }),
        case("nff-within-a-record", "truncation", || {
            told(
                "a.nff",
                b"s 0 0 0\n",
                "a.nff:1: the file ends within a record; a sphere is 's X Y Z RADIUS'",
            )
        }),
        case("world-of-a-plane", "flat worlds", || {
            told(
                "a.obj",
                b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
                "1 triangle",
            )
        }),
        case("world-of-a-line", "flat worlds", || {
            told(
                "a.obj",
                b"v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n",
                "a.obj: the box around all objects has surface area 0e0; it must lie within 1e-280 to 1e280: at least two of its sides must be longer than zero; if they are, scale the scene",
            )
        }),
        case("world-of-a-point", "flat worlds", || {
            told(
                "a.obj",
                b"v 1 1 1\nf 1 1 1\n",
                "a.obj: the box around all objects has surface area 0e0; it must lie within 1e-280 to 1e280: at least two of its sides must be longer than zero; if they are, scale the scene",
            )
        }),
        case("world-too-large", "overflow", || {
            told(
                "a.obj",
                b"v 0 0 0\nv 1e200 0 0\nv 0 1e200 0\nf 1 2 3\n",
                "a.obj: the box around all objects has surface area inf; it must lie within 1e-280 to 1e280: at least two of its sides must be longer than zero; if they are, scale the scene",
            )
        }),
        case("world-too-small", "underflow", || {
            told(
                "a.obj",
                b"v 0 0 0\nv 5e-324 0 0\nv 0 5e-324 0\nf 1 2 3\n",
                "a.obj: the box around all objects has surface area 0e0; it must lie within 1e-280 to 1e280: at least two of its sides must be longer than zero; if they are, scale the scene",
            )
        }),
        case("world-too-far", "cancellation", || {
            told(
                "a.obj",
                b"v 1e15 0 0\nv 1000000000000001 0 0\nv 1e15 1 0\nf 1 2 3\n",
                "a.obj: the longest side of the scene is 1e0, but its coordinates reach 1.000000000000001e15, where f64 can tell few points of it apart; move the scene to the origin",
            )
        }),
        case("unknown-ending", "names", || {
            told(
                "a.blend",
                b"",
                "a.blend: cannot read .blend files; scenes are simple:uniform, simple:soup, simple:clustered, simple:overlapping, simple:mixture, simple:greedy, simple:flat, spd:balls, spd:gears, spd:jacks, spd:lattice, spd:mount, spd:rings, spd:sombrero, spd:teapot, spd:tetra, spd:tree, hard:NAME (`validate list scenes` names them), and files ending in .obj, .ply, .stl, .off, .nff",
            )
        }),
    ]
}

/// What is said of a file: what it holds, or why it is refused.
fn told(path: &str, bytes: impl AsRef<[u8]>, expected: &str) -> Finding {
    let measured = match Scene::parse(path, bytes.as_ref()) {
        Ok(scene) => scene.counts(),
        Err(error) => error.to_string(),
    };
    Finding::of(expected, measured)
}

/// The longest message, in bytes.
const SHORT: usize = 1100;

/// Whether a file is refused in few words, however many it has itself.
fn short(path: &str, bytes: impl AsRef<[u8]>) -> Finding {
    let measured = match Scene::parse(path, bytes.as_ref()) {
        Ok(scene) => scene.counts(),
        Err(error) if error.to_string().len() <= SHORT => "few words".into(),
        Err(error) => format!("{} bytes", error.to_string().len()),
    };
    Finding::of("few words", measured)
}

/// A PLY file that declares so many vertices and one face, whose count of corners has that type.
fn ply(format: &str, vertices: u64, count: &str, payload: &[u8]) -> Vec<u8> {
    let header = format!(
        "ply\nformat {format} 1.0\nelement vertex {vertices}\nproperty float x\nproperty float y\nproperty float z\n\
         element face 1\nproperty list {count} int vertex_index\nend_header\n"
    );
    [header.as_bytes(), payload].concat()
}
