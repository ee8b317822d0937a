//! Pictures made of pixels, and their encoding.

/// Pixels of 8-bit red, green and blue.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Bitmap {
    /// Pixels across.
    pub width: usize,
    /// Pixels up.
    pub height: usize,
    /// Three bytes a pixel, from left to right and top to bottom.
    pub rgb: Vec<u8>,
}

impl Bitmap {
    /// A white picture.
    pub fn white(width: usize, height: usize) -> Self {
        Bitmap {
            width,
            height,
            rgb: vec![255; 3 * width * height],
        }
    }

    /// The picture on a square of this many pixels a side, each the mean of those it covers; itself if it is not larger.
    pub fn shrunk_to(&self, side: usize) -> Self {
        if self.width.min(self.height) <= side {
            return self.clone();
        }
        let cut = |i: usize, length: usize| i * length / side;
        let mean = |x: usize, y: usize, channel: usize| {
            let (columns, rows) = (
                cut(x, self.width)..cut(x + 1, self.width),
                cut(y, self.height)..cut(y + 1, self.height),
            );
            let covered = columns.len() * rows.len();
            let of_row = |y: usize| {
                columns
                    .clone()
                    .map(move |x| 3 * (y * self.width + x) + channel)
            };
            let sum: usize = rows
                .flat_map(of_row)
                .map(|i| usize::from(self.rgb[i]))
                .sum();
            ((sum + covered / 2) / covered) as u8
        };
        let pixels = (0..side).flat_map(|y| (0..side).map(move |x| (x, y)));
        Bitmap {
            width: side,
            height: side,
            rgb: pixels
                .flat_map(|(x, y)| [0, 1, 2].map(|channel| mean(x, y, channel)))
                .collect(),
        }
    }

    /// The picture as a PNG, with its resolution noted in a pHYs chunk where it has one.
    pub fn png(&self, dots_per_inch: Option<f64>) -> Result<Vec<u8>, png::EncodingError> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, self.width as u32, self.height as u32);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_pixel_dims(dots_per_inch.map(|dots| {
            let dots_per_metre = (dots / 0.0254).round() as u32;
            png::PixelDimensions {
                xppu: dots_per_metre,
                yppu: dots_per_metre,
                unit: png::Unit::Meter,
            }
        }));
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&self.rgb)?;
        writer.finish()?;
        Ok(bytes)
    }
}

/// Bytes as text of 64 characters (RFC 4648, section 4), as `data:` addresses have them.
pub fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for group in bytes.chunks(3) {
        let byte = |i: usize| u32::from(group.get(i).copied().unwrap_or(0));
        let bits = byte(0) << 16 | byte(1) << 8 | byte(2);
        for place in 0..4 {
            text.push(if place <= group.len() {
                char::from(DIGITS[(bits >> (18 - 6 * place) & 63) as usize])
            } else {
                '='
            });
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_smaller_picture_has_means() {
        let picture = Bitmap {
            width: 4,
            height: 2,
            rgb: (0..8u8).flat_map(|i| [10 * i, 0, 255]).collect(),
        };
        // Pixels 0, 1, 4, 5 and 2, 3, 6, 7.
        let small = picture.shrunk_to(1);
        assert_eq!(
            (small.width, small.height, small.rgb),
            (1, 1, vec![35, 0, 255])
        );
        assert_eq!(picture.shrunk_to(2), picture);
        let square = Bitmap {
            width: 3,
            height: 3,
            rgb: (0..9u8).flat_map(|i| [10 * i; 3]).collect(),
        };
        // Columns 0 and 1, 2: parts of whole pixels.
        assert_eq!(
            square
                .shrunk_to(2)
                .rgb
                .chunks(3)
                .map(|c| c[0])
                .collect::<Vec<_>>(),
            [0, 15, 45, 60]
        );
    }

    #[test]
    fn base64_is_that_of_the_rfc() {
        for (bytes, text) in [
            ("", ""),
            ("f", "Zg=="),
            ("fo", "Zm8="),
            ("foo", "Zm9v"),
            ("foob", "Zm9vYg=="),
            ("fooba", "Zm9vYmE="),
            ("foobar", "Zm9vYmFy"),
        ] {
            assert_eq!(base64(bytes.as_bytes()), text);
        }
        assert_eq!(base64(&[0xfb, 0xff, 0xfe]), "+//+");
    }
}
