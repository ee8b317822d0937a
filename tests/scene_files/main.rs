//! Mesh files, good and bad: what is read, and what the message says where something is wrong.

mod nff;
mod obj;
mod off;
mod ply;
mod stl;

use std::error::Error;
use std::fs;
use std::path::PathBuf;

use proptest::prelude::*;
use sahlab::scene::{Scene, SceneError};
use tempfile::TempDir;

/// A square without its faces, in each kind of file; that of binary files is bent.
const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
const OFF_SQUARE: &str = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
const PLY_SQUARE: &str = "0 0 0 1\n1 0 0 2\n1. 1 0 3\n0 1 -.0 4\n";
const CORNERS: [[f32; 3]; 4] = [[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.5], [0.0, 1.0, 0.0]];

/// Reads a file of that name with these contents; gives its path too.
fn load(name: &str, contents: &[u8]) -> (Result<Scene, SceneError>, String) {
    let dir = TempDir::new().expect("a temporary folder");
    let path = dir.path().join(name);
    fs::write(&path, contents).expect("a temporary file");
    let path = path.to_str().expect("a path in UTF-8").to_owned();
    (Scene::load(&path), path)
}

fn good(name: &str, contents: impl AsRef<[u8]>) -> Scene {
    let (scene, path) = load(name, contents.as_ref());
    let scene = scene.unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(scene.name, path);
    scene
}

/// Checks that the message is the path, `place`, and `: cause; remedy` with these parts in them.
fn bad(name: &str, contents: impl AsRef<[u8]>, place: &str, wrong: &str, right: &str) {
    let (scene, path) = load(name, contents.as_ref());
    let message = match scene {
        Ok(scene) => panic!("read as {}, but {wrong}", scene.counts()),
        Err(e) => e.to_string(),
    };
    let rest = message.strip_prefix(&format!("{path}{place}: "));
    let (cause, remedy) = rest
        .and_then(|r| r.split_once("; "))
        .unwrap_or_else(|| panic!("no '{place}: ..; ..' in: {message}"));
    assert!(cause.contains(wrong), "'{wrong}' is not in: {message}");
    assert!(remedy.contains(right), "'{right}' is not in: {message}");
    assert!(!message.ends_with('.'), "{message}");
}

/// Bad files in a table: contents, place, cause, remedy; `\n` in the contents stands for a line end.
fn bad_table(name: &str, before: &str, table: &str) {
    for row in table.trim().lines() {
        let cells: Vec<&str> = row.split('|').map(str::trim).collect();
        let [contents, place, wrong, right] = cells[..] else {
            panic!("not a row of four: {row}");
        };
        let contents = before.to_owned() + &contents.replace("\\n", "\n");
        bad(name, contents, place, wrong, right);
    }
}

/// Triangles and the notes, joined.
fn counted(scene: &Scene) -> (usize, String) {
    (scene.objects.triangles.len(), scene.notes.join("; "))
}

/// A PLY header; vertices have a byte of colour.
fn header(format: &str, vertices: usize, faces: usize) -> String {
    format!(
        "ply\nformat {format} 1.0\ncomment made by hand\nobj_info none\nelement vertex {vertices}\n\
         property float x\nproperty double y\nproperty float z\nproperty uchar red\n\
         element face {faces}\nproperty list uchar int vertex_indices\nend_header\n"
    )
}

/// A binary PLY file: each vertex is a float, a double, a float and a byte, each face a byte of count and its corners.
fn binary(big: bool, vertices: &[[f32; 3]], faces: &[Vec<i32>]) -> Vec<u8> {
    let end = if big { "big" } else { "little" };
    let format = format!("binary_{end}_endian");
    let mut bytes = header(&format, vertices.len(), faces.len()).into_bytes();
    let mut put = |little: &[u8]| {
        if big {
            bytes.extend(little.iter().rev());
        } else {
            bytes.extend(little);
        }
    };
    for [x, y, z] in vertices {
        put(&x.to_le_bytes());
        put(&f64::from(*y).to_le_bytes());
        put(&z.to_le_bytes());
        put(&[7]);
    }
    for face in faces {
        put(&[face.len() as u8]);
        face.iter().for_each(|i| put(&i.to_le_bytes()));
    }
    bytes
}

#[test]
fn missing_files_and_unknown_kinds() {
    let e = Scene::load("no-such-file.obj").expect_err("no file");
    assert_eq!(e.to_string(), "no-such-file.obj: cannot read the file");
    assert!(e.source().is_some());
    bad(
        "a.dxf",
        "SECTION",
        "",
        "cannot read .dxf files",
        ".obj, .ply, .stl, .off, .nff",
    );
}

