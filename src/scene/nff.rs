//! Neutral File Format (Haines): a scene with its camera, lights and materials, read and written.
//!
//! Words are parted by any white space; `#` begins a comment. The records:
//!
//! | record | contents |
//! |:---|:---|
//! | `b` | background: red, green, blue |
//! | `v` | view: the lines `from`, `at`, `up` (three numbers each), `angle`, `hither`, `resolution` (two) |
//! | `l` | light: position, perhaps a colour |
//! | `f` | material of what follows: red, green, blue, Kd, Ks, Shine, T, index of refraction |
//! | `s` | sphere: centre, radius |
//! | `c` | open cone: base, its radius, apex, its radius |
//! | `p` | polygon: number of corners, corners |
//! | `pp` | patch: number of corners, and for each the corner and its normal |

mod number;
mod read;
mod write;

pub(super) use read::parse;
