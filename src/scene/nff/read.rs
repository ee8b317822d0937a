//! The reader: one word after the other, since a record may stand on any number of lines.

use std::borrow::Cow;
use std::iter::Peekable;
use std::vec::IntoIter;

use glam::DVec3;

use crate::geom::{Cone, Polygon};
use crate::scene::draft::Draft;
use crate::scene::look::{Material, Stage, View};
use crate::scene::mesh::{Fault, lines, number, whole, without_comment};
use crate::scene::{SceneError, plural};

/// What objects have that stand before the first `f`.
const WHITE: Material = Material {
    colour: DVec3::ONE,
    diffuse: 1.0,
    specular: 0.0,
    shine: 0.0,
    transmittance: 0.0,
    index: 1.0,
};

/// The objects of an NFF file with their look, if the file has a view; and notes.
pub(in crate::scene) fn parse(
    path: &str,
    bytes: &[u8],
) -> Result<(Draft, Vec<String>), SceneError> {
    let lines: Vec<(usize, Cow<str>)> = lines(bytes).map_err(|f| f.at(path, 1))?.collect();
    let words = lines.iter().flat_map(|(line, text)| {
        let words = without_comment(text).split_whitespace();
        words.map(move |word| (*line, word))
    });
    let mut reader = Reader {
        words: words.collect::<Vec<_>>().into_iter().peekable(),
        line: 1,
        contents: Contents::default(),
    };
    while let Some((line, keyword)) = reader.words.next() {
        reader.line = line;
        reader
            .record(keyword)
            .map_err(|(line, fault)| fault.at(path, line))?;
    }
    Ok(reader.contents.finish())
}

/// A fault and the line that it is in.
type Misplaced = (usize, Fault);

struct Reader<'a> {
    /// The words to come, each with its line.
    words: Peekable<IntoIter<(usize, &'a str)>>,
    /// Line at which the record began, later that of the last word taken.
    line: usize,
    contents: Contents,
}

