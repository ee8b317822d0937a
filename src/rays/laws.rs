//! Laws of random lines: exact ones that cross-check each other, and look-alikes that are wrong.
//!
//! The metric holds for one law only. The look-alikes are negative controls: each must be caught by
//! [`checks`](super::checks), or the checks prove nothing.

use std::f64::consts::{PI, TAU};

use glam::DVec3;
use rand::Rng;
use rand::distr::Distribution;
use rand_distr::{UnitDisc, UnitSphere};

use crate::geom::{Aabb, Line, Span};

use super::address::{Purpose, generator, uniform};
use super::surface_line;

/// A law of random lines that hit a box; some are rays or segments, whose span is part of the line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LineLaw {
    /// Exact: point on the box's surface, cosine-weighted direction. The study's own.
    Surface,
    /// Exact: uniform direction, uniform point of the disc that the bounding sphere casts; kept if it hits the box.
    Disc,
    /// Exact: two uniform points on the bounding sphere; kept if it hits the box.
    SpherePoints,
    /// Point on the surface, uniform direction of the hemisphere.
    UniformHemisphere,
    /// Point on the bounding sphere, uniform inward direction; kept if it hits the box.
    SphereHemisphere,
    /// Line through two uniform points of the box's surface (not of one face).
    BoxChord,
    /// From a point of a sphere of twice the radius to a uniform point of the box.
    SphereToVolume,
    /// Through a uniform point of the box, uniform direction.
    VolumeLine,
    /// Through two uniform points of the box.
    VolumeChord,
    /// Ray from a uniform point of the box, uniform direction.
    VolumeRay,
    /// Segment between two uniform points of the box, as shadow rays are.
    VolumeSegment,
    /// Disc, polar angle uniform instead of its cosine.
    PolarUniform,
    /// Disc, radius uniform instead of its square.
    DiscRadius,
    /// Disc of nine tenths of the radius.
    SmallDisc,
    /// Disc, directions stretched 1 % along z.
    Stretched,
    /// Disc, directions uniform in a cube and normalised.
    CubeDirections,
    /// Disc, directions along the three axes only.
    AxesOnly,
}

impl LineLaw {
    /// The exact laws.
    pub const EXACT: [Self; 3] = [Self::Surface, Self::Disc, Self::SpherePoints];

    /// The wrong ones.
    pub const WRONG: [Self; 14] = [
        Self::UniformHemisphere,
        Self::SphereHemisphere,
        Self::BoxChord,
        Self::SphereToVolume,
        Self::VolumeLine,
        Self::VolumeChord,
        Self::VolumeRay,
        Self::VolumeSegment,
        Self::PolarUniform,
        Self::DiscRadius,
        Self::SmallDisc,
        Self::Stretched,
        Self::CubeDirections,
        Self::AxesOnly,
    ];

