//! PLY (Stanford): ASCII and both binary kinds; elements `vertex` and `face`, all others passed over.
//!
//! The crate `ply-rs-bw` reads the header and the binary elements. ASCII elements are read here: the crate takes
//! neither `.5` nor `1.` for a number, and passes over what stands on a line beyond the declared properties, such as
//! the corners of a face whose count is too small. Numbers of a text keep the precision they are written with.

mod header;

use std::io::ErrorKind;

use glam::DVec3;
use ply_rs_bw::parser::{ParseError, Parser};
use ply_rs_bw::ply::{
    ElementDef, Encoding, Header, Property, PropertyAccess, PropertyAccessResult, PropertyType,
};

use super::SceneError;
use super::mesh::{Faces, Fault, Mesh, lines, number, whole};

/// Names of the list of a face's corners.
const CORNERS: [&str; 2] = ["vertex_indices", "vertex_index"];

/// The triangles of a PLY file.
pub(super) fn parse(path: &str, bytes: &[u8]) -> Result<Mesh, SceneError> {
    let (head, payload) = header::split(bytes).map_err(|(line, f)| f.at(path, line))?;
    let length = head.lines().count();
    let header = header::header(&head).map_err(|(line, f)| f.at(path, line))?;
    header::check(&header).map_err(|f| f.at(path, length))?;

    let mut contents = Contents {
        path,
        mesh: Mesh::new(0),
        faces: Faces::default(),
    };
    if header.encoding == Encoding::Ascii {
        contents.read_text(&header, payload, length)?;
    } else {
        contents.read_binary(&header, payload)?;
    }
    Ok(contents.mesh)
}

/// What has been read so far.
struct Contents<'a> {
    path: &'a str,
    mesh: Mesh,
    faces: Faces,
}

impl Contents<'_> {
    /// Reads elements of a line each, which follow a header of `length` lines.
    fn read_text(
        &mut self,
        header: &Header,
        payload: &[u8],
        length: usize,
    ) -> Result<(), SceneError> {
        let path = self.path;
        let at = |line, kind: &str, i: usize, mut fault: Fault| {
            fault.wrong = format!("{kind} {i}: {}", fault.wrong);
            fault.at(path, line)
        };
        let mut last = length;
        let mut rows = lines(payload)
            .map_err(|f| f.at(path, length + 1))?
            .map(|(line, text)| (length + line, text))
            .filter(|(_, text)| !text.trim_ascii().is_empty());
        let mut face_lines = Vec::new();
        for (kind, element) in &header.elements {
            if element.properties.is_empty() {
                continue;
            }
            for i in 0..element.count {
                let Some((line, text)) = rows.next() else {
                    let fault = Fault::new("the file ends before it", declared(element));
                    return Err(at(last, kind, i, fault));
                };
                last = line;
                Element::from_text(&text, element)
                    .and_then(|e| self.keep(kind, i, e))
                    .map_err(|f| at(line, kind, i, f))?;
                if kind == "face" {
                    face_lines.push(line);
                }
            }
        }
        if let Some((line, _)) = rows.next() {
            let all = Fault::new(
                "there is more after the last element",
                "the counts in the header must match",
            );
            return Err(all.at(path, line));
        }
        std::mem::take(&mut self.faces)
            .into_mesh(&mut self.mesh)
            .map_err(|(i, f)| at(face_lines[i], "face", i, f))
    }

    /// Reads elements of bytes.
    fn read_binary(&mut self, header: &Header, payload: &[u8]) -> Result<(), SceneError> {
        let path = self.path;
        let within = |element: String, fault: Fault| SceneError::Element {
            path: path.into(),
            element,
            wrong: fault.wrong,
            right: fault.right,
        };
        let parser = Parser::<Element>::new();
        let mut rest = payload;
        for (kind, element) in &header.elements {
            if element.properties.is_empty() {
                continue;
            }
            for i in 0..element.count {
                let read = match header.encoding {
                    Encoding::BinaryBigEndian => parser.read_big_endian_element(&mut rest, element),
                    _ => parser.read_little_endian_element(&mut rest, element),
                };
                read.map_err(|e| unreadable(&e, element))
                    .and_then(|e| self.keep(kind, i, e))
                    .map_err(|f| within(format!("{kind} {i}"), f))?;
            }
        }
        if !rest.trim_ascii().is_empty() {
            let more = Fault::new(
                format!("{} bytes are left over", rest.len()),
                "the counts in the header must match",
            );
            return Err(within("after the last element".into(), more));
        }
        std::mem::take(&mut self.faces)
            .into_mesh(&mut self.mesh)
            .map_err(|(i, f)| within(format!("face {i}"), f))
    }

    fn keep(&mut self, kind: &str, number: usize, element: Element) -> Result<(), Fault> {
        match kind {
            "vertex" => self.mesh.vertices.push(element.position()?),
            "face" => {
                for corner in element.corners {
                    let corner = usize::try_from(corner).map_err(|_| {
                        Fault::new(
                            format!("there is no vertex {corner}"),
                            "vertices are numbered from 0",
                        )
                    })?;
                    self.faces.corner(corner);
                }
                self.faces.end(number);
            }
            _ => {}
        }
        Ok(())
    }
}

