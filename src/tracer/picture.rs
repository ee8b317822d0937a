//! Colours of pixel corners made into a picture.

use glam::DVec3;

/// A picture of 8-bit red, green and blue.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Pixels across.
    pub width: u32,
    /// Pixels up.
    pub height: u32,
    /// Three bytes a pixel, from left to right and top to bottom.
    pub rgb: Vec<u8>,
}

impl Picture {
    /// Every pixel the mean of its four corners, `corners` of them a row.
    pub(super) fn of_corners(colours: &[DVec3], corners: usize) -> Self {
        let pixels = corners - 1;
        let mut rgb = Vec::with_capacity(3 * pixels * pixels);
        for (above, below) in colours
            .chunks_exact(corners)
            .zip(colours.chunks_exact(corners).skip(1))
        {
            for (above, below) in above.windows(2).zip(below.windows(2)) {
                // What is brighter than white is cut before the mean: else one highlight's corner would leave steps.
                let [a, b, c, d] = [above[0], above[1], below[0], below[1]]
                    .map(|colour| colour.clamp(DVec3::ZERO, DVec3::ONE));
                let mean = 0.25 * (a + b + c + d);
                rgb.extend(mean.to_array().map(displayed));
            }
        }
        Self {
            width: pixels as u32,
            height: pixels as u32,
            rgb,
        }
    }
}

/// The byte that shows light from 0 to 1. Colours of the databases are values of a display, so no gamma is put on them.
fn displayed(light: f64) -> u8 {
    (255.0 * light).round() as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_are_means_of_corners() {
        let (black, white) = (DVec3::ZERO, DVec3::splat(7.0));
        let red = DVec3::X;
        let corners = [black, black, white, black, black, white, red, red, red];
        let picture = Picture::of_corners(&corners, 3);
        let half = displayed(0.5);
        let [quarter, three] = [displayed(0.25), displayed(0.75)];
        assert_eq!((picture.width, picture.height), (2, 2));
        assert_eq!(picture.rgb[..6], [0, 0, 0, half, half, half]);
        assert_eq!(picture.rgb[6..], [half, 0, 0, three, quarter, quarter]);
        assert_eq!([displayed(0.0), displayed(1.0)], [0, 255]);
    }
}
