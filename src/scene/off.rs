//! Object File Format (Geomview): a header, counts, vertices, faces; all numbers from 0.
//!
//! The word OFF may be missing, and the counts may stand on its line. Its prefixes tell what follows x y z in every
//! vertex: ST two texture coordinates, C a colour of three or four numbers, N a normal. A face is its number of
//! corners, its corners, and perhaps a colour. The word is read in either case.

use glam::DVec3;

use super::SceneError;
use super::mesh::{Fault, Mesh, lines, numbers, whole, without_comment};

/// The triangles of an OFF file.
pub(super) fn parse(path: &str, bytes: &[u8]) -> Result<Mesh, SceneError> {
    let all = lines(bytes).map_err(|f| f.at(path, 1))?;
    let mut last = 1;
    // Lines that say something, as words.
    let mut rows = Vec::new();
    for (line, text) in all {
        let words: Vec<String> = without_comment(&text)
            .split_whitespace()
            .map(str::to_owned)
            .collect();
        if !words.is_empty() {
            last = line;
            rows.push((line, words));
        }
    }
    let mut rows = rows.into_iter().peekable();

    // The header word, if there is one; then the counts, on its line or the next.
    let mut extra = Extra::default();
    if let Some((line, words)) = rows.peek_mut()
        && words[0].parse::<f64>().is_err()
    {
        extra = Extra::announced(&words[0]).map_err(|f| f.at(path, *line))?;
        words.remove(0);
    }
    let empty = |(_, words): &(usize, Vec<String>)| words.is_empty();
    rows.next_if(empty);
    let ended = |what: &str| {
        Fault::new(
            format!("the file ends before {what}"),
            "counts, vertices and faces must all be there",
        )
        .at(path, last)
    };
    let (line, words) = rows.next().ok_or_else(|| ended("the counts"))?;
    let [vertices, faces] = counts(&words).map_err(|f| f.at(path, line))?;

    let mut mesh = Mesh::new(0);
    for number in 0..vertices {
        let what = || format!("vertex {number} of {vertices}");
        let (line, words) = rows.next().ok_or_else(|| ended(&what()))?;
        let vertex = extra
            .vertex(&words, &what())
            .map_err(|f| f.at(path, line))?;
        mesh.vertices.push(vertex);
    }
    for number in 0..faces {
        let what = || format!("face {number} of {faces}");
        let (line, words) = rows.next().ok_or_else(|| ended(&what()))?;
        let corners = corners(&words).map_err(|f| f.at(path, line))?;
        mesh.face(&corners).map_err(|f| f.at(path, line))?;
    }
    if let Some((line, _)) = rows.next() {
        let more = Fault::new(
            format!("there is more after the last of {vertices} vertices and {faces} faces"),
            "the counts in the header must match",
        );
        return Err(more.at(path, line));
    }
    Ok(mesh)
}

/// How many numbers may follow x y z in a vertex.
#[derive(Default)]
struct Extra {
    least: usize,
    most: usize,
}

impl Extra {
    /// What a header such as OFF, COFF, NOFF or STCNOFF announces.
    fn announced(header: &str) -> Result<Self, Fault> {
        let misspelt = || {
            Fault::new(
                format!("the header '{header}' is not known"),
                "the file must start with OFF, COFF, NOFF, CNOFF or STOFF, or with its counts",
            )
        };
        let upper = header.to_ascii_uppercase();
        let mut rest = upper.strip_suffix("OFF").ok_or_else(misspelt)?;
        let mut extra = Self::default();
        for (prefix, least, most) in [("ST", 2, 2), ("C", 3, 4), ("N", 3, 3)] {
            if let Some(after) = rest.strip_prefix(prefix) {
                rest = after;
                extra.least += least;
                extra.most += most;
            }
        }
        if rest.is_empty() {
            Ok(extra)
        } else {
            Err(misspelt())
        }
    }

    fn vertex(&self, words: &[String], what: &str) -> Result<DVec3, Fault> {
        let all = numbers(words.iter().map(String::as_str))?;
        let (least, most) = (3 + self.least, 3 + self.most);
        match all[..] {
            [x, y, z, ..] if (least..=most).contains(&all.len()) => Ok(DVec3::new(x, y, z)),
            _ => {
                let expected = if least == most {
                    least.to_string()
                } else {
                    format!("{least} or {most}")
                };
                Err(Fault::new(
                    format!("{what} has {} numbers", all.len()),
                    format!("the header announces {expected} for each vertex"),
                ))
            }
        }
    }
}

/// Numbers of vertices and faces; a number of edges may follow.
fn counts(words: &[String]) -> Result<[usize; 2], Fault> {
    let counts: Vec<usize> = words
        .iter()
        .map(|w| whole(w, "count"))
        .collect::<Result<_, _>>()?;
    match counts[..] {
        [vertices, faces] | [vertices, faces, _] => Ok([vertices, faces]),
        _ => Err(Fault::new(
            format!("{} counts", counts.len()),
            "the counts are those of vertices, faces and edges",
        )),
    }
}

/// The corners of a face; a colour of at most four numbers may follow them.
fn corners(words: &[String]) -> Result<Vec<usize>, Fault> {
    let n = whole(&words[0], "number of corners")?;
    let rest = &words[1..];
    let wrong = |wrong: String| {
        Fault::new(
            wrong,
            "a face is its number of corners, its corners, and at most 4 numbers of colour",
        )
    };
    if rest.len() < n {
        return Err(wrong(format!("a face of {n} corners names {}", rest.len())));
    }
    let (corners, colour) = rest.split_at(n);
    if colour.len() > 4 {
        return Err(wrong(format!(
            "{} numbers follow the corners",
            colour.len()
        )));
    }
    numbers(colour.iter().map(String::as_str))?;
    corners.iter().map(|w| whole(w, "vertex number")).collect()
}
