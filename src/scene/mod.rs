//! What is in the world: procedural scenes and scenes read from files.
//!
//! A scene is named by one word: `simple:NAME[:N]` (made here, after the kinds of scene that MacDonald & Booth tried),
//! `spd:NAME[:SIZE]` (Haines' Standard Procedural Databases), `hard:NAME[:SIZE]` (what breaks builders and traversals), or the
//! path of a file. The same word gives the same bits
//! on every machine: only + - * / and square roots, `libm`, and random numbers from a fixed seed are used.

mod catalogue;
mod draft;
mod error;
mod hard;
pub mod look;
mod mesh;
mod nff;
mod obj;
mod off;
mod ply;
mod quote;
mod random;
mod simple;
mod spd;
mod stl;

use std::ops::RangeInclusive;

use crate::geom::{Aabb, Objects, Polygon, Triangle};

pub use catalogue::catalogue;
pub(crate) use catalogue::nearest_name;
use catalogue::{Make, Recipe, generate, unknown};
use draft::Draft;
pub use error::SceneError;
pub use look::Look;
pub(crate) use quote::quotable;
use random::Random;
pub(crate) use random::unit_interval;
pub use spd::{SPD_GROUPS, spd_group, spd_scenes};

/// The file name extensions that can be read.
pub const EXTENSIONS: [&str; 5] = ["obj", "ply", "stl", "off", "nff"];

/// The largest number of objects of a scene.
pub const MAX_OBJECTS: usize = (1 << 27) - 1;

/// Surface areas of a world that are understood: areas of parts of it and squares of areas' shares stay within f64.
pub const AREAS: RangeInclusive<f64> = 1e-280..=1e280;

/// A named set of objects. Never empty.
///
/// ```
/// use sahlab::scene::Scene;
///
/// let file = Scene::parse("one.obj", b"v 0 0 0\nv 1 0 0\nv 0 2 0\nf 1 2 3\n")?;
/// assert_eq!((file.counts().as_str(), file.world.surface_area()), ("1 triangle", 4.0));
/// let made = Scene::load("spd:tetra:2")?;
/// assert_eq!(made.objects.len(), 16);
/// let wrong = Scene::load("spd:tetras").unwrap_err().to_string();
/// assert!(wrong.contains("tetra"), "{wrong}");
/// # Ok::<(), sahlab::scene::SceneError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Scene {
    /// The name one types to get it, e.g. `spd:balls:4` or a path.
    pub name: String,
    /// The objects.
    pub objects: Objects,
    /// Box of each object, in the order of their numbers.
    pub bounds: Vec<Aabb>,
    /// The smallest box around all objects: the root of every tree. Its surface area is one of [`AREAS`].
    pub world: Aabb,
    /// Camera, lights and materials, if the scene has them.
    pub look: Option<Look>,
    /// What a user should know of how it was read, e.g. degenerate triangles that can never be hit.
    pub notes: Vec<String>,
}

impl Scene {
    /// Checks the objects and their boxes; adds a note on objects without area to `notes`.
    pub fn new(
        name: impl Into<String>,
        objects: Objects,
        mut notes: Vec<String>,
    ) -> Result<Self, SceneError> {
        let name = name.into();
        if objects.is_empty() {
            return Err(SceneError::Empty { name, notes });
        }
        if objects.len() > MAX_OBJECTS {
            return Err(SceneError::TooMany {
                name,
                count: objects.len(),
                most: MAX_OBJECTS,
            });
        }
        check(&name, &objects)?;
        let bounds = objects.bounds();
        if let Some(number) = bounds.iter().position(|b| !b.is_valid()) {
            return Err(SceneError::Object {
                name,
                object: kind_and_number(&objects, number),
                wrong: "is so small or so large that its box cannot be computed",
                right: "squares of its lengths must be numbers that f64 has: scale the scene",
            });
        }
        let world = bounds.iter().copied().fold(Aabb::EMPTY, Aabb::union);
        let area = world.surface_area();
        if !AREAS.contains(&area) {
            return Err(SceneError::World { name, area });
        }
        notes.extend(degenerate(&objects));
        let side = world.extent().max_element();
        let largest = world.lo.abs().max(world.hi.abs()).max_element();
        if side < FAR * largest {
            return Err(SceneError::Far {
                name,
                side,
                largest,
            });
        }
        if side < NEAR * largest {
            notes.push(format!(
                "far from the origin: the longest side is {side:e}, the largest coordinate {largest:e}; rounding moves \
                 objects against each other, so move the scene to the origin"
            ));
        }
        Ok(Self {
            name,
            objects,
            bounds,
            world,
            look: None,
            notes,
        })
    }

