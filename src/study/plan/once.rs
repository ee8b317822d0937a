//! Lists in which nothing may be named twice.

use std::fmt::Display;

use super::{Wrong, wrong_unless};

/// At least one thing of this sort, none twice.
pub(in crate::study) fn each_once<T: PartialEq + Display>(
    key: &'static str,
    sort: &str,
    all: &[T],
) -> Result<(), Wrong> {
    wrong_unless(!all.is_empty(), key, || {
        format!("{key} must name at least one")
    })?;
    none_twice(key, sort, all)
}

/// Nothing of this sort twice.
pub(in crate::study) fn none_twice<T: PartialEq + Display>(
    key: &'static str,
    sort: &str,
    all: &[T],
) -> Result<(), Wrong> {
    let again = |i: &usize| all[..*i].contains(&all[*i]);
    match (1..all.len()).find(again) {
        None => Ok(()),
        Some(i) => Err(Wrong {
            key,
            message: format!("{sort} '{}' is named twice", all[i]),
        }),
    }
}
