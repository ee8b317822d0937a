//! Rays of a user's own, as text and as arrays.

use super::case;
use crate::rays::file;
use crate::study::stability::case::{Case, Finding};

/// The cases of ray files.
pub(super) fn cases() -> Vec<Case> {
    vec![
        case("csv-empty", "emptiness", || {
            told(
                "r.csv",
                b"",
                "r.csv: the file is empty; expected 'ox,oy,oz,dx,dy,dz' or 'ox,oy,oz,dx,dy,dz,tmax'",
            )
        }),
        case("csv-without-rays", "emptiness", || {
            told(
                "r.csv",
                b"ox,oy,oz,dx,dy,dz,tmax\n\n\n",
                "r.csv: there are no rays in it; expected at least one",
            )
        }),
        case("csv-other-columns", "headers", || {
            told(
                "r.csv",
                b"x,y,z\n0,0,0\n",
                "r.csv:1: the header is 'x,y,z'; expected 'ox,oy,oz,dx,dy,dz' or 'ox,oy,oz,dx,dy,dz,tmax'",
            )
        }),
        case("csv-escape-sequence", "control characters", || {
            told(
                "r.csv",
                b"ox,\x1b[2J\n",
                "r.csv:1: the header is 'ox,\\u{1b}[2J'; expected 'ox,oy,oz,dx,dy,dz' or 'ox,oy,oz,dx,dy,dz,tmax'",
            )
        }),
        case("csv-five-fields", "fields", || {
            told(
                "r.csv",
                b"ox,oy,oz,dx,dy,dz,tmax\n0,0,0,1,1\n",
                "r.csv:2: 5 fields; expected 7, as in the header",
            )
        }),
        case("csv-not-a-number", "numbers", || {
            told(
                "r.csv",
                b"ox,oy,oz,dx,dy,dz,tmax\n0,nan,0,0,0,1,\n",
                "r.csv:2: oy is NaN; it must be a finite number",
            )
        }),
        case("csv-number-too-large", "overflow", || {
            told(
                "r.csv",
                b"ox,oy,oz,dx,dy,dz,tmax\n0,0,1e309,0,0,1,\n",
                "r.csv:2: oz is inf; it must be a finite number",
            )
        }),
        case("csv-no-direction", "directions", || {
            told(
                "r.csv",
                b"ox,oy,oz,dx,dy,dz,tmax\n0,0,0,0,-0,0,\n",
                "r.csv:2: the direction is zero; at least one of dx, dy and dz must not be zero",
            )
        }),
        case("csv-direction-too-long", "overflow", || {
            told(
                "r.csv",
                b"ox,oy,oz,dx,dy,dz,tmax\n0,0,0,0,0,1e51,\n",
                "r.csv:2: the largest part of the direction is 1e51; it must lie within 1e-50 to 1e50: scale the direction; tmax counts in units of it",
            )
        }),
        case("csv-direction-too-short", "underflow", || {
            told(
                "r.csv",
                b"ox,oy,oz,dx,dy,dz,tmax\n0,0,0,0,0,5e-324,\n",
                "r.csv:2: the largest part of the direction is 5e-324; it must lie within 1e-50 to 1e50: scale the direction; tmax counts in units of it",
            )
        }),
        case("csv-ends-before-it-begins", "ranges", || {
            told(
                "r.csv",
                b"ox,oy,oz,dx,dy,dz,tmax\n0,0,0,0,0,1,-1\n",
                "r.csv:2: tmax is -1; it must be 0 or more; blank or inf for a ray without end",
            )
        }),
        case("npy-no-array", "magic", || {
            told(
                "r.npy",
                b"\x93NUMPX",
                "r.npy: does not begin as a .npy file does; expected an array of type '<f8', in C order, of shape (n, 6) or (n, 7), as numpy.save writes it",
            )
        }),
        case("npy-header-of-four-gigabytes", "allocation", || {
            told(
                "r.npy",
                b"\x93NUMPY\x02\0\xff\xff\xff\xff{",
                "r.npy: the file ends within its header; expected an array of type '<f8', in C order, of shape (n, 6) or (n, 7), as numpy.save writes it",
            )
        }),
        case("npy-rows-without-end", "allocation", || {
            told(
                "r.npy",
                npy("<f8", "False", "(18446744073709551615, 7)"),
                "r.npy: row 0: the file ends before its end; its header says 18446744073709551615 rows of 7 numbers",
            )
        }),
        case("npy-quintillion-rows", "allocation", || {
            told(
                "r.npy",
                npy("<f8", "False", "(1152921504606846976, 6)"),
                "r.npy: row 0: the file ends before its end; its header says 1152921504606846976 rows of 6 numbers",
            )
        }),
        case("npy-single-precision", "types", || {
            told(
                "r.npy",
                npy("<f4", "False", "(1, 6)"),
                "r.npy: its type is '<f4'; expected an array of type '<f8', in C order, of shape (n, 6) or (n, 7), as numpy.save writes it",
            )
        }),
        case("npy-fortran-order", "order", || {
            told(
                "r.npy",
                npy("<f8", "True", "(1, 6)"),
                "r.npy: it is in Fortran order; expected an array of type '<f8', in C order, of shape (n, 6) or (n, 7), as numpy.save writes it",
            )
        }),
        case("npy-one-row-without-numbers", "truncation", || {
            told(
                "r.npy",
                npy("<f8", "False", "(1, 6)"),
                "r.npy: row 0: the file ends before its end; its header says 1 rows of 6 numbers",
            )
        }),
        case("npy-no-rows", "emptiness", || {
            told(
                "r.npy",
                npy("<f8", "False", "(0, 6)"),
                "r.npy: there are no rays in it; expected at least one",
            )
        }),
        case("npy-version-nine", "versions", || {
            told(
                "r.npy",
                b"\x93NUMPY\x09\0",
                "r.npy: of version 9 of the format; expected an array of type '<f8', in C order, of shape (n, 6) or (n, 7), as numpy.save writes it",
            )
        }),
    ]
}

/// What is said of a file: how many rays it holds, or why it is refused.
fn told(name: &str, bytes: impl AsRef<[u8]>, expected: &str) -> Finding {
    let measured = match file::parse(name, bytes.as_ref()) {
        Ok(casts) => format!("{} rays", casts.len()),
        Err(error) => error.to_string(),
    };
    Finding::of(expected, measured)
}

/// The header of a NumPy array, and nothing behind it.
fn npy(descr: &str, fortran: &str, shape: &str) -> Vec<u8> {
    let header =
        format!("{{'descr': '{descr}', 'fortran_order': {fortran}, 'shape': {shape}, }}\n");
    let length = (header.len() as u16).to_le_bytes();
    [b"\x93NUMPY\x01\0", &length[..], header.as_bytes()].concat()
}
