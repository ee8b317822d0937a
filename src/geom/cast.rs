//! Rays as they are kept: in sets, in files.

use glam::DVec3;

use super::{Line, Ray, Span};

/// A ray as it is kept: 64 bytes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cast {
    /// Point at t = 0.
    pub origin: DVec3,
    /// Direction, not necessarily of unit length: t counts in units of it. Those the program makes have unit length, so
    /// that t is a distance.
    pub direction: DVec3,
    /// Where it begins and ends.
    pub span: Span,
}

impl Cast {
    /// The ray, with the constants of the object tests.
    pub fn ray(&self) -> Ray {
        Ray::new(Line::new(self.origin, self.direction), self.span)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ray_is_sixty_four_bytes() {
        assert_eq!(size_of::<Cast>(), 64);
    }
}
