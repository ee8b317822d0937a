//! Hard cases of files.

use super::case::Case;

/// The cases of this group.
pub fn cases() -> Vec<Case> {
    Vec::new()
}