    /// A scene of objects and, if they have one, their look.
    fn from_draft(
        name: impl Into<String>,
        draft: Draft,
        notes: Vec<String>,
    ) -> Result<Self, SceneError> {
        let (objects, look) = draft.into_parts();
        Ok(Self {
            look,
            ..Self::new(name, objects, notes)?
        })
    }

    /// The scene of that name: `simple:NAME[:N]`, `spd:NAME[:SIZE]`, `hard:NAME[:SIZE]`, or a path that ends in one of [`EXTENSIONS`].
    ///
    /// A procedural scene's name always carries its size, so that one scene has one name.
    pub fn load(spec: &str) -> Result<Self, SceneError> {
        match spec.split_once(':') {
            Some((group @ ("simple" | "spd" | "hard"), rest)) => generate(spec, group, rest),
            _ => read(spec),
        }
    }

    /// The scene in a file's bytes; the path, one that ends in one of [`EXTENSIONS`], tells the format and names the scene.
    ///
    /// # Errors
    /// If the path ends otherwise, or the bytes are no scene.
    pub fn parse(path: &str, bytes: &[u8]) -> Result<Self, SceneError> {
        let (draft, notes) = reader(path)?(path, bytes)?;
        Self::from_draft(path, draft, notes)
    }

    /// How many objects of each kind there are, e.g. `7381 spheres, 1 polygon`.
    pub fn counts(&self) -> String {
        let o = &self.objects;
        let kinds = [
            (o.triangles.len(), "triangle"),
            (o.spheres.len(), "sphere"),
            (o.cones.len(), "cone"),
            (o.polygons.len(), "polygon"),
        ];
        let present: Vec<_> = kinds
            .into_iter()
            .filter(|&(n, _)| n > 0)
            .map(|(n, kind)| plural(n, kind))
            .collect();
        present.join(", ")
    }
}

/// Reads the bytes of a file of this name.
type Parse = fn(&str, &[u8]) -> Result<(Draft, Vec<String>), SceneError>;

/// What reads files that end like this one.
fn reader(path: &str) -> Result<Parse, SceneError> {
    let extension = std::path::Path::new(path)
        .extension()
        .map(|e| e.to_string_lossy().to_lowercase());
    match extension.as_deref() {
        Some("nff") => Ok(nff::parse),
        Some("obj") => Ok(|path, bytes| Ok(obj::parse(path, bytes)?.into_draft())),
        Some("off") => Ok(|path, bytes| Ok(off::parse(path, bytes)?.into_draft())),
        Some("ply") => Ok(|path, bytes| Ok(ply::parse(path, bytes)?.into_draft())),
        Some("stl") => Ok(|path, bytes| Ok(stl::parse(path, bytes)?.into_draft())),
        Some(other) => Err(unknown(path, format!("cannot read .{other} files"))),
        None => Err(unknown(path, "no such scene".into())),
    }
}

fn read(path: &str) -> Result<Scene, SceneError> {
    // Before the file is looked for: a misspelt name of a scene is no missing file.
    reader(path)?;
    let bytes = std::fs::read(path).map_err(|source| SceneError::Read {
        path: path.into(),
        source,
    })?;
    Scene::parse(path, &bytes)
}

