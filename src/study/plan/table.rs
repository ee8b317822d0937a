//! Tables of an experiment file: one laid over another, and where a key stands.

use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// A table with the entries of another in place of its own of the same name, within tables too; the error is the place of what is no table.
pub(super) fn overlay<'i>(
    table: &Spanned<DeTable<'i>>,
    quick: Spanned<DeValue<'i>>,
) -> Result<Spanned<DeTable<'i>>, usize> {
    let start = quick.span().start;
    let DeValue::Table(entries) = quick.into_inner() else {
        return Err(start);
    };
    let mut table = table.clone();
    merge(table.get_mut(), entries);
    Ok(table)
}

/// Put entries in place of those of the same key; of a table, its entries one by one.
fn merge<'i>(table: &mut DeTable<'i>, entries: DeTable<'i>) {
    for (key, value) in entries {
        let name = key.get_ref().as_ref();
        let own = table.get_mut(name).map(Spanned::get_mut);
        if let (Some(DeValue::Table(own)), DeValue::Table(inner)) = (own, value.get_ref()) {
            merge(own, inner.clone());
        } else {
            table.remove(name);
            table.insert(key, value);
        }
    }
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
