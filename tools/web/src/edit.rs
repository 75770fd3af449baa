//! One key of an airframe file, set for its user.

use toml_edit::{DocumentMut, Item, Table, Value};

/// The text with `key = value` in `[table]`, without the key where there is no value; the rest stays as it
/// is written.
///
/// # Errors
/// A text that is no TOML, a value that is none.
pub fn set(text: &str, table: &str, key: &str, value: &str) -> Result<String, String> {
    let mut document: DocumentMut = text
        .parse()
        .map_err(|error| format!("the file is no TOML yet: {error}"))?;
    if value.is_empty() {
        if let Some(table) = document.get_mut(table).and_then(Item::as_table_like_mut) {
            table.remove(key);
        }
        return Ok(document.to_string());
    }
    let mut value: Value = value
        .parse()
        .map_err(|error| format!("{value} is no value: {error}"))?;
    let tables = document.entry(table).or_insert_with(|| Item::Table(Table::new()));
    let tables = tables
        .as_table_like_mut()
        .ok_or_else(|| format!("`{table}` is no table"))?;
    if let Some(old) = tables.get(key).and_then(Item::as_value) {
        *value.decor_mut() = old.decor().clone();
    }
    tables.insert(key, Item::Value(value));
    Ok(document.to_string())
}
