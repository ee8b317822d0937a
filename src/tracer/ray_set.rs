//! The rays of a picture by kind, in an order that depends on nothing but the scene.

use serde::{Deserialize, Serialize};

use crate::geom::Cast;
use crate::kd::Ask;

/// What a ray is cast for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RayKind {
    /// From the eye: nearest hit.
    Primary,
    /// From a surface to a light: any hit up to the light.
    Shadow,
    /// Reflected or refracted: nearest hit.
    Secondary,
}

impl RayKind {
    /// Every kind, in the order of their numbers.
    pub const ALL: [Self; 3] = [Self::Primary, Self::Shadow, Self::Secondary];

    /// The name in files and on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Primary => "primary",
            Self::Shadow => "shadow",
            Self::Secondary => "secondary",
        }
    }

    /// What such rays ask: shadow rays for any hit, all others for the nearest.
    pub const fn ask(self) -> Ask {
        match self {
            Self::Shadow => Ask::Any,
            Self::Primary | Self::Secondary => Ask::Nearest,
        }
    }
}

impl std::fmt::Display for RayKind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(self.name())
    }
}

/// The rays of one kind: pixel corner by pixel corner, from left to right and top to bottom.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct KindRays {
    /// The rays. Those of one corner follow each other depth first.
    pub rays: Vec<Cast>,
    /// Where the rays of each corner end.
    ends: Vec<u32>,
    /// Whether each ray hits something; of the shadow rays, is blocked.
    hit: Vec<bool>,
}

impl KindRays {
    /// The rays that a corner's primary ray led to.
    pub fn of_corner(&self, corner: usize) -> &[Cast] {
        let first = corner.checked_sub(1).map_or(0, |before| self.ends[before]);
        &self.rays[first as usize..self.ends[corner] as usize]
    }

    /// The same with whether each hits something.
    pub(super) fn of_corner_with_hits(&self, corner: usize) -> impl Iterator<Item = (&Cast, bool)> {
        let rays = self.of_corner(corner);
        let first = self.ends[corner] as usize - rays.len();
        rays.iter().zip(self.hit[first..].iter().copied())
    }

    /// How many of the rays hit something; of the shadow rays, are blocked.
    pub fn hits(&self) -> u64 {
        self.hit.iter().filter(|&&hit| hit).count() as u64
    }

    /// Add a ray of the current corner.
    pub(super) fn push(&mut self, cast: Cast, hit: bool) {
        self.rays.push(cast);
        self.hit.push(hit);
    }

    /// No more rays of the current corner.
    pub(super) fn end_corner(&mut self) {
        self.ends.push(in_32_bits(self.rays.len()));
    }

    /// Rows put one after the other.
    fn joined(rows: Vec<Self>) -> Self {
        let mut all = Self::default();
        all.rays
            .reserve_exact(rows.iter().map(|row| row.rays.len()).sum());
        for row in rows {
            let before = all.rays.len();
            let ends = row
                .ends
                .iter()
                .map(|&end| in_32_bits(before + end as usize));
            all.ends.extend(ends);
            all.rays.extend(row.rays);
            all.hit.extend(row.hit);
        }
        all
    }
}

/// A number of rays; so many more would not fit into memory.
fn in_32_bits(rays: usize) -> u32 {
    u32::try_from(rays).expect("fewer than 2^32 rays of a kind")
}

/// All rays of a picture.
#[derive(Clone, Debug, PartialEq)]
pub struct RaySet {
    /// Rays of each kind, in the order of [`RayKind::ALL`].
    kinds: [KindRays; 3],
}

impl RaySet {
    /// The rays of a kind.
    pub fn of(&self, kind: RayKind) -> &KindRays {
        &self.kinds[kind as usize]
    }

    /// Number of pixel corners: of primary rays.
    pub fn corners(&self) -> usize {
        self.of(RayKind::Primary).rays.len()
    }

    /// Number of rays of all kinds.
    pub fn len(&self) -> usize {
        self.kinds.iter().map(|kind| kind.rays.len()).sum()
    }

    /// Whether there is no ray.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Rows of corners put one below the other.
    pub(super) fn joined(rows: Vec<[KindRays; 3]>) -> Self {
        let mut columns: [Vec<KindRays>; 3] = Default::default();
        for row in rows {
            for (column, kind) in columns.iter_mut().zip(row) {
                column.push(kind);
            }
        }
        Self {
            kinds: columns.map(KindRays::joined),
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::geom::Span;

    #[test]
    fn rows_are_joined_in_order() {
        let cast = |x: f64| Cast {
            origin: DVec3::new(x, 0.0, 0.0),
            direction: DVec3::X,
            span: Span::from(0.0),
        };
        let row = |corners: &[&[f64]]| {
            let mut kinds: [KindRays; 3] = Default::default();
            for corner in corners {
                for &x in *corner {
                    kinds[1].push(cast(x), x > 3.0);
                }
                kinds.iter_mut().for_each(KindRays::end_corner);
            }
            kinds
        };
        let set = RaySet::joined(vec![row(&[&[1.0, 2.0], &[]]), row(&[&[3.0], &[4.0, 5.0]])]);
        let shadow = set.of(RayKind::Shadow);
        let wanted: [&[f64]; 4] = [&[1.0, 2.0], &[], &[3.0], &[4.0, 5.0]];
        for (corner, wanted) in wanted.iter().enumerate() {
            let found: Vec<f64> = shadow
                .of_corner(corner)
                .iter()
                .map(|c| c.origin.x)
                .collect();
            assert_eq!(found, *wanted);
        }
        assert_eq!((shadow.rays.len(), shadow.hits(), set.len()), (5, 2, 5));
    }
}
