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
