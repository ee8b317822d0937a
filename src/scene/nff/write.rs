//! The writer: what it writes with 17 digits reads back to the same bits.

use std::fmt::{Arguments, Write};

use glam::DVec3;

use super::number::significant;
use crate::geom::Object;
use crate::scene::Scene;

impl Scene {
    /// The scene as an NFF file with that many significant digits (the original programs write 6); `None` if it has no
    /// look.
    ///
    /// Objects stand by material, those of a material in the order of their numbers. A polygon of three corners is read
    /// back as a triangle.
    pub fn to_nff(&self, digits: usize) -> Option<String> {
        let look = self.look.as_ref()?;
        let number = |x: f64| significant(x, digits);
        let vector = |v: DVec3| v.to_array().map(number).join(" ");
        let mut lines = Lines::default();

        let (stage, view) = (&look.stage, &look.stage.view);
        lines.add(format_args!("b {}", vector(stage.background)));
        lines.add(format_args!("v"));
        for (name, v) in [("from", view.from), ("at", view.at), ("up", view.up)] {
            lines.add(format_args!("{name} {}", vector(v)));
        }
        lines.add(format_args!("angle {}", number(view.angle)));
        lines.add(format_args!("hither {}", number(view.hither)));
        let [across, up] = view.resolution;
        lines.add(format_args!("resolution {across} {up}"));
        for light in &stage.lights {
            lines.add(format_args!("l {}", vector(*light)));
        }

        let mut objects_of = vec![Vec::new(); look.materials.len()];
        for (object, &material) in (0..).zip(&look.material_of) {
            objects_of[material as usize].push(object);
        }
        for (material, objects) in look.materials.iter().zip(objects_of) {
            let shares = [
                material.diffuse,
                material.specular,
                material.shine,
                material.transmittance,
                material.index,
            ];
            let shares = shares.map(number).join(" ");
            lines.add(format_args!("f {} {shares}", vector(material.colour)));
            for object in objects {
                match self.objects.get(object) {
                    Object::Triangle(triangle) => {
                        let normals = look.normals.get(object as usize).copied().flatten();
                        lines.add(format_args!(
                            "{} 3",
                            if normals.is_some() { "pp" } else { "p" }
                        ));
                        for (i, &corner) in triangle.0.iter().enumerate() {
                            match normals {
                                Some(n) => {
                                    lines.add(format_args!("{} {}", vector(corner), vector(n[i])));
                                }
                                None => lines.add(format_args!("{}", vector(corner))),
                            }
                        }
                    }
                    Object::Sphere(s) => {
                        lines.add(format_args!("s {} {}", vector(s.centre), number(s.radius)));
                    }
                    Object::Cone(c) => {
                        let [base, apex] = [(c.base, c.base_radius), (c.apex, c.apex_radius)].map(
                            |(centre, radius)| format!("{} {}", vector(centre), number(radius)),
                        );
                        lines.add(format_args!("c {base} {apex}"));
                    }
                    Object::Polygon(polygon) => {
                        lines.add(format_args!("p {}", polygon.corners().len()));
                        for &corner in polygon.corners() {
                            lines.add(format_args!("{}", vector(corner)));
                        }
                    }
                }
            }
        }
        Some(lines.0)
    }
}

/// A text line by line.
#[derive(Default)]
struct Lines(String);

impl Lines {
    fn add(&mut self, line: Arguments) {
        writeln!(self.0, "{line}").expect("a string takes every text");
    }
}