fn declared(element: &ElementDef) -> String {
    format!(
        "the header declares {} of kind {}",
        element.count, element.name
    )
}

/// The crate's error for a binary element.
fn unreadable(error: &ParseError, element: &ElementDef) -> Fault {
    if error.kind() == ErrorKind::UnexpectedEof {
        return Fault::new("the file ends within it", declared(element));
    }
    let text = error.to_string();
    let first = text.lines().next().unwrap_or_default();
    Fault::new(
        format!("it cannot be read ({})", first.trim_end_matches('.')),
        "it must be as the header declares",
    )
}

/// What matters of an element of any kind.
struct Element {
    position: DVec3,
    corners: Vec<i64>,
}

impl Element {
    /// An element that stands on a line.
    fn from_text(text: &str, declaration: &ElementDef) -> Result<Self, Fault> {
        let mut words = text.split_ascii_whitespace();
        let mut element = Self::new();
        for (name, property) in &declaration.properties {
            let mut next = || {
                words.next().ok_or_else(|| {
                    Fault::new(
                        format!("the line ends before '{name}' does"),
                        "every declared property must be there",
                    )
                })
            };
            match property.data_type {
                PropertyType::Scalar(_) => match axis(name) {
                    Some(axis) => element.position[axis] = number(next()?)?,
                    None => drop(next()?),
                },
                PropertyType::List(..) => {
                    for _ in 0..whole(next()?, "count")? {
                        let word = next()?;
                        if CORNERS.contains(&name.as_str()) {
                            let corner = word.parse().map_err(|_| {
                                Fault::new(
                                    format!("'{word}' is not a vertex number"),
                                    "a vertex number is a whole number from 0",
                                )
                            })?;
                            element.corners.push(corner);
                        }
                    }
                }
            }
        }
        match words.next() {
            None => Ok(element),
            Some(word) => Err(Fault::new(
                format!("'{word}' stands after the last declared property"),
                "a line must hold what the header declares, and a list as many as its count says",
            )),
        }
    }

    fn position(&self) -> Result<DVec3, Fault> {
        if self.position.is_finite() {
            Ok(self.position)
        } else {
            Err(Fault::new(
                "a coordinate is not finite",
                "every coordinate must be finite",
            ))
        }
    }
}

/// The axis of that name.
fn axis(name: &str) -> Option<usize> {
    ["x", "y", "z"].iter().position(|&axis| axis == name)
}

impl PropertyAccess for Element {
    fn new() -> Self {
        Self {
            position: DVec3::ZERO,
            corners: Vec::new(),
        }
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        if let (Some(axis), Some(value)) = (axis(name), scalar(&property)) {
            self.position[axis] = value;
        } else if CORNERS.contains(&name)
            && let Some(list) = whole_list(property)
        {
            self.corners = list;
        } else {
            return PropertyAccessResult::Ignored;
        }
        PropertyAccessResult::Set
    }
}

fn scalar(property: &Property) -> Option<f64> {
    match *property {
        Property::Char(x) => Some(x.into()),
        Property::UChar(x) => Some(x.into()),
        Property::Short(x) => Some(x.into()),
        Property::UShort(x) => Some(x.into()),
        Property::Int(x) => Some(x.into()),
        Property::UInt(x) => Some(x.into()),
        Property::Float(x) => Some(x.into()),
        Property::Double(x) => Some(x),
        _ => None,
    }
}

fn whole_list(property: Property) -> Option<Vec<i64>> {
    fn wide<T: Into<i64>>(list: Vec<T>) -> Option<Vec<i64>> {
        Some(list.into_iter().map(Into::into).collect())
    }
    match property {
        Property::ListChar(list) => wide(list),
        Property::ListUChar(list) => wide(list),
        Property::ListShort(list) => wide(list),
        Property::ListUShort(list) => wide(list),
        Property::ListInt(list) => wide(list),
        Property::ListUInt(list) => wide(list),
        _ => None,
    }
}
