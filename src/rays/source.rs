//! Where the rays of a set come from: laws of lines through the scene's box, and sources that break one assumption of the
//! metric at a time.

use std::f64::consts::TAU;
use std::fmt;
use std::str::FromStr;

use glam::DVec3;
use rand::Rng;
use rand::distr::Distribution;
use rand::rngs::ChaCha8Rng;
use rand_distr::UnitSphere;

use crate::geom::{Aabb, Cast, Line, Span};
use crate::scene::Scene;

use super::address::{Purpose, generator, uniform};
use super::{LineLaw, SurfacePoints};

/// Where rays come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// A law of lines through the box of the scene.
    Law(LineLaw),
    /// A parallel beam: one direction, drawn from the seed, uniform over the box's silhouette; the light of a far sun.
    Beam,
    /// One point twice the box's bounding radius away from its centre, in a direction drawn from the seed; directions uniform
    /// over the cone around the bounding sphere, kept if they hit the box. A camera that sees all of the scene.
    Eye,
    /// Uniform points of the objects' surfaces, directions by the cosine law around the normal, either side as likely: light
    /// reflected by dull surfaces. They begin a little off the surface, or rounding would end half of them where they start.
    Objects,
}

impl Source {
    /// Every source.
    pub fn all() -> impl Iterator<Item = Self> {
        let laws = LineLaw::EXACT.into_iter().chain(LineLaw::WRONG);
        laws.map(Self::Law)
            .chain([Self::Beam, Self::Eye, Self::Objects])
    }

    /// The name in files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Law(LineLaw::Surface) => "lines",
            Self::Law(law) => law.name(),
            Self::Beam => "beam",
            Self::Eye => "eye",
            Self::Objects => "objects",
        }
    }

    /// One line on what it does.
    pub fn description(self) -> &'static str {
        match self {
            Self::Law(law) => law.description(),
            Self::Beam => "parallel: one direction, uniform over the box's silhouette",
            Self::Eye => "from one point outside, uniform directions towards the bounding sphere",
            Self::Objects => "from uniform points of the objects' surfaces, cosine law",
        }
    }
}

impl fmt::Display for Source {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for Source {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let named = Self::all().find(|source| source.name() == text);
        named.ok_or_else(|| {
            let names: Vec<_> = Self::all().map(Self::name).collect();
            format!(
                "'{text}' is no source of rays; expected one of {}",
                names.join(", ")
            )
        })
    }
}

/// The rays of a source in a scene: ray i is a function of the seed and i.
pub struct SourceRays<'a> {
    world: Aabb,
    seed: u64,
    drawn: Drawn<'a>,
}

/// What is drawn once for all rays.
enum Drawn<'a> {
    Law(LineLaw),
    Beam { direction: DVec3 },
    Eye { origin: DVec3 },
    Objects(SurfacePoints<'a>),
}

/// Where rays from surfaces begin, as a share of the box's diagonal.
const OFFSET: f64 = 1e-9;

/// The second side of a box that an eye sees, as a share of the longest: below it nearly all rays of the eye would miss.
const THINNEST: f64 = 1e-3;

/// Stream of the generator that belongs to no ray.
const ONCE: u64 = u64::MAX;

impl<'a> SourceRays<'a> {
    /// The rays of a source in a scene.
    ///
    /// # Errors
    /// If the objects have no surface to start from or none of the box is beside it, or if the box is too thin to be seen
    /// from the eye.
    pub fn new(source: Source, scene: &'a Scene, seed: u64) -> Result<Self, String> {
        let world = scene.world;
        let mut rng = generator(seed, Purpose::Sources);
        rng.set_stream(ONCE);
        let drawn = match source {
            Source::Law(law) => Drawn::Law(law),
            Source::Beam => Drawn::Beam {
                direction: isotropic(&mut rng),
            },
            Source::Eye => {
                let mut sides = world.extent().to_array();
                sides.sort_by(f64::total_cmp);
                if sides[1] < THINNEST * sides[2] {
                    return Err(format!(
                        "{}: its box is so thin that hardly a ray of an eye would hit it",
                        scene.name
                    ));
                }
                Drawn::Eye {
                    origin: world.centre() + world.extent().length() * isotropic(&mut rng),
                }
            }
            Source::Objects if world.volume() == 0.0 => {
                return Err(format!(
                    "{}: its box is flat, so no ray that leaves an object runs in it",
                    scene.name
                ));
            }
            Source::Objects => Drawn::Objects(SurfacePoints::new(scene)?),
        };
        Ok(Self { world, seed, drawn })
    }

    /// Ray i.
    pub fn cast(&self, i: u64) -> Cast {
        let mut rng = generator(self.seed, Purpose::Sources);
        rng.set_stream(i);
        let (line, span) = match &self.drawn {
            Drawn::Law(law) => law.sample(&self.world, self.seed, i),
            Drawn::Beam { direction } => (self.of_beam(*direction, &mut rng), Span::FULL),
            Drawn::Eye { origin } => loop {
                let line = self.of_eye(*origin, &mut rng);
                if self.world.clip(&line, Span::FULL).is_some() {
                    break (line, Span::FULL);
                }
            },
            Drawn::Objects(points) => {
                let (origin, normal) = points.draw(&mut rng);
                let side = if uniform(&mut rng) < 0.5 {
                    normal
                } else {
                    -normal
                };
                let line = Line::new(origin, cosine_around(side, &mut rng));
                (line, Span::from(OFFSET * self.world.extent().length()))
            }
        };
        Cast {
            origin: line.origin,
            direction: line.direction,
            span,
        }
    }

