//! The header of a PLY file: where it ends, and whether it declares a mesh.

use std::collections::BTreeSet;

use ply_rs_bw::parser::{Parser, Reader};
use ply_rs_bw::ply::{Header, PropertyDef, PropertyType, ScalarType};

use super::super::mesh::Fault;
use super::{CORNERS, Element};

/// The header with its last line, and what follows.
pub(super) fn split(bytes: &[u8]) -> Result<(String, &[u8]), (usize, Fault)> {
    let mut end = 0;
    for (i, line) in bytes.split_inclusive(|&b| b == b'\n').enumerate() {
        let text = line.trim_ascii();
        if i == 0 && text != b"ply" {
            let fault = Fault::new(
                "this is not a PLY file",
                "its first line must be 'ply', ended by a line feed",
            );
            return Err((1, fault));
        }
        end += line.len();
        if text == b"end_header" {
            let head = String::from_utf8_lossy(&bytes[..end]).into_owned();
            return Ok((head, &bytes[end..]));
        }
    }
    let count = bytes.iter().filter(|&&b| b == b'\n').count();
    let fault = Fault::new(
        "the file ends before its header does",
        "a line 'end_header' must end the header",
    );
    Err((count.max(1), fault))
}

/// The header as the crate reads it.
pub(super) fn header(head: &str) -> Result<Header, (usize, Fault)> {
    let mut reader = Reader::new(head.as_bytes());
    let header = Parser::<Element>::new().read_header(&mut reader);
    let header = header.map_err(|error| match error.line() {
        Some(line) => {
            let text = head.lines().nth(line - 1).unwrap_or_default();
            let fault = Fault::new(
                format!("cannot read the header line '{text}'"),
                "header lines are 'format ENCODING 1.0', 'comment ...', 'obj_info ...', 'element NAME COUNT', \
                 'property TYPE NAME' and 'property list TYPE TYPE NAME'",
            );
            (line, fault)
        }
        None => (
            head.lines().count(),
            Fault::new(
                "the header has no line 'format'",
                "ascii 1.0, binary_little_endian 1.0 or binary_big_endian 1.0 must be declared",
            ),
        ),
    })?;
    declared_once(head)?;
    Ok(header)
}

/// Whether each name is declared once, and one list of a face's corners: of two declarations of a name the crate keeps the last,
/// and of two lists neither is the better.
fn declared_once(head: &str) -> Result<(), (usize, Fault)> {
    let (mut elements, mut properties) = (BTreeSet::new(), BTreeSet::new());
    let (mut element, mut lists) = ("", 0);
    for (i, line) in head.lines().enumerate() {
        let words: Vec<_> = line.split_whitespace().collect();
        let first = match words[..] {
            ["element", name, _] => {
                properties.clear();
                element = name;
                elements.insert(name)
            }
            ["property", .., name] => properties.insert(name),
            _ => true,
        };
        if !first {
            let fault = Fault::new(
                format!("'{line}' declares a name again"),
                "the names of elements must differ, and so must those of an element's properties",
            );
            return Err((i + 1, fault));
        }
        if let ["property", "list", .., name] = words[..] {
            lists += usize::from(element == "face" && CORNERS.contains(&name));
        }
        if lists > 1 {
            let fault = Fault::new(
                format!("'{line}' declares a second list of corners"),
                "a face has one, 'vertex_indices' or 'vertex_index'",
            );
            return Err((i + 1, fault));
        }
    }
    Ok(())
}

/// Whether the header declares a mesh.
pub(super) fn check(header: &Header) -> Result<(), Fault> {
    let element = |name: &str| {
        header.elements.get(name).ok_or_else(|| {
            Fault::new(
                format!("the header declares no element '{name}'"),
                "a mesh has the elements 'vertex' and 'face' (strips are not read)",
            )
        })
    };
    let vertex = element("vertex")?;
    for axis in ["x", "y", "z"] {
        let scalar = |p: &PropertyDef| matches!(p.data_type, PropertyType::Scalar(_));
        if !vertex.properties.get(axis).is_some_and(scalar) {
            return Err(Fault::new(
                format!("vertices have no number '{axis}'"),
                "'property float' or 'property double' must declare x, y and z",
            ));
        }
    }
    let face = element("face")?;
    let named = CORNERS.iter().filter_map(|name| face.properties.get(*name));
    let list = named.map(|p| &p.data_type).find_map(|kind| match kind {
        PropertyType::List(_, item) => Some(item),
        PropertyType::Scalar(_) => None,
    });
    match list {
        Some(ScalarType::Float | ScalarType::Double) => Err(Fault::new(
            "the corners of faces are not whole numbers",
            "they must be a list of int or uint",
        )),
        Some(_) => Ok(()),
        None => Err(Fault::new(
            "faces have no list of corners",
            "'property list uchar int vertex_indices' must declare it",
        )),
    }
}
