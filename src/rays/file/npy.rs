//! Rays as a NumPy array of f64, n x 6 or n x 7: the format `.npy`, versions 1.0 to 3.0
//! (numpy.org/doc/stable/reference/generated/numpy.lib.format.html).
//!
//! Read here and not by a crate: of the format one type in one order is wanted, and the crates for it bring a parser of
//! Python's literals along, with arbitrary integers and a grammar compiler.

use super::{Fault, RayFileError, cast};
use crate::geom::Cast;

/// What a file begins with.
const MAGIC: &[u8] = b"\x93NUMPY";

/// What would be right.
const EXPECTED: &str = "expected an array of type '<f8', in C order, of shape (n, 6) or (n, 7), as numpy.save writes it";

/// The rays of a file's bytes; `name` names it in errors.
pub(super) fn parse(name: &str, bytes: &[u8]) -> Result<Vec<Cast>, RayFileError> {
    let (header, data) = split(bytes).map_err(|fault| fault.at(name.into()))?;
    let [rows, columns] = shape(header).map_err(|fault| fault.at(name.into()))?;
    if rows == 0 {
        return Err(Fault::no_rays().at(name.into()));
    }
    let row_bytes = columns * size_of::<f64>();
    let all = rows.checked_mul(row_bytes);
    if all.is_none_or(|all| data.len() < all) {
        let right = format!("its header says {rows} rows of {columns} numbers");
        let place = format!("{name}: row {}", data.len() / row_bytes);
        return Err(Fault::new("the file ends before its end", right).at(place));
    }
    if all.is_some_and(|all| data.len() > all) {
        let wrong = "something follows the last row";
        let right = format!("its header says {rows} rows of {columns} numbers");
        return Err(Fault::new(wrong, right).at(name.into()));
    }
    let rays = data
        .chunks_exact(row_bytes)
        .enumerate()
        .map(|(row, bytes)| {
            let mut numbers = [f64::INFINITY; 7];
            for (number, bytes) in numbers.iter_mut().zip(bytes.chunks_exact(8)) {
                *number = f64::from_le_bytes(bytes.try_into().expect("chunks of eight bytes"));
            }
            let [parts @ .., tmax] = numbers;
            cast(parts, tmax).map_err(|fault| fault.at(format!("{name}: row {row}")))
        });
    rays.collect()
}

/// The header's text, and what follows it.
fn split(bytes: &[u8]) -> Result<(&str, &[u8]), Fault> {
    let fault = |wrong: &str| Fault::new(wrong, EXPECTED);
    let rest = bytes.strip_prefix(MAGIC);
    let rest = rest.ok_or_else(|| fault("does not begin as a .npy file does"))?;
    let short = || fault("the file ends within its header");
    let (&[major, _minor], rest) = rest.split_first_chunk().ok_or_else(short)?;
    let (length, rest) = match major {
        1 => {
            let (length, rest) = rest.split_first_chunk().ok_or_else(short)?;
            (usize::from(u16::from_le_bytes(*length)), rest)
        }
        2 | 3 => {
            let (length, rest) = rest.split_first_chunk().ok_or_else(short)?;
            (u32::from_le_bytes(*length) as usize, rest)
        }
        other => return Err(fault(&format!("of version {other} of the format"))),
    };
    let (header, data) = rest.split_at_checked(length).ok_or_else(short)?;
    let header = std::str::from_utf8(header).map_err(|_| fault("its header is not UTF-8"))?;
    Ok((header, data))
}

/// Rows and columns, if type, order and shape are as wanted. The header is a Python dictionary, its keys in any order.
fn shape(header: &str) -> Result<[usize; 2], Fault> {
    let fault = |wrong: String| Fault::new(wrong, EXPECTED);
    let value = |key: &str| {
        let found = ['\'', '"'].iter().find_map(|quote| {
            let (_, after) = header.split_once(&format!("{quote}{key}{quote}"))?;
            Some(after.trim_start().strip_prefix(':')?.trim_start())
        });
        found.ok_or_else(|| fault(format!("its header has no '{key}'")))
    };
    let descr = value("descr")?;
    let quoted = |quote: char| descr.strip_prefix(quote)?.split_once(quote);
    match quoted('\'').or_else(|| quoted('"')) {
        Some(("<f8", _)) => {}
        Some((other, _)) => return Err(fault(format!("its type is '{other}'"))),
        None => return Err(fault("its type has fields".into())),
    }
    if !value("fortran_order")?.starts_with("False") {
        return Err(fault("it is in Fortran order".into()));
    }
    let shape = value("shape")?;
    let inner = shape.strip_prefix('(').and_then(|s| s.split_once(')'));
    let (inner, _) = inner.ok_or_else(|| fault("its header has no shape".into()))?;
    let wrong = || fault(format!("its shape is ({inner})"));
    let sides = inner.split(',').map(str::trim).filter(|s| !s.is_empty());
    let sides: Result<Vec<usize>, _> = sides.map(str::parse).collect();
    match sides.map_err(|_| wrong())?[..] {
        [rows, columns @ (6 | 7)] => Ok([rows, columns]),
        _ => Err(wrong()),
    }
}