/// Refuses coordinates that are not finite and radii that are not positive.
fn check(name: &str, objects: &Objects) -> Result<(), SceneError> {
    let bad_triangle = objects
        .triangles
        .iter()
        .position(|t| !t.0.iter().all(|p| p.is_finite()));
    let bad_centre = objects.spheres.iter().position(|s| !s.centre.is_finite());
    let bad_radius = objects
        .spheres
        .iter()
        .position(|s| !(s.radius > 0.0 && s.radius.is_finite()));
    let bad_end = objects
        .cones
        .iter()
        .position(|c| !(c.base.is_finite() && c.apex.is_finite() && c.base != c.apex));
    let bad_width = objects.cones.iter().position(|c| {
        let radii = [c.base_radius, c.apex_radius];
        !radii.iter().all(|&r| r >= 0.0 && r.is_finite()) || radii == [0.0; 2]
    });
    let bad_polygon = objects
        .polygons
        .iter()
        .position(|p| !p.corners().iter().all(|c| c.is_finite()));
    let coordinate = (
        "has a coordinate that is not finite",
        "every coordinate must be a finite number",
    );
    let radius = (
        "has a radius that is not a positive number",
        "every radius must be finite and above zero",
    );
    let ends = (
        "has ends that coincide or are not finite",
        "the two ends must be finite and differ",
    );
    let radii = (
        "has radii that are negative, not finite, or both zero",
        "both radii must be finite, none negative, and one above zero",
    );
    let found = [
        (bad_triangle, "triangle", coordinate),
        (bad_centre, "sphere", coordinate),
        (bad_radius, "sphere", radius),
        (bad_end, "cone", ends),
        (bad_width, "cone", radii),
        (bad_polygon, "polygon", coordinate),
    ];
    for (number, kind, (wrong, right)) in found {
        if let Some(number) = number {
            return Err(SceneError::Object {
                name: name.into(),
                object: format!("{kind} {number}"),
                wrong,
                right,
            });
        }
    }
    Ok(())
}

/// An object by its kind and its number among those of the kind, e.g. `cone 0`.
fn kind_and_number(objects: &Objects, number: usize) -> String {
    let mut number = number;
    for (count, kind) in [
        (objects.triangles.len(), "triangle"),
        (objects.spheres.len(), "sphere"),
        (objects.cones.len(), "cone"),
    ] {
        if number < count {
            return format!("{kind} {number}");
        }
        number -= count;
    }
    format!("polygon {number}")
}

/// A note on triangles and polygons without area, if there are any.
fn degenerate(objects: &Objects) -> Option<String> {
    let flat = |area: f64| area == 0.0;
    let triangles = objects.triangles.iter().map(Triangle::area);
    let polygons = objects.polygons.iter().map(Polygon::area);
    let found = [
        (triangles.filter(|&a| flat(a)).count(), "triangle"),
        (polygons.filter(|&a| flat(a)).count(), "polygon"),
    ];
    let told: Vec<_> = found
        .into_iter()
        .filter(|&(n, _)| n > 0)
        .map(|(n, kind)| plural(n, kind))
        .collect();
    (!told.is_empty()).then(|| format!("{} without area: kept, never hit", told.join(", ")))
}

/// Least longest side, as a share of the largest coordinate, for which coordinates have seven digits to tell sides by.
const NEAR: f64 = 1e-9;

/// Below this share fewer than about 500 coordinates are left along the longest side: areas are noise.
const FAR: f64 = 1e-13;

