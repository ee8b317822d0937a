//! The kernels that are compared: numbers of 64 or 32 bits, and whether planes are widened.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

/// How a line meets boxes and objects.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub enum Kernel {
    /// The study's own: f64, closed, unpadded.
    F64,
    /// f32, closed, unpadded.
    F32,
    /// f32, each plane's t widened to both sides: never a wrong miss.
    F32Padded,
}

impl Kernel {
    /// Each of them.
    pub const ALL: [Self; 3] = [Self::F64, Self::F32, Self::F32Padded];

    /// The name in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::F64 => "f64",
            Self::F32 => "f32",
            Self::F32Padded => "f32-padded",
        }
    }
}

impl FromStr for Kernel {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let named = Self::ALL.into_iter().find(|kernel| kernel.name() == text);
        named.ok_or_else(|| {
            let names = Self::ALL.map(Self::name).join(", ");
            format!("'{text}' is no kernel; expected one of {names}")
        })
    }
}

impl TryFrom<String> for Kernel {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

impl From<Kernel> for String {
    fn from(kernel: Kernel) -> Self {
        kernel.name().into()
    }
}

impl fmt::Display for Kernel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}