/// A mesh: vertices, and faces of three to five different corners.
fn mesh() -> impl Strategy<Value = (Vec<[f32; 3]>, Vec<Vec<i32>>)> {
    let vertices = prop::collection::vec(prop::array::uniform3(-100_f32..100.0), 5..20);
    let faces = prop::collection::vec((0_i32..1000, 3_i32..6), 1..20);
    (vertices, faces).prop_map(|(vertices, faces)| {
        let n = vertices.len() as i32;
        let corners = |(start, size)| (0..size).map(|k| (start + k) % n).collect();
        let faces = faces.into_iter().map(corners).collect();
        (vertices, faces)
    })
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 64,
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    /// One mesh in eight files gives the same triangles.
    #[test]
    fn all_kinds_agree((vertices, faces) in mesh()) {
        let mut obj = String::new();
        let mut off = format!("OFF\n{} {} 0\n", vertices.len(), faces.len());
        let mut ply = header("ascii", vertices.len(), faces.len());
        for [x, y, z] in &vertices {
            obj += &format!("v {x} {y} {z}\n");
            off += &format!("{x} {y} {z}\n");
            ply += &format!("{x} {y} {z} 0\n");
        }
        for f in &faces {
            let words = |first: i32| -> String { f.iter().map(|i| format!(" {}", i + first)).collect() };
            obj += &format!("f{}\n", words(1));
            off += &format!("{}{}\n", f.len(), words(0));
            ply += &format!("{}{}\n", f.len(), words(0));
        }
        let scene = good("a.obj", obj);
        let expected: usize = faces.iter().map(|f| f.len() - 2).sum();
        prop_assert_eq!(scene.objects.triangles.len(), expected);
        prop_assert_eq!(&good("a.off", off).objects, &scene.objects);
        prop_assert_eq!(&good("a.ply", ply).objects, &scene.objects);
        let little = good("a.ply", binary(false, &vertices, &faces));
        let big = good("a.ply", binary(true, &vertices, &faces));
        prop_assert_eq!(&little.objects, &big.objects);
        let fans = faces.iter().flat_map(|f| f[1..].windows(2).map(|w| [f[0], w[0], w[1]]));
        let fans: Vec<_> = fans.map(|t| t.map(|i| vertices[i as usize])).collect();
        prop_assert_eq!(&good("a.stl", stl::text(&fans)).objects, &scene.objects);
        prop_assert_eq!(&good("a.stl", stl::binary("", &fans)).objects, &big.objects);
        prop_assert_eq!(&good("a.nff", nff::text(&fans)).objects, &scene.objects);
        // The shortest text of an f32 is another f64 than the f32 itself, but near it.
        prop_assert_eq!(big.objects.triangles.len(), expected);
        for (a, b) in big.objects.triangles.iter().zip(&scene.objects.triangles) {
            for k in 0..3 {
                prop_assert!((a.0[k] - b.0[k]).abs().max_element() < 1e-5);
            }
        }
    }

    /// Noise in a good file may make it bad, but no reader panics.
    #[test]
    fn readers_never_panic(
        noise in prop::collection::vec(any::<u8>(), 0..300),
        cut in 0_usize..600,
    ) {
        let mut files = [
            format!("{SQUARE}f 1 2 3\n").into_bytes(),
            format!("OFF\n4 1 0\n{OFF_SQUARE}3 0 1 2\n").into_bytes(),
            (header("ascii", 4, 1) + PLY_SQUARE + "3 0 1 2\n").into_bytes(),
            binary(false, &CORNERS, &[vec![0, 1, 2]]),
            binary(true, &CORNERS, &[vec![0, 1, 2]]),
            stl::text(&[[[0.0; 3]; 3]; 2]).into_bytes(),
            stl::binary("solid", &[[[1.0; 3]; 3]; 3]),
            nff::EVERYTHING.into(),
        ];
        for file in &mut files {
            let start = cut.min(file.len());
            let end = (start + noise.len() / 8).min(file.len());
            file.splice(start..end, noise.iter().copied());
            for name in ["a.obj", "a.off", "a.ply", "a.stl", "a.nff"] {
                drop(load(name, file));
            }
        }
    }
}

/// Real meshes, where they are: in the folder SAHLAB_MODELS, or `models` of the project.
#[test]
fn real_meshes() {
    let folder = std::env::var_os("SAHLAB_MODELS").map_or_else(
        || PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("models"),
        PathBuf::from,
    );
    for (file, triangles) in [
        ("teapot.obj", 15_704),
        ("sponza.obj", 66_450),
        ("dragon_res3.ply", 47_794),
    ] {
        let path = folder.join(file);
        if !path.exists() {
            println!("skipped: {file} is not in the folder of models");
            continue;
        }
        let scene = Scene::load(path.to_str().expect("a path in UTF-8")).expect("a mesh");
        assert_eq!(scene.objects.triangles.len(), triangles, "{file}");
    }
}