    /// A line of this direction, uniform over the box's silhouette: through a uniform point of a face that looks towards the
    /// light, taken by the area it shows.
    fn of_beam(&self, direction: DVec3, rng: &mut ChaCha8Rng) -> Line {
        let shown = self.world.face_areas() * direction.abs();
        let mut rest = uniform(rng) * (shown.x + shown.y + shown.z);
        // Rounding may leave a rest behind the last face that shows anything.
        let last = (1..3).rev().find(|&k| shown[k] > 0.0).unwrap_or(0);
        let mut axis = 0;
        while axis < last && rest >= shown[axis] {
            rest -= shown[axis];
            axis += 1;
        }
        let at = DVec3::from_array(std::array::from_fn(|_| uniform(rng)));
        let mut point = (self.world.lo + at * self.world.extent()).min(self.world.hi);
        point[axis] = if direction[axis] > 0.0 {
            self.world.lo[axis]
        } else {
            self.world.hi[axis]
        };
        Line::new(point, direction)
    }

    /// A line from the eye that may miss the box: in the cone that holds its bounding sphere, seen from two radii away, so that
    /// the sine of its half angle is 1/2.
    fn of_eye(&self, origin: DVec3, rng: &mut ChaCha8Rng) -> Line {
        let axis = (self.world.centre() - origin).normalize();
        let least = 0.75_f64.sqrt();
        let (x, y) = axis.any_orthonormal_pair();
        let height = 1.0 - (1.0 - least) * uniform(rng);
        let across = (1.0 - height * height).max(0.0).sqrt();
        let (sine, cosine) = libm::sincos(TAU * uniform(rng));
        Line::new(origin, height * axis + across * (cosine * x + sine * y))
    }
}

/// A uniform direction.
fn isotropic(rng: &mut impl Rng) -> DVec3 {
    DVec3::from_array(UnitSphere.sample(rng))
}

/// A direction of density proportional to its cosine with a unit normal: a uniform point of the disc, lifted (Malley).
fn cosine_around(normal: DVec3, rng: &mut impl Rng) -> DVec3 {
    let (x, y) = normal.any_orthonormal_pair();
    let share = uniform(rng);
    let (sine, cosine) = libm::sincos(TAU * uniform(rng));
    share.sqrt() * (cosine * x + sine * y) + (1.0 - share).max(0.0).sqrt() * normal
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::{Objects, Targets, Triangle};

    #[test]
    fn names_read_back() {
        for source in Source::all() {
            assert_eq!(source.name().parse(), Ok(source));
        }
        assert!("line".parse::<Source>().is_err());
    }

    #[test]
    fn rays_meet_the_box_and_keep_their_law() {
        let scene = Scene::load("spd:tetra:2").expect("a scene");
        for source in Source::all() {
            let rays = SourceRays::new(source, &scene, 9).expect("rays");
            let again = SourceRays::new(source, &scene, 9).expect("rays");
            let other = SourceRays::new(source, &scene, 10).expect("rays");
            let mut directions = DVec3::ZERO;
            for i in 0..500 {
                let cast = rays.cast(i);
                assert_eq!(cast, again.cast(i));
                assert_ne!(cast, other.cast(i));
                let line = Line::new(cast.origin, cast.direction);
                assert!(scene.world.clip(&line, cast.span).is_some(), "{source}");
                directions += cast.direction.normalize();
            }
            // Only the beam has one direction, and only it and the eye a preferred one.
            let mean = directions.length() / 500.0;
            match source {
                Source::Beam => assert!((mean - 1.0).abs() < 1e-12),
                Source::Eye => assert!(mean > 0.9 && mean < 0.999),
                _ => assert!(mean < 0.25, "{source} {mean}"),
            }
        }
    }

    #[test]
    fn rays_from_a_flat_object_leave_it() {
        let corners = [[0.1, 0.2, 0.3], [1.3, 0.1, -0.7], [0.4, 1.9, 0.2]].map(DVec3::from);
        let objects = Objects {
            triangles: vec![Triangle(corners)],
            ..Objects::default()
        };
        let scene = Scene::new("one triangle", objects, Vec::new()).expect("a scene");
        let rays = SourceRays::new(Source::Objects, &scene, 1).expect("rays");
        for i in 0..2000 {
            assert_eq!(scene.objects.intersect(0, &rays.cast(i).ray()), None, "{i}");
        }
    }

    #[test]
    fn cosine_law_around_a_normal() {
        let mut rng = generator(1, Purpose::Sources);
        let normal = DVec3::new(0.6, 0.0, 0.8);
        let n = 20_000;
        let mean = (0..n)
            .map(|_| cosine_around(normal, &mut rng).dot(normal))
            .sum::<f64>()
            / f64::from(n);
        // E cos = 2/3 with variance 1/18; five standard errors.
        assert!((mean - 2.0 / 3.0).abs() < 5.0 * (1.0 / 18.0 / f64::from(n)).sqrt());
    }
}