impl Reader<'_> {
    /// Reads what follows a keyword.
    fn record(&mut self, keyword: &str) -> Result<(), Misplaced> {
        let start = self.line;
        let at_start = |fault| (start, fault);
        match keyword {
            "b" => {
                let background = self.vector("a background is 'b RED GREEN BLUE'")?;
                once(&mut self.contents.background, background, "b").map_err(at_start)
            }
            "v" => {
                let view = self.view()?;
                check_view(&view).map_err(at_start)?;
                once(&mut self.contents.view, view, "v").map_err(at_start)
            }
            "l" => self.light(),
            "f" => self.material(),
            "s" => {
                let [x, y, z, radius] = self.numbers("a sphere is 's X Y Z RADIUS'")?;
                if radius <= 0.0 {
                    let wrong = format!("the radius {radius} is not positive");
                    return Err((start, Fault::new(wrong, "a radius is above zero")));
                }
                self.contents.shaped().sphere(DVec3::new(x, y, z), radius);
                Ok(())
            }
            "c" => {
                let cone = self.cone()?;
                check_cone(&cone).map_err(at_start)?;
                self.contents.shaped().cone(cone);
                Ok(())
            }
            "p" => {
                let form = "a polygon is 'p N' and N times X Y Z";
                let corners = self.corners(form, |reader| reader.vector(form))?;
                self.contents.face(corners).map_err(at_start)
            }
            "pp" => {
                let form = "a patch is 'pp N' and N times a corner and its normal, X Y Z NX NY NZ";
                let pair = |reader: &mut Self| Ok((reader.vector(form)?, reader.vector(form)?));
                let (corners, normals): (Vec<_>, Vec<_>) =
                    self.corners(form, pair)?.into_iter().unzip();
                self.contents.patch(corners, normals).map_err(at_start)
            }
            _ => Err(at_start(Fault::new(
                format!("'{keyword}' is no record"),
                "the records are b, v, l, f, s, c, p and pp",
            ))),
        }
    }

    /// The next word, which must be there.
    fn word(&mut self, form: &str) -> Result<&str, Misplaced> {
        let ended = || Fault::new("the file ends within a record", form);
        let (line, word) = self.words.next().ok_or_else(|| (self.line, ended()))?;
        self.line = line;
        Ok(word)
    }

    fn numbers<const N: usize>(&mut self, form: &str) -> Result<[f64; N], Misplaced> {
        let mut all = [0.0; N];
        for x in &mut all {
            let parsed = number(self.word(form)?);
            *x = parsed.map_err(|fault| (self.line, Fault::new(fault.wrong, form)))?;
        }
        Ok(all)
    }

    fn vector(&mut self, form: &str) -> Result<DVec3, Misplaced> {
        self.numbers(form).map(DVec3::from_array)
    }

    /// A number of corners from 3 on, and the corners.
    fn corners<T>(
        &mut self,
        form: &str,
        corner: impl Fn(&mut Self) -> Result<T, Misplaced>,
    ) -> Result<Vec<T>, Misplaced> {
        let count = whole(self.word(form)?, "number of corners");
        let count = count.map_err(|fault| (self.line, fault))?;
        if count < 3 {
            let wrong = format!("a face with {}", plural(count, "corner"));
            return Err((self.line, Fault::new(wrong, "a face needs at least 3")));
        }
        (0..count).map(|_| corner(self)).collect()
    }

    fn view(&mut self) -> Result<View, Misplaced> {
        let form = "a view is 'v' and the lines from X Y Z, at X Y Z, up X Y Z, angle A, hither H, resolution N M";
        let mut vector = |name| {
            self.expect(name, form)?;
            self.vector(form)
        };
        let (from, at, up) = (vector("from")?, vector("at")?, vector("up")?);
        let mut single = |name| {
            self.expect(name, form)?;
            self.numbers(form).map(|[x]| x)
        };
        let (angle, hither) = (single("angle")?, single("hither")?);
        self.expect("resolution", form)?;
        let mut resolution = [0; 2];
        for pixels in &mut resolution {
            let word = self.word(form)?;
            let wrong = format!("'{word}' is not a number of pixels");
            let parsed = word.parse().ok().filter(|&n: &u32| n > 0);
            let fault = || Fault::new(wrong, "a number of pixels is a whole number from 1");
            *pixels = parsed.ok_or_else(|| (self.line, fault()))?;
        }
        Ok(View {
            from,
            at,
            up,
            angle,
            hither,
            resolution,
        })
    }

    fn expect(&mut self, name: &str, form: &str) -> Result<(), Misplaced> {
        let word = self.word(form)?;
        if word == name {
            return Ok(());
        }
        let wrong = format!("'{word}' stands where '{name}' must");
        Err((self.line, Fault::new(wrong, form)))
    }

    fn light(&mut self) -> Result<(), Misplaced> {
        let form = "a light is 'l X Y Z' or 'l X Y Z RED GREEN BLUE'";
        let position = self.vector(form)?;
        self.contents.lights.push(position);
        let coloured = |&(_, word): &(usize, &str)| word.parse::<f64>().is_ok();
        if self.words.peek().is_some_and(coloured) {
            self.vector(form)?;
            self.contents.coloured_lights += 1;
        }
        Ok(())
    }

    fn material(&mut self) -> Result<(), Misplaced> {
        let form = "a material is 'f RED GREEN BLUE KD KS SHINE T INDEX'";
        let colour = self.vector(form)?;
        let [diffuse, specular, shine, transmittance, index] = self.numbers(form)?;
        self.contents.draft.material(Material {
            colour,
            diffuse,
            specular,
            shine,
            transmittance,
            index,
        });
        self.contents.has_material = true;
        Ok(())
    }

    fn cone(&mut self) -> Result<Cone, Misplaced> {
        let form = "a cone is 'c', base X Y Z RADIUS, apex X Y Z RADIUS";
        let base = self.vector(form)?;
        let [base_radius] = self.numbers(form)?;
        let apex = self.vector(form)?;
        let [apex_radius] = self.numbers(form)?;
        Ok(Cone {
            base,
            base_radius,
            apex,
            apex_radius,
        })
    }
}

