//! The two image formats that runs keep pictures in: binary portable pixmaps (PPM, P6) and portable float maps of one
//! channel (PFM, Pf).

use std::fs;
use std::path::Path;

use crate::report::{Bitmap, ReportError};

/// A square of numbers, row by row from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct FloatMap {
    /// Numbers across.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// All of them.
    pub values: Vec<f64>,
}

/// Most pixels across or up: more than any picture of a run has, and little enough that products do not overflow.
const LARGEST: usize = 1 << 15;

/// Reads a pixmap of 8-bit colours.
pub fn read_ppm(path: &Path) -> Result<Bitmap, ReportError> {
    parsed(path, ppm)
}

/// Reads a float map of one channel.
pub fn read_pfm(path: &Path) -> Result<FloatMap, ReportError> {
    parsed(path, pfm)
}

fn parsed<T>(path: &Path, parse: fn(&[u8]) -> Result<T, String>) -> Result<T, ReportError> {
    let bytes = fs::read(path).map_err(|source| ReportError::Read {
        path: path.to_owned(),
        source,
    })?;
    parse(&bytes).map_err(|what| ReportError::Picture {
        path: path.to_owned(),
        what,
    })
}

fn ppm(bytes: &[u8]) -> Result<Bitmap, String> {
    let ([width, height], most, pixels) = header(bytes, "P6", "a binary portable pixmap")?;
    if most != "255" {
        return Err(format!("largest value {most}, expected 255"));
    }
    let [width, height] = sides(width, height)?;
    expect_length(pixels, 3 * width * height)?;
    Ok(Bitmap {
        width,
        height,
        rgb: pixels.to_vec(),
    })
}

fn pfm(bytes: &[u8]) -> Result<FloatMap, String> {
    let ([width, height], scale, pixels) =
        header(bytes, "Pf", "a portable float map of one channel")?;
    // The sign of the scale tells the order of the bytes.
    let number = match scale.parse::<f64>() {
        Ok(scale) if scale < 0.0 => f32::from_le_bytes,
        Ok(scale) if scale > 0.0 => f32::from_be_bytes,
        _ => {
            return Err(format!(
                "scale '{scale}', expected a number other than 0, e.g. -1.0"
            ));
        }
    };
    let [width, height] = sides(width, height)?;
    expect_length(pixels, 4 * width * height)?;
    let (numbers, _) = pixels.as_chunks::<4>();
    // Rows are kept from the bottom.
    let rows = numbers.chunks_exact(width).rev();
    Ok(FloatMap {
        width,
        height,
        values: rows
            .flatten()
            .map(|&bytes| f64::from(number(bytes)))
            .collect(),
    })
}

/// Width, height, the word after them, and all that follows one white space behind it.
fn header<'b>(
    bytes: &'b [u8],
    magic: &str,
    what: &str,
) -> Result<([&'b str; 2], &'b str, &'b [u8]), String> {
    let mut rest = bytes;
    let mut word = || {
        let start = rest.iter().position(|b| !b.is_ascii_whitespace())?;
        let length = rest[start..].iter().position(u8::is_ascii_whitespace)?;
        let word = std::str::from_utf8(&rest[start..start + length]).ok()?;
        rest = &rest[start + length + 1..];
        Some(word)
    };
    let words = [word(), word(), word(), word()];
    match words {
        [Some(first), Some(width), Some(height), Some(last)] if first == magic => {
            Ok(([width, height], last, rest))
        }
        _ => Err(format!(
            "not {what}: expected '{magic}', width, height and one more number"
        )),
    }
}

fn sides(width: &str, height: &str) -> Result<[usize; 2], String> {
    let side = |text: &str| {
        let side = text
            .parse()
            .ok()
            .filter(|side| (1..=LARGEST).contains(side));
        side.ok_or_else(|| format!("{width} by {height} pixels, expected 1 to {LARGEST} each way"))
    };
    Ok([side(width)?, side(height)?])
}

fn expect_length(pixels: &[u8], length: usize) -> Result<(), String> {
    if pixels.len() == length {
        Ok(())
    } else {
        Err(format!(
            "{} bytes of pixels, expected {length}",
            pixels.len()
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pixmap_is_read() {
        let bitmap = ppm(b"P6\n2 1\n255\n\x01\x02\x03\n\x05 ").unwrap();
        assert_eq!((bitmap.width, bitmap.height), (2, 1));
        assert_eq!(
            bitmap.rgb,
            [1, 2, 3, 10, 5, 32],
            "white space may be a colour"
        );
    }

    #[test]
    fn a_float_map_is_turned_upright() {
        let mut bytes = b"Pf\n1 2\n-1.0\n".to_vec();
        bytes.extend(1.5f32.to_le_bytes());
        bytes.extend(7f32.to_le_bytes());
        let map = pfm(&bytes).unwrap();
        assert_eq!((map.width, map.height, map.values), (1, 2, vec![7.0, 1.5]));
        let mut bytes = b"Pf 1 1 1.0 ".to_vec();
        bytes.extend(1.5f32.to_be_bytes());
        assert_eq!(pfm(&bytes).unwrap().values, [1.5]);
    }

    #[test]
    fn faults_are_told() {
        let fault = |bytes: &[u8]| ppm(bytes).unwrap_err();
        assert_eq!(
            fault(b"P5\n1 1\n255\n\0"),
            "not a binary portable pixmap: expected 'P6', width, height and one more number"
        );
        assert!(fault(b"P6\n1 1").starts_with("not a binary"));
        assert_eq!(
            fault(b"P6\n1 1\n65535\n......"),
            "largest value 65535, expected 255"
        );
        assert_eq!(
            fault(b"P6\n0 1\n255\n"),
            "0 by 1 pixels, expected 1 to 32768 each way"
        );
        assert_eq!(
            fault(b"P6\n1 1\n255\n\0\0"),
            "2 bytes of pixels, expected 3"
        );
        assert_eq!(
            pfm(b"Pf 1 1 x\n\0\0\0\0").unwrap_err(),
            "scale 'x', expected a number other than 0, e.g. -1.0"
        );
        let error = read_ppm(Path::new("no/such.ppm")).unwrap_err();
        assert_eq!(error.to_string(), "no/such.ppm: cannot read");
    }
}
