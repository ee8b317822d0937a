//! A user's own rays: what `validate trace` and `validate scene --rays` make of them.
#![allow(clippy::unwrap_used, missing_docs)]

#[path = "../common/mod.rs"]
mod common;

mod embree;
mod files;
mod hits;
mod reference;
mod scene;

use std::fs;
use std::path::Path;

use assert_cmd::Command;
use sahlab::geom::Cast;
use sahlab::study::records::{HitRecord, TraceRecord};

fn validate(folder: &Path) -> Command {
    let mut command = Command::cargo_bin("validate").unwrap();
    command.current_dir(folder);
    command
}

/// `validate trace SCENE --rays FILE --quiet ...` in a folder; gives the rows and the record.
fn traced(folder: &Path, scene: &str, file: &str, more: &[&str]) -> (Vec<HitRecord>, TraceRecord) {
    let mut command = validate(folder);
    command.args(["trace", scene, "--rays", file, "--quiet"]);
    command.args(more).assert().code(0);
    let data = folder.join("data/trace");
    let mut rows = csv::Reader::from_path(data.join("hits.csv")).unwrap();
    let rows = rows.deserialize().collect::<Result<_, _>>().unwrap();
    let record = fs::read(data.join("trace.json")).unwrap();
    (rows, serde_json::from_slice(&record).unwrap())
}

/// The numbers of a ray, its end last.
fn numbers(cast: &Cast) -> [f64; 7] {
    let ([ox, oy, oz], [dx, dy, dz]) = (cast.origin.to_array(), cast.direction.to_array());
    [ox, oy, oz, dx, dy, dz, cast.span.t1]
}

/// Rays as text that reads back to the bit.
fn as_csv(casts: &[Cast]) -> String {
    let mut text = String::from("ox,oy,oz,dx,dy,dz,tmax\n");
    for cast in casts {
        let [parts @ .., end] = numbers(cast);
        for part in parts {
            text += &format!("{part:?},");
        }
        text += &if end.is_finite() {
            format!("{end:?}\n")
        } else {
            "\n".into()
        };
    }
    text
}

/// An array of f64 with so many columns, as NumPy writes it.
fn as_npy(columns: usize, numbers: impl Iterator<Item = f64>) -> Vec<u8> {
    let data: Vec<u8> = numbers.flat_map(f64::to_le_bytes).collect();
    let rows = data.len() / 8 / columns;
    let header =
        format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({rows}, {columns}), }}\n");
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header.bytes());
    bytes.extend(data);
    bytes
}