/// Keeps what may stand in a file once.
fn once<T>(kept: &mut Option<T>, new: T, keyword: &str) -> Result<(), Fault> {
    if kept.is_some() {
        let wrong = format!("there is a record '{keyword}' before");
        return Err(Fault::new(wrong, "a file has one"));
    }
    *kept = Some(new);
    Ok(())
}

fn check_view(view: &View) -> Result<(), Fault> {
    if !(view.angle > 0.0 && view.angle < 180.0) {
        return Err(Fault::new(
            format!("the angle of view is {}", view.angle),
            "it lies between 0 and 180 degrees",
        ));
    }
    let forward = view.at - view.from;
    let across = forward.cross(view.up);
    if across == DVec3::ZERO {
        return Err(Fault::new(
            "'up' points along the view, or 'from' and 'at' coincide",
            "the eye, the point looked at and 'up' must span a plane",
        ));
    }
    let has_length = |v: DVec3| v.length_squared().is_normal();
    let near = |v: DVec3| v.length_squared().is_finite();
    let lengths = [forward, view.up, across].into_iter().all(has_length);
    if !(lengths && near(view.from) && near(view.at)) {
        return Err(Fault::new(
            "the view's coordinates are too large or too small",
            "squares of its lengths must be numbers that f64 has",
        ));
    }
    Ok(())
}

fn check_cone(cone: &Cone) -> Result<(), Fault> {
    let radii = [cone.base_radius, cone.apex_radius];
    if radii.iter().any(|&r| r < 0.0) || radii == [0.0; 2] {
        return Err(Fault::new(
            format!("the radii are {} and {}", radii[0], radii[1]),
            "no radius is below zero, and one is above",
        ));
    }
    if cone.base == cone.apex {
        let wrong = "base and apex of the cone coincide";
        return Err(Fault::new(wrong, "they must differ"));
    }
    Ok(())
}

/// What has been read.
#[derive(Default)]
struct Contents {
    draft: Draft,
    background: Option<DVec3>,
    view: Option<View>,
    lights: Vec<DVec3>,
    has_material: bool,
    /// Whether an object stands before the first material.
    bare: bool,
    coloured_lights: usize,
    /// Patches with more than three corners.
    many_sided: usize,
}

impl Contents {
    /// The draft, about to get an object.
    fn shaped(&mut self) -> &mut Draft {
        if !self.has_material {
            self.draft.material(WHITE);
            self.has_material = true;
            self.bare = true;
        }
        &mut self.draft
    }

    fn face(&mut self, corners: Vec<DVec3>) -> Result<(), Fault> {
        if let &[a, b, c] = &corners[..] {
            self.shaped().triangle([a, b, c]);
            return Ok(());
        }
        let right =
            "corners lie in one plane and differ from their neighbours, and there is an area";
        let polygon = Polygon::new(corners).map_err(|wrong| Fault::new(wrong, right))?;
        self.shaped().polygon(polygon);
        Ok(())
    }

    fn patch(&mut self, corners: Vec<DVec3>, normals: Vec<DVec3>) -> Result<(), Fault> {
        match (&corners[..], &normals[..]) {
            (&[a, b, c], &[n, m, k]) => {
                self.shaped().patch([a, b, c], [n, m, k]);
                Ok(())
            }
            _ => {
                self.many_sided += 1;
                self.face(corners)
            }
        }
    }

    fn finish(mut self) -> (Draft, Vec<String>) {
        let mut notes = Vec::new();
        if self.bare {
            notes.push("objects stand before the first 'f': they are white".into());
        }
        if self.many_sided > 0 {
            let patches = plural(self.many_sided, "record");
            notes.push(format!(
                "{patches} 'pp' with more than 3 corners: polygons, their normals passed over"
            ));
        }
        if self.coloured_lights > 0 {
            let lights = plural(self.coloured_lights, "light");
            notes.push(format!("{lights} with a colour: taken as white"));
        }
        match self.view {
            Some(view) => {
                if self.background.is_none() {
                    notes.push("no record 'b': the background is black".into());
                }
                self.draft.stage(Stage {
                    background: self.background.unwrap_or_default(),
                    view,
                    lights: self.lights,
                });
            }
            None => notes.push("no record 'v': objects alone, nothing to look at them with".into()),
        }
        (self.draft, notes)
    }
}
