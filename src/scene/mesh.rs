//! What the mesh readers share: lines of text, numbers, and faces that become triangles.
//!
//! No face is lost silently: what cannot become triangles is an error that says where it stands.

use std::borrow::Cow;

use glam::DVec3;

use super::draft::Draft;
use super::{SceneError, plural, quotable};
use crate::geom::{Objects, Triangle};

/// What is wrong with a line or an element, before it is known where that is.
#[derive(Debug)]
pub(super) struct Fault {
    pub(super) wrong: String,
    pub(super) right: String,
}

impl Fault {
    /// `wrong` may quote the file.
    pub(super) fn new(wrong: impl AsRef<str>, right: impl Into<String>) -> Self {
        Self {
            wrong: quotable(wrong.as_ref()),
            right: right.into(),
        }
    }

    /// The error for this fault in a line.
    pub(super) fn at(self, path: &str, line: usize) -> SceneError {
        SceneError::Line {
            path: path.into(),
            line,
            wrong: self.wrong,
            right: self.right,
        }
    }
}

/// Vertices and the triangles made from faces so far.
pub(super) struct Mesh {
    /// All vertices; those of no face do not matter.
    pub(super) vertices: Vec<DVec3>,
    /// What to tell the user.
    pub(super) notes: Vec<String>,
    triangles: Vec<Triangle>,
    /// Number the file gives to its first vertex: for messages.
    first: usize,
    /// Faces with more than three corners, and triangles made of them.
    split: [usize; 2],
}

impl Mesh {
    /// Nothing yet, in a format that counts vertices from `first`.
    pub(super) fn new(first: usize) -> Self {
        Self {
            vertices: Vec::new(),
            notes: Vec::new(),
            triangles: Vec::new(),
            first,
            split: [0; 2],
        }
    }

    /// Adds a face by the places of its corners in `vertices`, as a fan about the first.
    ///
    /// A triangle may name a vertex twice: it has no area then, and is kept.
    pub(super) fn face(&mut self, corners: &[usize]) -> Result<(), Fault> {
        let n = corners.len();
        if n < 3 {
            return Err(Fault::new(
                format!("a face with {}", plural(n, "corner")),
                "a face needs at least 3",
            ));
        }
        if let Some(beyond) = corners.iter().find(|&&c| c >= self.vertices.len()) {
            return Err(self.no_vertex(&(beyond + self.first).to_string()));
        }
        if n > 3 {
            let mut sorted = corners.to_vec();
            sorted.sort_unstable();
            if let Some(pair) = sorted.windows(2).find(|w| w[0] == w[1]) {
                return Err(Fault::new(
                    format!(
                        "vertex {} stands twice in a face with {n} corners",
                        pair[0] + self.first
                    ),
                    "the corners of a face must differ",
                ));
            }
            self.split[0] += 1;
            self.split[1] += n - 2;
        }
        let [a, rest @ ..] = corners else {
            return Ok(());
        };
        let fan = rest.windows(2).map(|w| [*a, w[0], w[1]]);
        self.triangles
            .extend(fan.map(|t| Triangle(t.map(|i| self.vertices[i]))));
        Ok(())
    }

    /// Adds a triangle by its corners.
    pub(super) fn triangle(&mut self, corners: [DVec3; 3]) {
        self.triangles.push(Triangle(corners));
    }

    /// The fault of a face that names a vertex which does not exist.
    pub(super) fn no_vertex(&self, number: &str) -> Fault {
        let right = match self.vertices.len() {
            0 => "there are no vertices".into(),
            n => format!("vertices run from {} to {}", self.first, n - 1 + self.first),
        };
        Fault::new(format!("there is no vertex {number}"), right)
    }

    /// The triangles, and notes for the user.
    pub(super) fn into_draft(mut self) -> (Draft, Vec<String>) {
        let [faces, triangles] = self.split;
        if faces > 0 {
            self.notes.push(format!(
                "{} with more than 3 corners split into {} (fans, right for convex faces)",
                plural(faces, "face"),
                plural(triangles, "triangle")
            ));
        }
        let objects = Objects {
            triangles: self.triangles,
            ..Objects::default()
        };
        (objects.into(), self.notes)
    }
}

/// The lines of a text file with their numbers, from 1, without line ends. Bytes that are not UTF-8 are replaced.
///
/// A file without a single line feed is taken to end its lines with carriage returns. UTF-16 is refused.
pub(super) fn lines(bytes: &[u8]) -> Result<impl Iterator<Item = (usize, Cow<'_, str>)>, Fault> {
    if bytes.starts_with(&[0xFF, 0xFE]) || bytes.starts_with(&[0xFE, 0xFF]) {
        return Err(Fault::new(
            "the text is in UTF-16",
            "save it as UTF-8 or ASCII",
        ));
    }
    let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
    let end = if bytes.contains(&b'\n') { b'\n' } else { b'\r' };
    let lines = bytes.split(move |&b| b == end);
    Ok((1..).zip(lines.map(|l| String::from_utf8_lossy(l.strip_suffix(b"\r").unwrap_or(l)))))
}

