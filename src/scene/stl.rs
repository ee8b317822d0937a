//! STL (stereolithography), as text and binary: triangles alone, without units or shared vertices.
//!
//! A text may hold several solids; all are read. Words may stand in either case and be parted by any white space.
//! Normals and binary attributes are passed over. A binary file is known by its length, since its header may begin with
//! `solid` too.

use glam::DVec3;

use super::mesh::{Fault, Mesh, lines, numbers};
use super::{SceneError, plural};

/// Bytes before the first triangle of a binary file: a free header and the number of triangles.
const HEADER: usize = 84;

/// Bytes of a triangle: a normal, three corners, an attribute.
const FACET: usize = 50;

/// The triangles of an STL file.
pub(super) fn parse(path: &str, bytes: &[u8]) -> Result<Mesh, SceneError> {
    match announced(bytes) {
        Some(count) if count.checked_mul(FACET) == Some(bytes.len() - HEADER) => {
            binary(path, bytes)
        }
        // What is no text was meant to be binary.
        Some(count) if bytes.contains(&0) => Err(SceneError::Element {
            path: path.into(),
            element: "header".into(),
            wrong: format!(
                "{} announced, but {} bytes follow the header",
                plural(count, "triangle"),
                bytes.len() - HEADER
            ),
            right: format!("each triangle takes {FACET} bytes, and nothing may follow the last"),
        }),
        _ => text(path, bytes),
    }
}

/// The number of triangles that a binary header announces.
fn announced(bytes: &[u8]) -> Option<usize> {
    let count = bytes.get(HEADER - 4..HEADER)?;
    let count = u32::from_le_bytes(count.try_into().ok()?);
    usize::try_from(count).ok()
}

/// A binary file of the right length.
fn binary(path: &str, bytes: &[u8]) -> Result<Mesh, SceneError> {
    let mut mesh = Mesh::new(0);
    for (i, facet) in bytes[HEADER..].chunks_exact(FACET).enumerate() {
        let mut parts = facet[12..48]
            .chunks_exact(4)
            .map(|b| f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]])));
        let mut next = || parts.next().unwrap_or(f64::NAN);
        let corners = [(); 3].map(|()| DVec3::new(next(), next(), next()));
        if !corners.iter().all(|c| c.is_finite()) {
            return Err(SceneError::Element {
                path: path.into(),
                element: format!("triangle {i}"),
                wrong: "a coordinate is not finite".into(),
                right: "every number must be finite".into(),
            });
        }
        mesh.triangle(corners);
    }
    Ok(mesh)
}

/// What a line of a text may follow, and so which lines may come next.
#[derive(Clone, Copy)]
enum Place {
    /// Outside of all solids.
    File,
    /// In a solid, outside of its facets.
    Solid,
    /// After `facet`.
    Facet,
    /// After `outer loop`.
    Loop,
    /// After `endloop`.
    Done,
}

impl Place {
    /// What must come here.
    fn next(self) -> &'static str {
        match self {
            Self::File => "'solid NAME' must begin a solid",
            Self::Solid => "'facet normal X Y Z' or 'endsolid' must come next",
            Self::Facet => "'outer loop' must come next",
            Self::Loop => "three lines 'vertex X Y Z' and 'endloop' make a triangle",
            Self::Done => "'endfacet' must come next",
        }
    }
}

/// A file of words.
fn text(path: &str, bytes: &[u8]) -> Result<Mesh, SceneError> {
    let mut mesh = Mesh::new(0);
    let mut place = Place::File;
    let mut corners = Vec::new();
    let mut last = 1;
    for (line, text) in lines(bytes).map_err(|f| f.at(path, 1))? {
        let lower = text.to_ascii_lowercase();
        let words: Vec<&str> = lower.split_whitespace().collect();
        if words.is_empty() {
            continue;
        }
        last = line;
        let unexpected = |cause: &str| Fault::new(cause, place.next()).at(path, line);
        place = match (place, &words[..]) {
            (Place::File, ["solid", ..]) => Place::Solid,
            (Place::Solid, ["endsolid", ..]) => Place::File,
            (Place::Solid, ["facet", ..]) => Place::Facet,
            (Place::Facet, ["outer", "loop"]) => Place::Loop,
            (Place::Loop, ["vertex", rest @ ..]) => {
                let vertex = numbers(rest.iter().copied()).map_err(|f| f.at(path, line))?;
                let [x, y, z] = vertex[..] else {
                    let cause = format!("a vertex with {}", plural(vertex.len(), "number"));
                    return Err(Fault::new(cause, "a vertex is 'vertex X Y Z'").at(path, line));
                };
                corners.push(DVec3::new(x, y, z));
                Place::Loop
            }
            (Place::Loop, ["endloop"]) => {
                let triangle = <[DVec3; 3]>::try_from(std::mem::take(&mut corners))
                    .map_err(|c| unexpected(&format!("a facet with {} vertices", c.len())))?;
                mesh.triangle(triangle);
                Place::Done
            }
            (Place::Done, ["endfacet"]) => Place::Solid,
            _ => return Err(unexpected(&format!("'{}' is not expected here", words[0]))),
        };
    }
    match place {
        Place::File => Ok(mesh),
        _ => Err(Fault::new("the file ends within a solid", place.next()).at(path, last)),
    }
}
