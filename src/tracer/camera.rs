//! The pinhole camera: rays through the corners of pixels, as the Standard Procedural Databases ask for.

use glam::DVec3;

use crate::geom::Line;
use crate::scene::look::View;

/// Pixels across and up of the databases' protocol: 513 x 513 corners, 263,169 primary rays.
pub const PIXELS: u32 = 512;

/// A camera over a square of pixels. Its rays go through pixel corners, so there is one more of them each way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    eye: DVec3,
    /// From the eye to the middle of the picture, unit length.
    forward: DVec3,
    /// From the middle of the picture to its right edge.
    right: DVec3,
    /// From the middle of the picture to its upper edge.
    up: DVec3,
    /// Pixels across and up.
    pixels: u32,
}

impl Camera {
    /// The camera of a view whose eye is not the point looked at, whose up is not the direction looked in, and whose
    /// angle lies between 0 and 180 degrees; `pixels` is at least 1.
    pub fn new(view: &View, pixels: u32) -> Self {
        let forward = (view.at - view.from).normalize();
        let right = forward.cross(view.up).normalize();
        let half = libm::tan(0.5 * view.angle.to_radians());
        Self {
            eye: view.from,
            forward,
            right: half * right,
            up: half * right.cross(forward),
            pixels,
        }
    }

    /// Rays across and up.
    pub fn corners(&self) -> u32 {
        self.pixels + 1
    }

    /// The ray through corner (i, j), 0 to `pixels` each: i from left to right, j from top to bottom.
    ///
    /// Of unit direction, so that t is a distance. The middle row and column lie exactly in the planes through the axis.
    pub fn ray(&self, i: u32, j: u32) -> Line {
        let share = |k: u32| f64::from(2 * k) / f64::from(self.pixels) - 1.0;
        let direction = self.forward + share(i) * self.right - share(j) * self.up;
        Line::new(self.eye, direction.normalize())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn view() -> View {
        View {
            from: DVec3::new(1.0, -4.0, 2.0),
            at: DVec3::new(1.0, 3.0, 2.0),
            up: DVec3::new(0.0, 0.3, 2.0),
            angle: 90.0,
            hither: 0.0,
            resolution: [512; 2],
        }
    }

    #[test]
    fn corner_rays_run_along_the_frustums_edges() {
        let camera = Camera::new(&view(), PIXELS);
        assert_eq!(camera.corners(), 513);
        let last = PIXELS;
        for (corner, [x, z]) in [
            ([0, 0], [-1.0, 1.0]),
            ([last, 0], [1.0, 1.0]),
            ([0, last], [-1.0, -1.0]),
            ([last, last], [1.0, -1.0]),
            ([last / 2, last / 2], [0.0, 0.0]),
            ([last / 4, last / 2], [-0.5, 0.0]),
        ] {
            let ray = camera.ray(corner[0], corner[1]);
            let wanted = DVec3::new(x, 1.0, z).normalize();
            assert_eq!(ray.origin, view().from);
            assert!(ray.direction.distance(wanted) < 1e-15, "{corner:?}");
        }
        assert_eq!(camera.ray(last / 2, 7).direction.x, 0.0);
    }
}