/// A number with its noun.
fn plural(n: usize, noun: &str) -> String {
    let s = if n == 1 { "" } else { "s" };
    format!("{n} {noun}{s}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::Sphere;
    use glam::DVec3;

    fn one_triangle(corners: [[f64; 3]; 3]) -> Objects {
        Objects {
            triangles: vec![Triangle(corners.map(DVec3::from))],
            ..Objects::default()
        }
    }

    fn message(result: Result<Scene, SceneError>) -> String {
        result.expect_err("an error").to_string()
    }

    #[test]
    fn far_scenes_are_told_or_refused() {
        let at = |offset: f64| {
            one_triangle([
                [offset, 0.0, 0.0],
                [offset + 1.0, 0.0, 0.0],
                [offset, 1.0, 1.0],
            ])
        };
        assert!(
            Scene::new("x", at(1e8), Vec::new())
                .expect("near")
                .notes
                .is_empty()
        );
        let notes = Scene::new("x", at(1e11), Vec::new()).expect("far").notes;
        assert!(notes[0].starts_with("far from the origin"), "{notes:?}");
        let text = message(Scene::new("x", at(1e14), Vec::new()));
        assert!(text.contains("move the scene to the origin"), "{text}");
    }

    #[test]
    fn what_cannot_be_a_scene_is_refused() {
        let empty = Scene::new("x", Objects::default(), Vec::new());
        assert!(message(empty).starts_with("x: the scene is empty"));
        for bad in [f64::NAN, f64::INFINITY] {
            let t = one_triangle([[0.0; 3], [1.0, 0.0, 0.0], [0.0, bad, 0.0]]);
            let text = message(Scene::new("x", t, Vec::new()));
            assert!(text.contains("triangle 0 has a coordinate"), "{text}");
        }
        let notes = vec!["3 lines passed over".into()];
        let empty = message(Scene::new("x", Objects::default(), notes));
        assert!(
            empty.ends_with("one face or object (3 lines passed over)"),
            "{empty}"
        );
        // A line and a point have no surface; a coordinate of 1e200 gives too much of it.
        for corners in [
            [[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]],
            [[1.0; 3]; 3],
            [[0.0; 3], [1e200, 0.0, 0.0], [0.0, 1e200, 0.0]],
            [[0.0; 3], [1e141, 0.0, 0.0], [0.0, 1e141, 0.0]],
            [[0.0; 3], [1e-141, 0.0, 0.0], [0.0, 1e-141, 0.0]],
        ] {
            let text = message(Scene::new("x", one_triangle(corners), Vec::new()));
            assert!(text.contains("surface area"), "{text}");
            assert!(text.contains("scale the scene"), "{text}");
        }
        for scale in [1e-139, 1e139] {
            let t = one_triangle([[0.0; 3], [scale, 0.0, 0.0], [0.0, scale, 0.0]]);
            assert!(Scene::new("x", t, Vec::new()).is_ok());
        }
        for radius in [0.0, -1.0, f64::NAN] {
            let objects = Objects {
                spheres: vec![Sphere {
                    centre: DVec3::ZERO,
                    radius,
                }],
                ..Objects::default()
            };
            let text = message(Scene::new("x", objects, Vec::new()));
            assert!(text.contains("sphere 0 has a radius"), "{text}");
        }
    }

    #[test]
    fn a_scene_far_from_the_origin_is_told() {
        let notes = |x: f64| {
            let t = one_triangle([[x, 0.0, 0.0], [x + 1.0, 0.0, 0.0], [x, 1.0, 0.0]]);
            Scene::new("x", t, Vec::new()).expect("a scene").notes
        };
        assert_eq!(notes(1e8), [""; 0]);
        assert!(notes(-1e10)[0].contains("move the scene to the origin"));
    }

    #[test]
    fn objects_without_area_are_kept_and_told() {
        let mut objects = one_triangle([[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
        objects
            .triangles
            .push(Triangle([DVec3::ZERO, DVec3::X, 2.0 * DVec3::X]));
        let scene = Scene::new("x", objects, vec!["first".into()]).expect("a scene");
        assert_eq!(scene.bounds.len(), 2);
        assert_eq!(
            scene.notes,
            ["first", "1 triangle without area: kept, never hit"]
        );
        assert_eq!(scene.counts(), "2 triangles");
        assert_eq!(scene.world.hi, DVec3::new(2.0, 1.0, 0.0));
    }
}