    /// The name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Surface => "surface",
            Self::Disc => "disc",
            Self::SpherePoints => "sphere-points",
            Self::UniformHemisphere => "uniform-hemisphere",
            Self::SphereHemisphere => "sphere-hemisphere",
            Self::BoxChord => "box-chord",
            Self::SphereToVolume => "sphere-to-volume",
            Self::VolumeLine => "volume-line",
            Self::VolumeChord => "volume-chord",
            Self::VolumeRay => "volume-ray",
            Self::VolumeSegment => "volume-segment",
            Self::PolarUniform => "polar-uniform",
            Self::DiscRadius => "disc-radius",
            Self::SmallDisc => "small-disc",
            Self::Stretched => "stretched",
            Self::CubeDirections => "cube-directions",
            Self::AxesOnly => "axes-only",
        }
    }

    /// One line on what it does.
    pub fn description(self) -> &'static str {
        match self {
            Self::Surface => {
                "exact: face by area, uniform point, cosine-weighted direction (the study's own)"
            }
            Self::Disc => "exact: uniform direction, uniform point of the bounding sphere's disc",
            Self::SpherePoints => "exact: through two uniform points of the bounding sphere",
            Self::UniformHemisphere => "wrong: surface point, uniform instead of cosine hemisphere",
            Self::SphereHemisphere => "wrong: point of the bounding sphere, uniform hemisphere",
            Self::BoxChord => "wrong: through two uniform points of the box's surface",
            Self::SphereToVolume => {
                "wrong: from a sphere of twice the radius to a uniform point inside"
            }
            Self::VolumeLine => "wrong: through a uniform point inside, uniform direction",
            Self::VolumeChord => "wrong: through two uniform points inside",
            Self::VolumeRay => "wrong: ray from a uniform point inside (interior origins)",
            Self::VolumeSegment => "wrong: segment between two uniform points inside (shadow rays)",
            Self::PolarUniform => "wrong: polar angle uniform instead of its cosine",
            Self::DiscRadius => "wrong: disc radius without the square root",
            Self::SmallDisc => "wrong: disc 10 % too small",
            Self::Stretched => "wrong: directions stretched 1 % in z",
            Self::CubeDirections => "wrong: directions from a cube, normalised",
            Self::AxesOnly => "wrong: axis-parallel directions only (passes every test of boxes)",
        }
    }

    /// Line i of a seed with its span. The line hits the box; the span is all of it but for rays and segments.
    pub fn sample(self, world: &Aabb, seed: u64, i: u64) -> (Line, Span) {
        let mut rng = generator(seed, Purpose::Laws);
        rng.set_stream(i);
        loop {
            let (line, span) = self.draw(world, &mut rng);
            if world.clip(&line, span).is_some() {
                return (line, span);
            }
        }
    }

    /// One draw, which may miss the box.
    fn draw(self, world: &Aabb, rng: &mut impl Rng) -> (Line, Span) {
        let centre = world.centre();
        let radius = 0.5 * world.extent().length();
        let isotropic = |rng: &mut _| DVec3::from_array(UnitSphere.sample(rng));
        let full = |origin, direction| (Line::new(origin, direction), Span::FULL);
        match self {
            Self::Surface => {
                let u = std::array::from_fn(|_| uniform(rng));
                (surface_line(world, u), Span::FULL)
            }
            Self::Disc => {
                let direction = isotropic(rng);
                full(centre + radius * disc_point(direction, rng), direction)
            }
            Self::SpherePoints => {
                let (a, b) = (isotropic(rng), isotropic(rng));
                full(centre + radius * a, b - a)
            }
            Self::UniformHemisphere => {
                let (origin, inward) = surface_point(world, rng);
                let d = isotropic(rng);
                full(origin, if d.dot(inward) < 0.0 { -d } else { d })
            }
            Self::SphereHemisphere => {
                let (a, d) = (isotropic(rng), isotropic(rng));
                full(centre + radius * a, if d.dot(a) > 0.0 { -d } else { d })
            }
            Self::BoxChord => loop {
                let ((a, face), (b, other)) =
                    (surface_point(world, rng), surface_point(world, rng));
                if face != other {
                    return full(a, b - a);
                }
            },
            Self::SphereToVolume => {
                let origin = centre + 2.0 * radius * isotropic(rng);
                full(origin, volume_point(world, rng) - origin)
            }
            Self::VolumeLine => full(volume_point(world, rng), isotropic(rng)),
            Self::VolumeChord => {
                let a = volume_point(world, rng);
                full(a, volume_point(world, rng) - a)
            }
            Self::VolumeRay => {
                let line = Line::new(volume_point(world, rng), isotropic(rng));
                (line, Span::from(0.0))
            }
            Self::VolumeSegment => {
                let a = volume_point(world, rng);
                let line = Line::new(a, volume_point(world, rng) - a);
                (line, Span { t0: 0.0, t1: 1.0 })
            }
            Self::PolarUniform => {
                let (sine, cosine) = libm::sincos(PI * uniform(rng));
                let (y, x) = libm::sincos(TAU * uniform(rng));
                let direction = DVec3::new(sine * x, sine * y, cosine);
                full(centre + radius * disc_point(direction, rng), direction)
            }
            Self::DiscRadius => {
                let direction = isotropic(rng);
                let point = disc_point(direction, rng);
                full(
                    centre + radius * uniform(rng) * point.normalize(),
                    direction,
                )
            }
            Self::SmallDisc => {
                let direction = isotropic(rng);
                full(
                    centre + 0.9 * radius * disc_point(direction, rng),
                    direction,
                )
            }
            Self::Stretched => {
                let direction = (isotropic(rng) * DVec3::new(1.0, 1.0, 1.01)).normalize();
                full(centre + radius * disc_point(direction, rng), direction)
            }
            Self::CubeDirections => {
                let direction =
                    DVec3::from_array(std::array::from_fn(|_| 2.0 * uniform(rng) - 1.0))
                        .normalize();
                full(centre + radius * disc_point(direction, rng), direction)
            }
            Self::AxesOnly => {
                let which = (6.0 * uniform(rng)) as usize;
                let mut direction = DVec3::ZERO;
                direction[which / 2] = if which.is_multiple_of(2) { 1.0 } else { -1.0 };
                full(centre + radius * disc_point(direction, rng), direction)
            }
        }
    }
}

/// A uniform point of the unit disc through the origin, perpendicular to a unit direction.
fn disc_point(direction: DVec3, rng: &mut impl Rng) -> DVec3 {
    let (x, y) = direction.any_orthonormal_pair();
    let [a, b]: [f64; 2] = UnitDisc.sample(rng);
    a * x + b * y
}

fn volume_point(world: &Aabb, rng: &mut impl Rng) -> DVec3 {
    let u = DVec3::from_array(std::array::from_fn(|_| uniform(rng)));
    world.lo + u * world.extent()
}

/// A uniform point of the surface with its face's inward normal.
fn surface_point(world: &Aabb, rng: &mut impl Rng) -> (DVec3, DVec3) {
    let line = surface_line(world, [uniform(rng), uniform(rng), 0.0, 0.0]);
    (line.origin, line.direction)
}
