//! What can be wrong with a scene: each message says where, what is wrong, and what would be right.

use std::io;

use super::AREAS;

/// Why there is no scene.
#[derive(Debug, thiserror::Error)]
pub enum SceneError {
    /// The text is neither the name of a scene nor a file of a known kind.
    #[error("{spec}: {wrong}; {right}")]
    Unknown {
        /// What was asked for.
        spec: String,
        /// What is wrong with it.
        wrong: String,
        /// What there is instead.
        right: String,
    },
    /// The scene exists, but not in this size.
    #[error("{spec}: {wrong}; sizes of {name} run from {least} to {most}")]
    Size {
        /// What was asked for.
        spec: String,
        /// What is wrong with the size.
        wrong: String,
        /// The scene's name without a size.
        name: String,
        /// Smallest size.
        least: usize,
        /// Largest size: more would be too many objects.
        most: usize,
    },
    /// The file cannot be opened or read.
    #[error("{path}: cannot read the file")]
    Read {
        /// The file.
        path: String,
        /// Why.
        #[source]
        source: io::Error,
    },
    /// A line of a text file is wrong.
    #[error("{path}:{line}: {wrong}; {right}")]
    Line {
        /// The file.
        path: String,
        /// The line, counted from 1.
        line: usize,
        /// What is wrong with it.
        wrong: String,
        /// What would be right.
        right: String,
    },
    /// An element of a binary file is wrong.
    #[error("{path}: {element}: {wrong}; {right}")]
    Element {
        /// The file.
        path: String,
        /// The element by kind and number, e.g. `face 17` (counted from 0).
        element: String,
        /// What is wrong with it.
        wrong: String,
        /// What would be right.
        right: String,
    },
    /// There is nothing in the scene.
    #[error(
        "{name}: the scene is empty; it needs at least one face or object{}",
        in_brackets(notes)
    )]
    Empty {
        /// The scene.
        name: String,
        /// What the reader has to say, e.g. which lines it passed over.
        notes: Vec<String>,
    },
    /// There is too much in the scene for the 32-bit numbers of a tree.
    #[error("{name}: {count} objects are too many; at most {most} are possible")]
    TooMany {
        /// The scene.
        name: String,
        /// How many there are.
        count: usize,
        /// How many there may be.
        most: usize,
    },
    /// An object has a coordinate that is not a finite number, or a radius that is not positive.
    #[error("{name}: {object} {wrong}; {right}")]
    Object {
        /// The scene.
        name: String,
        /// The object by kind and number, e.g. `sphere 3` (counted from 0).
        object: String,
        /// What is wrong with it.
        wrong: &'static str,
        /// What would be right.
        right: &'static str,
    },
    /// The box around everything has no area, or one whose square leaves f64.
    #[error(
        "{name}: the box around all objects has surface area {area:e}; it must lie within {least:e} to {most:e}: \
         at least two of its sides must be longer than zero; if they are, scale the scene",
        least = AREAS.start(),
        most = AREAS.end()
    )]
    World {
        /// The scene.
        name: String,
        /// The surface area.
        area: f64,
    },
    /// The scene lies so far from the origin that its coordinates cannot tell its parts.
    #[error(
        "{name}: the longest side of the scene is {side:e}, but its coordinates reach {largest:e}, where f64 can tell few \
         points of it apart; move the scene to the origin"
    )]
    Far {
        /// The scene.
        name: String,
        /// Longest side of its box.
        side: f64,
        /// Largest coordinate.
        largest: f64,
    },
}

/// Notes as a remark at the end of a sentence.
fn in_brackets(notes: &[String]) -> String {
    if notes.is_empty() {
        String::new()
    } else {
        format!(" ({})", notes.join("; "))
    }
}
