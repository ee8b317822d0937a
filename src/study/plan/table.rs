//! Tables of an experiment file: one laid over another, and where a key stands.

use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// A table with the entries of another in place of its own of the same name; the error is the place of what is no table.
pub(super) fn overlay<'i>(
    table: &Spanned<DeTable<'i>>,
    quick: Spanned<DeValue<'i>>,
) -> Result<Spanned<DeTable<'i>>, usize> {
    let start = quick.span().start;
    let DeValue::Table(entries) = quick.into_inner() else {
        return Err(start);
    };
    let mut table = table.clone();
    for (key, value) in entries {
        table.get_mut().remove(key.get_ref().as_ref());
        table.get_mut().insert(key, value);
    }
    Ok(table)
}

/// Where a key stands, with dots between tables and keys; if not itself, then its table.
pub(super) fn place(table: &DeTable, key: &str) -> Option<usize> {
    let mut outside = Some(table);
    let mut found = None;
    for part in key.split('.') {
        let Some((key, value)) = outside.and_then(|table| table.get_key_value(part)) else {
            break;
        };
        found = Some(key.span().start);
        outside = value.get_ref().as_table();
    }
    found
}