/// Faces kept until all vertices are known, each with the place it stands at.
#[derive(Default)]
pub(super) struct Faces {
    corners: Vec<usize>,
    /// Place, and where the corners end.
    ends: Vec<(usize, usize)>,
}

impl Faces {
    /// Adds a corner to the face that is being read.
    pub(super) fn corner(&mut self, corner: usize) {
        self.corners.push(corner);
    }

    /// Ends the face that is being read; `place` is a line, or the face's number.
    pub(super) fn end(&mut self, place: usize) {
        self.ends.push((place, self.corners.len()));
    }

    /// Turns all faces into triangles; a fault comes with the place of its face.
    pub(super) fn into_mesh(self, mesh: &mut Mesh) -> Result<(), (usize, Fault)> {
        let mut start = 0;
        for (place, end) in self.ends {
            mesh.face(&self.corners[start..end])
                .map_err(|fault| (place, fault))?;
            start = end;
        }
        Ok(())
    }
}

/// What stands before a `#`.
pub(super) fn without_comment(line: &str) -> &str {
    line.split('#').next().unwrap_or_default()
}

/// A finite number.
pub(super) fn number(token: &str) -> Result<f64, Fault> {
    match token.parse::<f64>() {
        Ok(x) if x.is_finite() => Ok(x),
        Ok(_) => Err(Fault::new(
            format!("'{token}' is not finite"),
            "every number must be finite",
        )),
        Err(_) => Err(Fault::new(
            format!("'{token}' is not a number"),
            "a number such as -1.5 or 2e-3 must stand here",
        )),
    }
}

/// All tokens as finite numbers.
pub(super) fn numbers<'a>(tokens: impl IntoIterator<Item = &'a str>) -> Result<Vec<f64>, Fault> {
    tokens.into_iter().map(number).collect()
}

/// A count or a vertex number from 0.
pub(super) fn whole(token: &str, what: &str) -> Result<usize, Fault> {
    token.parse().map_err(|_| {
        Fault::new(
            format!("'{token}' is not a {what}"),
            format!("a {what} is a whole number from 0"),
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn line_ends_and_marks() {
        let all = |bytes| -> Vec<(usize, String)> {
            let lines = lines(bytes).expect("text");
            lines.map(|(i, l)| (i, l.into_owned())).collect()
        };
        let expected = [(1, "a".to_owned()), (2, "b".to_owned())];
        for text in ["a\nb", "a\r\nb", "a\rb", "\u{FEFF}a\nb"] {
            assert_eq!(all(text.as_bytes()), expected, "{text:?}");
        }
        assert_eq!(all(b"a\xFF")[0].1, "a\u{FFFD}");
        assert!(lines(&[0xFF, 0xFE, b'v', 0]).is_err());
    }

    #[test]
    fn a_face_becomes_a_fan() {
        let mut mesh = Mesh::new(1);
        mesh.vertices = (0..6)
            .map(|i| DVec3::new(f64::from(i), f64::from(i * i), 0.0))
            .collect();
        mesh.face(&[0, 1, 2]).expect("a triangle");
        mesh.face(&[3, 3, 4]).expect("a degenerate triangle");
        mesh.face(&[0, 1, 2, 3, 4]).expect("a pentagon");
        assert_eq!(
            mesh.face(&[0, 1]).expect_err("two").wrong,
            "a face with 2 corners"
        );
        let fault = mesh.face(&[0, 1, 6]).expect_err("out of range");
        assert_eq!(fault.wrong, "there is no vertex 7");
        assert_eq!(fault.right, "vertices run from 1 to 6");
        let fault = mesh.face(&[0, 1, 2, 1]).expect_err("twice");
        assert_eq!(
            fault.wrong,
            "vertex 2 stands twice in a face with 4 corners"
        );
        let (draft, notes) = mesh.into_draft();
        let (objects, _) = draft.into_parts();
        assert_eq!(objects.triangles.len(), 5);
        assert_eq!(objects.triangles[4].0[2].x, 4.0);
        assert!(notes[0].starts_with("1 face with more than 3 corners split into 3 triangles"));
    }

    #[test]
    fn numbers_are_finite() {
        assert_eq!(
            numbers([".5", "5.", "-1e-3", "+2"]).expect("four"),
            [0.5, 5.0, -1e-3, 2.0]
        );
        for bad in ["nan", "inf", "1e999", "1,5", "", "0x10", "1d3"] {
            assert!(number(bad).is_err(), "{bad}");
        }
    }
}
