//! The procedural scenes by name: which there are, how to make them, and what to say when there is none of that name.

use super::draft::Draft;
use super::random::Random;
use super::{EXTENSIONS, Scene, SceneError, hard, simple, spd};
use crate::geom::Objects;

/// A procedural scene: how it is called, what it is, and how to make it.
pub(super) struct Recipe {
    /// What stands before the colon.
    pub(super) group: &'static str,
    /// What stands after it.
    pub(super) name: &'static str,
    /// One line for a list of scenes.
    pub(super) about: &'static str,
    /// The size taken when none is given.
    pub(super) size: usize,
    /// Smallest and largest size.
    pub(super) sizes: [usize; 2],
    /// Makes the scene of a size.
    pub(super) make: Make,
}

/// How a procedural scene is made.
pub(super) enum Make {
    /// Objects alone, with random numbers seeded by name and size.
    Objects(fn(usize, Random) -> Objects),
    /// Objects with their look.
    Staged(fn(usize) -> Draft),
}

/// The procedural scenes: what one types, and a line on what it is.
pub fn catalogue() -> Vec<(String, String)> {
    recipes()
        .map(|r| {
            let about = format!("{} (size {} if none is given)", r.about, r.size);
            (r.spec(), about)
        })
        .collect()
}

impl Recipe {
    /// What one types to get it at its usual size.
    pub(super) fn spec(&self) -> String {
        format!("{}:{}", self.group, self.name)
    }
}

fn recipes() -> impl Iterator<Item = &'static Recipe> {
    simple::RECIPES
        .iter()
        .chain(spd::recipes())
        .chain(&hard::RECIPES)
}

/// The scene `rest`, which is NAME or NAME:SIZE, of a group; `spec` is what was asked for.
pub(super) fn generate(spec: &str, group: &str, rest: &str) -> Result<Scene, SceneError> {
    let (name, size) = match rest.split_once(':') {
        Some((name, size)) => (name, Some(size)),
        None => (rest, None),
    };
    let Some(recipe) = recipes().find(|r| r.group == group && r.name == name) else {
        return Err(unknown(spec, "no such scene".into()));
    };
    let [least, most] = recipe.sizes;
    let wrong_size = |wrong| SceneError::Size {
        spec: spec.into(),
        wrong,
        name: recipe.spec(),
        least,
        most,
    };
    let size = match size {
        None => recipe.size,
        Some(text) => text
            .parse()
            .map_err(|_| wrong_size(format!("the size '{text}' is not a whole number")))?,
    };
    if size < least {
        return Err(wrong_size(format!("the size {size} is too small")));
    }
    if size > most {
        return Err(wrong_size(format!("the size {size} is too large")));
    }
    let name = format!("{}:{size}", recipe.spec());
    let draft = match recipe.make {
        Make::Objects(make) => make(size, Random::named(&name)).into(),
        Make::Staged(make) => make(size),
    };
    Scene::from_draft(name, draft, Vec::new())
}

/// The error for a scene that does not exist, with the nearest name that does and all the others.
pub(super) fn unknown(spec: &str, wrong: String) -> SceneError {
    let names: Vec<String> = recipes().map(Recipe::spec).collect();
    let near = nearest_name(spec.trim_end_matches(':'), names.iter().map(String::as_str));
    let hint = near.map_or(String::new(), |name| format!("did you mean {name}? "));
    let usual: Vec<&str> = names
        .iter()
        .map(String::as_str)
        .filter(|name| !name.starts_with("hard:"))
        .collect();
    let kinds = EXTENSIONS.map(|e| format!(".{e}")).join(", ");
    SceneError::Unknown {
        spec: spec.into(),
        wrong,
        right: format!(
            "{hint}scenes are {}, hard:NAME (`validate list scenes` names them), and files ending in {kinds}",
            usual.join(", ")
        ),
    }
}

/// The name that is nearest to a misspelt one, if it is near.
pub(crate) fn nearest_name<'n>(
    wrong: &str,
    names: impl Iterator<Item = &'n str>,
) -> Option<&'n str> {
    let nearest = names.map(|name| (edits(wrong, name), name)).min();
    nearest
        .filter(|&(distance, _)| distance <= 3)
        .map(|(_, name)| name)
}

/// Least number of letters to insert, remove or replace to turn one word into the other (Levenshtein).
fn edits(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, y) in b.iter().enumerate() {
            let replaced = diagonal + usize::from(x != *y);
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(diagonal + 1).min(row[j] + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(spec: &str) -> String {
        Scene::load(spec).expect_err("an error").to_string()
    }

    #[test]
    fn every_scene_of_the_catalogue_loads_and_names_itself() {
        let all = catalogue();
        assert_eq!(all.len(), 47);
        for (spec, about) in all {
            let scene = Scene::load(&spec).expect("a scene of the catalogue");
            assert!(scene.name.starts_with(&format!("{spec}:")), "{spec}");
            let again = Scene::load(&scene.name).expect("the same scene");
            assert_eq!(again.objects, scene.objects);
            assert_eq!(again.name, scene.name);
            assert!(scene.bounds.iter().all(|b| scene.world.contains(b)));
            if !spec.starts_with("hard:") {
                assert!(scene.notes.is_empty(), "{spec}: {:?}", scene.notes);
            }
            assert!(!about.is_empty());
        }
    }

    #[test]
    fn sizes_out_of_range_are_told_the_range() {
        let text = message("spd:balls:9");
        assert_eq!(
            text,
            "spd:balls:9: the size 9 is too large; sizes of spd:balls run from 1 to 8"
        );
        let text = message("simple:soup:0");
        assert!(text.contains("the size 0 is too small"), "{text}");
        for bad in ["", "x", "-1", "2.5", "3:4"] {
            let text = message(&format!("spd:tetra:{bad}"));
            assert!(text.contains(&format!("the size '{bad}' is not")), "{text}");
        }
    }

    #[test]
    fn unknown_scenes_are_told_the_known_ones() {
        let text = message("simple:unifrom");
        assert!(text.contains("did you mean simple:uniform?"), "{text}");
        assert!(
            text.contains("spd:tetra") && text.contains(".ply"),
            "{text}"
        );
        assert!(message("spd:bals").contains("did you mean spd:balls?"));
        assert!(message("simple").contains("simple: no such scene; scenes are"));
        let text = message("room.dxf");
        assert!(
            text.starts_with("room.dxf: cannot read .dxf files"),
            "{text}"
        );
        let text = message("no/such/file.obj");
        assert_eq!(text, "no/such/file.obj: cannot read the file");
    }

    #[test]
    fn edit_distance() {
        assert_eq!(edits("", "abc"), 3);
        assert_eq!(edits("kitten", "sitting"), 3);
        assert_eq!(edits("same", "same"), 0);
    }
}
