//! Wavefront OBJ: vertices and faces, all else passed over.
//!
//! Vertices count from 1, or from the latest backwards (-1); a face may name vertices that come later. Texture and
//! normal numbers must be whole numbers but are not looked up. A backslash at a line's end continues it.

use std::collections::BTreeMap;

use glam::DVec3;

use super::mesh::{Faces, Fault, Mesh, lines, numbers, without_comment};
use super::quote::within;
use super::{SceneError, plural};

/// Keywords that carry no face and are passed over without a word.
const IGNORED: [&str; 12] = [
    "vt", "vn", "vp", "g", "o", "s", "usemtl", "mtllib", "l", "p", "mg", "lod",
];

/// The triangles of an OBJ file.
pub(super) fn parse(path: &str, bytes: &[u8]) -> Result<Mesh, SceneError> {
    let mut mesh = Mesh::new(1);
    let mut faces = Faces::default();
    // Unknown keywords: how many lines, and the first.
    let mut unknown: BTreeMap<String, [usize; 2]> = BTreeMap::new();

    let mut lines = lines(bytes).map_err(|f| f.at(path, 1))?;
    while let Some((line, text)) = lines.next() {
        // A comment ends the line: it cannot be continued, and may itself end with a backslash.
        let head = |text: &str| {
            let head = text.trim_end().strip_suffix('\\')?;
            (!text.contains('#')).then(|| head.to_owned() + " ")
        };
        let mut text = text;
        if let Some(mut whole) = head(&text) {
            // Piece by piece, so that a file of backslashes takes no longer than another.
            for (_, next) in lines.by_ref() {
                match head(&next) {
                    Some(piece) => whole += &piece,
                    None => {
                        whole += &next;
                        break;
                    }
                }
            }
            text = whole.into();
        }
        let mut words = without_comment(&text).split_whitespace();
        match words.next() {
            None => {}
            Some("v") => {
                let vertex = vertex(words).map_err(|f| f.at(path, line))?;
                mesh.vertices.push(vertex);
            }
            Some("f") => {
                for word in words {
                    faces.corner(corner(word, &mesh).map_err(|f| f.at(path, line))?);
                }
                faces.end(line);
            }
            Some(keyword) if IGNORED.contains(&keyword) => {}
            Some(keyword) => unknown.entry(keyword.into()).or_insert([0, line])[0] += 1,
        }
    }

    faces
        .into_mesh(&mut mesh)
        .map_err(|(line, f)| f.at(path, line))?;
    mesh.notes.extend(passed_over(unknown));
    Ok(mesh)
}

/// Unknown keywords told one by one: what is no OBJ file may have thousands.
const TOLD: usize = 4;

/// Notes on unknown keywords, in the order of their first lines.
fn passed_over(unknown: BTreeMap<String, [usize; 2]>) -> Vec<String> {
    let mut unknown: Vec<_> = unknown.into_iter().collect();
    unknown.sort_by_key(|&(_, [_, first])| first);
    let (told, others) = unknown.split_at(unknown.len().min(TOLD));
    let mut notes: Vec<_> = told
        .iter()
        .map(|(keyword, [count, first])| {
            format!(
                "{} with the unknown keyword '{}' passed over, the first at line {first}",
                plural(*count, "line"),
                within(keyword, 40)
            )
        })
        .collect();
    if !others.is_empty() {
        let lines = others.iter().map(|(_, [count, _])| count).sum();
        notes.push(format!(
            "{} with {} passed over",
            plural(lines, "line"),
            plural(others.len(), "other unknown keyword")
        ));
    }
    notes
}

/// x y z, and perhaps a weight or a colour, which are passed over.
fn vertex<'a>(words: impl Iterator<Item = &'a str>) -> Result<DVec3, Fault> {
    let all = numbers(words)?;
    match all[..] {
        [x, y, z] | [x, y, z, _] | [x, y, z, _, _, _] | [x, y, z, _, _, _, _] => {
            Ok(DVec3::new(x, y, z))
        }
        _ => Err(Fault::new(
            format!("a vertex with {}", plural(all.len(), "number")),
            "a vertex is v x y z, perhaps with a weight or a colour after it",
        )),
    }
}

/// Place of the vertex that a corner `v`, `v/vt`, `v//vn` or `v/vt/vn` names.
fn corner(word: &str, mesh: &Mesh) -> Result<usize, Fault> {
    let misspelt = || {
        Fault::new(
            format!("'{word}' is not a corner of a face"),
            "a corner is v, v/vt, v//vn or v/vt/vn with whole numbers",
        )
    };
    let mut parts = word.split('/');
    let first = parts.next().unwrap_or_default();
    let number: i64 = first.parse().map_err(|_| misspelt())?;
    let others: Vec<_> = parts.collect();
    let whole = |part: &&str| part.is_empty() || part.parse::<i64>().is_ok();
    if others.len() > 2 || !others.iter().all(whole) {
        return Err(misspelt());
    }
    // From the latest backwards: -1 is the last vertex so far.
    let place = if number < 0 {
        i64::try_from(mesh.vertices.len()).map(|n| n + number)
    } else {
        Ok(number - 1)
    };
    match place.map(usize::try_from) {
        Ok(Ok(place)) => Ok(place),
        _ if number == 0 => Err(Fault::new(
            "there is no vertex 0",
            "vertices count from 1, or from -1 backwards",
        )),
        _ => Err(Fault::new(
            format!("there is no vertex {number}"),
            format!("{} before this line", plural(mesh.vertices.len(), "v line")),
        )),
    }
}
